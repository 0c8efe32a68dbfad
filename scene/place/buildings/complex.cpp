// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/complex.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include "core/error.h"
#include "scene/place/buildings/layers.h"

namespace greatx::scene::place {

namespace {

/// Buildings of one block have one foundation, unless theirs would be this much deeper than they need.
constexpr double most_extra_depth_m = 3.0;

class Groups {
 public:
  explicit Groups(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t of(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

/// Sets the bottoms of parts on the ground: one level for buildings that touch.
void lay_foundations(std::vector<Building>& buildings, const Plan& plan, double depth_m) {
  Groups blocks(buildings.size());
  for (const PlanEdge& edge : plan.edges)
    for (const Layer& left : plan.layers[edge.left])
      for (const Layer& right : plan.layers[edge.right]) blocks.join(left.building, right.building);
  std::vector<double> lowest(buildings.size(), 1e300);
  const auto own = [&](const Building& building) {
    return std::floor(10.0 * (building.ground_z - depth_m)) / 10.0;
  };
  for (uint32_t i = 0; i < buildings.size(); ++i)
    lowest[blocks.of(i)] = std::min(lowest[blocks.of(i)], own(buildings[i]));
  for (uint32_t i = 0; i < buildings.size(); ++i) {
    const double block = lowest[blocks.of(i)], needed = own(buildings[i]);
    const double bottom = on_grid(needed - block > most_extra_depth_m ? needed : block);
    for (Part& part : buildings[i].parts)
      if (part.on_ground) part.bottom_z = bottom;
  }
}

/// Level roofs and bottoms that meet and differ by less than same_height_m get the height of the largest one.
void level_neighbours(std::vector<Building>& buildings, const Plan& plan, double& most_welded) {
  // A surface is the roof face of a part, or its bottom.
  std::vector<double*> heights;
  std::vector<double> sizes;
  std::map<std::array<uint32_t, 3>, uint32_t> index;
  constexpr uint32_t bottom = 0xFFFFFFFFu;
  const auto surface = [&](uint32_t building, uint32_t part, uint32_t face) {
    const auto [found, is_new] =
        index.try_emplace({building, part, face}, static_cast<uint32_t>(heights.size()));
    if (is_new) {
      Part& owner = buildings[building].parts[part];
      heights.push_back(face == bottom ? &owner.bottom_z : &owner.roof[face].plane.height);
      sizes.push_back(area(face == bottom ? owner.area : owner.roof[face].area));
    }
    return found->second;
  };
  std::vector<std::array<uint32_t, 2>> pairs;
  const auto compare = [&](const std::vector<Layer>& a, const std::vector<Layer>& b) {
    std::vector<uint32_t> found;
    for (const std::vector<Layer>* layers : {&a, &b})
      for (const Layer& layer : *layers) {
        if (layer.top.level()) found.push_back(surface(layer.building, layer.part, layer.roof_face));
        found.push_back(surface(layer.building, layer.part, bottom));
      }
    for (size_t i = 0; i < found.size(); ++i)
      for (size_t j = 0; j < i; ++j)
        if (const double off = std::abs(*heights[found[i]] - *heights[found[j]]);
            off > 0.0 && off < same_height_m)
          pairs.push_back({found[i], found[j]});
  };
  for (const PlanEdge& edge : plan.edges) compare(plan.layers[edge.left], plan.layers[edge.right]);
  if (pairs.empty()) return;
  Groups groups(heights.size());
  for (const auto& [a, b] : pairs) groups.join(a, b);
  std::vector<uint32_t> largest(heights.size());
  std::iota(largest.begin(), largest.end(), 0u);
  for (uint32_t i = 0; i < heights.size(); ++i) {
    uint32_t& best = largest[groups.of(i)];
    if (sizes[i] > sizes[best]) best = i;
  }
  for (uint32_t i = 0; i < heights.size(); ++i) {
    const double height = *heights[largest[groups.of(i)]];
    most_welded = std::max(most_welded, std::abs(height - *heights[i]));
    *heights[i] = height;
  }
}

/// Heights at the corners of the plan. Heights nearer than same_height_m are merged, and those of planes that
/// cross too near to the corner.
class CornerHeights {
 public:
  CornerHeights(const Plan& plan, const std::vector<PlaneCrossing>& crossings, double& most_welded)
      : clusters_(plan.triangulation.points().size()) {
    struct Value {
      double z;
      bool level;
    };
    std::vector<std::vector<Value>> values(clusters_.size());
    std::set<std::pair<uint32_t, uint32_t>> done;
    const auto& triangles = plan.triangulation.triangles();
    for (uint32_t t = 0; t < triangles.size(); ++t) {
      const std::vector<Layer>& layers = plan.layers[plan.region_of[t]];
      if (layers.empty()) continue;
      for (const uint32_t corner : triangles[t].corners) {
        if (!done.emplace(corner, plan.region_of[t]).second) continue;
        const dvec2 p = plan.place(corner);
        for (const Layer& layer : layers) {
          values[corner].push_back({layer.bottom.z(p), layer.bottom.level()});
          values[corner].push_back({layer.top.z(p), layer.top.level()});
        }
      }
    }
    std::map<uint32_t, std::vector<std::pair<double, double>>> merged;
    for (const PlaneCrossing& crossing : crossings)
      if (crossing.corner != Triangulation::none)
        merged[crossing.corner].emplace_back(crossing.low, crossing.high);
    for (size_t corner = 0; corner < values.size(); ++corner) {
      auto& list = values[corner];
      const auto found = merged.find(static_cast<uint32_t>(corner));
      const auto joined = [&](double low, double high) {
        if (high - low < same_height_m) return true;
        return found != merged.end() &&
               std::any_of(found->second.begin(), found->second.end(),
                           [&](const auto& range) { return range.first <= low && high <= range.second; });
      };
      std::sort(list.begin(), list.end(), [](const Value& a, const Value& b) { return a.z < b.z; });
      for (size_t i = 0; i < list.size();) {
        size_t end = i;
        double sum = 0.0, level = 0.0;
        bool has_level = false;
        for (; end < list.size() && (end == i || joined(list[end - 1].z, list[end].z)); ++end) {
          sum += list[end].z;
          if (list[end].level && !has_level) {
            has_level = true;
            level = list[end].z;
          }
        }
        // A level surface stays level: its height stands for the others.
        const double z = on_grid(has_level ? level : sum / static_cast<double>(end - i));
        most_welded = std::max({most_welded, std::abs(z - list[i].z), std::abs(z - list[end - 1].z)});
        clusters_[corner].push_back({list[i].z, z});
        i = end;
      }
    }
  }

  /// Returns the height that stands for z at a corner.
  double at(uint32_t corner, double z) const {
    const auto& list = clusters_[corner];
    auto found = std::upper_bound(list.begin(), list.end(), z,
                                  [](double value, const Cluster& c) { return value < c.low; });
    GREATX_CHECK(found != list.begin(), "height {} is not known at point {}", z, corner);
    return (found - 1)->z;
  }
  /// Appends the heights strictly between two of them.
  void between(uint32_t corner, double low, double high, std::vector<double>& out) const {
    for (const Cluster& cluster : clusters_[corner])
      if (cluster.z > low && cluster.z < high) out.push_back(cluster.z);
  }

 private:
  struct Cluster {
    double low, z;
  };
  std::vector<std::vector<Cluster>> clusters_;  ///< of each point, ascending
};

/// A height along an edge, at its two ends.
struct Rail {
  double from, to;
  double sum() const { return from + to; }
  bool operator==(const Rail&) const = default;
};

class Walls {
 public:
  Walls(const Plan& plan, const CornerHeights& heights, Complex& out)
      : plan_(plan), heights_(heights), out_(out) {}

  void add(const PlanEdge& edge) {
    const std::vector<Span> left = spans(edge, edge.left), right = spans(edge, edge.right);
    if (left.empty() && right.empty()) return;
    std::vector<Rail> rails;
    for (const std::vector<Span>* side : {&left, &right})
      for (const Span& span : *side) rails.insert(rails.end(), {span.low, span.high});
    std::sort(rails.begin(), rails.end(), [](const Rail& a, const Rail& b) {
      return std::tuple(a.sum(), a.from) < std::tuple(b.sum(), b.from);
    });
    rails.erase(std::unique(rails.begin(), rails.end()), rails.end());
    bool shared = false;
    for (const Span& a : left)
      for (const Span& b : right) shared = shared || a.layer->building != b.layer->building;
    const Layer *from_left = nullptr, *from_right = nullptr;
    Rail start{};
    for (size_t i = 0; i + 1 < rails.size(); ++i) {
      const Layer* l = occupant(left, rails[i], rails[i + 1]);
      const Layer* r = occupant(right, rails[i], rails[i + 1]);
      const bool goes_on = i > 0 && same(l, from_left) && same(r, from_right);
      if (!goes_on) {
        if (i > 0) emit(edge, from_left, from_right, start, rails[i], shared);
        start = rails[i];
        from_left = l;
        from_right = r;
      }
    }
    if (rails.size() > 1) emit(edge, from_left, from_right, start, rails.back(), shared);
  }

 private:
  struct Span {
    const Layer* layer;
    Rail low, high;
  };

  static bool same(const Layer* a, const Layer* b) {
    return (a ? a->building : no_building) == (b ? b->building : no_building);
  }

  std::vector<Span> spans(const PlanEdge& edge, uint32_t region) const {
    std::vector<Span> result;
    const dvec2 u = plan_.place(edge.from), v = plan_.place(edge.to);
    for (const Layer& layer : plan_.layers[region])
      result.push_back({&layer,
                        {heights_.at(edge.from, layer.bottom.z(u)), heights_.at(edge.to, layer.bottom.z(v))},
                        {heights_.at(edge.from, layer.top.z(u)), heights_.at(edge.to, layer.top.z(v))}});
    return result;
  }

  static const Layer* occupant(const std::vector<Span>& spans, const Rail& low, const Rail& high) {
    const double middle = 0.5 * (low.sum() + high.sum());
    for (const Span& span : spans)
      if (span.low.sum() < middle && middle < span.high.sum()) return span.layer;
    return nullptr;
  }

  void emit(const PlanEdge& edge, const Layer* left, const Layer* right, const Rail& low, const Rail& high,
            bool shared) {
    if (same(left, right)) return;
    // A party wall belongs to the building whose top is higher here, so that this one is closed alone.
    bool owner_left = left != nullptr;
    if (left && right) {
      const dvec2 middle = 0.5 * (plan_.place(edge.from) + plan_.place(edge.to));
      const double l = left->top.z(middle), r = right->top.z(middle);
      owner_left = l != r ? l > r : left->building < right->building;
    }
    const Layer *owner = owner_left ? left : right, *other = owner_left ? right : left;
    WallPiece wall;
    wall.building = owner->building;
    wall.part = owner->part;
    wall.neighbour = other ? other->building : no_building;
    wall.beside_neighbour = shared;
    // The outside is on the right of the way, so the owner is on its left.
    const uint32_t from = owner_left ? edge.from : edge.to, to = owner_left ? edge.to : edge.from;
    wall.from = plan_.triangulation.points()[from];
    wall.to = plan_.triangulation.points()[to];
    wall.from_z = chain(from, owner_left ? low.from : low.to, owner_left ? high.from : high.to);
    wall.to_z = chain(to, owner_left ? low.to : low.from, owner_left ? high.to : high.from);
    if (wall.from_z.size() + wall.to_z.size() < 3) return;
    out_.walls.push_back(std::move(wall));
  }

  std::vector<double> chain(uint32_t corner, double low, double high) const {
    std::vector<double> z{low};
    if (high > low) {
      heights_.between(corner, low, high, z);
      z.push_back(high);
    }
    return z;
  }

  const Plan& plan_;
  const CornerHeights& heights_;
  Complex& out_;
};

class Flats {
 public:
  Flats(const Plan& plan, const CornerHeights& heights, Complex& out)
      : plan_(plan), heights_(heights), out_(out) {}

  void add(uint32_t triangle) {
    const std::vector<Layer>& layers = plan_.layers[plan_.region_of[triangle]];
    for (size_t i = 0; i < layers.size(); ++i) {
      const Layer& layer = layers[i];
      const auto top = corners(triangle, layer.top), bottom = corners(triangle, layer.bottom);
      if (top == bottom) continue;  // it has no height here
      const bool below = i > 0 && corners(triangle, layers[i - 1].top) == bottom;
      const bool above = i + 1 < layers.size() && corners(triangle, layers[i + 1].bottom) == top;
      if (!below) emit(FlatFace::Kind::floor, layer, {bottom[0], bottom[2], bottom[1]});
      if (!above)
        emit(FlatFace::Kind::roof, layer, top);
      else if (layers[i + 1].building != layer.building)
        emit(FlatFace::Kind::slab, layer, top, layers[i + 1].building);
    }
    if (!layers.empty()) {
      const auto& c = plan_.triangulation.triangles()[triangle].corners;
      const auto& points = plan_.triangulation.points();
      out_.built_area_m2[layers.back().building] +=
          0.5 * static_cast<double>(orientation(points[c[0]], points[c[1]], points[c[2]])) /
          (grid_per_m * grid_per_m);
    }
  }

 private:
  std::array<dvec3, 3> corners(uint32_t triangle, const Plane& plane) const {
    std::array<dvec3, 3> result;
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t corner = plan_.triangulation.triangles()[triangle].corners[i];
      const dvec2 p = plan_.place(corner);
      result[i] = dvec3(p, heights_.at(corner, plane.z(p)));
    }
    return result;
  }
  void emit(FlatFace::Kind kind, const Layer& layer, const std::array<dvec3, 3>& corners,
            uint32_t neighbour = no_building) {
    out_.flats.push_back({kind, layer.building, layer.part, neighbour, corners});
  }

  const Plan& plan_;
  const CornerHeights& heights_;
  Complex& out_;
};

void report_overlaps(const std::vector<Building>& buildings, const Plan& plan,
                     std::vector<Finding>& findings) {
  for (const auto& [pair, size] : plan.overlaps)
    if (size > 0.1)
      findings.push_back(
          {Finding::Kind::repaired, "buildings_overlap", label(buildings[pair.first]),
           fmt::format("{:.2f} m^2 of {:.2f} m^2 lie within {}, which is higher and stands there", size,
                       buildings[pair.first].plan_area_m2, label(buildings[pair.second]))});
}

}  // namespace

Complex make_complex(std::vector<Building>& buildings, const ComplexOptions& options,
                     std::vector<Finding>& findings) {
  Complex out;
  out.built_area_m2.assign(buildings.size(), 0.0);
  if (buildings.empty()) return out;
  Edges edges = noded_outlines(buildings, {options.weld_m, options.simplify_m});
  if (edges.empty()) return out;
  std::vector<dvec2> corners;
  for (const Building& building : buildings)
    for (const Polygon& polygon : building.read_outline)
      corners.insert(corners.end(), polygon.outer.begin(), polygon.outer.end());
  out.most_moved_m = largest_distance(corners, edges, 4.0 * (options.weld_m + options.simplify_m) + 0.1);
  Plan plan = divided_plan(edges);
  fill_layers(plan, buildings, options.weld_m);
  lay_foundations(buildings, plan, options.foundation_m);
  level_neighbours(buildings, plan, out.most_welded_m);
  fill_layers(plan, buildings, options.weld_m);  // with the heights that are valid now
  std::vector<PlaneCrossing> crossings = plane_crossings(plan);
  // A corner moves the edge by up to a grid unit, which may bring up another crossing beside it.
  constexpr int most_rounds = 8;
  for (int round = 0; round < most_rounds; ++round) {
    Edges divided = divided_at(crossings, plan, edges);
    if (divided == edges) break;
    edges = std::move(divided);
    plan = divided_plan(edges);
    fill_layers(plan, buildings, options.weld_m);
    crossings = plane_crossings(plan);
  }
  report_overlaps(buildings, plan, findings);
  const CornerHeights heights(plan, crossings, out.most_welded_m);
  Walls walls(plan, heights, out);
  for (const PlanEdge& edge : plan.edges) walls.add(edge);
  Flats flats(plan, heights, out);
  for (uint32_t t = 0; t < plan.triangulation.triangles().size(); ++t) flats.add(t);
  return out;
}

std::vector<std::array<dvec3, 3>> triangles_of(const WallPiece& wall) {
  const dvec2 from = to_metres(wall.from), to = to_metres(wall.to);
  std::vector<std::array<dvec3, 3>> triangles;
  // Climbs both sides. Each step takes the side whose next corner is nearer in height to the corner opposite,
  // so that triangles on narrow walls are no slivers.
  size_t i = 0, j = 0;
  while (i + 1 < wall.from_z.size() || j + 1 < wall.to_z.size()) {
    const dvec3 a(from, wall.from_z[i]), b(to, wall.to_z[j]);
    const bool climb_from =
        j + 1 == wall.to_z.size() || (i + 1 < wall.from_z.size() &&
                                      std::abs(wall.from_z[i + 1] - b.z) <= std::abs(wall.to_z[j + 1] - a.z));
    if (climb_from)
      triangles.push_back({a, b, dvec3(from, wall.from_z[++i])});
    else
      triangles.push_back({a, b, dvec3(to, wall.to_z[++j])});
  }
  return triangles;
}

}  // namespace greatx::scene::place
