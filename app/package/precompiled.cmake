# Parsing the same headers again for each source took a fifth of the build time. Sources must still include what they
# use: the Debian packages are built without precompiled headers, which reveals missing includes.
set(usual_headers
  <Eigen/Geometry> ${PROJECT_SOURCE_DIR}/mapping/types/json/json_templates.hpp
  <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <optional>
  <random> <span> <string> <utility> <vector>)

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
# Same options and warnings as all targets: the compiler ignores headers that were precompiled with different options.
function(roomradar_precompiled name)
  add_library(${name} OBJECT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp)
  target_link_libraries(${name} PRIVATE Eigen3::Eigen roomradar::options roomradar::warnings ${ARGN})
endfunction()
roomradar_precompiled(precompiled nlohmann_json::nlohmann_json)
target_precompile_headers(precompiled PRIVATE ${usual_headers})
if(ROOMRADAR_TESTS)
  find_package(GTest REQUIRED)
  roomradar_precompiled(precompiled_tests nlohmann_json::nlohmann_json GTest::gtest)
  target_precompile_headers(precompiled_tests PRIVATE ${usual_headers} <gtest/gtest.h>)
endif()

function(roomradar_use_precompiled directory)
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    if(type MATCHES "STATIC|EXECUTABLE")  # not plugins: they are position independent, these headers are not
      get_target_property(sources ${target} SOURCES)
      if(type STREQUAL EXECUTABLE AND sources MATCHES "[.]cpp")
        target_link_libraries(${target} PRIVATE roomradar::json)  # json_templates.hpp leaves its templates to it
      endif()
      get_target_property(linked ${target} LINK_LIBRARIES)
      if("GTest::gtest" IN_LIST linked)
        target_precompile_headers(${target} REUSE_FROM precompiled_tests)
      else()
        target_precompile_headers(${target} REUSE_FROM precompiled)
      endif()
    endif()
  endforeach()
  get_property(folders DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(folder ${folders})
    roomradar_use_precompiled(${folder})
  endforeach()
endfunction()
roomradar_use_precompiled(${PROJECT_SOURCE_DIR})
