// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/crossings.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/rf/crossings_support.h"

namespace greatx::rf {
namespace {

using test::cross;
using test::segment;
using test::TinyScene;
using ::testing::ElementsAre;

/// Returns for each segment 1 if it is visible and 0 if it is blocked. All facets are opaque.
std::vector<uint8_t> visible(const scene::Scene& scene, std::span<const Segment> segments,
                             const std::vector<Pose>& bodies = {Pose{}}) {
  std::vector<uint8_t> answers;
  for (const Crossing& crossing : cross(scene, FacetKinds(scene.facets.size()), segments, bodies)) {
    EXPECT_TRUE(crossing.walls.empty());
    EXPECT_EQ(crossing.foliage_m, 0.0);
    answers.push_back(crossing.blocked ? 0 : 1);
  }
  return answers;
}

/// Returns a scene of two facets. Facet 0 is a wall in the plane x = 0 that faces +x; facet 1 is the ground z
/// = 0.
TinyScene wall_on_ground() {
  TinyScene tiny;
  tiny.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10})
      .quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
  return tiny;
}

TEST(Crossings, WallBlocksAndTheWayAroundItDoesNot) {
  const std::vector<Segment> segments{
      segment({-5, 0, 2}, {5, 0, 2}),    // through the wall
      segment({-5, 0, 12}, {5, 0, 12}),  // above it
      segment({5, 0, 2}, {-5, 0, 2}),    // from the other side
      segment({-5, 25, 2}, {5, 25, 2}),  // beside it
      segment({1, 0, 2}, {5, 0, 2}),     // in front
      segment({5, 0, 2}, {5, 0, -2}),    // through the ground
      segment({2, 3, 4}, {2, 3, 4}),     // a point
  };
  EXPECT_THAT(visible(wall_on_ground().build(), segments), ElementsAre(0, 1, 0, 1, 1, 0, 1));
}

TEST(Crossings, TheFacetsOfTheEndsDoNotBlock) {
  // The reflection point on the wall is rounded to a point behind the wall.
  Segment s = segment({8, 0, 3}, {-3e-4, 1, 2});
  EXPECT_THAT(visible(wall_on_ground().build(), std::vector{s}), ElementsAre(0));
  s.facet_b = 0;
  EXPECT_THAT(visible(wall_on_ground().build(), std::vector{s}), ElementsAre(1));
  // Facets other than the named one still block.
  s = segment({8, 0, 3}, {-4, 0, -1});
  s.facet_b = 1;
  EXPECT_THAT(visible(wall_on_ground().build(), std::vector{s}), ElementsAre(0));
}

TEST(Crossings, TheBodiesOfTheEndsDoNotBlock) {
  TinyScene tiny = wall_on_ground();
  const uint32_t drone = tiny.body("drone"), car = tiny.body("car");
  tiny.object("drone", drone).box({-1, -1, -1}, {1, 1, 1});
  tiny.object("car", car).box({-1, -1, -1}, {1, 1, 1});
  const std::vector<Pose> poses{Pose{}, Pose{{10, 0, 8}, {1, 0, 0, 0}}, Pose{{20, 0, 8}, {1, 0, 0, 0}}};
  Segment plain = segment({10, 0, 8}, {30, 0, 8}), own = plain, both = plain, reversed = plain;
  own.body_a = drone;
  both.body_a = drone;
  both.body_b = car;
  std::swap(reversed.a, reversed.b);
  reversed.body_a = car;
  reversed.body_b = drone;
  Segment moved = segment({10, 0, 12}, {10, 0, 9.5});
  EXPECT_THAT(visible(tiny.build(), std::vector{plain, own, both, reversed, moved}, poses),
              ElementsAre(0, 0, 1, 1, 1));
}

TEST(Crossings, FacetsOfMovingBodiesAreWhereTheBodyIs) {
  TinyScene tiny;
  const uint32_t car = tiny.body("car");
  tiny.object("car", car).quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
  const std::vector<Pose> poses{
      Pose{}, Pose{{100, 50, 3}, orientation_from_yaw_pitch_roll(0.5 * 3.14159265358979, 0, 0)}};
  // Turned by 90 degrees, the plate lies in the plane y = 50.
  const std::vector<Segment> segments{
      segment({100, 45, 3}, {100, 55, 3}), segment({95, 50, 3.5}, {105, 50, 3.5}),
      segment({100, 49.995, 3}, {100, 40, 3}), segment({100, 50.005, 3}, {100, 40, 3}),
      segment({100, 50, 3}, {100, 40, 3})};
  EXPECT_THAT(visible(tiny.build(), segments, poses), ElementsAre(0, 1, 1, 0, 1));
}

TEST(Crossings, EmptyBatchRecordsNothing) {
  gpu::Device& device = test::device();
  const scene::Scene scene = wall_on_ground().build();
  scene::GpuScene gpu_scene(device, scene, {});
  CrossingPass pass(gpu_scene, FacetKinds(scene.facets.size()));
  gpu::TickRing ring(device, 1, 1u << 16, 1u << 16);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, std::vector{Pose{}});
  const uint64_t before = device.counters().dispatches;
  EXPECT_TRUE(pass.collect(pass.record(slot, {}), {}, FacetWorld(scene)).empty());
  EXPECT_EQ(device.counters().dispatches, before);
  ring.submit(slot);
  ring.wait(slot);
}

