// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Handles text that comes from outside: names in scenes, ids in XML, cells of tables. A terminal obeys
// control characters, and JSON holds only UTF-8.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace greatx {

/// Returns the place of the first byte that is not UTF-8 (RFC 3629: no overlong forms, no surrogates), or
/// nothing if the whole text is UTF-8.
std::optional<size_t> find_bad_utf8(std::string_view text);

/// Escapes a name for a message or a table. Control characters (C0, delete, C1), line and paragraph
/// separators and the marks that change the direction of writing become \u001b, which means the same in JSON.
/// A byte that is not UTF-8 becomes \xff.
std::string printable(std::string_view text);
/// Does the same for a whole message or table: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

/// Parses a plain scalar by YAML 1.2's core schema (section 10.3.2), whatever the locale:
/// [-+]? ( \. [0-9]+ | [0-9]+ ( \. [0-9]* )? ) ( [eE] [-+]? [0-9]+ )?
/// The result is empty if the text does not match or the number is not finite.
std::optional<double> parse_number(std::string_view text);

/// Returns " (did you mean 'x'?)" for the candidate nearest to `word`, or an empty text if none is near.
std::string suggestion(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace greatx
