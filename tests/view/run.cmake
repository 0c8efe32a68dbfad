# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_run SUITES SOURCES live_test.cpp replay_test.cpp run_loop_test.cpp run_support.cpp
                ${PROJECT_SOURCE_DIR}/tests/io/sample_run.cpp
            LINK greatx_view_run greatx_sim greatx_io greatx_gpu_test_support)
