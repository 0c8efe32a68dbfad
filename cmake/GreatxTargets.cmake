# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0

# Options that every target of the project is compiled with.
add_library(greatx_options INTERFACE)
target_compile_options(greatx_options INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual -Werror
  # A unity build of tests mixes files: a name of one file then hides that of another.
  $<$<NOT:$<BOOL:$<TARGET_PROPERTY:GREATX_MIXES_FILES>>>:-Wshadow>
  # Vulkan structs are initialized with their sType alone; the other members are zero.
  -Wno-missing-field-initializers)
target_include_directories(greatx_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(greatx_options INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_FORCE_DEPTH_ZERO_TO_ONE
                                                    GLM_ENABLE_EXPERIMENTAL
                                                    GREATX_VERSION="${PROJECT_VERSION}")
# Without this option, compilers may fuse multiplications and additions and give different results.
target_compile_options(greatx_options INTERFACE -ffp-contract=off)
# Code that reads untrusted files is hardened: stack canaries, bounds checks of buffers and containers where
# the compiler and the library know the bounds, addresses that are resolved at start and then read-only, and
# position-independent executables. tests/apps/check_binaries.py checks each of these. Sanitizers have their
# own checks and must not be combined with these. Libraries that only compute with values already checked
# elsewhere (COMPUTES of greatx_room) have no container checks, which would slow down their inner loops.
if(NOT GREATX_SANITIZE)
  target_compile_options(greatx_options INTERFACE
                         -fstack-protector-strong
                         $<$<NOT:$<BOOL:$<TARGET_PROPERTY:GREATX_COMPUTES>>>:-D_GLIBCXX_ASSERTIONS>
                         # _FORTIFY_SOURCE needs an optimizing build.
                         "$<$<NOT:$<CONFIG:Debug>>:-U_FORTIFY_SOURCE;-D_FORTIFY_SOURCE=3>")
  target_link_options(greatx_options INTERFACE -Wl,-z,relro -Wl,-z,now -Wl,-z,noexecstack)
endif()
if(GREATX_FUZZERS)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "GREATX_FUZZERS: libFuzzer belongs to clang, found ${CMAKE_CXX_COMPILER_ID}")
  endif()
  # Warnings are errors with GCC; clang has others.
  target_compile_options(greatx_options INTERFACE -fsanitize=fuzzer-no-link -Wno-error)
endif()
if(GREATX_SANITIZE STREQUAL "threads")
  # ThreadSanitizer does not see fences alone; the one in sim/channel stands beside atomic operations.
  target_compile_options(greatx_options INTERFACE -fsanitize=thread -Wno-tsan)
  target_link_options(greatx_options INTERFACE -fsanitize=thread)
elseif(GREATX_SANITIZE)
  target_compile_options(greatx_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined
                                                  -fno-omit-frame-pointer)
  target_link_options(greatx_options INTERFACE -fsanitize=address,undefined)
endif()

# greatx_target(VARIABLE ROOM): sets VARIABLE to the library of a room. The library of rf/radar/echoes is
# greatx_rf_radar_echoes.
function(greatx_target VARIABLE ROOM)
  string(REPLACE "/" "_" name ${ROOM})
  set(${VARIABLE} greatx_${name} PARENT_SCOPE)
endfunction()

# greatx_links(TARGET ROOM...): links a program or a module with the libraries of its rooms.
# tests/apps/check_arrows.py reads these calls.
function(greatx_links TARGET)
  foreach(room ${ARGN})
    greatx_target(library ${room})
    target_link_libraries(${TARGET} PRIVATE ${library})
  endforeach()
endfunction()

# greatx_room(ROOM [COMPUTES] [APART] SOURCES FILE... ROOMS ROOM... USES LIBRARY...): declares a folder and
# its static library. ROOMS are the only other rooms whose headers its files may include;
# tests/apps/check_arrows.py checks this. USES are external libraries. COMPUTES: the room reads no untrusted
# input (see above). APART: its files are compiled one by one even in a unity build.
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
  # A library of all rooms of a top-level folder, for tests.
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

