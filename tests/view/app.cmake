# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_parts SUITES SOURCES script_test.cpp viewpoint_test.cpp
            LINK greatx_view_camera greatx_view_script greatx_scene_description)

# The window, drawn in memory; and a real one, where a display can be had.
greatx_test(view_window SUITES SOURCES window_test.cpp LINK greatx_view_window PkgConfig::imgui)
find_program(XVFB_RUN xvfb-run)
if(XVFB_RUN)
  add_test(NAME view_window_x11
           COMMAND ${XVFB_RUN} -a -s "-screen 0 1400x900x24 -noreset" $<TARGET_FILE:test_view_window>
                   --gtest_filter=RealWindow.*)
  set_tests_properties(view_window_x11 PROPERTIES LABELS view_window ENVIRONMENT "GREATX_TEST_DISPLAY=1")
endif()

# The real program, by scripts.
greatx_test(view_program
            SOURCES edit_program_test.cpp overlay_program_test.cpp view_bench_test.cpp view_program_test.cpp
            LINK greatx_io greatx_sim_tradeoff_error nlohmann_json::nlohmann_json)
target_compile_definitions(test_view_program
  PRIVATE GREATX_PROGRAM="$<TARGET_FILE:greatx>" GREATX_XVFB_RUN="${XVFB_RUN}"
          GREATX_VIEW_GOLDENS="${CMAKE_CURRENT_SOURCE_DIR}/goldens")
add_dependencies(test_view_program greatx)
# Only this target rewrites the viewer's picture in the source folder.
add_custom_target(update-viewer-golden
  COMMAND ${CMAKE_COMMAND} -E env GREATX_UPDATE_GOLDENS=1
          $<TARGET_FILE:test_view_program> --gtest_filter=ViewProgram.LooksAsBefore --gtest_brief=1
  DEPENDS test_view_program USES_TERMINAL)
