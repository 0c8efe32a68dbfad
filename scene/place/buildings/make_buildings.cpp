// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/make_buildings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "scene/place/buildings/heights.h"
#include "scene/place/buildings/roofs.h"
#include "scene/place/buildings/weld.h"
#include "scene/place/input/osm_values.h"

namespace greatx::scene::place {

namespace {

/// Footprints below this are no buildings, m^2.
constexpr double least_area_m2 = 0.5;

/// A feature that is a building or a part, with its valid area.
struct Candidate {
  const Feature* feature = nullptr;
  std::vector<Polygon> area;
  std::vector<Polygon> read_area;  ///< before corners of neighbours became one
  Box box;
  std::vector<RoofFace> solid_roof;  ///< of a solid
  double solid_bottom = 0.0;
  std::vector<size_t> parts;  ///< into the list of parts
};

std::string label_of(const Feature& feature) { return object_label(feature.source, feature.id); }

/// Lowest ground below the rings: at the corners and every 5 m between them.
double lowest_ground(const std::vector<Polygon>& area, const GroundAt& ground) {
  double low = 1e300;
  for (const Polygon& polygon : area)
    for (size_t i = 0; i < polygon.outer.size(); ++i) {
      const dvec2 a = polygon.outer[i], b = polygon.outer[(i + 1) % polygon.outer.size()];
      const int steps = static_cast<int>(glm::distance(a, b) / 5.0) + 1;
      for (int k = 0; k < steps; ++k)
        low = std::min(low, ground(a + (b - a) * (static_cast<double>(k) / steps)));
    }
  return low;
}

/// Median of the surface model over the area, or nothing if it covers less than half of it.
std::optional<double> median_surface(const HeightField& surface, const std::vector<Polygon>& area) {
  if (surface.empty()) return std::nullopt;
  const Box box = box_of(area);
  const double step = std::max(0.5, std::max(box.high.x - box.low.x, box.high.y - box.low.y) / 40.0);
  std::vector<double> found;
  size_t asked = 0;
  for (double y = box.low.y + 0.5 * step; y < box.high.y; y += step)
    for (double x = box.low.x + 0.5 * step; x < box.high.x; x += step) {
      if (std::none_of(area.begin(), area.end(), [&](const Polygon& p) { return contains(p, {x, y}); }))
        continue;
      ++asked;
      if (const auto z = surface.at({x, y})) found.push_back(*z);
    }
  if (found.empty() || 2 * found.size() < asked) return std::nullopt;
  std::nth_element(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(found.size() / 2), found.end());
  return found[found.size() / 2];
}

class Maker {
 public:
  Maker(const PlaceInput& input, const BuildingConfig& config, const GroundAt& ground,
        std::vector<Finding>& findings)
      : input_(input), config_(config), ground_(ground), findings_(findings) {}

  std::vector<Building> run() {
    for (const Feature& feature : input_.features) {
      if (is_building(feature))
        add_candidate(feature, outlines_);
      else if (is_building_part(feature))
        add_candidate(feature, parts_);
    }
    weld_all();
    join_parts();
    std::vector<Building> buildings;
    for (const Candidate& outline : outlines_) buildings.push_back(build(outline));
    for (size_t i = 0; i < parts_.size(); ++i)
      if (!joined_[i]) {
        note(Finding::Kind::assumed, "part_without_building", *parts_[i].feature,
             "no building is around it: it is one of its own");
        buildings.push_back(build(parts_[i]));
      }
    std::erase_if(buildings, [](const Building& building) { return building.parts.empty(); });
    return buildings;
  }

 private:
  void note(Finding::Kind kind, const char* topic, const Feature& feature, std::string detail) {
    findings_.push_back({kind, topic, label_of(feature), std::move(detail)});
  }