/// Returns random segments on both sides of the wall.
std::vector<Segment> random_segments(uint32_t walls = 0) {
  RandomStream random(8, 4);
  std::vector<Segment> alone;
  for (int i = 0; i < 600; ++i) {
    const auto point = [&] {
      const double x = random.uniform(-30, 30), y = random.uniform(-30, 30);
      return dvec3(x, y, random.uniform(-1, 15));
    };
    const dvec3 a = point();
    alone.push_back(segment(a, point(), walls));
  }
  return alone;
}

TEST(Crossings, WhatHangsOnABlockedSegmentIsBlockedUnseen) {
  std::vector<Segment> alone = random_segments();
  // Every third segment decides for its two neighbours. Every other one of these segments equals an earlier
  // one.
  for (uint32_t i = 7; i + 1 < alone.size(); i += 6) alone[i] = alone[i - 6 < 7 ? 1 : i - 6];
  std::vector<Segment> batch = alone;
  for (uint32_t i = 1; i + 1 < batch.size(); i += 3) batch[i - 1].only_if = batch[i + 1].only_if = i;
  for (uint32_t i = 7; i + 1 < batch.size(); i += 6) batch[i].same_as = 1;
  const scene::Scene scene = wall_on_ground().build();
  const std::vector<uint8_t> each = visible(scene, alone), answers = visible(scene, batch);
  size_t unseen = 0, seen = 0;
  for (uint32_t i = 0; i < batch.size(); ++i) {
    const uint32_t leader = batch[i].only_if;
    const bool looked_at = leader == shared::rf_none || each[leader] != 0;
    EXPECT_EQ(answers[i], looked_at ? each[i] : 0) << i;
    ++(looked_at ? seen : unseen);
  }
  EXPECT_GT(unseen, 50u);
  EXPECT_GT(seen, 300u);
}

// The batch is split as for a device with little memory: some parts hold leaders, others hold the segments
// that depend on them.
TEST(Crossings, PartsChangeNoAnswer) {
  const scene::Scene scene = wall_on_ground().build();
  for (const uint32_t walls : {0u, 2u}) {
    std::vector<Segment> batch = random_segments(walls);
    for (uint32_t i = 1; i + 1 < batch.size(); i += 3) batch[i - 1].only_if = batch[i + 1].only_if = i;
    for (uint32_t i = 7; i + 1 < batch.size(); i += 6) batch[i] = batch[1], batch[i].same_as = 1;
    const FacetKinds kinds = test::all_of(walls > 0 ? FacetKind::wall : FacetKind::opaque, scene);
    const std::vector<Crossing> whole = cross(scene, kinds, batch);
    for (const uint64_t rows : {1u, 7u, 100u, 250u}) {
      const std::vector<Crossing> parts =
          cross(scene, kinds, batch, {Pose{}}, rows * sizeof(shared::GpuSegment));
      for (size_t i = 0; i < batch.size(); ++i) {
        ASSERT_EQ(parts[i].blocked, whole[i].blocked) << rows << ": " << i;
        if (!whole[i].blocked) {
          ASSERT_EQ(parts[i].walls, whole[i].walls) << rows << ": " << i;
        }
      }
    }
    const auto blocked = std::ranges::count_if(whole, [](const Crossing& c) { return c.blocked; });
    EXPECT_GT(blocked, walls > 0 ? -1 : 100);
    EXPECT_LT(blocked, 500);
  }
}

TEST(Crossings, SegmentsHangOnEarlierAnswersAlone) {
  const scene::Scene scene = wall_on_ground().build();
  std::vector<Segment> chain(3, segment({10, 0, 8}, {30, 0, 8}));
  chain[1].only_if = 0;
  chain[2].only_if = 1;
  EXPECT_THROW(visible(scene, chain), ContractError);
  std::vector<Segment> later(2, segment({10, 0, 8}, {30, 0, 8}));
  later[0].same_as = 1;
  EXPECT_THROW(visible(scene, later), ContractError);
}

TEST(Crossings, EachAnswerDependsOnItsSegmentAlone) {
  RandomStream random(4, 4);
  std::vector<Segment> segments;
  for (int i = 0; i < 500; ++i) {
    const auto point = [&] {
      return dvec3(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-3, 15));
    };
    segments.push_back(segment(point(), point()));
  }
  const scene::Scene scene = wall_on_ground().build();
  const std::vector<uint8_t> together = visible(scene, segments);
  std::vector<Segment> backwards(segments.rbegin(), segments.rend());
  std::vector<uint8_t> again = visible(scene, backwards);
  std::reverse(again.begin(), again.end());
  EXPECT_EQ(together, again);
  EXPECT_EQ(visible(scene, std::span(segments).first(1))[0], together[0]);
}

