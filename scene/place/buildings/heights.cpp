// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/heights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/units.h"
#include "scene/place/input/object_random.h"
#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

constexpr double roof_level_m = 2.5;
constexpr double usual_roof_angle = radians(35.0);
constexpr double most_roof_share = 0.45;
constexpr double most_height_m = 1000.0;

void report(std::vector<Finding>& findings, Finding::Kind kind, const char* topic, const PartContext& context,
            std::string detail) {
  findings.push_back({kind, topic, context.label, std::move(detail)});
}

/// Reads a positive length, and reports a value that is none.
std::optional<double> length(const Feature& feature, const char* key, const PartContext& context,
                             std::vector<Finding>& findings, bool zero_counts = false) {
  const std::string* text = feature.tag(key);
  if (!text) return std::nullopt;
  const std::optional<double> value = parse_length_m(*text);
  if (value && (*value > 0.0 || (zero_counts && *value == 0.0)) && *value <= most_height_m) return value;
  report(findings, Finding::Kind::left_out, "value_not_understood", context,
         fmt::format("{} = \"{}\" is no height between 0 and {} m and does not count", key, *text,
                     most_height_m));
  return std::nullopt;
}

std::optional<double> levels(const Feature& feature, const char* key, const PartContext& context,
                             std::vector<Finding>& findings) {
  const std::string* text = feature.tag(key);
  if (!text) return std::nullopt;
  const std::optional<double> value = parse_levels(*text);
  if (value && *value >= 0.0 && *value <= 300.0) return value;
  report(findings, Finding::Kind::left_out, "value_not_understood", context,
         fmt::format("{} = \"{}\" is no number of storeys between 0 and 300 and does not count", key, *text));
  return std::nullopt;
}

dvec2 assumed_range(const std::string& use, const BuildingConfig& config) {
  if (const auto found = config.assumed_height_m.find(use); found != config.assumed_height_m.end())
    return found->second;
  if (const auto found = config.assumed_height_m.find(""); found != config.assumed_height_m.end())
    return found->second;
  static const std::vector<std::pair<std::vector<std::string>, dvec2>> usual{
      {{"garage", "garages", "shed", "hut", "carport", "kiosk", "service", "roof", "greenhouse"}, {2.5, 3.5}},
      {{"bungalow", "cabin", "static_caravan"}, {3.5, 5.0}},
      {{"house", "detached", "semidetached_house", "terrace", "residential", "farm"}, {6.0, 9.0}},
      {{"apartments", "dormitory", "hotel"}, {12.0, 22.0}},
      {{"office", "commercial", "government", "hospital", "university"}, {10.0, 25.0}},
      {{"industrial", "warehouse", "retail", "supermarket", "hangar", "barn"}, {6.0, 12.0}},
      {{"church", "cathedral", "chapel", "mosque", "temple"}, {10.0, 20.0}}};
  for (const auto& [names, range] : usual)
    if (std::find(names.begin(), names.end(), use) != names.end()) return range;
  return {5.0, 12.0};
}

/// Returns the first year that a tag of the building's age names.
std::optional<int> year_of(const Feature& feature) {
  for (const char* key : {"start_date", "construction_date", "building:age", "year_of_construction"})
    if (const std::string* text = feature.tag(key))
      for (size_t i = 0; i + 4 <= text->size(); ++i) {
        const bool digits = std::all_of(text->begin() + static_cast<std::ptrdiff_t>(i),
                                        text->begin() + static_cast<std::ptrdiff_t>(i + 4),
                                        [](char c) { return c >= '0' && c <= '9'; });
        if (!digits) continue;
        int year = 0;
        for (size_t k = i; k < i + 4; ++k) year = 10 * year + ((*text)[k] - '0');
        return year;
      }
  return std::nullopt;
}

bool is_pitched_kind(const std::string& use) {
  static const std::array<const char*, 8> kinds{
      "house", "detached", "semidetached_house", "terrace", "farm", "bungalow", "cabin", "barn"};
  return std::find(kinds.begin(), kinds.end(), use) != kinds.end();
}

