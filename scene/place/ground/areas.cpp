// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/ground/areas.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

struct Rule {
  const char *key, *value;  ///< value "*": any but "no"
  Cover cover;
};

// https://wiki.openstreetmap.org/wiki/Map_features. The first rule that fits counts.
constexpr Rule area_rules[] = {{"natural", "water", Cover::water},
                               {"waterway", "riverbank", Cover::water},
                               {"waterway", "dock", Cover::water},
                               {"landuse", "reservoir", Cover::water},
                               {"landuse", "basin", Cover::water},
                               {"leisure", "swimming_pool", Cover::water},
                               {"area:highway", "*", Cover::road},
                               {"amenity", "parking", Cover::parking},
                               {"place", "square", Cover::square},
                               {"man_made", "bridge", Cover::square},
                               {"aeroway", "runway", Cover::road},
                               {"aeroway", "taxiway", Cover::road},
                               {"aeroway", "apron", Cover::parking},
                               {"leisure", "pitch", Cover::pitch},
                               {"leisure", "track", Cover::pitch},
                               {"leisure", "playground", Cover::sand},
                               {"natural", "beach", Cover::sand},
                               {"natural", "sand", Cover::sand},
                               {"landuse", "forest", Cover::wood},
                               {"natural", "wood", Cover::wood},
                               {"natural", "scrub", Cover::scrub},
                               {"natural", "heath", Cover::scrub},
                               {"landuse", "orchard", Cover::scrub},
                               {"landuse", "vineyard", Cover::scrub},
                               {"natural", "wetland", Cover::wetland},
                               {"natural", "bare_rock", Cover::rock},
                               {"natural", "scree", Cover::rock},
                               {"landuse", "quarry", Cover::rock},
                               {"landuse", "grass", Cover::grass},
                               {"landuse", "village_green", Cover::grass},
                               {"landuse", "recreation_ground", Cover::grass},
                               {"landuse", "cemetery", Cover::grass},
                               {"landuse", "allotments", Cover::grass},
                               {"leisure", "park", Cover::grass},
                               {"leisure", "garden", Cover::grass},
                               {"leisure", "golf_course", Cover::grass},
                               {"natural", "grassland", Cover::meadow},
                               {"landuse", "meadow", Cover::meadow},
                               {"landuse", "farmland", Cover::farmland},
                               {"landuse", "farmyard", Cover::residential},
                               {"landuse", "railway", Cover::rail},
                               {"landuse", "brownfield", Cover::residential},
                               {"landuse", "construction", Cover::residential},
                               {"landuse", "residential", Cover::residential},
                               {"landuse", "commercial", Cover::residential},
                               {"landuse", "retail", Cover::residential},
                               {"landuse", "industrial", Cover::residential}};

struct LineRule {
  const char* value;
  double width_m;
  Cover cover;
};

// Widths without tags: the usual carriageway of each kind, with its lanes.
constexpr LineRule highway_rules[] = {
    {"motorway", 11.5, Cover::road},      {"trunk", 10.0, Cover::road},
    {"primary", 9.0, Cover::road},        {"secondary", 8.0, Cover::road},
    {"tertiary", 7.0, Cover::road},       {"unclassified", 5.5, Cover::road},
    {"residential", 5.5, Cover::road},    {"living_street", 5.0, Cover::road},
    {"service", 3.5, Cover::road},        {"motorway_link", 5.5, Cover::road},
    {"trunk_link", 5.5, Cover::road},     {"primary_link", 5.5, Cover::road},
    {"secondary_link", 5.5, Cover::road}, {"tertiary_link", 5.5, Cover::road},
    {"road", 5.5, Cover::road},           {"busway", 3.5, Cover::road},
    {"pedestrian", 5.0, Cover::square},   {"track", 3.0, Cover::path},
    {"footway", 2.0, Cover::path},        {"path", 1.5, Cover::path},
    {"cycleway", 2.0, Cover::path},       {"bridleway", 2.0, Cover::path},
    {"steps", 2.0, Cover::path}};
constexpr LineRule railway_rules[] = {{"rail", 3.0, Cover::rail},
                                      {"light_rail", 2.8, Cover::rail},
                                      {"tram", 2.6, Cover::rail},
                                      {"subway", 2.8, Cover::rail},
                                      {"narrow_gauge", 2.4, Cover::rail}};
constexpr LineRule waterway_rules[] = {{"river", 10.0, Cover::water},
                                       {"canal", 8.0, Cover::water},
                                       {"stream", 2.0, Cover::water},
                                       {"drain", 1.5, Cover::water},
                                       {"ditch", 1.0, Cover::water}};

