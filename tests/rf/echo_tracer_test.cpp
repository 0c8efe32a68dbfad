// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/echo_tracer.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;

/// The bodies of one owner share a ball that rays and cones are tested against first. Tracers of one body
/// each have no such ball around several of them.
TEST(EchoTracer, BodiesOfOneOwnerAreMetAsEachAlone) {
  TinyScene tiny;
  std::vector<uint32_t> bodies{0};
  for (const char* name : {"walker", "left", "right", "cart", "wheel", "stone"})
    bodies.push_back(tiny.body(name));
  for (const uint32_t body : bodies) {
    tiny.object("thing", body);
    for (int k = 0; k < 3; ++k) {
      const dvec3 at(0.3 * k, 0.2 * body, -0.1 * k);
      tiny.quad(at, at + dvec3(0.5, 0, 0.1), at + dvec3(0.5, 0.4, 0.6), at + dvec3(0, 0.4, 0.5));
    }
  }
  scene::Scene scene = tiny.build();
  for (const auto& [part, carrier] : {std::pair{2u, 1u}, {3u, 1u}, {5u, 4u}})
    scene.bodies[bodies[part]].joint = scene::Joint{bodies[carrier]};
  RandomStream random(7, 0);
  const auto anywhere = [&](double reach) {
    return reach * (2.0 * dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0);
  };
  FacetWorld world(scene);
  for (const uint32_t body : bodies) {
    if (body == 0) continue;
    Motion motion;
    const double half = 0.3 * body;
    motion.pose = {anywhere(6.0), {std::cos(half), 0.0, 0.0, std::sin(half)}};
    world.move(body, motion);
  }
  const FacetTrees trees(scene);
  const EchoTracer together(scene, trees);
  std::vector<EchoTracer> alone;
  for (const uint32_t body : bodies)
    alone.emplace_back(scene, trees, [&](uint32_t facet) { return scene.facets[facet].body == body; });
  const EchoTracer::View view = together.view(world, 0);
  int met = 0;
  size_t gathered = 0;
  for (int ray = 0; ray < 4000; ++ray) {
    const dvec3 from = anywhere(8.0), to = ray % 2 == 0 ? anywhere(2.0) : anywhere(8.0);
    const dvec3 direction = glm::normalize(to - from);
    EchoTracer::Met nearest;
    std::vector<FacetPiece> all, pieces;
    const EchoTracer::Cone cone{from, direction, 0.0, ray % 3 == 0 ? 5.0 : 1e30, 0.01 * (ray % 20)};
    for (const EchoTracer& tracer : alone) {
      const EchoTracer::View own = tracer.view(world, 0);
      const EchoTracer::Met one = tracer.first(own, from, direction, ~0u);
      if (one.facet != ~0u && one.distance < nearest.distance) nearest = one;
      pieces.clear();
      tracer.gather(own, cone, pieces);
      all.insert(all.end(), pieces.begin(), pieces.end());
    }
    std::sort(all.begin(), all.end());
    const EchoTracer::Met found = together.first(view, from, direction, ~0u);
    ASSERT_EQ(found.facet, nearest.facet) << "ray " << ray;
    ASSERT_EQ(found.distance, nearest.distance) << "ray " << ray;
    pieces.clear();
    together.gather(view, cone, pieces);
    ASSERT_EQ(pieces, all) << "cone " << ray;
    met += found.facet != ~0u ? 1 : 0;
    gathered += pieces.size();
  }
  EXPECT_GT(met, 100);
  EXPECT_GT(gathered, 1000u);
}

}  // namespace
}  // namespace greatx::rf
