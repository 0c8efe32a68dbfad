// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the shortcuts of the search for echoes: each must give what the long way gives.
#include <set>

#include <gtest/gtest.h>

#include "rf/radar/echoes/ray_hits.h"
#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

/// Returns a grid of 2000 tubes around +x.
RayGrid grid_ahead() {
  EchoOptions options;
  options.field_of_view = {-0.6, 0.6, -0.3, 0.3};
  options.tubes = 2000;
  return RayGrid(options, Pose{});
}

TEST(RadarTubes, NeighboursShareTheirSidesAndCorners) {
  const RayGrid grid = grid_ahead();
  // Neighbour i shares these corners: (own, its). The first four lie across sides, the others across corners.
  static constexpr uint32_t shared[8][2][2] = {{{0, 3}, {1, 2}}, {{1, 0}, {2, 3}}, {{3, 0}, {2, 1}},
                                               {{0, 1}, {3, 2}}, {{0, 2}, {0, 2}}, {{1, 3}, {1, 3}},
                                               {{2, 0}, {2, 0}}, {{3, 1}, {3, 1}}};
  uint32_t compared = 0;
  for (uint32_t tube = 0; tube < grid.size(); ++tube) {
    const std::array<uint32_t, 8> ring = grid.neighbours(tube);
    const std::array<dvec3, 4> own = grid.corners(tube);
    for (uint32_t i = 0; i < 8; ++i) {
      if (ring[i] == RayGrid::outside) continue;
      const std::array<dvec3, 4> its = grid.corners(ring[i]);
      for (const auto& [mine, other] : shared[i])
        ASSERT_LT(glm::distance(own[mine], its[other]), 1e-14) << "tube " << tube << ", neighbour " << i;
      ++compared;
    }
  }
  EXPECT_GT(compared, 7 * grid.size());  // few are at the border
}

/// Adds boards that hide each other in part to a scene, one of them on a body of its own.
TinyScene boards() {
  TinyScene tiny;
  const uint32_t body = tiny.body("turned");
  const auto board = [](TinyScene& to, double x, double y, double half) {
    to.quad({x, y + half, -half}, {x, y - half, -half}, {x, y - half, half}, {x, y + half, half});
  };
  for (int i = 0; i < 12; ++i) board(tiny.object("board"), 10.0 + i, 0.7 * i - 4.0, 0.8);
  board(tiny.object("mover", body), 9.0, 1.0, 0.7);
  return tiny;
}

TEST(RadarTubes, RaysOneAfterTheOtherMeetWhatEachOneMeetsAlone) {
  const scene::Scene scene = boards().build();
  const FacetTrees trees(scene);
  const FacetWorld world(scene);
  const EchoTracer tracer(scene, trees);
  const RayGrid grid = grid_ahead();
  const EchoRays rays{dvec3(0.1, 0.2, 0.3), dvec3(0.1, 0.2, 0.3), 0, 0};
  const auto all = [](uint32_t) { return true; };
  const auto three = [](uint32_t, uint32_t) { return 3u; };
  const EchoTracer::Answer answer = tracer.trace(world, rays, grid, 3, true, all, three, 1);
  const RayHits hits(answer.words, grid.size());
  const EchoTracer::View view = tracer.view(world, 0);
  std::set<uint32_t> met;
  for (uint32_t tube = 0; tube < grid.size(); ++tube) {
    const uint32_t facet = tracer.first(view, rays.source, grid.axis(tube), ~0u).facet;
    ASSERT_EQ(RayHits::facet(hits.word(tube, 0)), facet) << "tube " << tube;
    met.insert(facet);
  }
  EXPECT_GT(met.size(), 8u);
}

TEST(RadarTubes, BallsHoldTheirPieces) {
  const scene::Scene scene = boards().build();
  const FacetTrees trees(scene);
  FacetWorld world(scene);
  Motion motion;
  motion.pose = {{3.0, -1.0, 2.0}, orientation_from_yaw_pitch_roll(0.7, 0.2, -0.4)};
  world.move(1, motion);
  std::array<dvec3, FacetTrees::most_corners> room;
  for (uint32_t facet = 0; facet < world.facet_count(); ++facet)
    for (const uint32_t piece : trees.pieces(facet)) {
      const FacetTrees::Ball ball = trees.ball(world, facet, piece);
      double farthest = 0.0;
      for (const dvec3& corner : trees.corners(world, facet, piece, room))
        farthest = std::max(farthest, glm::distance(corner, ball.center));
      EXPECT_LT(farthest, ball.radius);
      EXPECT_GT(farthest, 0.9 * ball.radius);  // no larger than it has to be
    }
}

}  // namespace
}  // namespace greatx::rf
