# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0

# Makes packages of Debian: cmake --preset release -DGREATX_DEBIAN=ON, a build, then
# cpack --config build/release/CPackConfig.cmake. packaging/deb.sh does so in a chroot.
#
#   greatx           programs, manual page, completions, examples, schemas, documents
#   python3-greatx   the Python package with its compiled module
#   libgreatx0.1     the library that embeds the engine
#   libgreatx-dev    its header and its CMake package
#
# dpkg-shlibdeps finds the libraries on which they depend.

set(GREATX_MAINTAINER "The greatx authors <greatx@packages.invalid>" CACHE STRING
    "Who answers for Debian's packages: NAME <ADDRESS>")
set(CMAKE_INSTALL_PREFIX /usr)
if(CMAKE_LIBRARY_ARCHITECTURE)
  set(CMAKE_INSTALL_LIBDIR lib/${CMAKE_LIBRARY_ARCHITECTURE})
endif()
# All libraries are in the system's folders. HDF5's folder of headers has no library that is loaded.
set(CMAKE_INSTALL_RPATH_USE_LINK_PATH OFF)
set(greatx_python_folder lib/python3/dist-packages)
set(greatx_zsh_folder vendor-completions)

set(soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME greatx)
set(CPACK_PACKAGE_CONTACT ${GREATX_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "simulator of sensing and communication in one scene")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/deb)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program python library development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME greatx)
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
"greatx computes channel state information, RGB, depth, LiDAR, radar, events
 and poses of one moving scene, on any Vulkan 1.3 device, GPU or CPU.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS "mesa-vulkan-drivers")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-greatx, libgreatx-dev")

find_package(Python COMPONENTS Interpreter)
math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-greatx)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_COMPONENT_PYTHON_DESCRIPTION
    "This package reads data sets of greatx, converts them, and runs the\n simulator from Python.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS "mesa-vulkan-drivers")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "greatx")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libgreatx${soversion})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "This is the library for programs that embed the simulator.")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${PROJECT_BINARY_DIR}/debian/shlibs
                                               ${PROJECT_BINARY_DIR}/debian/triggers)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_RECOMMENDS "mesa-vulkan-drivers")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libgreatx-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION
    "This is what a program that embeds the simulator is compiled with: a header\n and a package of CMake.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libgreatx${soversion} (= ${PROJECT_VERSION})")

# Every package of Debian has its licence and its changes in its own folder, and manual pages are compressed.
set(debian ${PROJECT_BINARY_DIR}/debian)
file(CONFIGURE OUTPUT ${debian}/changelog CONTENT
"greatx (@PROJECT_VERSION@) unstable; urgency=medium

  * Built from the project's sources by CPack.

 -- @GREATX_MAINTAINER@  Thu, 01 Jan 2026 00:00:00 +0000
" @ONLY)
file(WRITE ${debian}/copyright
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: greatx

Files: *
Copyright: 2026 The greatx authors
License: Apache-2.0
 On Debian systems, the text of this licence is in
 /usr/share/common-licenses/Apache-2.0.
")
file(WRITE ${debian}/shlibs "libgreatx ${soversion} libgreatx${soversion} (>= ${PROJECT_VERSION})\n")
file(WRITE ${debian}/triggers "activate-noawait ldconfig\n")
find_program(GZIP gzip REQUIRED)
set(manual ${PROJECT_BINARY_DIR}/manual)
add_custom_target(greatx_debian ALL
  COMMAND ${GZIP} -9nkf ${debian}/changelog
  COMMAND ${GZIP} -9nkf ${manual}/greatx.1 ${manual}/greatx-places.1
  COMMENT "" VERBATIM)
foreach(component program python library development)
  string(TOUPPER ${component} upper)
  set(folder share/doc/${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  install(FILES ${debian}/copyright DESTINATION ${folder} COMPONENT ${component})
  install(FILES ${debian}/changelog.gz DESTINATION ${folder} COMPONENT ${component})
endforeach()
