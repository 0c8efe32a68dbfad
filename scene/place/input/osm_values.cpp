// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/input/osm_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "core/text.h"

namespace greatx::scene::place {

namespace {

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\n\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n\r") - first + 1);
}

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

/// Returns a number whose decimal sign is a point, or a comma if there is no point.
std::optional<double> decimal(std::string_view text) {
  std::string plain(trimmed(text));
  if (plain.find('.') == std::string::npos && std::count(plain.begin(), plain.end(), ',') == 1)
    plain[plain.find(',')] = '.';
  return parse_number(plain);
}

constexpr double foot_m = 0.3048, inch_m = 0.0254;

/// Reads `5'6"`, `40'` and `66"`.
std::optional<double> feet_and_inches(std::string_view text) {
  const auto mark = text.find('\'');
  double length = 0.0, sign = 1.0;
  if (mark != std::string_view::npos) {
    const auto feet = decimal(text.substr(0, mark));
    if (!feet) return std::nullopt;
    sign = trimmed(text).front() == '-' ? -1.0 : 1.0;
    length = *feet * foot_m;
    text = trimmed(text.substr(mark + 1));
    if (text.empty()) return length;
  }
  if (text.empty() || text.back() != '"') return std::nullopt;
  const auto inches = decimal(text.substr(0, text.size() - 1));
  if (!inches || (mark != std::string_view::npos && *inches < 0.0)) return std::nullopt;
  return length + sign * *inches * inch_m;
}

constexpr std::pair<std::string_view, double> length_units[] = {
    {"m", 1.0},       {"metre", 1.0},     {"metres", 1.0}, {"meter", 1.0},   {"meters", 1.0},
    {"km", 1000.0},   {"cm", 0.01},       {"mm", 0.001},   {"ft", foot_m},   {"foot", foot_m},
    {"feet", foot_m}, {"yd", 3 * foot_m}, {"in", inch_m},  {"inch", inch_m}, {"inches", inch_m}};

constexpr std::string_view compass_points[] = {"n", "nne", "ne", "ene", "e", "ese", "se", "sse",
                                               "s", "ssw", "sw", "wsw", "w", "wnw", "nw", "nnw"};

constexpr std::pair<std::string_view, uint32_t> colour_names[] = {{"aliceblue", 0xf0f8ff},
                                                                  {"antiquewhite", 0xfaebd7},
                                                                  {"aqua", 0x00ffff},
                                                                  {"aquamarine", 0x7fffd4},
                                                                  {"azure", 0xf0ffff},
                                                                  {"beige", 0xf5f5dc},
                                                                  {"bisque", 0xffe4c4},
                                                                  {"black", 0x000000},
                                                                  {"blanchedalmond", 0xffebcd},
                                                                  {"blue", 0x0000ff},
                                                                  {"blueviolet", 0x8a2be2},
                                                                  {"brown", 0xa52a2a},
                                                                  {"burlywood", 0xdeb887},
                                                                  {"cadetblue", 0x5f9ea0},
                                                                  {"chartreuse", 0x7fff00},
                                                                  {"chocolate", 0xd2691e},
                                                                  {"coral", 0xff7f50},
                                                                  {"cornflowerblue", 0x6495ed},
                                                                  {"cornsilk", 0xfff8dc},
                                                                  {"crimson", 0xdc143c},
                                                                  {"cyan", 0x00ffff},
                                                                  {"darkblue", 0x00008b},
                                                                  {"darkcyan", 0x008b8b},
                                                                  {"darkgoldenrod", 0xb8860b},
                                                                  {"darkgray", 0xa9a9a9},
                                                                  {"darkgreen", 0x006400},
                                                                  {"darkgrey", 0xa9a9a9},
                                                                  {"darkkhaki", 0xbdb76b},
                                                                  {"darkmagenta", 0x8b008b},
                                                                  {"darkolivegreen", 0x556b2f},
                                                                  {"darkorange", 0xff8c00},
                                                                  {"darkorchid", 0x9932cc},
                                                                  {"darkred", 0x8b0000},
                                                                  {"darksalmon", 0xe9967a},
                                                                  {"darkseagreen", 0x8fbc8f},
                                                                  {"darkslateblue", 0x483d8b},
                                                                  {"darkslategray", 0x2f4f4f},
                                                                  {"darkslategrey", 0x2f4f4f},
                                                                  {"darkturquoise", 0x00ced1},
                                                                  {"darkviolet", 0x9400d3},
                                                                  {"deeppink", 0xff1493},
                                                                  {"deepskyblue", 0x00bfff},
                                                                  {"dimgray", 0x696969},
                                                                  {"dimgrey", 0x696969},
                                                                  {"dodgerblue", 0x1e90ff},
                                                                  {"firebrick", 0xb22222},
                                                                  {"floralwhite", 0xfffaf0},
                                                                  {"forestgreen", 0x228b22},
                                                                  {"fuchsia", 0xff00ff},
                                                                  {"gainsboro", 0xdcdcdc},
                                                                  {"ghostwhite", 0xf8f8ff},
                                                                  {"gold", 0xffd700},
                                                                  {"goldenrod", 0xdaa520},
                                                                  {"gray", 0x808080},
                                                                  {"green", 0x008000},
                                                                  {"greenyellow", 0xadff2f},
                                                                  {"grey", 0x808080},
                                                                  {"honeydew", 0xf0fff0},
                                                                  {"hotpink", 0xff69b4},
                                                                  {"indianred", 0xcd5c5c},
                                                                  {"indigo", 0x4b0082},
                                                                  {"ivory", 0xfffff0},
                                                                  {"khaki", 0xf0e68c},
                                                                  {"lavender", 0xe6e6fa},
                                                                  {"lavenderblush", 0xfff0f5},
                                                                  {"lawngreen", 0x7cfc00},
                                                                  {"lemonchiffon", 0xfffacd},
                                                                  {"lightblue", 0xadd8e6},
                                                                  {"lightcoral", 0xf08080},
                                                                  {"lightcyan", 0xe0ffff},
                                                                  {"lightgoldenrodyellow", 0xfafad2},
                                                                  {"lightgray", 0xd3d3d3},
                                                                  {"lightgreen", 0x90ee90},
                                                                  {"lightgrey", 0xd3d3d3},
                                                                  {"lightpink", 0xffb6c1},
                                                                  {"lightsalmon", 0xffa07a},
                                                                  {"lightseagreen", 0x20b2aa},
                                                                  {"lightskyblue", 0x87cefa},
                                                                  {"lightslategray", 0x778899},
                                                                  {"lightslategrey", 0x778899},
                                                                  {"lightsteelblue", 0xb0c4de},
                                                                  {"lightyellow", 0xffffe0},
                                                                  {"lime", 0x00ff00},
                                                                  {"limegreen", 0x32cd32},
                                                                  {"linen", 0xfaf0e6},
                                                                  {"magenta", 0xff00ff},
                                                                  {"maroon", 0x800000},
                                                                  {"mediumaquamarine", 0x66cdaa},
                                                                  {"mediumblue", 0x0000cd},
                                                                  {"mediumorchid", 0xba55d3},
                                                                  {"mediumpurple", 0x9370db},
                                                                  {"mediumseagreen", 0x3cb371},
                                                                  {"mediumslateblue", 0x7b68ee},
                                                                  {"mediumspringgreen", 0x00fa9a},
                                                                  {"mediumturquoise", 0x48d1cc},
                                                                  {"mediumvioletred", 0xc71585},
                                                                  {"midnightblue", 0x191970},
                                                                  {"mintcream", 0xf5fffa},
                                                                  {"mistyrose", 0xffe4e1},
                                                                  {"moccasin", 0xffe4b5},
                                                                  {"navajowhite", 0xffdead},
                                                                  {"navy", 0x000080},
                                                                  {"oldlace", 0xfdf5e6},
                                                                  {"olive", 0x808000},
                                                                  {"olivedrab", 0x6b8e23},
                                                                  {"orange", 0xffa500},
                                                                  {"orangered", 0xff4500},
                                                                  {"orchid", 0xda70d6},
                                                                  {"palegoldenrod", 0xeee8aa},
                                                                  {"palegreen", 0x98fb98},
                                                                  {"paleturquoise", 0xafeeee},
                                                                  {"palevioletred", 0xdb7093},
                                                                  {"papayawhip", 0xffefd5},
                                                                  {"peachpuff", 0xffdab9},
                                                                  {"peru", 0xcd853f},
                                                                  {"pink", 0xffc0cb},
                                                                  {"plum", 0xdda0dd},
                                                                  {"powderblue", 0xb0e0e6},
                                                                  {"purple", 0x800080},
                                                                  {"rebeccapurple", 0x663399},
                                                                  {"red", 0xff0000},
                                                                  {"rosybrown", 0xbc8f8f},
                                                                  {"royalblue", 0x4169e1},
                                                                  {"saddlebrown", 0x8b4513},
                                                                  {"salmon", 0xfa8072},
                                                                  {"sandybrown", 0xf4a460},
                                                                  {"seagreen", 0x2e8b57},
                                                                  {"seashell", 0xfff5ee},
                                                                  {"sienna", 0xa0522d},
                                                                  {"silver", 0xc0c0c0},
                                                                  {"skyblue", 0x87ceeb},
                                                                  {"slateblue", 0x6a5acd},
                                                                  {"slategray", 0x708090},
                                                                  {"slategrey", 0x708090},
                                                                  {"snow", 0xfffafa},
                                                                  {"springgreen", 0x00ff7f},
                                                                  {"steelblue", 0x4682b4},
                                                                  {"tan", 0xd2b48c},
                                                                  {"teal", 0x008080},
                                                                  {"thistle", 0xd8bfd8},
                                                                  {"tomato", 0xff6347},
                                                                  {"turquoise", 0x40e0d0},
                                                                  {"violet", 0xee82ee},
                                                                  {"wheat", 0xf5deb3},
                                                                  {"white", 0xffffff},
                                                                  {"whitesmoke", 0xf5f5f5},
                                                                  {"yellow", 0xffff00},
                                                                  {"yellowgreen", 0x9acd32}};

std::array<unsigned char, 3> rgb_of(uint32_t word) {
  return {static_cast<unsigned char>(word >> 16), static_cast<unsigned char>(word >> 8 & 0xffu),
          static_cast<unsigned char>(word & 0xffu)};
}

}  // namespace