void find_shape(PartHeights& part, const Feature& feature, const PartContext& context,
                const BuildingConfig& config, std::vector<Finding>& findings) {
  if (const std::string* text = feature.tag("roof:shape")) {
    const std::optional<RoofShape> shape = roof_shape(*text);
    if (!shape)
      report(findings, Finding::Kind::assumed, "roof_unknown", context,
             fmt::format("roof:shape = \"{}\" is not known: the roof is flat", *text));
    part.shape = shape.value_or(RoofShape::flat);
  } else if (is_pitched_kind(context.use) && context.convex && context.area_m2 < 400.0 &&
             context.half_width_m > 1.5) {
    RandomStream random = random_of(feature, config.seed, 2);
    part.shape = random.uniform() < 0.75 ? RoofShape::gabled : RoofShape::hipped;
    report(findings, Finding::Kind::assumed, "roof_assumed", context,
           fmt::format("no roof:shape: a {} of this size gets a {} roof", context.use, name_of(part.shape)));
  }
  if (const std::string* text = feature.tag("roof:direction"))
    if (const std::optional<double> direction = parse_direction_deg(*text))
      part.direction_rad = radians(90.0 - *direction);
  if (const std::string* text = feature.tag("roof:orientation")) part.across = *text == "across";
}

/// Height of the roof as the tags say it, or by rule. `walls_m` is the height without the roof, or with it if
/// `includes_roof`.
double roof_height(const Feature& feature, const PartContext& context, RoofShape shape, double height_m,
                   bool includes_roof, std::vector<Finding>& findings) {
  if (shape == RoofShape::flat) return 0.0;
  const double span = shape == RoofShape::skillion ? 2.0 * context.half_width_m : context.half_width_m;
  if (const auto given = length(feature, "roof:height", context, findings)) return *given;
  if (const std::string* text = feature.tag("roof:angle"))
    if (const auto angle = parse_levels(*text); angle && *angle > 0.0 && *angle < 85.0)
      return std::tan(radians(*angle)) * span;
  if (const auto count = levels(feature, "roof:levels", context, findings); count && *count > 0.0)
    return *count * roof_level_m;
  const double by_angle = std::tan(usual_roof_angle) * span * (shape == RoofShape::skillion ? 0.4 : 1.0);
  const double share = includes_roof ? most_roof_share : most_roof_share / (1.0 - most_roof_share);
  return shape == RoofShape::dome ? std::min(context.half_width_m, share * height_m)
                                  : std::min(by_angle, share * height_m);
}

}  // namespace

PartHeights heights_of(const Feature& feature, const PartContext& context, const BuildingConfig& config,
                       std::vector<Finding>& findings) {
  PartHeights part;
  find_shape(part, feature, context, config, findings);
  const auto storeys = levels(feature, "building:levels", context, findings);
  const auto bottom_storeys = levels(feature, "building:min_level", context, findings);
  if (const auto given = length(feature, "min_height", context, findings, true))
    part.bottom_m = *given;
  else if (bottom_storeys)
    part.bottom_m = *bottom_storeys * config.floor_height_m;
  const auto add_roof = [&](double walls_m) {
    part.roof_m = roof_height(feature, context, part.shape, walls_m, false, findings);
    part.top_m = walls_m + part.roof_m;
  };
  if (const auto height = length(feature, "height", context, findings)) {
    part.top_m = *height;
    part.roof_m = roof_height(feature, context, part.shape, *height - part.bottom_m, true, findings);
  } else if (storeys && *storeys > 0.0) {
    part.from = Source::levels;
    add_roof(*storeys * config.floor_height_m);
  } else if (context.surface_m && *context.surface_m > 1.5) {
    part.from = Source::surface;
    part.top_m = *context.surface_m;
    part.roof_m = roof_height(feature, context, part.shape, part.top_m, true, findings);
  } else {
    part.from = Source::assumed;
    const dvec2 range = assumed_range(context.use, config);
    RandomStream random = random_of(feature, config.seed, 1);
    const double walls = std::round(10.0 * random.uniform(range.x, range.y)) / 10.0;
    add_roof(part.bottom_m + walls);
    report(findings, Finding::Kind::assumed, "height_assumed", context,
           fmt::format("no height and no storeys: walls of {:.1f} m, drawn between {} and {} m for \"{}\"",
                       walls, range.x, range.y, context.use));
  }
  if (part.bottom_m >= part.top_m) {
    report(findings, Finding::Kind::left_out, "bottom_above_top", context,
           fmt::format("its bottom, {:.2f} m, lies above its top, {:.2f} m: it starts at the ground",
                       part.bottom_m, part.top_m));
    part.bottom_m = 0.0;
  }
  const double most_roof = part.top_m - part.bottom_m;
  if (part.roof_m > most_roof) {
    report(
        findings, Finding::Kind::repaired, "roof_higher_than_building", context,
        fmt::format("its roof of {:.2f} m is higher than the whole of {:.2f} m: the walls end at the bottom",
                    part.roof_m, most_roof));
    part.roof_m = most_roof;
  }
  const double walls = part.top_m - part.roof_m;
  part.storeys = storeys && *storeys >= 1.0
                     ? static_cast<int>(std::lround(*storeys))
                     : std::max(1, static_cast<int>(std::lround(walls / config.floor_height_m)));
  return part;
}

