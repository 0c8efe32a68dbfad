// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts a report's page together. Inside of draw/report.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "draw/report/parts.h"

namespace greatx::io::report {

/// The files of page/, embedded at build time.
std::string_view page_style();
std::string_view page_script();

/// The first characters of every report.
std::string_view page_mark();
/// Returns the characters of a page without data and blobs.
size_t page_overhead();
/// Returns the page. A content security policy forbids every request, and every script but the page's own.
std::string page_of(const Json& data, const Blobs& blobs, std::vector<size_t> used);

}  // namespace greatx::io::report