  void add_candidate(const Feature& feature, std::vector<Candidate>& list) {
    Candidate candidate;
    candidate.feature = &feature;
    if (!feature.faces.empty()) {
      candidate.solid_roof = roof_of_solid(feature.faces, candidate.solid_bottom);
      double sum = 0.0;
      std::vector<Polygon> all;
      for (const RoofFace& face : candidate.solid_roof) {
        all.insert(all.end(), face.area.begin(), face.area.end());
        sum += area(face.area);
      }
      candidate.area = unite(all);
      if (const double united = area(candidate.area); sum > 1.01 * united + 0.01)
        note(Finding::Kind::doubtful, "solid_overhangs", feature,
             fmt::format("roof faces lie above each other over {:.1f} of {:.1f} m^2: the highest ones count",
                         sum - united, united));
    } else {
      candidate.area = repaired(feature.polygons, label_of(feature), "outline", findings_);
      if (candidate.area.size() > 1) candidate.area = unite(candidate.area);
    }
    const double size = area(candidate.area);
    std::erase_if(candidate.area, [](const Polygon& polygon) { return area(polygon) < 0.01; });
    if (size < least_area_m2 || candidate.area.empty()) {
      note(Finding::Kind::left_out, "footprint_too_small", feature,
           fmt::format("its footprint has {:.3f} m^2, less than {} m^2", size, least_area_m2));
      return;
    }
    candidate.box = box_of(candidate.area);
    candidate.read_area = candidate.area;
    list.push_back(std::move(candidate));
  }

  /// Joins corners and walls of neighbours, before roofs are made of them.
  void weld_all() {
    std::vector<Ring*> rings;
    const auto add = [&](std::vector<Polygon>& area) {
      for (Polygon& polygon : area) {
        rings.push_back(&polygon.outer);
        for (Ring& hole : polygon.holes) rings.push_back(&hole);
      }
    };
    for (std::vector<Candidate>* list : {&outlines_, &parts_})
      for (Candidate& candidate : *list) {
        if (candidate.solid_roof.empty()) add(candidate.area);
        for (RoofFace& face : candidate.solid_roof) add(face.area);
      }
    weld(rings, config_.weld_m);
    for (std::vector<Candidate>* list : {&outlines_, &parts_})
      for (Candidate& candidate : *list) {
        if (candidate.solid_roof.empty()) {
          candidate.area = repaired(candidate.area);
          continue;
        }
        std::vector<Polygon> all;
        for (RoofFace& face : candidate.solid_roof) {
          face.area = repaired(face.area);
          all.insert(all.end(), face.area.begin(), face.area.end());
        }
        candidate.area = unite(all);
      }
  }

  /// Finds the building of each part: the one that it names, or the smallest one that holds its middle.
  void join_parts() {
    joined_.assign(parts_.size(), false);
    std::map<std::pair<std::string, std::string>, size_t> by_id;
    for (size_t i = 0; i < outlines_.size(); ++i)
      by_id.emplace(std::pair(outlines_[i].feature->source, outlines_[i].feature->id), i);
    for (size_t i = 0; i < parts_.size(); ++i) {
      const Candidate& part = parts_[i];
      size_t best = outlines_.size();
      if (!part.feature->part_of.empty())
        if (const auto found = by_id.find({part.feature->source, part.feature->part_of});
            found != by_id.end()) {
          if (outlines_[found->second].box.grown(1.0).meets(part.box))
            best = found->second;
          else
            note(Finding::Kind::doubtful, "part_away_from_building", *part.feature,
                 fmt::format("it names {} as its building, which is elsewhere: its place counts",
                             part.feature->part_of));
        }
      if (best == outlines_.size()) best = around(part);
      if (best == outlines_.size()) continue;
      outlines_[best].parts.push_back(i);
      joined_[i] = true;
    }
  }

  size_t around(const Candidate& part) const {
    size_t best = outlines_.size();
    double least = 1e300;
    const double size = area(part.area);
    for (size_t i = 0; i < outlines_.size(); ++i) {
      if (!outlines_[i].box.grown(0.1).meets(part.box)) continue;
      const double own = area(outlines_[i].area);
      if (own < least && area(intersect(outlines_[i].area, part.area)) > 0.5 * size) {
        least = own;
        best = i;
      }
    }
    return best;
  }

  Building build(const Candidate& outline) {
    const Feature& feature = *outline.feature;
    Building building;
    building.source = feature.source;
    building.id = feature.id;
    const std::string* use = feature.tag("building");
    building.use = use ? *use : "yes";
    if (const std::string* name = feature.tag("name")) building.name = *name;
    building.ground_z = lowest_ground(outline.area, ground_);
    building.read_outline = outline.read_area;
    building.plan_area_m2 = area(outline.read_area);
    building.floor_height_m = config_.floor_height_m;
    if (outline.parts.empty()) {
      add_part(building, outline, outline.area, feature);
    } else {
      std::vector<Polygon> whole = outline.read_area;
      for (const size_t index : outline.parts) {
        add_part(building, parts_[index], parts_[index].area, feature);
        whole.insert(whole.end(), parts_[index].read_area.begin(), parts_[index].read_area.end());
      }
      building.plan_area_m2 = area(unite(whole));  // parts may reach beyond the outline
      add_rest(building, outline);
    }
    building.facade_class = facade_class_of(feature, config_, building.storeys);
    for (const char* key : {"building:colour", "building:facade:colour"})
      if (const std::string* colour = feature.tag(key)) building.facade_colour = parse_colour(*colour);
    return building;
  }

