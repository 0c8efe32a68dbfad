# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_edit SUITES SOURCES edit_test.cpp
            LINK greatx_view_edit greatx_assets greatx_sim_experiment greatx_sim_scenario_parse)