std::optional<double> parse_length_m(std::string_view text, double unit_m) {
  text = trimmed(text);
  if (const auto number = decimal(text)) return *number * unit_m;
  if (text.find_first_of("'\"") != std::string_view::npos) return feet_and_inches(text);
  const auto last = text.find_last_of("0123456789.,");
  if (last == std::string_view::npos) return std::nullopt;
  const auto number = decimal(text.substr(0, last + 1));
  const std::string unit = lower(trimmed(text.substr(last + 1)));
  if (number)
    for (const auto& [name, metres] : length_units)
      if (unit == name) return *number * metres;
  return std::nullopt;
}

std::optional<double> parse_levels(std::string_view text) { return decimal(text); }

std::optional<double> parse_direction_deg(std::string_view text) {
  text = trimmed(text);
  std::string_view plain = text;
  if (plain.ends_with("°")) plain = trimmed(plain.substr(0, plain.size() - std::string_view("°").size()));
  if (const auto number = decimal(plain)) {
    const double turned = std::fmod(*number, 360.0);
    return turned < 0.0 ? turned + 360.0 : turned;
  }
  std::string letters;
  for (std::string word = lower(text); !word.empty();) {
    bool found = false;
    for (const std::string_view name : {"north", "south", "east", "west"})
      if (word.starts_with(name)) {
        letters += name.front();
        word.erase(0, name.size());
        found = true;
      }
    if (found) continue;
    if (word.front() != '-' && word.front() != '_' && word.front() != ' ') letters += word.front();
    word.erase(0, 1);
  }
  for (size_t i = 0; i < std::size(compass_points); ++i)
    if (letters == compass_points[i]) return 22.5 * static_cast<double>(i);
  return std::nullopt;
}

