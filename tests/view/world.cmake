# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_world SOURCES world_test.cpp
            LINK greatx_view_world greatx_sim greatx_io greatx_gpu_test_support nlohmann_json::nlohmann_json)
target_compile_definitions(test_view_world PRIVATE GREATX_PROGRAM="$<TARGET_FILE:greatx>")
add_dependencies(test_view_world greatx)
