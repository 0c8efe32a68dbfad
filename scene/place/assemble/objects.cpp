// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/objects.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "core/random.h"
#include "core/units.h"
#include "scene/generator/objects/trees.h"
#include "scene/place/input/object_random.h"
#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

constexpr size_t most_trees = 200'000;
constexpr int tree_shapes = 4;

class Finder {
 public:
  Finder(const VegetationConfig& config, const CoverMap& covers, const Box& rectangle,
         const std::function<bool(const dvec2&)>& blocked, const std::function<double(const dvec2&)>& ground,
         std::vector<Finding>& findings)
      : config_(config),
        covers_(covers),
        rectangle_(rectangle),
        blocked_(blocked),
        ground_(ground),
        findings_(findings) {}

  void add(const Feature& feature) {
    if (feature.point) add_point(feature, *feature.point);
    for (const std::vector<dvec2>& line : feature.lines) {
      if (is(feature, "natural", "tree_row")) add_row(feature, line);
      if (is(feature, "barrier", "hedge")) add_hedge(feature, line);
    }
  }

  void add_wood(const GroundArea& wood) {
    const double spacing = std::sqrt(1e4 / config_.woods_per_hectare);
    for (const Polygon& polygon : wood.polygons) {
      const Box box = box_of(polygon);
      // The lattice is that of the whole plane, so that a wood has the same trees in every cut of the map.
      const auto first = [&](double low) { return static_cast<int64_t>(std::floor(low / spacing)); };
      for (int64_t j = first(box.low.y); j <= first(box.high.y); ++j)
        for (int64_t i = first(box.low.x); i <= first(box.high.x); ++i) {
          RandomStream random(config_.seed, static_cast<uint32_t>(i), static_cast<uint32_t>(j));
          const double u = random.uniform(), v = random.uniform();
          const dvec2 place((static_cast<double>(i) + u) * spacing, (static_cast<double>(j) + v) * spacing);
          if (!rectangle_.holds(place) || !contains(polygon, place) || covers_.at(place) != Cover::wood ||
              blocked_(place))
            continue;
          add_tree(place, random, "", "", std::nullopt, -1);
        }
    }
  }

  ObjectPlan take() {
    if (left_out_ > 0)
      findings_.push_back({Finding::Kind::left_out, "too_many_trees", "woods",
                           fmt::format("{} trees beyond the limit of {}", left_out_, most_trees)});
    return std::move(plan_);
  }

 private:
  static bool is(const Feature& feature, const char* key, const char* value) {
    const std::string* text = feature.tag(key);
    return text && *text == value;
  }
  static std::optional<double> height(const Feature& feature) {
    const std::string* text = feature.tag("height");
    const auto value = text ? parse_length_m(*text) : std::nullopt;
    return value && *value > 0.3 && *value < 150.0 ? value : std::nullopt;
  }

  void add_point(const Feature& feature, const dvec2& place) {
    if (!rectangle_.holds(place)) return;
    RandomStream random = random_of(feature, config_.seed, 9);
    const auto put = [&](ObjectKind kind) {
      double yaw = 0.0;
      if (const std::string* text = feature.tag("direction"))
        if (const auto direction = parse_direction_deg(*text)) yaw = radians(90.0 - *direction);
      plan_.objects.push_back(
          {kind, 0, 0, dvec3(place, ground_(place)), yaw,
           kind == ObjectKind::mast || kind == ObjectKind::lamp ? height(feature).value_or(0.0) : 0.0,
           feature.source, feature.id});
    };
    if (is(feature, "natural", "tree")) {
      if (blocked_(place)) {
        findings_.push_back({Finding::Kind::left_out, "tree_in_building",
                             object_label(feature.source, feature.id), "it stands within a building"});
        return;
      }
      add_tree(place, random, feature.source, feature.id, height(feature), species(feature));
    } else if (is(feature, "highway", "street_lamp")) {
      put(ObjectKind::lamp);
    } else if (is(feature, "highway", "traffic_signals")) {
      put(ObjectKind::signal);
    } else if (is(feature, "man_made", "mast") || is(feature, "man_made", "communications_tower") ||
               is(feature, "tower:type", "communication")) {
      put(ObjectKind::mast);
    } else if (is(feature, "amenity", "bench")) {
      put(ObjectKind::bench);
    } else if (is(feature, "amenity", "waste_basket")) {
      put(ObjectKind::bin);
    }
  }

