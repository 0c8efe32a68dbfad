// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/source/vocabulary.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/text.h"
#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

using Pairs = std::pair<std::string_view, std::string_view>;

/// Names of OSM Buildings' GeoJSON (https://osmbuildings.org/documentation/viewer/, "Data") and of its data
/// service, with their keys in OpenStreetMap.
constexpr Pairs osm_buildings_names[] = {{"height", "height"},
                                         {"minHeight", "min_height"},
                                         {"min_height", "min_height"},
                                         {"levels", "building:levels"},
                                         {"minLevel", "building:min_level"},
                                         {"minLevels", "building:min_level"},
                                         {"roofLevels", "roof:levels"},
                                         {"roofHeight", "roof:height"},
                                         {"roofShape", "roof:shape"},
                                         {"roofDirection", "roof:direction"},
                                         {"roofMaterial", "roof:material"},
                                         {"roofColor", "roof:colour"},
                                         {"roofColour", "roof:colour"},
                                         {"material", "building:material"},
                                         {"color", "building:colour"},
                                         {"colour", "building:colour"},
                                         {"wallColor", "building:colour"},
                                         {"name", "name"}};

/// Attributes of CityJSON 2.0 (section 2.2.1) and of tables made from CityGML.
constexpr Pairs city_json_names[] = {{"storeysAboveGround", "building:levels"},
                                     {"storeysBelowGround", "building:levels:underground"},
                                     {"yearOfConstruction", "start_date"},
                                     {"name", "name"}};

constexpr std::array length_keys{"height",          "min_height",      "roof:height",
                                 "est_height",      "building:height", "building:min_height",
                                 "roof:min_height", "width",           "diameter_crown"};

constexpr std::array known_keys{
    "building", "building:part", "highway",          "railway",    "waterway", "natural",      "landuse",
    "leisure",  "amenity",       "barrier",          "power",      "man_made", "area:highway", "aeroway",
    "water",    "tourism",       "public_transport", "tower:type", "telecom",  "emergency",    "surface",
    "place",    "shop",          "bridge",           "landcover"};

constexpr std::array silent_names{
    "FID",  "fid",        "ogc_fid",  "timestamp", "version",    "changeset",  "user",
    "uid",  "@id",        "id",       "osm_id",    "osm_way_id", "full_id",    "osm_type",
    "tags", "other_tags", "all_tags", "meta",      "relations",  "@relations", "z_order"};

/// Reads hstore: "key"=>"value","key"=>"value", with \" and \\ (PostgreSQL, hstore).
void add_hstore(std::string_view text, std::map<std::string, std::string, std::less<>>& tags) {
  const auto quoted = [&]() -> std::optional<std::string> {
    const auto begin = text.find('"');
    if (begin == std::string_view::npos) return std::nullopt;
    text.remove_prefix(begin + 1);
    std::string value;
    while (!text.empty() && text.front() != '"') {
      if (text.front() == '\\' && text.size() > 1) text.remove_prefix(1);
      value += text.front();
      text.remove_prefix(1);
    }
    if (text.empty()) return std::nullopt;
    text.remove_prefix(1);
    return value;
  };
  while (const auto key = quoted()) {
    const auto value = quoted();
    if (!value) return;
    tags.emplace(*key, *value);
  }
}

void add_json(const std::string& text, std::map<std::string, std::string, std::less<>>& tags) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return add_hstore(text, tags);
  for (const auto& [key, value] : json.items()) {
    if (value.is_string())
      tags.emplace(key, value.get<std::string>());
    else if (value.is_number_integer())
      tags.emplace(key, fmt::format("{}", value.get<int64_t>()));
    else if (value.is_number())
      tags.emplace(key, number_text(value.get<double>()));
  }
}

const std::string* find(const Attributes& attributes, std::string_view name) {
  const auto found = attributes.find(name);
  return found != attributes.end() && !found->second.empty() ? &found->second : nullptr;
}