# greatx_built_effects(ROOM...): tells the files of these rooms by core/built_effects.h which effects of radio
# the program has (GREATX_EFFECTS).
function(greatx_built_effects)
  foreach(room ${ARGN})
    greatx_target(library ${room})
    target_compile_definitions(${library} PRIVATE
                               GREATX_BUILDS_ALL_EFFECTS=$<STREQUAL:${GREATX_EFFECTS},all>)
  endforeach()
endfunction()

# greatx_compile_fast(TARGET): compiles a test with little optimization. Tests are compiled more often than
# they run, and a run spends its time in the rooms that it tests.
function(greatx_compile_fast TARGET)
  target_compile_options(${TARGET} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# Test programs are many and link much, so they are linked by the quickest linker that is there.
find_program(GREATX_LLD ld.lld)
find_program(GREATX_GOLD ld.gold)
set(greatx_test_linker "")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND GREATX_LLD)
  set(greatx_test_linker -fuse-ld=lld)
elseif(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND GREATX_GOLD)
  set(greatx_test_linker -fuse-ld=gold)
endif()

# greatx_test(NAME [SUITES] [COST NUMBER] SOURCES ... ALONE ... LINK ...): declares a GoogleTest program and
# adds its tests to ctest with the label NAME: one by one, or with SUITES each suite in one process. Tests
# whose name has "HardCase" in it also have the label "hard" (cmake/GreatxListTests.cmake). ctest starts tests
# of a greater COST first. A unity build compiles the files of ALONE one by one, because their anonymous
# namespaces share names with other files.
function(greatx_test NAME)
  cmake_parse_arguments(ARG "SUITES" "COST" "SOURCES;ALONE;LINK" ${ARGN})
  add_executable(test_${NAME} ${ARG_SOURCES} ${ARG_ALONE})
  set_target_properties(test_${NAME} PROPERTIES UNITY_BUILD "${GREATX_UNITY}" UNITY_BUILD_BATCH_SIZE 7
                                                GREATX_MIXES_FILES "${GREATX_UNITY}")
  if(ARG_ALONE)
    set_source_files_properties(${ARG_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
  greatx_compile_fast(test_${NAME})
  target_link_libraries(test_${NAME} PRIVATE greatx_options ${ARG_LINK} greatx_core greatx_test_support
                                             GTest::gtest GTest::gmock)
  if(GREATX_PRECOMPILED_HEADERS)
    target_precompile_headers(test_${NAME} REUSE_FROM greatx_test_headers)
  endif()
  target_link_options(test_${NAME} PRIVATE ${greatx_test_linker})
  set_property(GLOBAL APPEND PROPERTY GREATX_TEST_PROGRAMS test_${NAME})
  if(NOT ARG_COST)
    set(ARG_COST 0)
  endif()
  set(list ${CMAKE_CURRENT_BINARY_DIR}/tests_${NAME}.cmake)
  set(lister ${PROJECT_SOURCE_DIR}/cmake/GreatxListTests.cmake)
  set_property(TARGET test_${NAME} APPEND PROPERTY LINK_DEPENDS ${lister})
  add_custom_command(TARGET test_${NAME} POST_BUILD
    COMMAND ${CMAKE_COMMAND} -DPROGRAM=$<TARGET_FILE:test_${NAME}> -DLABEL=${NAME} -DSUITES=${ARG_SUITES}
            -DCOST=${ARG_COST} -DFILE=${list} -P ${lister}
    VERBATIM)
  # ctest reads the second file, which reads the first one if the program has been built.
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/include_${NAME}.cmake
       "if(EXISTS \"${list}\")\n"
       "  include(\"${list}\")\n"
       "else()\n"
       "  add_test(test_${NAME}_was_not_built test_${NAME})\n"
       "endif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${CMAKE_CURRENT_BINARY_DIR}/include_${NAME}.cmake)
endfunction()
