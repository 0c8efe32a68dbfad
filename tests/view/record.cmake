# SPDX-FileCopyrightText: 2026 The greatx authors
# SPDX-License-Identifier: Apache-2.0
pkg_check_modules(libwebpdemux REQUIRED IMPORTED_TARGET libwebpdemux)
greatx_test(view_record SOURCES recorder_test.cpp LINK greatx_view_record greatx_io PkgConfig::libwebpdemux)