  void add_part(Building& building, const Candidate& candidate, const std::vector<Polygon>& plan,
                const Feature& whole) {
    if (!candidate.solid_roof.empty()) {
      add_solid(building, candidate);
      return;
    }
    const Feature& feature = *candidate.feature;
    const Rectangle box = smallest_rectangle(plan.front().outer);
    PartContext context{label_of(feature), building.use, 0.0, false, area(plan), std::nullopt};
    const std::vector<Rectangle> rectangles =
        plan.size() == 1 ? wings(plan.front()) : std::vector<Rectangle>{};
    for (const Rectangle& wing : rectangles)
      context.half_width_m = std::max(context.half_width_m, wing.half.y);
    if (rectangles.empty()) context.half_width_m = box.half.y;
    context.convex = plan.size() == 1 && rectangles.size() == 1;
    if (const auto top = median_surface(input_.surface, plan)) context.surface_m = *top - building.ground_z;
    const PartHeights heights = heights_of(feature, context, config_, findings_);
    RoofOptions roof{heights.shape, building.ground_z + heights.top_m - heights.roof_m,
                     building.ground_z + heights.top_m, heights.direction_rad, heights.across};
    Part part;
    part.area = plan;
    part.on_ground = heights.bottom_m == 0.0;
    part.bottom_z = building.ground_z + heights.bottom_m;
    part.top_z = roof.ridge_z;
    part.eaves_z = roof.eaves_z;
    // A roof that met the ground at a slant would lie on it along a strip.
    part.roof = roof_over(plan, roof, part.on_ground ? building.ground_z + 0.1 : part.bottom_z, feature);
    part.roof_class = roof_class_of(feature, heights.shape, building.use);
    const std::string* colour = feature.tag("roof:colour");
    if (!colour) colour = whole.tag("roof:colour");
    if (colour) part.roof_colour = parse_colour(*colour);
    if (building.parts.empty()) building.height_from = heights.from;
    if (heights.storeys > building.storeys || building.parts.empty()) building.storeys = heights.storeys;
    finish(building, std::move(part));
  }

  /// Makes the roof of a part. No point of it lies below `least_z`: where it would, its eaves are raised.
  std::vector<RoofFace> roof_over(const std::vector<Polygon>& plan, RoofOptions options, double least_z,
                                  const Feature& feature) {
    constexpr double slack_m = 1e-3;
    const double eaves = options.eaves_z;
    for (;;) {
      std::vector<RoofFace> roof;
      double lowest = 1e300;
      for (const Polygon& polygon : plan)
        for (RoofFace& face : make_roof(polygon, options)) {
          for (const Polygon& piece : face.area)
            for (const dvec2& p : piece.outer) lowest = std::min(lowest, face.plane.z(p));
          roof.push_back(std::move(face));
        }
      if (lowest >= least_z - slack_m || options.shape == RoofShape::flat) {
        if (options.eaves_z > eaves)
          note(Finding::Kind::repaired, "roof_reaches_bottom", feature,
               fmt::format(
                   "a roof of {:.2f} m would end below the ground or the part's bottom: its eaves were "
                   "raised by {:.2f} m",
                   options.ridge_z - eaves, std::min(options.eaves_z, options.ridge_z) - eaves));
        return roof;
      }
      options.eaves_z += least_z - lowest + slack_m;
      if (options.eaves_z > options.ridge_z - 0.05) options.shape = RoofShape::flat;
    }
  }

