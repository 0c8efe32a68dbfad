# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_overlay SUITES
  SOURCES overlay_paths_test.cpp overlay_run_test.cpp overlay_shapes_test.cpp overlay_story_test.cpp
          overlay_tables_test.cpp
  LINK greatx_view_overlay greatx_sim greatx_gpu_test_support nlohmann_json::nlohmann_json)
