# A fifth of a build was the same headers parsed again for each source. Sources name what they include all the same: the
# Debian packages are built without, and tell who forgot.
set(usual_headers
  <Eigen/Geometry> <nlohmann/json.hpp>
  <algorithm> <array> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <limits> <map> <memory> <optional>
  <random> <span> <string> <utility> <vector>)

file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/precompiled.cpp CONTENT "")
# The same options and warnings as everywhere: the compiler passes over headers that were precompiled with others.
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
    if(type MATCHES "STATIC|EXECUTABLE")  # a plugin is position independent, which these headers are not
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
