// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

namespace greatx::sim {

/// Returns the UTC seconds since 1970-01-01T00:00:00Z of a date and time with its offset, in the form of RFC
/// 3339, section 5.6: "2026-06-21T12:00:00+02:00", "2026-06-21T10:00:00.25Z". A space may stand for the T. A
/// leap second counts as the first second of the next minute. The result is empty if the text is not well
/// formed or no such day or time exists. The calendar is Gregorian, for years 0 to 9999.
std::optional<double> parse_date_time(std::string_view text);

/// The years 1900 to 2150, for which sun and moon are known (renderer/daylight/almanac.h), as seconds since
/// 1970.
inline constexpr double first_known_instant = -2208988800.0, last_known_instant = 5711817600.0;

}  // namespace greatx::sim
