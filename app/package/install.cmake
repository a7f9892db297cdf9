# Installation and Debian packages of the program, and of the libraries for other programs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(targets GLOBAL PROPERTY roomradar_libraries)
list(APPEND targets roomradar_options roomradar_warnings)
set_target_properties(roomradar_options PROPERTIES EXPORT_NAME options)
set_target_properties(roomradar_warnings PROPERTIES EXPORT_NAME warnings)

# Each Debian package has the licence in a folder of its own.
function(install_licence package component)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} RENAME copyright COMPONENT ${component})
endfunction()

# The program.
get_property(programs GLOBAL PROPERTY roomradar_programs)
install(TARGETS roomradar ${programs} COMPONENT program)
install(TARGETS roomradar_video LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/roomradar COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/roomradar.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/roomradar.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME roomradar COMPONENT program)
install(FILES ${PROJECT_BINARY_DIR}/roomradar.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions
  RENAME _roomradar COMPONENT program)
install(FILES app/quality/presets.json app/run/frame-stream.schema.json DESTINATION ${CMAKE_INSTALL_DATADIR}/roomradar COMPONENT program)
if(ROOMRADAR_HAS_WINDOW)
  install(FILES app/package/roomradar.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications COMPONENT program)
  install(FILES app/package/roomradar.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/mime/packages COMPONENT program)
  install(FILES app/package/roomradar.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps
    COMPONENT program)
endif()
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install_licence(roomradar program)

# The library for C, engines and other languages, and what programs need to link it.
set(components program development)
if(ROOMRADAR_WITH_C_API)
  list(APPEND components library c_development)
  install(TARGETS roomradar_c LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT c_development)
  get_target_property(c_headers roomradar_c C_HEADERS)
  install(FILES ${c_headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/roomradar-c COMPONENT c_development)
  file(RELATIVE_PATH prefix_of_pc /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
  configure_file(app/package/roomradar.pc.in ${PROJECT_BINARY_DIR}/roomradar.pc @ONLY)
  install(FILES ${PROJECT_BINARY_DIR}/roomradar.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT c_development)
  install_licence(libroomradar0 library)
  install_licence(libroomradar-c-dev c_development)
endif()

# The libraries: find_package(roomradar COMPONENTS ...); see roomradar-config.cmake.in.
install(TARGETS ${targets} EXPORT roomradar COMPONENT development)
set(header_dir ${CMAKE_INSTALL_INCLUDEDIR}/roomradar)
get_property(internal GLOBAL PROPERTY roomradar_internal_folders)
set(excluded "")
foreach(folder app/c_api app/package ${internal})
  list(APPEND excluded PATTERN ${folder} EXCLUDE)
endforeach()
install(DIRECTORY mapping radar dynamic app DESTINATION ${header_dir} COMPONENT development FILES_MATCHING PATTERN "*.hpp"
  ${excluded})
install(FILES ${PROJECT_BINARY_DIR}/generated/mapping/types/system/version.hpp
  DESTINATION ${header_dir}/mapping/types/system COMPONENT development)
# Static libraries fit the OpenCV that they were built with: installed, they look for its libraries by name and version.
get_target_property(opencv_soname opencv_core IMPORTED_SONAME_RELEASE)
string(REGEX REPLACE ".*\\.so\\." "" opencv_abi "${opencv_soname}")
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/roomradar)
install(EXPORT roomradar NAMESPACE roomradar:: FILE roomradar-targets.cmake DESTINATION ${config_dir} COMPONENT development)
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/roomradar-config.cmake.in ${PROJECT_BINARY_DIR}/roomradar-config.cmake
  INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/roomradar-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/roomradar-config.cmake ${PROJECT_BINARY_DIR}/roomradar-config-version.cmake
  DESTINATION ${config_dir} COMPONENT development)
install_licence(libroomradar-dev development)

# The Python module. ROOMRADAR_PYTHON_DIR: where Debian's Python looks for modules, or the root of a wheel.
if(ROOMRADAR_HAS_PYTHON)
  list(APPEND components python)
  set(ROOMRADAR_PYTHON_DIR lib/python3/dist-packages CACHE STRING "folder of Python modules, relative to the prefix")
  install(TARGETS _roomradar DESTINATION ${ROOMRADAR_PYTHON_DIR}/roomradar COMPONENT python)
  install(FILES app/python/roomradar/__init__.py app/python/roomradar/__init__.pyi app/python/roomradar/py.typed
    DESTINATION ${ROOMRADAR_PYTHON_DIR}/roomradar COMPONENT python)
  # What app/python/setup.py builds.
  add_custom_target(install_python
    COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --component python DEPENDS _roomradar roomradar_video)
  if(SKBUILD)
    install(TARGETS roomradar_video LIBRARY DESTINATION ${ROOMRADAR_PYTHON_DIR}/roomradar COMPONENT python)
  else()
    install(DIRECTORY app/python/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-roomradar COMPONENT python
      FILES_MATCHING PATTERN "*.py")
    install_licence(python3-roomradar python)
  endif()
