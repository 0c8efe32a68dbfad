# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0

# What every target of the project compiles with.
add_library(greatx_options INTERFACE)
target_compile_options(greatx_options INTERFACE -Wall -Wextra -Wpedantic $<$<NOT:$<BOOL:$<TARGET_PROPERTY:GREATX_MIXES_FILES>>>:-Wshadow> -Wconversion -Wno-sign-conversion
                                                -Wnon-virtual-dtor -Woverloaded-virtual -Werror
                                                # Vulkan's structs are begun with their sType alone; the rest
                                                # is zero.
                                                -Wno-missing-field-initializers)
target_include_directories(greatx_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(greatx_options INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_DEPTH_ZERO_TO_ONE
                                                    GLM_ENABLE_EXPERIMENTAL GREATX_VERSION="${PROJECT_VERSION}")
# The same sums on every compiler: no fused multiply-add that the source does not ask for.
target_compile_options(greatx_options INTERFACE -ffp-contract=off)
# What meets files of strangers fails early and is hard to turn to other ends: canaries on stacks, bounds of
# buffers and of containers checked where the compiler and the library know them, all addresses resolved at
# start and then read-only, no fixed address. tests/apps/check_binaries.py looks for each. Sanitizers have
# checks of their own, and want none beside. Libraries that only compute, from values that others have
# checked, go without the checks of containers (greatx_room's COMPUTES): these cost time in their inner
# loops, and no file of a stranger reaches them.
if(NOT GREATX_SANITIZE)
  target_compile_options(greatx_options INTERFACE -fstack-protector-strong
                                                  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:GREATX_COMPUTES>>>:-D_GLIBCXX_ASSERTIONS>
                                                  # Needs an optimizer.
                                                  "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
  target_link_options(greatx_options INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()
if(GREATX_SANITIZE)
  target_compile_options(greatx_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                  -fno-omit-frame-pointer)
  target_link_options(greatx_options INTERFACE -fsanitize=address,undefined)
endif()

# greatx_target(VARIABLE ROOM): the library of a room; of rf/radar/echoes it is greatx_rf_radar_echoes.
function(greatx_target VARIABLE ROOM)
  string(REPLACE "/" "_" name ${ROOM})
  set(${VARIABLE} greatx_${name} PARENT_SCOPE)
endfunction()

# greatx_links(TARGET ROOM...): what a program or a module is made of; tests/apps/check_arrows.py reads it.
function(greatx_links TARGET)
  foreach(room ${ARGN})
    greatx_target(library ${room})
    target_link_libraries(${TARGET} PRIVATE ${library})
  endforeach()
endfunction()

# greatx_room(ROOM [COMPUTES] [APART] SOURCES FILE... ROOMS ROOM... USES LIBRARY...): a folder and its static
# library. ROOMS are the arrows: the rooms that its files may include, which tests/apps/check_arrows.py holds
# them to. USES are libraries from elsewhere. COMPUTES: it reads no input of strangers (see above). APART: its
# files are compiled one by one even in a unity build.
function(greatx_room ROOM)
  cmake_parse_arguments(ARG "APART;COMPUTES" "" "SOURCES;ROOMS;USES" ${ARGN})
  greatx_target(library ${ROOM})
  set(links greatx_options)
  foreach(other ${ARG_ROOMS})
    greatx_target(name ${other})
    list(APPEND links ${name})
  endforeach()
  if(ARG_SOURCES)
    list(TRANSFORM ARG_SOURCES PREPEND ${PROJECT_SOURCE_DIR}/${ROOM}/)
    add_library(${library} STATIC ${ARG_SOURCES})
    set_target_properties(${library} PROPERTIES UNITY_BUILD "${GREATX_UNITY}" UNITY_BUILD_BATCH_SIZE 10)
    target_link_libraries(${library} PUBLIC ${links} ${ARG_USES})
    set_target_properties(${library} PROPERTIES GREATX_COMPUTES ${ARG_COMPUTES})
    if(ARG_APART)
      set_target_properties(${library} PROPERTIES UNITY_BUILD OFF)
    endif()
  else()
    add_library(${library} INTERFACE)
    target_link_libraries(${library} INTERFACE ${links} ${ARG_USES})
  endif()
  # All rooms of a top folder together, for tests.
  string(REGEX REPLACE "/.*" "" top ${ROOM})
  if(NOT top STREQUAL ROOM)
    if(NOT TARGET greatx_${top})
      add_library(greatx_${top} INTERFACE)
    endif()
    if(NOT top STREQUAL core)
      target_link_libraries(greatx_${top} INTERFACE ${library})
    endif()
  endif()
endfunction()

# Tests are compiled more often than they run, and the time of a run goes into the rooms that they test.
function(greatx_compile_fast TARGET)
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# greatx_test(NAME SOURCES ... ALONE ... LINK ...): a GoogleTest program, each test of it known to ctest under the label
# NAME; those whose name has "HardCase" have the label "hard" as well. A unity build leaves out the files of ALONE, whose
# names in anonymous namespaces are also those of other files.
function(greatx_test NAME)
  cmake_parse_arguments(ARG "" "" "SOURCES;ALONE;LINK" ${ARGN})
  add_executable(test_${NAME} ${ARG_SOURCES} ${ARG_ALONE})
  set_target_properties(test_${NAME} PROPERTIES UNITY_BUILD "${GREATX_UNITY}" UNITY_BUILD_BATCH_SIZE 7)
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  # In a unity build a name of one file hides that of another; file by file, in the preset dev, -Wshadow is on.
  set_target_properties(test_${NAME} PROPERTIES GREATX_MIXES_FILES "${GREATX_UNITY}")
  greatx_compile_fast(test_${NAME})
  target_link_libraries(test_${NAME} PRIVATE greatx_options ${ARG_LINK} greatx_core greatx_test_support GTest::gtest GTest::gmock)
  if(GREATX_PRECOMPILED_HEADERS)
    target_precompile_headers(test_${NAME} REUSE_FROM greatx_test_headers)
  endif()
  set_property(GLOBAL APPEND PROPERTY GREATX_TEST_PROGRAMS test_${NAME})
  gtest_discover_tests(test_${NAME} TEST_FILTER "*HardCase*" TEST_LIST hard_${NAME} DISCOVERY_TIMEOUT 60)
  gtest_discover_tests(test_${NAME} TEST_FILTER "-*HardCase*" TEST_LIST plain_${NAME} DISCOVERY_TIMEOUT 60)
  # Read by ctest after the lists: gtest_discover_tests() itself cannot pass a list of two labels on.
  set(labels ${CMAKE_CURRENT_BINARY_DIR}/labels_${NAME}.cmake)
  file(WRITE ${labels}
       "foreach(test IN LISTS hard_${NAME})\n  set_tests_properties(\"\${test}\" PROPERTIES LABELS \"hard;${NAME}\")\n"
       "endforeach()\n"
       "foreach(test IN LISTS plain_${NAME})\n  set_tests_properties(\"\${test}\" PROPERTIES LABELS ${NAME})\n"
       "endforeach()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${labels})
endfunction()
