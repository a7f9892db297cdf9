# Functions that turn a folder into a target roomradar::NAME, installed and exported. Its links state which folders it
# may include.
set_property(GLOBAL PROPERTY roomradar_libraries "")
set_property(GLOBAL PROPERTY roomradar_internal_folders "")

# roomradar_library(NAME [INTERNAL] [SOURCES FILE...] [PUBLIC TARGET...] [PRIVATE TARGET...])
# INTERNAL: part of the program; neither the library nor the folder's headers are installed.
function(roomradar_library name)
  cmake_parse_arguments(ARG "INTERNAL" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(roomradar_${name} STATIC ${ARG_SOURCES})
  add_library(roomradar::${name} ALIAS roomradar_${name})
  target_link_libraries(roomradar_${name} PUBLIC ${ARG_PUBLIC} PRIVATE roomradar::warnings ${ARG_PRIVATE})
  set_target_properties(roomradar_${name} PROPERTIES EXPORT_NAME ${name})
  if(ARG_INTERNAL)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
    set_property(GLOBAL APPEND PROPERTY roomradar_internal_folders ${folder})
  else()
    set_property(GLOBAL APPEND PROPERTY roomradar_libraries roomradar_${name})
  endif()
endfunction()

# roomradar_group(NAME [INTERNAL] LIBRARY...): one target name for several libraries.
function(roomradar_group name)
  cmake_parse_arguments(ARG "INTERNAL" "" "" ${ARGN})
  add_library(roomradar_${name} INTERFACE)
  add_library(roomradar::${name} ALIAS roomradar_${name})
  list(TRANSFORM ARG_UNPARSED_ARGUMENTS PREPEND roomradar:: OUTPUT_VARIABLE libraries)
  target_link_libraries(roomradar_${name} INTERFACE ${libraries})
  set_target_properties(roomradar_${name} PROPERTIES EXPORT_NAME ${name})
  if(NOT ARG_INTERNAL)
    set_property(GLOBAL APPEND PROPERTY roomradar_libraries roomradar_${name})
  endif()
endfunction()
