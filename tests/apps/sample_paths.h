// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths made by hand in a scene of a wall, a roof and a tree.
#pragma once

#include "core/units.h"
#include "draw/paths/facts.h"
#include "tests/support/tiny_scene.h"

namespace greatx::apps {

/// Holds a scene of three facets and one wedge between facets 0 and 1, `origin` away from the world's origin:
/// - facet 0: the wall y = 10 (object "house", material "glass"),
/// - facet 1: the roof z = 20 (object "roof", material "tile"),
/// - facet 2: a tree (object "tree", material "leaves").
struct SampleScene {
  explicit SampleScene(const dvec3& origin = dvec3(0.0)) {
    test::TinyScene tiny;
    const uint32_t glass = tiny.material("glass", 0.1f), tile = tiny.material("tile", 0.2f),
                   leaves = tiny.material("leaves", 0.3f);
    const dvec3 o = origin;
    tiny.object("house", 0, glass)
        .quad(o + dvec3(-50, 10, 0), o + dvec3(50, 10, 0), o + dvec3(50, 10, 20), o + dvec3(-50, 10, 20));
    tiny.object("roof", 0, tile)
        .quad(o + dvec3(-50, 10, 20), o + dvec3(50, 10, 20), o + dvec3(50, 30, 20), o + dvec3(-50, 30, 20));
    tiny.object("tree", 0, leaves).triangle(o + dvec3(0, -5, 0), o + dvec3(1, -5, 0), o + dvec3(0, -5, 3));
    scene = tiny.build(origin);
    scene::Wedge wedge;
    wedge.facet_0 = 0;
    wedge.facet_n = 1;
    wedges.push_back(wedge);
  }
  PathScene view() const { return {&scene, wedges, 3.5e9}; }

  scene::Scene scene;
  std::vector<scene::Wedge> wedges;
};

/// Returns a path through `vertices` (local) with the transfer matrix gain * diag(1, -1) / length.
inline rf::Path path_through(const std::vector<dvec3>& vertices, std::vector<rf::Interaction> interactions,
                             double gain = 1.0) {
  rf::Path path;
  path.vertices = vertices;
  path.interactions = std::move(interactions);
  for (size_t i = 0; i + 1 < vertices.size(); ++i)
    path.length_m += glm::distance(vertices[i], vertices[i + 1]);
  path.delay_s = path.length_m / speed_of_light;
  path.departure = glm::normalize(vertices[1] - vertices[0]);
  path.arrival = glm::normalize(vertices[vertices.size() - 2] - vertices.back());
  path.transfer[0] = gain / path.length_m;
  path.transfer[3] = -gain / path.length_m;
  return path;
}

/// Returns a link from (0, 0, 2) to (40, 0, 2) with two paths: the line of sight, and a reflection at the
/// wall whose gain is 10 dB lower.
inline PathLink sample_link(const dvec3& origin = dvec3(0.0)) {
  const dvec3 a(0, 0, 2), b(40, 0, 2);
  PathLink link;
  link.name = "uav/antenna";
  link.transmitter_m = a + origin;
  link.receiver_m = b + origin;
  link.distance_m = 40.0;
  link.paths.push_back(path_through({a, b}, {}));
  link.paths.push_back(
      path_through({a, {20, 10, 2}, b}, {{rf::InteractionType::reflection, 0, 0}}, std::sqrt(0.1)));
  return link;
}

}  // namespace greatx::apps
