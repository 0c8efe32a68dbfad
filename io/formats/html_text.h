// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Text for pages of HTML that have everything in themselves: names that come from outside, bytes of pictures,
// and data for scripts.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace greatx::io {

/// Returns the bytes in base64 (RFC 4648, section 4).
std::string base64(std::span<const std::byte> bytes);
/// Returns the number of characters of base64() for so many bytes.
constexpr size_t base64_size(size_t bytes) { return 4 * ((bytes + 2) / 3); }

/// Replaces the characters that have a meaning in HTML and SVG, in text and in attributes with either quote.
std::string html_escaped(std::string_view text);

/// Makes JSON fit for a <script> element. In such an element "</script" ends the data and "<!--" changes the
/// way in which they are read (HTML, section 4.12.1.3). `<`, `>` and `&` occur only in strings of JSON, and
/// become \u003c, \u003e and \u0026.
std::string json_for_script(std::string_view json);

}  // namespace greatx::io
