# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0

# Installs everything but the programs and the Python package, which their own folders install:
#
#   bin/                       greatx, greatx-places (which greatx starts from its own folder)
#   lib/libgreatx.so           for programs that embed the engine; include/greatx/greatx.h, lib/cmake/greatx
#   lib/greatx/python/         the Python package (GREATX_PYTHON_FOLDER)
#   share/man, share/bash-completion, share/zsh, share/fish
#   share/greatx/examples/     scenarios that need files from elsewhere, Python, C++ (embed/)
#   share/greatx/schema/       the JSON schemas of scenarios, places and radio materials
#   share/doc/greatx/          README.md, LICENSE, docs/
#
# At run time the programs need no file of these: scenarios, campaigns, schemas, shaders and fonts are in the
# programs. The folder may be moved as a whole.

include(CMakePackageConfigHelpers)

# The manual page and the completions, which apps/CMakeLists.txt lets the program write.
set(manual ${PROJECT_BINARY_DIR}/manual)
install(FILES ${manual}/greatx.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${manual}/greatx.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
        RENAME greatx)
set(GREATX_ZSH_FOLDER ${CMAKE_INSTALL_DATADIR}/zsh/site-functions CACHE STRING
    "Where the completion of zsh is installed (in packages of Debian: share/zsh/vendor-completions)")
install(FILES ${manual}/greatx.zsh DESTINATION ${GREATX_ZSH_FOLDER} RENAME _greatx)
install(FILES ${manual}/greatx.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
if(GREATX_PLACES_FOUND)
  file(WRITE ${manual}/greatx-places.1 ".so man1/greatx.1\n")
  install(FILES ${manual}/greatx-places.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()

install(DIRECTORY ${PROJECT_SOURCE_DIR}/assets/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/examples/
        DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx/examples/python PATTERN __pycache__ EXCLUDE)
file(GLOB schemas CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/docs/*.schema.json)
install(FILES ${schemas} DESTINATION ${CMAKE_INSTALL_DATADIR}/greatx/schema)
install(FILES ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/LICENSE
        DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
        PATTERN *.schema.json EXCLUDE)

install(TARGETS greatx_engine_library EXPORT greatxTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(FILES ${PROJECT_SOURCE_DIR}/engine/library/greatx.h
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/greatx)
install(EXPORT greatxTargets NAMESPACE greatx:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/greatxConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/greatxConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/greatxConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/greatxConfig.cmake ${PROJECT_BINARY_DIR}/greatxConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/greatx)
