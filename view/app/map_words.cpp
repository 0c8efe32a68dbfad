// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <sstream>

#include "core/error.h"
#include "core/text.h"
#include "sim/channel/radio_map_values.h"
#include "view/app/world_overlays.h"

namespace greatx::view {

namespace {

double number_of_word(const std::string& name, const std::string& text) {
  const auto number = parse_number(text);
  if (!number) throw_user_error("map: {}: expected a number, found '{}'", name, printable(text));
  return *number;
}

dvec2 corner_of_word(const std::string& name, const std::string& text) {
  const size_t comma = text.find(',');
  if (comma == std::string::npos)
    throw_user_error("map: {}: expected x,y, found '{}'", name, printable(text));
  return {number_of_word(name, text.substr(0, comma)), number_of_word(name, text.substr(comma + 1))};
}

void take_word(const std::string& name, const std::string& value, WorldSettings& settings) {
  sim::MapRequest& request = settings.map_request;
  if (name == "quantity") {
    settings.map_colors.quantity = sim::map_quantity(value).name;
  } else if (name == "cell") {
    request.cell_m = number_of_word(name, value);
  } else if (name == "height") {
    request.height.plane_z_m.reset();
    request.height.above_m = number_of_word(name, value);
  } else if (name == "plane") {
    request.height.plane_z_m = number_of_word(name, value);
  } else if (name == "over") {
    if (value != "ground" && value != "roofs")
      throw_user_error("map: over: expected ground or roofs, found '{}'", printable(value));
    request.height.over = value == "roofs" ? sim::MapOver::roofs : sim::MapOver::ground;
  } else if (name == "min") {
    request.min_m = corner_of_word(name, value);
  } else if (name == "max") {
    request.max_m = corner_of_word(name, value);
  } else {
    throw_user_error("map: expected quantity, cell, height, plane, over, min or max, found '{}'",
                     printable(name));
  }
}

}  // namespace

void parse_map_words(const std::string& words, WorldSettings& settings) {
  std::istringstream stream(words);
  WorldSettings wanted = settings;
  for (std::string word; stream >> word;) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw_user_error("map: expected NAME=VALUE, found '{}'", printable(word));
    take_word(word.substr(0, equals), word.substr(equals + 1), wanted);
  }
  wanted.version = settings.version + 1;
  settings = wanted;
}

}  // namespace greatx::view
