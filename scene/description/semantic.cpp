// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/semantic.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace greatx::scene {
namespace {

struct NamePattern {
  std::string_view word;
  SemanticClass semantic_class;
};

using enum SemanticClass;

// The first word of a name that is in this table determines the class. Names are split at punctuation, digits
// and changes of case. Words are compared whole, so that "car" does not match "cardboard". docs/materials.md
// lists the words.
constexpr NamePattern patterns[] = {
    {"ground", ground},
    {"plane", ground},
    {"terrain", ground},
    {"field", ground},
    {"grass", ground},
    {"road", road},
    {"street", road},
    {"highway", road},
    {"junction", road},
    {"crossing", road},
    {"pavement", pavement},
    {"sidewalk", pavement},
    {"kerb", pavement},
    {"curb", pavement},
    {"marking", lane_marking},
    {"lane", lane_marking},
    {"building", building},
    {"house", building},
    {"barn", building},
    {"wall", building},
    {"facade", building},
    {"tower", building},
    {"element", building},
    {"roof", roof},
    {"window", window},
    {"tree", vegetation},
    {"bush", vegetation},
    {"hedge", vegetation},
    {"shrub", vegetation},
    {"vegetation", vegetation},
    {"forest", vegetation},
    {"lamp", street_lamp},
    {"streetlight", street_lamp},
    {"streetlamp", street_lamp},
    {"lamppost", street_lamp},
    {"pole", pole},
    {"post", pole},
    {"trafficlight", pole},
    {"mast", mast},
    {"antenna", mast},
    {"car", vehicle},
    {"taxi", vehicle},
    {"hatchback", vehicle},
    {"sedan", vehicle},
    {"vehicle", vehicle},
    {"truck", vehicle},
    {"bus", vehicle},
    {"van", vehicle},
    {"police", vehicle},
    {"stationwagon", vehicle},
    {"uav", uav},
    {"drone", uav},
    {"quadrotor", uav},
    {"quadcopter", uav},
    {"water", water},
    {"river", water},
    {"lake", water},
    {"bench", furniture},
    {"furniture", furniture},
    {"dumpster", furniture},
    {"box", furniture},
    {"hydrant", furniture},
    {"bin", furniture},
    {"person", person},
    {"pedestrian", person},
    {"human", person},
};

// Two words that together have another meaning than the first word alone.
struct PairPattern {
  std::string_view first, second;
  SemanticClass semantic_class;
};
constexpr PairPattern pair_patterns[] = {
    {"street", "lamp", street_lamp},   {"street", "light", street_lamp},  {"traffic", "light", pole},
    {"lane", "marking", lane_marking}, {"road", "marking", lane_marking}, {"base", "station", mast},
    {"fire", "hydrant", furniture},    {"lamp", "post", street_lamp},
};

std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words;
  bool in_word = false;
  char previous = 0;
  for (const char character : name) {
    const auto byte = static_cast<unsigned char>(character);
    if (!std::isalpha(byte)) {
      in_word = false;
    } else {
      const bool hump = std::isupper(byte) && std::islower(static_cast<unsigned char>(previous));
      if (!in_word || hump) words.emplace_back();
      words.back() += static_cast<char>(std::tolower(byte));
      in_word = true;
    }
    previous = character;
  }
  return words;
}

bool matches(std::string_view word, std::string_view pattern) {
  if (word == pattern) return true;
  return word.size() == pattern.size() + 1 && word.starts_with(pattern) && word.back() == 's';  // plural
}

}  // namespace

const std::vector<std::string>& semantic_class_names() {
  static const std::vector<std::string> names = {
      "unlabeled", "ground", "road",       "pavement",  "lane_marking", "building",
      "roof",      "window", "vegetation", "pole",      "street_lamp",  "mast",
      "vehicle",   "uav",    "water",      "furniture", "person"};
  return names;
}

const char* name_of(SemanticClass semantic_class) {
  const auto index = static_cast<size_t>(semantic_class);
  GREATX_CHECK(index < semantic_class_names().size(), "semantic class {}", index);
  return semantic_class_names()[index].c_str();
}

std::optional<SemanticClass> semantic_class_called(const std::string& name) {
  const auto& names = semantic_class_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<SemanticClass>(found - names.begin());
}

std::optional<SemanticClass> semantic_class_from_name(const std::string& name) {
  const std::vector<std::string> words = words_of(name);
  for (size_t index = 0; index + 1 < words.size(); ++index) {
    for (const PairPattern& pair : pair_patterns) {
      if (words[index] == pair.first && matches(words[index + 1], pair.second)) return pair.semantic_class;
    }
  }
  for (const std::string& word : words) {
    for (const NamePattern& pattern : patterns) {
      if (matches(word, pattern.word)) return pattern.semantic_class;
    }
  }
  // Sionna RT's scenes are exported with names like "Hotel_Belfast-itu_marble", with one mesh per building
  // and material.
  if (name.find("-itu_") != std::string::npos) return SemanticClass::building;
  return std::nullopt;
}

}  // namespace greatx::scene
