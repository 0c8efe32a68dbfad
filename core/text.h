// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Text that came from outside: names in scenes, ids in XML, cells of tables. A terminal obeys control characters, and
// JSON holds UTF-8 alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace greatx {

/// The place of the first byte that is not UTF-8 (RFC 3629: no overlong forms, no surrogates); empty: all of it is.
std::optional<size_t> find_bad_utf8(std::string_view text);

/// As a name may stand in a message or in a table: control characters (C0, delete, C1), line and paragraph separators
/// and the marks that turn the direction of writing become \u001b, which means the same in JSON; a byte that is not
/// UTF-8 becomes \xff.
std::string printable(std::string_view text);
/// The same for a whole message or table: line feeds and tabs stay.
std::string printable_lines(std::string_view text);

/// A plain scalar by YAML 1.2's core schema (section 10.3.2), whatever the locale:
/// [-+]? ( \. [0-9]+ | [0-9]+ ( \. [0-9]* )? ) ( [eE] [-+]? [0-9]+ )?; empty if it is none or not finite.
std::optional<double> parse_number(std::string_view text);

}  // namespace greatx
