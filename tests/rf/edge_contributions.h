// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Sums the paths over one and two edges of small scenes, without a search.
#pragma once

#include <stdexcept>
#include <vector>

#include "core/units.h"
#include "rf/edges/corners.h"
#include "rf/edges/two_edges.h"
#include "tests/rf/scenes.h"

namespace greatx::rf::testing {

inline constexpr double frequency_hz = 3.5e9, wavelength = speed_of_light / frequency_hz,
                        wave_number = 2.0 * pi / wavelength;

/// Holds a scene with its facets, surfaces and wedges.
struct Setting {
  explicit Setting(const HandScene& hand, bool free_edges = false)
      : world(hand.scene),
        surfaces(hand.scene, frequency_hz),
        wedges(scene::find_wedges(hand.scene, {.free_edges = free_edges})) {}

  FacetWorld world;
  RadioSurfaces surfaces;
  std::vector<scene::Wedge> wedges;

  /// Tells whether no facet stands between. Points on a facet are on both of its sides.
  bool visible(const dvec3& a, const dvec3& b) const {
    for (uint32_t facet = 0; facet < world.facet_count(); ++facet) {
      const PosedFacet& plane = world.facet(facet);
      const double from = plane.distance(a), to = plane.distance(b);
      if (std::abs(from) < 1e-9 || std::abs(to) < 1e-9 || from * to > 0.0) continue;
      if (world.contains(facet, plane.plane_coordinates(a + from / (from - to) * (b - a)))) return false;
    }
    return true;
  }
};

struct Contribution {
  double length_m = 0.0;
  TwoEdgeMatrix map;
};

/// Appends the path over two edges, if it exists.
inline void add_pair(const Setting& setting, const scene::Wedge& first, const scene::Wedge& second,
                     const dvec3& tx, const dvec3& rx, std::vector<Contribution>& all) {
  const auto points = keller_points(first, second, tx, rx);
  if (!points || !setting.visible(tx, points->first) || !setting.visible(points->first, points->second) ||
      !setting.visible(points->second, rx))
    return;
  TwoEdgeRays rays;
  rays.before_m = glm::distance(tx, points->first);
  rays.between_m = glm::distance(points->first, points->second);
  rays.after_m = glm::distance(points->second, rx);
  rays.in = (points->first - tx) / rays.before_m;
  rays.between = (points->second - points->first) / rays.between_m;
  rays.out = (rx - points->second) / rays.after_m;
  all.push_back({rays.before_m + rays.between_m + rays.after_m,
                 two_edge_matrix(first, second, rays, setting.world, setting.surfaces)});
}

/// Appends the path over one edge, if it exists.
inline void add_single(const Setting& setting, const scene::Wedge& wedge, const dvec3& tx, const dvec3& rx,
                       std::vector<Contribution>& all) {
  const auto point = keller_point(wedge, tx, rx);
  if (!point || !setting.visible(tx, *point) || !setting.visible(*point, rx)) return;
  const double before = glm::distance(tx, *point), after = glm::distance(*point, rx);
  const EdgeDyadic edge = edge_dyadic(wedge, (*point - tx) / before, (rx - *point) / after, before, after,
                                      setting.world, setting.surfaces);
  Contribution one{before + after, {edge.beta_in, edge.phi_in, edge.beta_out, edge.phi_out}};
  std::copy_n(edge.matrix, 4, one.map.matrix);
  all.push_back(one);
}

/// Appends the path over an end of an edge, if it exists.
inline void add_corner(const Setting& setting, const scene::Wedge& wedge, Corner corner, const dvec3& tx,
                       const dvec3& rx, std::vector<Contribution>& all) {
  const dvec3 &at = corner_point(wedge, corner), beside = seen_corner(wedge, corner);
  if (!in_exterior(wedge, tx) || !in_exterior(wedge, rx) || !setting.visible(tx, beside) ||
      !setting.visible(beside, rx))
    return;
  const double before = glm::distance(tx, at), after = glm::distance(at, rx);
  const EdgeDyadic end = corner_dyadic(wedge, corner, (at - tx) / before, (rx - at) / after, before, after,
                                       setting.world, setting.surfaces);
  Contribution one{before + after, {end.beta_in, end.phi_in, end.beta_out, end.phi_out}};
  std::copy_n(end.matrix, 4, one.map.matrix);
  all.push_back(one);
}

inline std::vector<Contribution> contributions(const Setting& setting, const dvec3& tx, const dvec3& rx) {
  std::vector<Contribution> all;
  for (const scene::Wedge& wedge : setting.wedges) add_single(setting, wedge, tx, rx, all);
  for (const scene::Wedge& first : setting.wedges)
    for (const scene::Wedge& second : setting.wedges)
      if (&first != &second) add_pair(setting, first, second, tx, rx, all);
  return all;
}

/// Returns a block 0 <= x <= width, -depth <= y <= 0 in wavelengths, endless along z.
inline HandScene block(double width, double depth, uint32_t (*material)(HandScene&)) {
  HandScene hand;
  const uint32_t of_walls = material(hand);
  const double w = width * wavelength, d = depth * wavelength, z = 500.0;
  hand.quad({0, 0, -z}, {0, 0, z}, {w, 0, z}, {w, 0, -z}, of_walls);
  hand.quad({0, -d, -z}, {w, -d, -z}, {w, -d, z}, {0, -d, z}, of_walls);
  hand.quad({0, -d, -z}, {0, -d, z}, {0, 0, z}, {0, 0, -z}, of_walls);
  hand.quad({w, -d, -z}, {w, 0, -z}, {w, 0, z}, {w, -d, z}, of_walls);
  return hand;
}

}  // namespace greatx::rf::testing
