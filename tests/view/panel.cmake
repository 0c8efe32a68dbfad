# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
greatx_test(view_panel SUITES
  SOURCES panel_test.cpp
  LINK greatx_view_panel greatx_draw_sheet greatx_io)