endif()

# Jobs on several machines.
if(ROOMRADAR_HAS_MPI)
  list(APPEND components mpi)
  install(TARGETS roomradar-mpi COMPONENT mpi)
  install_licence(roomradar-mpi mpi)
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME roomradar)
# The first line of a component's description is the package's summary: no common one is set.
set(CPACK_PACKAGE_CONTACT "roomradar developers <roomradar@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME roomradar)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
# Mesa's EGL and its software renderer, for machines without a GPU; the Kinect's udev rules come with its library.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libfreenect-bin, fonts-dejavu-core")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "prescan a room with a depth camera, then run augmented reality in it
Keeps a scanned room as an octree on disk with a mesh, and lets virtual
objects rest on, slide along and be stopped by its surfaces, also by those
that the camera cannot see now.")
set(CPACK_DEBIAN_MPI_PACKAGE_NAME roomradar-mpi)
set(CPACK_DEBIAN_MPI_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_MPI_PACKAGE_DEPENDS "roomradar (= ${PROJECT_VERSION}), openmpi-bin")
set(CPACK_COMPONENT_MPI_DESCRIPTION "jobs of roomradar on several machines
Runs the jobs of `roomradar farm` and `roomradar building` on the ranks of an
MPI program, under mpirun or srun.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libroomradar-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
# zlib1g-dev: assimp's targets link it, libassimp-dev does not depend on it.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "libassimp-dev, libbz2-dev, libceres-dev, libdraco-dev, libegl-dev, libeigen3-dev, libjpeg62-turbo-dev, liblz4-dev, libmeshoptimizer-dev, libminizip-dev, liboctomap-dev, libopengl-dev, libpng-dev, libsqlite3-dev, libssl-dev, libstb-dev, libtbb-dev, libwebp-dev, libzstd-dev, nlohmann-json3-dev, zlib1g-dev")
foreach(module ${opencv_modules})
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libopencv-${module}${opencv_abi}")
endforeach()
# Component sources only.
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "libfreenect-dev, libopenni2-dev, pkg-config")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "roomradar")  # the module for videos
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "augmented reality in scanned rooms: static C++ libraries and headers
For programs in C++: maps of rooms, Cyber Radar, dynamic surfaces, frame
sources, and sessions with virtual objects.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libroomradar0)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
# The package that dpkg-shlibdeps names for programs that link the library. CPack generates this file for all packages or none.
if(ROOMRADAR_WITH_C_API)
  get_target_property(soversion roomradar_c SOVERSION)
  set(shlibs ${PROJECT_BINARY_DIR}/package/shlibs)
  file(CONFIGURE OUTPUT ${shlibs} CONTENT "libroomradar @soversion@ libroomradar@soversion@ (>= @PROJECT_VERSION@)\n" @ONLY)
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${shlibs})
  set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_STRICT_PERMISSION ON)
endif()
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "roomradar")  # the module for videos
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "augmented reality in scanned rooms: shared library for C
For engines and other languages: saved rooms, sessions, objects, radar.")
set(CPACK_DEBIAN_C_DEVELOPMENT_PACKAGE_NAME libroomradar-c-dev)
set(CPACK_DEBIAN_C_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_C_DEVELOPMENT_PACKAGE_DEPENDS "libroomradar0 (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_C_DEVELOPMENT_DESCRIPTION "augmented reality in scanned rooms: headers for C
Header files of roomradar's C interface, and its pkg-config file.")
if(ROOMRADAR_HAS_PYTHON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-roomradar)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  math(EXPR next_python "${Python_VERSION_MINOR} + 1" OUTPUT_FORMAT DECIMAL)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python}), python3-numpy, libegl-mesa0, libgl1-mesa-dri")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-matplotlib, python3-open3d, roomradar")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA
    ${CMAKE_CURRENT_LIST_DIR}/python/postinst ${CMAKE_CURRENT_LIST_DIR}/python/prerm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "augmented reality in scanned rooms: Python module
Frame sources, scans, maps, augmented reality sessions, Cyber Radar and a
simulator, with NumPy arrays.")
endif()
include(CPack)