  void add_solid(Building& building, const Candidate& candidate) {
    Part part;
    part.area = candidate.area;
    part.roof = candidate.solid_roof;
    part.bottom_z = candidate.solid_bottom;
    part.top_z = -1e300;
    part.eaves_z = 1e300;
    bool pitched = false;
    for (const RoofFace& face : part.roof) {
      pitched = pitched || !face.plane.level();
      for (const Polygon& polygon : face.area)
        for (const dvec2& p : polygon.outer) {
          part.top_z = std::max(part.top_z, face.plane.z(p));
          part.eaves_z = std::min(part.eaves_z, face.plane.z(p));
        }
    }
    // A solid that begins within a storey above the ground stands on it.
    part.on_ground = part.bottom_z < building.ground_z + config_.floor_height_m;
    building.height_from = Source::solid;
    building.storeys =
        std::max(building.storeys,
                 static_cast<int>(std::lround((part.eaves_z - building.ground_z) / config_.floor_height_m)));
    part.roof_class =
        roof_class_of(*candidate.feature, pitched ? RoofShape::gabled : RoofShape::flat, building.use);
    if (part.top_z <= building.ground_z + 0.05) {
      note(Finding::Kind::left_out, "roof_below_ground", *candidate.feature,
           fmt::format("its roof at z = {:.2f} m is not above the ground there, {:.2f} m", part.top_z,
                       building.ground_z));
      return;
    }
    finish(building, std::move(part));
  }

  void finish(Building& building, Part part) {
    for (const RoofFace& face : part.roof)
      for (const Polygon& polygon : face.area) {
        // Mean height over a polygon: its plane at the area's centroid, outer ring less holes.
        const auto moment = [&](const Ring& ring) {
          double sum = 0.0, size = 0.0;  // heights may be below zero: the sign is that of the area
          for (size_t i = 1; i + 1 < ring.size(); ++i) {
            const dvec2 a = ring[i] - ring[0], b = ring[i + 1] - ring[0];
            size += 0.5 * (a.x * b.y - a.y * b.x);
            sum += 0.5 * (a.x * b.y - a.y * b.x) * face.plane.z(ring[0] + (a + b) / 3.0);
          }
          return size < 0.0 ? -sum : sum;
        };
        double volume = moment(polygon.outer);
        for (const Ring& hole : polygon.holes) volume -= moment(hole);
        const double from = part.on_ground ? building.ground_z : part.bottom_z;
        building.plan_volume_m3 += volume - from * area(polygon);
      }
    building.parts.push_back(std::move(part));
  }

  /// Builds what the parts of a building leave uncovered, up to the top of the lowest part.
  void add_rest(Building& building, const Candidate& outline) {
    if (building.parts.empty()) return;
    std::vector<Polygon> covered;
    double lowest = 1e300;
    for (const Part& part : building.parts) {
      covered.insert(covered.end(), part.area.begin(), part.area.end());
      lowest = std::min(lowest, part.eaves_z);
    }
    std::vector<Polygon> rest = subtract(outline.area, unite(covered));
    std::erase_if(rest, [](const Polygon& polygon) { return area(polygon) < 0.05 * perimeter(polygon); });
    if (area(rest) < 0.05 * building.plan_area_m2) return;
    note(Finding::Kind::assumed, "parts_leave_rest", *outline.feature,
         fmt::format("its parts leave {:.0f} of {:.0f} m^2: these reach up to the lowest part, {:.1f} m",
                     area(rest), building.plan_area_m2, lowest - building.ground_z));
    Part part;
    part.area = rest;
    part.bottom_z = building.ground_z;
    part.top_z = part.eaves_z = lowest;
    part.roof = {{rest, {box_of(rest).low, lowest, dvec2(0.0)}}};
    part.roof_class = roof_class_of(*outline.feature, RoofShape::flat, building.use);
    finish(building, std::move(part));
  }

  const PlaceInput& input_;
  const BuildingConfig& config_;
  const GroundAt& ground_;
  std::vector<Finding>& findings_;
  std::vector<Candidate> outlines_, parts_;
  std::vector<bool> joined_;
};

}  // namespace

bool is_building(const Feature& feature) {
  const std::string* value = feature.tag("building");
  return value && *value != "no" && (!feature.polygons.empty() || !feature.faces.empty()) &&
         !feature.tag("building:part");
}

bool is_building_part(const Feature& feature) {
  const std::string* value = feature.tag("building:part");
  return value && *value != "no" && (!feature.polygons.empty() || !feature.faces.empty());
}

std::string label(const Building& building) { return object_label(building.source, building.id); }

std::vector<Polygon> outline(const Building& building) {
  std::vector<Polygon> all;
  for (const Part& part : building.parts) all.insert(all.end(), part.area.begin(), part.area.end());
  return building.parts.size() > 1 ? unite(all) : all;
}

std::vector<Building> make_buildings(const PlaceInput& input, const BuildingConfig& config,
                                     const GroundAt& ground, std::vector<Finding>& findings) {
  return Maker(input, config, ground, findings).run();
}

}  // namespace greatx::scene::place
