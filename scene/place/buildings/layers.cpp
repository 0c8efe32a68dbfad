// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/buildings/layers.h"

#include <algorithm>
#include <cmath>

#include "scene/place/buildings/complex.h"
#include "scene/place/plane/cells.h"

namespace greatx::scene::place {

namespace {

bool holds(const std::vector<Polygon>& area, const dvec2& p) {
  return std::any_of(area.begin(), area.end(), [&](const Polygon& polygon) { return contains(polygon, p); });
}

/// Returns the face of the roof above p: the one that holds p, or the highest one near it, since faces were
/// rounded apart from the outline.
uint32_t roof_face_at(const Part& part, const dvec2& p) {
  uint32_t best = 0;
  double highest = -1e300;
  for (uint32_t i = 0; i < part.roof.size(); ++i) {
    if (!holds(part.roof[i].area, p)) continue;
    if (part.roof[i].plane.z(p) <= highest) continue;
    highest = part.roof[i].plane.z(p);
    best = i;
  }
  if (highest > -1e300) return best;
  double least = 1e300;
  for (uint32_t i = 0; i < part.roof.size(); ++i) {
    const double off = std::abs(part.roof[i].plane.z(p) - part.top_z);
    if (off < least) {
      least = off;
      best = i;
    }
  }
  return best;
}

std::vector<Layer> layers_at(const std::vector<Building>& buildings, const std::vector<uint32_t>& near,
                             const dvec2& p) {
  std::vector<Layer> layers;
  for (const uint32_t i : near)
    for (uint32_t k = 0; k < buildings[i].parts.size(); ++k) {
      const Part& part = buildings[i].parts[k];
      if (part.roof.empty() || !holds(part.area, p)) continue;
      const uint32_t face = roof_face_at(part, p);
      layers.push_back({i, k, {p, part.bottom_z, dvec2(0.0)}, part.roof[face].plane, face});
    }
  return layers;
}

/// Makes the layers of a region disjoint. The layer with the highest top stands whole; what is left of the
/// others below it stands, too. Layers of one building that overlap become one.
std::vector<Layer> without_overlaps(std::vector<Layer> layers, const dvec2& p, double area_m2, Plan& plan) {
  std::stable_sort(layers.begin(), layers.end(),
                   [&](const Layer& a, const Layer& b) { return a.top.z(p) > b.top.z(p); });
  std::vector<Layer> kept;  // from the top down
  for (Layer& layer : layers) {
    if (kept.empty() || layer.top.z(p) <= kept.back().bottom.z(p) + same_height_m) {
      kept.push_back(layer);
      continue;
    }
    Layer& above = kept.back();
    const bool below = layer.bottom.z(p) < above.bottom.z(p) - same_height_m;
    if (above.building == layer.building) {
      if (below) above.bottom = layer.bottom;
      continue;
    }
    plan.overlaps[{layer.building, above.building}] += area_m2;
    if (!below) continue;
    layer.top = above.bottom;
    kept.push_back(layer);
  }
  std::reverse(kept.begin(), kept.end());
  std::erase_if(kept, [&](const Layer& l) { return l.top.z(p) - l.bottom.z(p) < same_height_m; });
  return kept;
}

/// Gives narrow regions the layers of a neighbour (fill_layers).
void close_narrow_regions(Plan& plan, double narrow_m) {
  std::vector<double> perimeter_m(plan.areas_m2.size(), 0.0);
  for (const PlanEdge& edge : plan.edges) {
    if (edge.left == edge.right) continue;
    const double length = glm::distance(plan.place(edge.from), plan.place(edge.to));
    perimeter_m[edge.left] += length;
    perimeter_m[edge.right] += length;
  }
  const auto narrow = [&](uint32_t region) {
    return 2.0 * plan.areas_m2[region] < narrow_m * perimeter_m[region];
  };
  std::map<std::pair<uint32_t, uint32_t>, double> borders;  // (narrow region, its neighbour) -> length
  for (const PlanEdge& edge : plan.edges) {
    if (edge.left == edge.right) continue;
    const double length = glm::distance(plan.place(edge.from), plan.place(edge.to));
    if (narrow(edge.left) && !narrow(edge.right)) borders[{edge.left, edge.right}] += length;
    if (narrow(edge.right) && !narrow(edge.left)) borders[{edge.right, edge.left}] += length;
  }
  std::map<uint32_t, std::pair<double, uint32_t>> longest;
  for (const auto& [pair, length] : borders) {
    auto& best = longest[pair.first];
    if (length > best.first) best = {length, pair.second};
  }
  for (const auto& [region, best] : longest) plan.layers[region] = plan.layers[best.second];
}

}  // namespace

Edges noded_outlines(const std::vector<Building>& buildings, const CleaningOptions& cleaning) {
  std::vector<Segment> segments;
  const auto add_ring = [&](const Ring& ring) {
    for (size_t i = 0; i < ring.size(); ++i)
      if (ring[i] != ring[(i + 1) % ring.size()]) segments.push_back({ring[i], ring[(i + 1) % ring.size()]});
  };
  const auto add = [&](const std::vector<Polygon>& area) {
    for (const Polygon& polygon : area) {
      add_ring(polygon.outer);
      for (const Ring& hole : polygon.holes) add_ring(hole);
    }
  };
  for (const Building& building : buildings)
    for (const Part& part : building.parts) {
      add(part.area);
      if (part.roof.size() > 1)
        for (const RoofFace& face : part.roof) add(face.area);
    }
  return cleaned(node(segments, 1.0 / grid_per_m), cleaning);
}

Plan divided_plan(const Edges& edges) {
  GridPoint low = edges.front()[0], high = low;
  for (const auto& edge : edges)
    for (const GridPoint& p : edge) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    }
  const int64_t margin = to_grid(1.0);
  Plan plan{triangulate_noded({low.x - margin, low.y - margin}, {high.x + margin, high.y + margin}, edges),
            {},
            {},
            {},
            {},
            {},
            {}};
  uint32_t regions = 0;
  plan.region_of = plan.triangulation.regions(&regions);
  plan.areas_m2.assign(regions, 0.0);
  plan.middles.resize(regions);
  const auto& triangles = plan.triangulation.triangles();
  const auto& points = plan.triangulation.points();
  // The middle of a region's largest triangle stands for the region.
  std::vector<int64_t> largest(regions, -1);
  for (uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& c = triangles[t].corners;
    const int64_t twice = orientation(points[c[0]], points[c[1]], points[c[2]]);
    const uint32_t region = plan.region_of[t];
    plan.areas_m2[region] += 0.5 * static_cast<double>(twice) / (grid_per_m * grid_per_m);
    if (twice > largest[region]) {
      largest[region] = twice;
      plan.middles[region] = (plan.place(c[0]) + plan.place(c[1]) + plan.place(c[2])) / 3.0;
    }
    for (uint32_t side = 0; side < 3; ++side) {
      const uint32_t other = triangles[t].across[side];
      if (!triangles[t].fixed[side] || other == Triangulation::none || other < t) continue;
      plan.edges.push_back({c[(side + 1) % 3], c[(side + 2) % 3], region, plan.region_of[other]});
    }
  }
  return plan;
}

