# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_times SUITES SOURCES time_history_test.cpp LINK greatx_view_times)
