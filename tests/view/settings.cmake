# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_settings SUITES SOURCES settings_test.cpp LINK greatx_view_settings)