void fill_layers(Plan& plan, const std::vector<Building>& buildings, double narrow_m) {
  Cells cells(32.0);
  for (uint32_t i = 0; i < buildings.size(); ++i) {
    Box box;
    for (const Part& part : buildings[i].parts) box.add(box_of(part.area));
    if (!box.empty()) cells.add(box.low, box.high, i);
  }
  plan.overlaps.clear();
  plan.layers.assign(plan.middles.size(), {});
  for (uint32_t region = 0; region < plan.layers.size(); ++region) {
    const dvec2& p = plan.middles[region];
    plan.layers[region] =
        without_overlaps(layers_at(buildings, cells.at(p), p), p, plan.areas_m2[region], plan);
  }
  close_narrow_regions(plan, narrow_m);
}

std::vector<PlaneCrossing> plane_crossings(const Plan& plan) {
  std::vector<PlaneCrossing> crossings;
  for (uint32_t e = 0; e < plan.edges.size(); ++e) {
    const PlanEdge& edge = plan.edges[e];
    std::vector<const Plane*> planes;
    for (const uint32_t region : {edge.left, edge.right})
      for (const Layer& layer : plan.layers[region]) {
        planes.push_back(&layer.bottom);
        planes.push_back(&layer.top);
      }
    const dvec2 u = plan.place(edge.from), v = plan.place(edge.to);
    const double length = glm::distance(u, v);
    for (size_t i = 0; i < planes.size(); ++i)
      for (size_t j = 0; j < i; ++j) {
        const std::array<double, 2> at_u{planes[i]->z(u), planes[j]->z(u)},
            at_v{planes[i]->z(v), planes[j]->z(v)};
        const double du = at_u[0] - at_u[1], dv = at_v[0] - at_v[1];
        // Heights that are this near become one anyway.
        if (std::abs(du) < same_height_m || std::abs(dv) < same_height_m || (du > 0.0) == (dv > 0.0))
          continue;
        PlaneCrossing crossing{e, du / (du - dv), Triangulation::none, 0.0, 0.0};
        const bool near_u = crossing.share * length < same_height_m,
                   near_v = (1.0 - crossing.share) * length < same_height_m;
        if (near_u || near_v) {
          crossing.corner = near_u ? edge.from : edge.to;
          const auto& z = near_u ? at_u : at_v;
          crossing.low = std::min(z[0], z[1]);
          crossing.high = std::max(z[0], z[1]);
        }
        crossings.push_back(crossing);
      }
  }
  return crossings;
}

Edges divided_at(const std::vector<PlaneCrossing>& crossings, const Plan& plan, const Edges& edges) {
  const auto& points = plan.triangulation.points();
  std::map<std::array<GridPoint, 2>, std::vector<double>> cuts;  // shares from the lesser end on
  for (const PlaneCrossing& crossing : crossings) {
    if (crossing.corner != Triangulation::none) continue;
    const GridPoint from = points[plan.edges[crossing.edge].from], to = points[plan.edges[crossing.edge].to];
    cuts[{std::min(from, to), std::max(from, to)}].push_back(from < to ? crossing.share
                                                                       : 1.0 - crossing.share);
  }
  if (cuts.empty()) return edges;
  std::vector<Segment> segments;
  for (const auto& edge : edges) {
    const dvec2 first = to_metres(edge[0]), end = to_metres(edge[1]);
    dvec2 last = first;
    if (const auto found = cuts.find(edge); found != cuts.end()) {
      std::sort(found->second.begin(), found->second.end());
      double before = -1.0;
      for (const double share : found->second) {
        if ((share - before) * glm::distance(first, end) < same_height_m) continue;
        before = share;
        const dvec2 here = to_metres(to_grid(glm::mix(first, end, share)));
        segments.push_back({last, here});
        last = here;
      }
    }
    segments.push_back({last, end});
  }
  return node(segments, 1.0 / grid_per_m);
}

}  // namespace greatx::scene::place