  /// Returns the number of the species, tree_species for a conifer, or -1.
  static int species(const Feature& feature) {
    if (is(feature, "leaf_type", "needleleaved")) return generator::tree_species;
    static constexpr std::array<std::pair<const char*, int>, 10> genera{{{"Tilia", 0},
                                                                         {"Acer", 1},
                                                                         {"Quercus", 2},
                                                                         {"Platanus", 3},
                                                                         {"Populus", 4},
                                                                         {"Fagus", 5},
                                                                         {"Pinus", generator::tree_species},
                                                                         {"Picea", generator::tree_species},
                                                                         {"Abies", generator::tree_species},
                                                                         {"Larix", generator::tree_species}}};
    for (const char* key : {"genus", "species", "taxon"})
      if (const std::string* text = feature.tag(key))
        for (const auto& [genus, number] : genera)
          if (text->rfind(genus, 0) == 0) return number;
    return -1;
  }

  void add_tree(const dvec2& place, RandomStream& random, const std::string& source, const std::string& id,
                std::optional<double> height_m, int kind) {
    if (plan_.objects.size() >= most_trees) {
      ++left_out_;
      return;
    }
    const int drawn = static_cast<int>(random.below(generator::tree_species));
    const int chosen = kind >= 0 ? kind : drawn;
    const bool conifer = chosen == generator::tree_species;
    PlacedObject tree{conifer ? ObjectKind::conifer : ObjectKind::tree,
                      conifer ? 0 : chosen,
                      static_cast<int>(random.below(tree_shapes)),
                      dvec3(place, ground_(place)),
                      random.uniform(-pi, pi),
                      height_m.value_or(0.0),
                      source,
                      id};
    plan_.objects.push_back(tree);
  }

  void add_row(const Feature& feature, const std::vector<dvec2>& line) {
    RandomStream random = random_of(feature, config_.seed, 10);
    double left = 0.0;
    for (size_t i = 0; i + 1 < line.size(); ++i) {
      const double length = glm::distance(line[i], line[i + 1]);
      double at = left;
      for (; at <= length; at += config_.row_spacing_m) {
        const dvec2 place = glm::mix(line[i], line[i + 1], at / std::max(length, 1e-9));
        if (rectangle_.holds(place) && !blocked_(place))
          add_tree(place, random, feature.source, feature.id, height(feature), species(feature));
      }
      left = at - length;
    }
  }

  void add_hedge(const Feature& feature, const std::vector<dvec2>& line) {
    Hedge hedge{{}, 0.8, height(feature).value_or(1.5), feature.source, feature.id};
    if (const std::string* text = feature.tag("width"))
      if (const auto width = parse_length_m(*text); width && *width > 0.1 && *width < 10.0)
        hedge.width_m = *width;
    for (const dvec2& p : line)
      if (rectangle_.holds(p)) hedge.line.push_back(p);
    if (hedge.line.size() >= 2) plan_.hedges.push_back(std::move(hedge));
  }

  const VegetationConfig& config_;
  const CoverMap& covers_;
  const Box& rectangle_;
  const std::function<bool(const dvec2&)>& blocked_;
  const std::function<double(const dvec2&)>& ground_;
  std::vector<Finding>& findings_;
  ObjectPlan plan_;
  size_t left_out_ = 0;
};

}  // namespace

const char* name_of(ObjectKind kind) {
  constexpr std::array<const char*, object_kinds> names{"tree", "conifer", "street_lamp", "traffic_signal",
                                                        "mast", "bench",   "bin"};
  return names[static_cast<size_t>(kind)];
}

ObjectPlan find_objects(const PlaceInput& input, const VegetationConfig& config, const GroundPlan& plan,
                        const CoverMap& covers, const Box& rectangle,
                        const std::function<bool(const dvec2&)>& blocked,
                        const std::function<double(const dvec2&)>& ground, std::vector<Finding>& findings) {
  Finder finder(config, covers, rectangle, blocked, ground, findings);
  for (const Feature& feature : input.features) finder.add(feature);
  if (config.woods_per_hectare > 0.0)
    for (const GroundArea& area : plan.areas)
      if (area.cover == Cover::wood) finder.add_wood(area);
  return finder.take();
}

}  // namespace greatx::scene::place
