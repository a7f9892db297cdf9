# Functions that turn a folder into a target roomradar::NAME, installed and exported. Its links state which folders it
# may include.
set_property(GLOBAL PROPERTY roomradar_libraries "")

# roomradar_library(NAME [SOURCES FILE...] [PUBLIC TARGET...] [PRIVATE TARGET...])
function(roomradar_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(roomradar_${name} STATIC ${ARG_SOURCES})
  add_library(roomradar::${name} ALIAS roomradar_${name})
  target_link_libraries(roomradar_${name} PUBLIC ${ARG_PUBLIC} PRIVATE roomradar::warnings ${ARG_PRIVATE})
  set_target_properties(roomradar_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY roomradar_libraries roomradar_${name})
endfunction()

# roomradar_group(NAME LIBRARY...): one target name for several libraries.
function(roomradar_group name)
  add_library(roomradar_${name} INTERFACE)
  add_library(roomradar::${name} ALIAS roomradar_${name})
  list(TRANSFORM ARGN PREPEND roomradar::)
  target_link_libraries(roomradar_${name} INTERFACE ${ARGN})
  set_target_properties(roomradar_${name} PROPERTIES EXPORT_NAME ${name})
  set_property(GLOBAL APPEND PROPERTY roomradar_libraries roomradar_${name})
endfunction()
