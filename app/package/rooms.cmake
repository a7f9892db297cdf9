# Functions that turn a folder into a target roomradar::NAME, installed and exported. Its links state which folders it
# may include.
set_property(GLOBAL PROPERTY roomradar_libraries "")

# roomradar_library(NAME [FILE_BY_FILE] [INTERNAL] [SOURCES FILE...] [PUBLIC TARGET...] [PRIVATE TARGET...])
# FILE_BY_FILE: no unity build. For what computes: inlining across sources changes which products and sums the compiler
# fuses, and with them the last bits of maps and of recorded sessions, which must not depend on how a build was made.
# INTERNAL: part of the program, not installed as a library.
function(roomradar_library name)
  cmake_parse_arguments(ARG "FILE_BY_FILE;INTERNAL" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(roomradar_${name} STATIC ${ARG_SOURCES})
  add_library(roomradar::${name} ALIAS roomradar_${name})
  target_link_libraries(roomradar_${name} PUBLIC ${ARG_PUBLIC} PRIVATE roomradar::warnings ${ARG_PRIVATE})
  set_target_properties(roomradar_${name} PROPERTIES EXPORT_NAME ${name})
  if(ARG_FILE_BY_FILE)
    set_target_properties(roomradar_${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  if(NOT ARG_INTERNAL)
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
