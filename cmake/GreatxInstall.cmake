# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0

# Installs everything but the programs and the Python package, which their own folders install:
#
#   bin/                       greatx, greatx-places (which greatx starts from its own folder)
#   lib/libgreatx.so           for programs that embed the engine; include/greatx/greatx.h, lib/cmake/greatx
#   lib/greatx/python/         the Python package
#   share/man, share/bash-completion, share/zsh, share/fish
#   share/greatx/examples/     scenarios that need files from elsewhere, Python, C++ (embed/)
#   share/greatx/schema/       the JSON schemas of scenarios, places and radio materials
#   share/doc/greatx/          README.md, LICENSE, docs/
#
# At run time the programs need no file of these: scenarios, campaigns, schemas, shaders and fonts are in the
# programs. The folder may be moved as a whole.
#
# With GREATX_DEBIAN, the places are those of Debian's packages, which cmake/GreatxDebian.cmake makes of the
# components program, python, library and development.

include(CMakePackageConfigHelpers)

# The manual page and the completions, which apps/CMakeLists.txt lets the program write.
set(manual ${PROJECT_BINARY_DIR}/manual)
if(GREATX_DEBIAN)
  set(page greatx.1.gz)
else()
  set(page greatx.1)
endif()
install(FILES ${manual}/${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
if(GREATX_PLACES_FOUND)
  string(REPLACE greatx greatx-places link ${page})
  install(FILES ${manual}/${link} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
endif()
install(FILES ${manual}/greatx.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME greatx COMPONENT program)
install(FILES ${manual}/greatx.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/${greatx_zsh_folder}
        RENAME _greatx COMPONENT program)
install(FILES ${manual}/greatx.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
        COMPONENT program)

install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx
        COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/examples/
        DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx/examples/python
        COMPONENT program PATTERN __pycache__ EXCLUDE)
file(GLOB schemas CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.schema.json)
install(FILES ${schemas} DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx/schema COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
if(NOT GREATX_DEBIAN)  # its packages have a file "copyright" instead
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
        COMPONENT program PATTERN *.schema.json EXCLUDE)

install(TARGETS greatx_engine_library EXPORT greatxTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(FILES ${PROJECT_SOURCE_DIR}/engine/library/greatx.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/greatx COMPONENT development)
install(EXPORT greatxTargets NAMESPACE greatx:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx
        COMPONENT development)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/greatxConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/greatxConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/greatxConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/greatxConfig.cmake ${PROJECT_BINARY_DIR}/greatxConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx COMPONENT development)