bool all_digits(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

/// Returns "way/123" for the forms way/123, way123, w123 and 123 with a type beside it.
std::string osm_id(const Attributes& attributes) {
  for (const char* name : {"@id", "full_id", "id"})
    if (const std::string* id = find(attributes, name)) {
      for (const auto& [letter, kind] : {std::pair{'n', "node"}, {'w', "way"}, {'r', "relation"}})
        if (id->front() == letter && all_digits(id->substr(1)))
          return fmt::format("{}/{}", kind, id->substr(1));
      if (id->find('/') != std::string::npos || !all_digits(*id)) return *id;
    }
  const std::string* type = find(attributes, "@type");
  if (type == nullptr) type = find(attributes, "osm_type");
  if (type == nullptr) type = find(attributes, "type");
  const bool typed = type != nullptr && (*type == "node" || *type == "way" || *type == "relation");
  if (const std::string* id = find(attributes, "osm_way_id")) return "way/" + *id;
  for (const char* name : {"osm_id", "@id", "id"})
    if (const std::string* id = find(attributes, name)) return typed ? *type + "/" + *id : *id;
  return {};
}

}  // namespace

Vocabulary::Vocabulary(const MapSource& source) : source_(source) {}

void Vocabulary::add_osm(const Attributes& attributes, Translated& result) const {
  result.id = osm_id(attributes);
  for (const char* name : {"tags", "other_tags", "all_tags"})
    if (const std::string* text = find(attributes, name)) add_json(*text, result.tags);
  for (const auto& [name, value] : attributes)
    if (!value.empty() && std::ranges::find(silent_names, name) == silent_names.end() &&
        !name.starts_with('@'))
      result.tags.emplace(name, value);
}

void Vocabulary::add_osm_buildings(const Attributes& attributes, Translated& result) const {
  if (const std::string* id = find(attributes, "id")) result.id = *id;
  for (const auto& [name, key] : osm_buildings_names)
    if (const std::string* value = find(attributes, name)) result.tags.emplace(key, *value);
  const std::string* type = find(attributes, "type");
  result.tags["building"] = type != nullptr ? *type : "yes";
  if (const std::string* parent = find(attributes, "building")) {
    result.part_of = *parent;
    result.tags["building:part"] = result.tags["building"];
    result.tags.erase("building");
  }
  const std::string* shape = find(attributes, "shape");
  result.left_out = shape != nullptr && *shape == "none";
}

Translated Vocabulary::translate(const Attributes& attributes) const {
  Translated result;
  if (source_.vocabulary == "osm_buildings") {
    add_osm_buildings(attributes, result);
  } else if (source_.vocabulary == "cityjson") {
    for (const auto& [name, key] : city_json_names)
      if (const std::string* value = find(attributes, name)) result.tags.emplace(key, *value);
  } else {
    add_osm(attributes, result);
  }
  for (const auto& [key, name] : source_.keys) {
    if (const std::string* value = find(attributes, name))
      result.tags[key] = *value;
    else
      result.tags.erase(key);
  }
  if (!source_.as.empty()) {
    const auto sign = source_.as.find('=');
    result.tags.emplace(source_.as.substr(0, sign), source_.as.substr(sign + 1));
  }
  if (!source_.id_field.empty())
    if (const std::string* id = find(attributes, source_.id_field)) result.id = *id;
  return result;
}

std::vector<std::string> lengths_to_metres(std::map<std::string, std::string, std::less<>>& tags,
                                           double unit_m) {
  std::vector<std::string> faulty;
  for (const char* key : length_keys) {
    const auto tag = tags.find(std::string_view(key));
    if (tag == tags.end()) continue;
    const auto length = parse_length_m(tag->second, unit_m);
    if (!length)
      faulty.emplace_back(key);
    else if (unit_m != 1.0)
      tag->second = number_text(*length);
  }
  return faulty;
}

bool has_known_key(const std::map<std::string, std::string, std::less<>>& tags) {
  return std::ranges::any_of(known_keys,
                             [&](const char* key) { return tags.contains(std::string_view(key)); });
}

size_t names_of_osm_buildings(const std::set<std::string>& names) {
  size_t alike = 0;
  for (const auto& [name, key] : osm_buildings_names)
    if (name != key && name != "material" && name != "color" && name != "colour" && name != "min_height")
      alike += names.contains(std::string(name));
  return alike;
}

std::string suggested_vocabulary(const std::set<std::string>& names) {
  if (names_of_osm_buildings(names) > 0)
    return "they look like those of OSM Buildings: add vocabulary: osm_buildings";
  for (const auto& [name, key] : city_json_names)
    if (name != "name" && names.contains(std::string(name)))
      return "they look like those of CityJSON: add vocabulary: cityjson and as: building=yes";
  return "say what the objects are, for example as: building=yes, and which attributes are heights, for "
         "example keys: {height: ATTRIBUTE}";
}

}  // namespace greatx::scene::place