TEST(HardCase, N06_SegmentInAWallsPlaneIsFiniteAndDefined) {
  // A surface does not block a segment in its plane. The ground below still blocks.
  const std::vector<Segment> segments{segment({0, -30, 2}, {0, 30, 2}), segment({0, -10, 2}, {0, 10, 5}),
                                      segment({0, 0, 2}, {0, 0, -2})};
  EXPECT_THAT(visible(wall_on_ground().build(), segments), ElementsAre(1, 1, 0));
}

TEST(HardCase, N07_VisibilityAtUtmCoordinatesIsTheSame) {
  const dvec3 utm(500000.0, 5411000.0, 35.0);
  TinyScene there;
  there.quad(utm + dvec3(0, -20, 0), utm + dvec3(0, 20, 0), utm + dvec3(0, 20, 10), utm + dvec3(0, -20, 10))
      .quad(utm + dvec3(-50, -50, 0), utm + dvec3(50, -50, 0), utm + dvec3(50, 50, 0),
            utm + dvec3(-50, 50, 0));
  RandomStream random(7, 4);
  std::vector<Segment> segments;
  for (int i = 0; i < 2000; ++i) {
    const auto point = [&] {
      return dvec3(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-3, 15));
    };
    segments.push_back(segment(point(), point()));
  }
  const std::vector<uint8_t> near = visible(wall_on_ground().build(), segments);
  EXPECT_EQ(near, visible(there.build(utm), segments));
  EXPECT_THAT(near, ::testing::Contains(0));
  EXPECT_THAT(near, ::testing::Contains(1));
}

TEST(HardCase, N11_PointExactlyOnASurfaceIsSeenFromBothSides) {
  const std::vector<Segment> segments{
      segment({5, 3, 4}, {0, 1, 2}),    // on the wall, from the front of the wall
      segment({-5, 3, 4}, {0, 1, 2}),   // from the back of the wall
      segment({0, 1, 2}, {5, 3, 4}),    // in the opposite direction
      segment({5, 1, 8}, {9, 4, 0}),    // a receiver on the ground
      segment({5, 1, -8}, {9, 4, 0}),   // from below
      segment({-5, 1, 8}, {9, 4, 0})};  // with the wall in between
  EXPECT_THAT(visible(wall_on_ground().build(), segments), ElementsAre(1, 1, 1, 1, 1, 0));
}

TEST(HardCase, N12_TransmitterFiveMillimetresFromAWallKeepsItsPaths) {
  // A transmitter 5 mm in front of the wall sees only the front, at the local origin and 10 km away from it.
  for (const double shift : {0.0, 300.0, 10000.0}) {
    const dvec3 there(0, shift, 0);
    TinyScene tiny;
    tiny.quad(there + dvec3(shift, -20, 0), there + dvec3(shift, 20, 0), there + dvec3(shift, 20, 10),
              there + dvec3(shift, -20, 10));
    const auto at = [&](double x, double y, double z) { return there + dvec3(shift + x, y, z); };
    const std::vector<Segment> segments{
        segment(at(0.005, 0, 5), at(30, 5, 2)),      // away from the wall
        segment(at(0.005, 0, 5), at(0.005, 15, 5)),  // along it
        segment(at(0.005, 0, 5), at(-30, 5, 2)),     // through it
        segment(at(-0.005, 0, 5), at(30, 5, 2)),     // from 5 mm behind it
        segment(at(-0.005, 0, 5), at(-30, 5, 2)),
    };
    EXPECT_THAT(visible(tiny.build(), segments), ElementsAre(1, 1, 0, 0, 1)) << "at " << shift << " m";
    // The reflection at the same wall.
    Segment down = segment(at(0.005, 0, 5), at(0, 0.001, 5)), up = segment(at(0, 0.001, 5), at(30, 6, 5));
    down.facet_b = 0;
    up.facet_a = 0;
    EXPECT_THAT(visible(tiny.build(), std::vector{down, up}), ElementsAre(1, 1)) << "at " << shift << " m";
  }
}

TEST(HardCase, N23_TwoWallsFourMillimetresApartHideWhatIsBehind) {
  TinyScene tiny;
  tiny.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10})
      .quad({-0.004, -20, 0}, {-0.004, 20, 0}, {-0.004, 20, 10}, {-0.004, -20, 10});
  Segment front = segment({9, 0, 5}, {0, 1, 5}), back = segment({9, 0, 5}, {-0.004, 1, 5}), between = front;
  front.facet_b = 0;
  back.facet_b = 1;
  between.a = {-0.004, 0.5, 5};
  between.facet_a = 1;
  between.facet_b = 0;
  EXPECT_THAT(visible(tiny.build(), std::vector{front, back, between}), ElementsAre(1, 0, 1));
}

TEST(HardCase, N64_EverythingIsVisibleInAnEmptyScene) {
  EXPECT_THAT(visible(TinyScene().build(), std::vector{segment({0, 0, 0}, {1, 2, 3})}), ElementsAre(1));
}

}  // namespace
}  // namespace greatx::rf