constexpr double lane_m = 3.25;

template <size_t count>
const LineRule* find(const LineRule (&rules)[count], const std::string& value) {
  const auto* found =
      std::find_if(rules, rules + count, [&](const LineRule& rule) { return value == rule.value; });
  return found != rules + count ? found : nullptr;
}

const LineRule* line_rule(const Feature& feature) {
  if (const std::string* value = feature.tag("highway")) return find(highway_rules, *value);
  if (const std::string* value = feature.tag("railway")) return find(railway_rules, *value);
  if (const std::string* value = feature.tag("waterway")) return find(waterway_rules, *value);
  return nullptr;
}

/// Whether a line or an area lies below the ground.
bool underground(const Feature& feature) {
  if (const std::string* tunnel = feature.tag("tunnel"))
    return *tunnel != "no" && *tunnel != "building_passage";
  const std::string* location = feature.tag("location");
  return location && *location == "underground";
}

double width_of(const Feature& feature, const LineRule& rule, double scale) {
  if (const std::string* text = feature.tag("width"))
    if (const auto width = parse_length_m(*text); width && *width > 0.2 && *width < 200.0) return *width;
  if (rule.cover == Cover::road)
    if (const std::string* text = feature.tag("lanes"))
      if (const auto lanes = parse_levels(*text); lanes && *lanes >= 1.0 && *lanes <= 20.0)
        return *lanes * lane_m;
  return rule.width_m * (rule.cover == Cover::road ? scale : 1.0);
}

}  // namespace

const char* name_of(Cover cover) {
  constexpr std::array<const char*, cover_count> names{
      "base",    "residential", "farmland", "meadow",  "grass",  "wood", "scrub", "sand", "rock",
      "wetland", "pitch",       "water",    "parking", "square", "rail", "path",  "road"};
  return names[static_cast<size_t>(cover)];
}

std::optional<Cover> cover_of_area(const Feature& feature) {
  for (const Rule& rule : area_rules)
    if (const std::string* value = feature.tag(rule.key))
      if (*value == rule.value || (rule.value[0] == '*' && *value != "no")) return rule.cover;
  if (const LineRule* rule = line_rule(feature)) return rule->cover;  // an area of a road
  return std::nullopt;
}

GroundPlan ground_plan(const PlaceInput& input, const GroundConfig& config, std::vector<Finding>& findings) {
  GroundPlan plan;
  std::vector<std::vector<Polygon>> bands(cover_count);
  for (const Feature& feature : input.features) {
    const std::string label = object_label(feature.source, feature.id);
    if (!feature.polygons.empty() && !feature.tag("building") && !feature.tag("building:part")) {
      const std::optional<Cover> cover = cover_of_area(feature);
      if (!cover || underground(feature)) continue;
      GroundArea area{*cover, repaired(feature.polygons, label, name_of(*cover), findings), {}};
      area.box = box_of(area.polygons);
      if (!area.polygons.empty()) plan.areas.push_back(std::move(area));
      continue;
    }
    const LineRule* rule = feature.lines.empty() ? nullptr : line_rule(feature);
    if (!rule) continue;
    if (underground(feature)) {
      findings.push_back({Finding::Kind::left_out, "tunnel", label, "it lies below the ground"});
      continue;
    }
    const double width = width_of(feature, *rule, config.road_width_scale);
    const std::string* bridge = feature.tag("bridge");
    for (const std::vector<dvec2>& line : feature.lines) {
      if (line.size() < 2) continue;
      if (bridge && *bridge != "no") {
        int layer = 1;
        if (const std::string* text = feature.tag("layer"))
          if (const auto value = parse_levels(*text))
            layer = std::max(1, static_cast<int>(std::lround(*value)));
        plan.bridges.push_back({feature.source, feature.id, rule->cover, line, width, layer});
        continue;
      }
      plan.lines.push_back({feature.source, feature.id, rule->cover, line, width});
      std::vector<Polygon>& all = bands[static_cast<size_t>(rule->cover)];
      for (Polygon& polygon : band(line, width)) all.push_back(std::move(polygon));
    }
  }
  // The bands of a kind become one area, so that crossings have no edges of their own.
  for (size_t cover = 0; cover < cover_count; ++cover)
    for (const Polygon& polygon : unite(bands[cover]))
      plan.areas.push_back({static_cast<Cover>(cover), {polygon}, box_of(polygon)});
  return plan;
}

}  // namespace greatx::scene::place