std::optional<std::array<unsigned char, 3>> parse_colour(std::string_view text) {
  std::string name;
  for (const char c : lower(trimmed(text)))
    if (c != '_' && c != '-' && c != ' ') name += c;
  if (!name.empty() && name.front() == '#') {
    uint32_t word = 0;
    const char* const end = name.data() + name.size();
    const auto [stopped, error] = std::from_chars(name.data() + 1, end, word, 16);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    if (name.size() == 4)
      return rgb_of((word >> 8) * 0x110000u + (word >> 4 & 0xfu) * 0x1100u + (word & 0xfu) * 0x11u);
    if (name.size() == 7) return rgb_of(word);
    return std::nullopt;
  }
  const auto found = std::ranges::lower_bound(colour_names, std::string_view(name), {},
                                              [](const auto& entry) { return entry.first; });
  if (found == std::end(colour_names) || found->first != name) return std::nullopt;
  return rgb_of(found->second);
}

std::vector<std::string> list_values(std::string_view text) {
  std::vector<std::string> values;
  for (;;) {
    const auto end = text.find(';');
    if (const std::string_view value = trimmed(text.substr(0, end)); !value.empty())
      values.emplace_back(value);
    if (end == std::string_view::npos) return values;
    text.remove_prefix(end + 1);
  }
}

bool means_yes(std::string_view text) { return text == "yes" || text == "true" || text == "1"; }

std::string number_text(double value) { return fmt::format("{}", value); }

}  // namespace greatx::scene::place
