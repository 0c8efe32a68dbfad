# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_scene SUITES SOURCES scene_test.cpp
            LINK greatx_view_scene greatx_view_pick greatx_view_overlay greatx_sim greatx_gpu_test_support)
# GREATX_VIEW_FRAMES=10000 runs so many frames.
greatx_test(view_growth COST 35 SOURCES growth_test.cpp
            LINK greatx_view_app greatx_sim greatx_gpu_test_support)
