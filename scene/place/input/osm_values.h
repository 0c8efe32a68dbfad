// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads the values of OpenStreetMap's tags. People write them, so each has several forms; a text of no known
// form gives nothing, and never a guess.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace greatx::scene::place {

/// Returns a length in metres: "12.5", "12 m", "12,5 m", "1.2 km", "40 ft", "40'", "5'6\"", "66\"", "3 in"
/// (OpenStreetMap wiki, "Map features/Units"). A number without a unit counts `unit_m` metres. The sign may
/// be negative.
std::optional<double> parse_length_m(std::string_view text, double unit_m = 1.0);

/// Returns a number of storeys: "3", "2.5". A list, "1;2" or "0-3", is no number.
std::optional<double> parse_levels(std::string_view text);

/// Returns a direction in degrees clockwise from north, in [0, 360): "137", "137.5°", "NNE", "north",
/// "south-west".
std::optional<double> parse_direction_deg(std::string_view text);

/// Returns sRGB: "#a0b0c0", "#abc", or one of the 148 names of CSS Color Module Level 4, section 6.1, in any
/// case, and with "_", "-" or blanks ("light_grey").
std::optional<std::array<unsigned char, 3>> parse_colour(std::string_view text);

/// Returns the values of a list, "a;b; c", without the blanks around them.
std::vector<std::string> list_values(std::string_view text);

/// Returns whether the value is one of those that mean yes: "yes", "true", "1".
bool means_yes(std::string_view text);

/// Returns the shortest text that reads as this number again.
std::string number_text(double value);

}  // namespace greatx::scene::place
