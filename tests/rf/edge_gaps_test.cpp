// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that no path leaves a closed room through the edges between its walls, where fp32 cannot tell on
// which side of a wall a reflection point lies.
#include "rf/paths/edge_gaps.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "rf/paths/path_solver.h"
#include "tests/rf/exhaustive.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;

constexpr double metal_carrier_hz = 3.5e9;
const dvec3 box_low(-6.0, -4.0, 0.0), box_high(6.0, 4.0, 3.2);

/// A closed box of a metal that lets nothing pass.
scene::Scene metal_box() {
  test::TinyScene tiny;
  scene::Material metal;
  metal.name = "metal";
  metal.radio.emplace().layers.push_back({*scene::itu_medium("metal"), 0.0});
  tiny.object("box", 0, tiny.material_as(metal)).box(box_low, box_high);
  return tiny.build();
}

/// Returns a point of a side of the box at `height_m` from one of its edges, with the axis of the side and
/// that of the wall behind the edge.
struct NearEdge {
  dvec3 point{0.0};
  int side = 0, wall = 0;
};
NearEdge near_edge(RandomStream& random, double height_m) {
  NearEdge at;
  at.side = static_cast<int>(random.below(3));
  at.wall = (at.side + 1 + static_cast<int>(random.below(2))) % 3;
  const int along = 3 - at.side - at.wall;
  const bool side_high = random.below(2) == 1, wall_high = random.below(2) == 1;
  at.point[at.side] = side_high ? box_high[at.side] : box_low[at.side];
  at.point[at.wall] = wall_high ? box_high[at.wall] - height_m : box_low[at.wall] + height_m;
  at.point[along] = random.uniform(box_low[along] + 0.5, box_high[along] - 0.5);
  return at;
}

class BoxLinks {
 public:
  BoxLinks() : scene_(metal_box()), gpu_(test::device(), scene_, {}), model_(scene_, metal_carrier_hz, {}) {}

  /// Returns the numbers of paths with one reflection at most, before and after occlusion.
  std::pair<size_t, size_t> paths(const dvec3& from, const std::vector<dvec3>& targets) {
    CrossingPass pass(gpu_, model_.kinds);
    PathSolver solver(model_, {.max_depth = 1});
    solver.set_candidates(exhaustive_candidates(model_.facets.facet_count(), 1), from, Source::transmitter);
    EndState transmitter;
    transmitter.position = from;
    std::vector<LinkGeometry> links;
    std::vector<Segment> segments;
    std::vector<size_t> first{0};
    for (const dvec3& target : targets) {
      EndState receiver;
      receiver.position = target;
      links.push_back(solver.geometry(receiver));
      solver.add_segments(links.back().paths, transmitter, receiver, segments);
      first.push_back(segments.size());
    }
    gpu::TickRing ring(test::device(), 1, 1u << 22, 1u << 22);
    gpu::TickSlot& slot = ring.begin();
    gpu_.record_update(slot, std::vector<Pose>(scene_.bodies.size()));
    const CrossingPass::Pending pending = pass.record(slot, segments);
    ring.submit(slot);
    ring.wait(slot);
    const std::vector<Crossing> crossings = pass.collect(pending, segments, model_.facets);
    std::pair<size_t, size_t> count;
    for (size_t i = 0; i < targets.size(); ++i) {
      EndState receiver;
      receiver.position = targets[i];
      count.first += links[i].paths.size();
      count.second +=
          solver
              .finish(links[i].paths, std::span(crossings).subspan(first[i], first[i + 1] - first[i]),
                      transmitter, receiver, model_.facets)
              .size();
    }
    return count;
  }

 private:
  scene::Scene scene_;
  scene::GpuScene gpu_;
  RadioModel model_;
};

/// Returns the targets that the ray from `from` reaches beyond its reflection at points near the edges.
std::vector<dvec3> beyond_edges(const dvec3& from, double least_m, double most_m, int count) {
  RandomStream random(11, 5, 0);
  std::vector<dvec3> targets;
  for (int i = 0; i < count; ++i) {
    const NearEdge at = near_edge(random, least_m * std::pow(most_m / least_m, random.uniform()));
    dvec3 direction = glm::normalize(at.point - from);
    direction[at.side] = -direction[at.side];
    targets.push_back(at.point + random.uniform(0.5, 20.0) * direction);
  }
  return targets;
}

bool inside_box(const dvec3& p) {
  return glm::all(glm::greaterThan(p, box_low)) && glm::all(glm::lessThan(p, box_high));
}

TEST(EdgeGaps, HardCaseNothingLeavesAClosedBox) {
  // From inside, a ray that is reflected next to an edge meets the wall behind the edge within 0.1 mm. The
  // target beyond that wall must stay dark, at every distance from the edge down to what belongs to both
  // walls.
  const dvec3 from(-4.7, 2.9, 2.8);
  std::vector<dvec3> outside;
  for (const dvec3& target : beyond_edges(from, 3e-7, 1e-2, 4000))
    if (!inside_box(target)) outside.push_back(target);
  ASSERT_GT(outside.size(), 1000u);
  const auto [geometric, lit] = BoxLinks().paths(from, outside);
  EXPECT_GT(geometric, outside.size()) << "they exist without the walls";
  EXPECT_EQ(lit, 0u);
}

TEST(EdgeGaps, OuterEdgesReflectUpToTheirEnds) {
  // From outside, the same edges are corners of a house: the wall behind is not in the way.
  const dvec3 from(-14.0, 11.0, 9.0);
  RandomStream random(12, 5, 0);
  std::vector<dvec3> targets;
  size_t seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const NearEdge at = near_edge(random, 3e-7 * std::pow(1e4, random.uniform()));
    const double outwards = at.point[at.side] == box_high[at.side] ? 1.0 : -1.0;
    if ((from[at.side] - at.point[at.side]) * outwards <= 0.0) continue;
    dvec3 direction = glm::normalize(at.point - from);
    direction[at.side] = -direction[at.side];
    targets.push_back(at.point + random.uniform(5.0, 20.0) * direction);
    ++seen;
  }
  ASSERT_GT(seen, 500u);
  // Line of sight and the reflection: the box is convex, so that both are free or the reflection alone is.
  const auto [geometric, lit] = BoxLinks().paths(from, targets);
  EXPECT_GE(lit, seen);
  EXPECT_GE(geometric, lit);
}

}  // namespace
}  // namespace greatx::rf
