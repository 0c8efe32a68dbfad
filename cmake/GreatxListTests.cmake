# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
#
# Asks a GoogleTest program for its tests and writes the file from which ctest reads them. With SUITES, the
# tests of a suite run in one process, which starts once: its device and whatever else the tests share are
# made once. Such an entry is named LABEL/SUITE; its output says which of the tests failed. The numbered hard
# cases of a suite are an entry of their own with the label "hard". Suites of many tests start first, so that
# none of them is left at the end. Else every test is an entry, which is better for tests that start other
# programs or take long, since ctest can spread them.
#
# usage: cmake -DPROGRAM=FILE -DLABEL=NAME -DSUITES=BOOL -DCOST=NUMBER -DFILE=FILE -P GreatxListTests.cmake
cmake_policy(VERSION 3.25)

execute_process(COMMAND ${PROGRAM} --gtest_list_tests
                OUTPUT_VARIABLE output RESULT_VARIABLE result TIMEOUT 60)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: ${result}\n${output}")
endif()
# Comments hold values and types of parameters, whose characters mean other things to CMake.
string(REGEX REPLACE " *#[^\n]*" "" output "${output}")
string(REPLACE "\n" ";" lines "${output}")

set(script "")
# An entry counts as skipped if all of its tests are. A failure beside a skipped test stays a failure.
set(all_skipped "\\[  PASSED  \\] 0 tests\\.\n(\\[  SKIPPED \\][^\n]*\n)+$")

function(add_entry NAME FILTER LABELS TESTS)
  set(cost ${COST})
  if(TESTS GREATER cost)
    set(cost ${TESTS})
  endif()
  set(text "add_test([==[${NAME}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${FILTER}]==])\n")
  string(APPEND text "set_tests_properties([==[${NAME}]==] PROPERTIES\n"
                     "  LABELS \"${LABELS}\" COST ${cost}\n"
                     "  SKIP_REGULAR_EXPRESSION [==[${all_skipped}]==])\n")
  string(APPEND script "${text}")
  set(script "${script}" PARENT_SCOPE)
endfunction()

# Adds the entries of a suite: `tests` holds its tests.
macro(end_suite)
  set(hard ${tests})
  list(FILTER hard INCLUDE REGEX HardCase)
  list(FILTER tests EXCLUDE REGEX HardCase)
  if(suite MATCHES HardCase)
    list(APPEND hard ${tests})
    set(tests "")
  endif()
  if(SUITES)
    if(tests)
      list(LENGTH tests count)
      list(JOIN tests ":${suite}." filter)
      add_entry(${LABEL}/${suite} "${suite}.${filter}" ${LABEL} ${count})
    endif()
    if(hard)
      list(LENGTH hard count)
      list(JOIN hard ":${suite}." filter)
      add_entry(${LABEL}/${suite}.HardCases "${suite}.${filter}" "hard;${LABEL}" ${count})
    endif()
  else()
    foreach(test IN LISTS tests)
      add_entry(${suite}.${test} ${suite}.${test} ${LABEL} 0)
    endforeach()
    foreach(test IN LISTS hard)
      add_entry(${suite}.${test} ${suite}.${test} "hard;${LABEL}" 0)
    endforeach()
  endif()
endmacro()

set(suite "")
set(tests "")
foreach(line IN LISTS lines)
  if(line MATCHES "^  ([^ ]+)$")
    list(APPEND tests ${CMAKE_MATCH_1})
  elseif(line MATCHES "^([^ ]+)\\.$")
    set(next ${CMAKE_MATCH_1})
    end_suite()
    set(suite ${next})
    set(tests "")
  endif()
endforeach()
end_suite()
if(script STREQUAL "")
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests: no tests in\n${output}")
endif()
file(WRITE ${FILE} "${script}")