std::string facade_class_of(const Feature& feature, const BuildingConfig& config, int storeys) {
  static const std::vector<std::pair<const char*, const char*>> materials{
      {"brick", "brick"},    {"plaster", "plaster"},       {"stucco", "plaster"},
      {"render", "plaster"}, {"concrete", "concrete"},     {"cement_block", "concrete"},
      {"stone", "stone"},    {"sandstone", "stone"},       {"limestone", "stone"},
      {"marble", "stone"},   {"glass", "glass"},           {"mirror", "glass"},
      {"metal", "metal"},    {"steel", "metal"},           {"metal_plates", "metal"},
      {"wood", "wood"},      {"timber_framing", "plaster"}};
  for (const char* key : {"building:material", "building:facade:material"})
    if (const std::string* value = feature.tag(key))
      for (const auto& [name, facade] : materials)
        if (*value == name) return facade;
  const std::string* kind = feature.tag("building");
  const std::string use = kind ? *kind : "yes";
  RandomStream random = random_of(feature, config.seed, 3);
  const double pick = random.uniform();
  const std::optional<int> year = year_of(feature);
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), use) != names.end();
  };
  if (is({"garage", "garages", "industrial", "warehouse", "hangar"})) return pick < 0.5 ? "blind" : "metal";
  if (is({"shed", "hut", "carport", "barn", "cabin"})) return "wood";
  if (is({"office", "commercial", "government"}) || storeys > 9)
    return pick < 0.4 ? "glass" : pick < 0.7 ? "ribbon" : "concrete";
  if (is({"supermarket", "retail", "kiosk", "sports_hall", "sports_centre", "stadium", "train_station"}))
    return pick < 0.5 ? "ribbon" : "metal";
  if (is({"church", "cathedral", "chapel", "monastery"})) return "stone";
  if (is({"water_tower", "silo", "bunker", "storage_tank"})) return "concrete";
  // Plaster takes any colour; bricks have their own.
  if (feature.tag("building:colour") || feature.tag("building:facade:colour")) return "plaster";
  // Housing looks as its time built: stucco, brick and stone up to the First World War, plaster until the
  // sixties, slabs of concrete until the nineties.
  if (year && *year < 1919) return pick < 0.4 ? "plaster" : pick < 0.75 ? "brick" : "stone";
  if (year && *year < 1960) return pick < 0.7 ? "plaster" : "brick";
  if (year && *year < 1992 && !is({"house", "detached", "semidetached_house", "terrace", "farm", "bungalow"}))
    return pick < 0.75 ? "concrete" : "plaster";
  if (year && *year >= 2005 && is({"apartments", "residential", "yes"}))
    return pick < 0.6 ? "plaster" : "ribbon";
  if (is({"house", "detached", "semidetached_house", "terrace", "farm", "bungalow"}))
    return pick < 0.5 ? "plaster" : "brick";
  return pick < 0.45 ? "plaster" : pick < 0.7 ? "brick" : pick < 0.85 ? "stone" : "concrete";
}

std::string roof_class_of(const Feature& feature, RoofShape shape, const std::string& use) {
  static const std::vector<std::pair<const char*, const char*>> materials{
      {"roof_tiles", "tiles"}, {"tile", "tiles"},     {"tiles", "tiles"},  {"clay", "tiles"},
      {"slate", "slate"},      {"stone", "slate"},    {"metal", "sheet"},  {"metal_sheet", "sheet"},
      {"copper", "sheet"},     {"zinc", "sheet"},     {"steel", "sheet"},  {"concrete", "flat"},
      {"gravel", "flat"},      {"tar_paper", "felt"}, {"bitumen", "felt"}, {"asphalt", "felt"},
      {"eternit", "felt"},     {"glass", "glass"},    {"grass", "green"},  {"plants", "green"},
      {"wood", "wood"},        {"thatch", "thatch"}};
  if (const std::string* value = feature.tag("roof:material"))
    for (const auto& [name, roof] : materials)
      if (*value == name) return roof;
  if (use == "greenhouse") return "glass";
  if (shape == RoofShape::flat || shape == RoofShape::skillion)
    return use == "garage" || use == "garages" ? "felt" : "flat";
  if (shape == RoofShape::dome || shape == RoofShape::round) return "sheet";
  return shape == RoofShape::mansard ? "slate" : "tiles";
}

}  // namespace greatx::scene::place
