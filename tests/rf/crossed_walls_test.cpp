// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "rf/paths/exact_crossings.h"
#include "tests/rf/crossings_support.h"

namespace greatx::rf {
namespace {

using test::all_of;
using test::cross;
using test::segment;
using test::TinyScene;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr uint32_t blocked = ~0u;

/// Returns the walls that each segment passes, or {blocked} for a blocked segment.
std::vector<std::vector<uint32_t>> passed(const scene::Scene& scene, const FacetKinds& kinds,
                                          std::span<const Segment> segments,
                                          const std::vector<Pose>& bodies = {Pose{}}) {
  std::vector<std::vector<uint32_t>> lists;
  for (const Crossing& crossing : cross(scene, kinds, segments, bodies)) {
    EXPECT_EQ(crossing.foliage_m, 0.0);
    lists.push_back(crossing.blocked ? std::vector{blocked} : crossing.walls);
  }
  return lists;
}

std::vector<std::vector<uint32_t>> passed(const TinyScene& tiny, std::span<const Segment> segments) {
  const scene::Scene scene = tiny.build();
  return passed(scene, all_of(FacetKind::wall, scene), segments);
}

/// Adds a wall in the plane x = `at`, 40 m wide and 10 m high.
TinyScene& wall_at(TinyScene& tiny, double at) {
  return tiny.quad({at, -20, 0}, {at, 20, 0}, {at, 20, 10}, {at, -20, 10});
}

TEST(CrossedWalls, AClosedBoxIsTwoWallsAndFromInsideOne) {
  TinyScene tiny;
  tiny.box({-4, -3, 0}, {4, 3, 5});  // facets 4: x = -4, 5: x = 4, 2: y = -3, 1: z = 5
  const std::vector<Segment> segments{
      segment({-9, 0.3, 2.2}, {9, 0.7, 2.9}, 2), segment({9, 0.7, 2.9}, {-9, 0.3, 2.2}, 2),
      segment({1, 0.3, 2.2}, {9, 0.7, 2.9}, 2),  segment({1, 0.3, 2.2}, {1.5, -7, 2}, 2),
      segment({1, 0.3, 2.2}, {-3, 1, 1}, 2),     segment({-9, 0.2, 2.2}, {-1, 0.3, 6}, 2)};
  EXPECT_THAT(passed(tiny, segments), ElementsAre(ElementsAre(4, 5), ElementsAre(4, 5), ElementsAre(5),
                                                  ElementsAre(2), IsEmpty(), ElementsAre(1, 4)));
}

TEST(CrossedWalls, MoreWallsThanAllowedBlock) {
  TinyScene tiny;
  for (int i = 0; i < 9; ++i) wall_at(tiny, i);
  std::vector<Segment> segments;
  for (uint32_t walls = 0; walls <= shared::crossings_max; ++walls)
    segments.push_back(segment({-3, 1, 4}, {2.5, 3, 5}, walls));
  segments.push_back(segment({-3, 1, 4}, {7.5, 3, 5}, 8));
  segments.push_back(segment({-3, 1, 4}, {8.5, 3, 5}, 8));
  const auto three = ElementsAre(0, 1, 2);
  const auto none = ElementsAre(blocked);
  EXPECT_THAT(passed(tiny, segments), ElementsAre(none, none, none, three, three, three, three, three, three,
                                                  ElementsAre(0, 1, 2, 3, 4, 5, 6, 7), none));
  EXPECT_THROW(passed(tiny, std::vector{segment({-3, 1, 4}, {3, 1, 4}, 9)}), ContractError);
}

TEST(CrossedWalls, SomethingOpaqueBlocksBeforeBetweenAndBehind) {
  TinyScene tiny;
  for (int i = 0; i < 3; ++i) wall_at(tiny, i);
  const scene::Scene scene = tiny.build();
  for (size_t opaque = 0; opaque < 3; ++opaque) {
    FacetKinds kinds = all_of(FacetKind::wall, scene);
    kinds[opaque] = FacetKind::opaque;
    EXPECT_THAT(passed(scene, kinds, std::vector{segment({-1, 1, 4}, {3, 3, 5}, 8)}),
                ElementsAre(ElementsAre(blocked)));
  }
  EXPECT_THAT(passed(scene, {FacetKind::wall, FacetKind::opaque, FacetKind::wall},
                     std::vector{segment({-1, 1, 4}, {0.5, 3, 5}, 8)}),
              ElementsAre(ElementsAre(0)));
}

TEST(CrossedWalls, OnTheDiagonalOfAWallItIsPassedOnce) {
  TinyScene tiny;
  wall_at(tiny, 0);  // split from (-20, 0) to (20, 10)
  RandomStream random(18, 1);
  std::vector<Segment> segments;
  for (int i = 0; i < 500; ++i) {
    const double s = random.uniform(0.01, 0.99);
    const dvec3 on(0, -20 + 40 * s, 10 * s);
    const dvec3 way(random.uniform(0.2, 5), random.uniform(-9, 9), random.uniform(-9, 9));
    segments.push_back(segment(on - way, on + way, 8));
    // A segment that also lies in a plane through the diagonal.
    segments.push_back(segment(on - dvec3(3, 0.4, 0.1), on + dvec3(3, 0.4, 0.1), 8));
  }
  for (const auto& walls : passed(tiny, segments)) EXPECT_THAT(walls, ElementsAre(0));
}

TEST(CrossedWalls, TheSeamOfTwoWallsIsOneWall) {
  // Two walls are neighbours in one plane. A segment through their common edge passes only one of them.
  TinyScene tiny;
  tiny.quad({0, -20, 0}, {0, 1, 0}, {0, 1, 10}, {0, -20, 10})
      .quad({0, 1, 0}, {0, 20, 0}, {0, 20, 10}, {0, 1, 10});
  std::vector<Segment> segments;
  RandomStream random(18, 2);
  for (int i = 0; i < 300; ++i) {
    const dvec3 on(0, 1, random.uniform(0.5, 9.5));
    const dvec3 way(random.uniform(0.05, 5), random.uniform(-9, 9), random.uniform(-9, 9));
    segments.push_back(segment(on - way, on + way, 8));
  }
  for (const auto& walls : passed(tiny, segments)) {
    ASSERT_EQ(walls.size(), 1u);
    EXPECT_LE(walls[0], 1u);
  }
  // At the edge of a house, a segment enters through one wall and leaves through another one.
  TinyScene house;
  house.box({0, 0, 0}, {4, 4, 4});
  EXPECT_THAT(
      passed(house, std::vector{segment({-1, -1, 1}, {2, 2, 1.5}, 8), segment({-1, -1, 1}, {5, 5, 2}, 8)}),
      ElementsAre(::testing::SizeIs(1), ::testing::SizeIs(2)));
}

TEST(CrossedWalls, AWallThatIsThereTwiceIsOneAndTwoMillimetresApartAreTwo) {
  TinyScene tiny;
  wall_at(wall_at(wall_at(tiny, 0), 0), 0.002);
  RandomStream random(19, 1);
  std::vector<Segment> segments;
  for (int i = 0; i < 200; ++i)
    segments.push_back(segment({random.uniform(-9, -1), random.uniform(-9, 9), random.uniform(0.5, 9.5)},
                               {random.uniform(1, 9), random.uniform(-9, 9), random.uniform(0.5, 9.5)}, 8));
  for (const auto& walls : passed(tiny, segments)) EXPECT_THAT(walls, ElementsAre(0, 2));
}

TEST(CrossedWalls, GrazingSegmentsPassWhatTheyCrossAndNothingThatTheyLieIn) {
  TinyScene tiny;
  wall_at(tiny, 0);
  const std::vector<Segment> segments{
      segment({0, -15, 2}, {0, 15, 3}, 1),            // in the plane of the wall
      segment({0.001, -15, 2}, {0.001, 15, 3}, 1),    // 1 mm beside the wall
      segment({0.001, -15, 2}, {-0.001, 15, 3}, 1),   // through the wall at 0.004 degrees
      segment({0.001, -15, 2}, {-0.00005, 15, 3}, 1)  // ends on the wall to the precision of fp32
  };
  EXPECT_THAT(passed(tiny, segments), ElementsAre(IsEmpty(), IsEmpty(), ElementsAre(0), IsEmpty()));
}

TEST(CrossedWalls, WhatAnEndBelongsToOrLiesOnIsNotPassed) {
  TinyScene tiny;
  wall_at(wall_at(wall_at(tiny, 0), 3), 6);
  Segment from_first = segment({1e-5, 0, 5}, {9, 1, 5}, 8);
  Segment wedge = segment({-0.2, 0, 5}, {9, 1, 5}, 8), other_end = wedge;
  wedge.facet_a = 0;
  wedge.other_a = 2;
  other_end.facet_b = 1;
  other_end.other_b = 0;
  EXPECT_THAT(passed(tiny, std::vector{from_first, wedge, other_end, segment({0, 1, 5}, {6, 2, 5}, 8)}),
              ElementsAre(ElementsAre(1, 2), ElementsAre(1), ElementsAre(2), ElementsAre(1)));
}

TEST(CrossedWalls, WallsOfMovingBodiesAreWhereTheBodyIs) {
  TinyScene tiny;
  wall_at(tiny, 0);
  const uint32_t car = tiny.body("car");
  tiny.object("car", car).box({-2, -1, -1}, {2, 1, 1});  // facets 1 to 6; 5 and 6: x = -2 and 2
  const scene::Scene scene = tiny.build();
  const FacetKinds kinds = all_of(FacetKind::wall, scene);
  Segment plain = segment({-9, 5.1, 3.3}, {30, 5.2, 3.4}, 8), own = plain;
  own.body_b = car;
  const std::vector<Segment> segments{plain, own};
  const auto turned = orientation_from_yaw_pitch_roll(0.5 * 3.14159265358979, 0, 0);
  EXPECT_THAT(passed(scene, kinds, segments, {Pose{}, Pose{{10, 5, 3}, {1, 0, 0, 0}}}),
              ElementsAre(ElementsAre(0, 5, 6), ElementsAre(0)));
  EXPECT_THAT(passed(scene, kinds, segments, {Pose{}, Pose{{10, 5, 3}, turned}}),
              ElementsAre(ElementsAre(0, 3, 4), ElementsAre(0)));
  EXPECT_THAT(passed(scene, kinds, segments, {Pose{}, Pose{{10, 25, 3}, turned}}),
              ElementsAre(ElementsAre(0), ElementsAre(0)));
}

/// Holds the intersection of a segment with a parallelogram, in fp64.
struct Meeting {
  bool unclear = false;  ///< so close to an outline or an end that the result in fp32 is uncertain
  bool met = false;
};
Meeting meet(const scene::Scene& scene, const scene::Facet& facet, const Segment& s, double margin) {
  const scene::FacetTriangle& first = scene.facet_triangles[facet.first_triangle];
  const scene::FacetTriangle& second = scene.facet_triangles[facet.first_triangle + 1];
  const dvec3 corner = first.corners[0], u = first.corners[1] - corner, v = second.corners[2] - corner;
  const double from = glm::dot(facet.normal, s.a) - facet.offset,
               to = glm::dot(facet.normal, s.b) - facet.offset;
  Meeting meeting;
  if (std::min(std::abs(from), std::abs(to)) < margin) meeting.unclear = true;
  if ((from > 0) == (to > 0)) return meeting;
  const dvec3 at = s.a + from / (from - to) * (s.b - s.a) - corner;
  const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), det = uu * vv - uv * uv;
  const double x = (glm::dot(at, u) * vv - glm::dot(at, v) * uv) / det;
  const double y = (glm::dot(at, v) * uu - glm::dot(at, u) * uv) / det;
  const double inside = std::min({x, y, 1 - x, 1 - y});
  meeting.met = inside > 0;
  meeting.unclear |= std::abs(inside) < margin;
  return meeting;
}

/// Compares parallelograms in all directions, a third of them opaque, with an independent intersection in
/// fp64. `shift` is the distance from the local origin.
void check_against_reference(double shift) {
  RandomStream random(5, 77);
  const auto vector = [&](double size) {
    return dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  const dvec3 there(shift, -0.7 * shift, 0.01 * shift);
  TinyScene tiny;
  FacetKinds kinds;
  for (int i = 0; i < 40; ++i) {
    const dvec3 corner = there + vector(20), u = vector(12), v = vector(12);
    tiny.quad(corner, corner + u, corner + u + v, corner + v);
    kinds.push_back(i % 3 == 0 ? FacetKind::opaque : FacetKind::wall);
  }
  const scene::Scene scene = tiny.build();
  std::vector<Segment> segments;
  for (uint32_t i = 0; i < 3000; ++i)
    segments.push_back(segment(there + vector(25), there + vector(25), 1 + i % 4));
  const auto found = passed(scene, kinds, segments);
  size_t compared = 0, free = 0, walls = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    std::vector<uint32_t> expected;
    bool unclear = false, stopped = false;
    for (uint32_t f = 0; f < scene.facets.size(); ++f) {
      const Meeting meeting = meet(scene, scene.facets[f], segments[i], 2e-3 + 1e-6 * shift);
      unclear |= meeting.unclear;
      if (!meeting.met) continue;
      expected.push_back(f);
      stopped |= kinds[f] == FacetKind::opaque;
    }
    if (unclear) continue;
    if (stopped || expected.size() > segments[i].walls) expected = {blocked};
    EXPECT_EQ(found[i], expected) << i;
    ++compared;
    free += expected != std::vector{blocked};
    walls += expected != std::vector{blocked} && !expected.empty();
  }
  EXPECT_GT(compared, 2000u);
  EXPECT_GT(free, 400u);
  EXPECT_GT(walls, 100u);
}
TEST(CrossedWalls, AgreeWithFp64OnRandomParallelograms) { check_against_reference(0.0); }
TEST(CrossedWalls, AgreeWithFp64TenKilometresFromTheOrigin) { check_against_reference(10000.0); }

/// Party walls of real maps: nearly in one plane, at offsets and angles where roundings decide whether they
/// are one wall or two. Every tracer then leaves them to the host, so that the lists are those of the exact
/// rule.
TEST(CrossedWalls, WallsAsNearAsRoundingsCountAsTheExactRuleSays) {
  RandomStream random(21, 0x70617274u);
  size_t merged = 0, apart = 0;
  for (int street = 0; street < 60; ++street) {
    TinyScene tiny;
    const dvec3 middle(random.uniform(-600, 600), random.uniform(-600, 600), 0.0);
    for (int wall = 0; wall < 2; ++wall) {
      const double turn = (street % 2 == 0 ? 1e-5 : 2e-3) * random.uniform(-1, 1);
      const double at = random.uniform(-4e-4, 4e-4);
      const dvec3 along(std::sin(turn), std::cos(turn), 0.0), from = middle + dvec3(at, 0, 0);
      const dvec3 up(0, 0, random.uniform(9, 11));
      const dvec3 a = from - random.uniform(15, 25) * along, b = from + random.uniform(15, 25) * along;
      tiny.quad(a, b, b + up, a + up);
    }
    const scene::Scene scene = tiny.build();
    const FacetKinds kinds = all_of(FacetKind::wall, scene);
    const FacetWorld world(scene);
    const ExactCrossings exact(scene, kinds);
    std::vector<Segment> segments;
    for (int i = 0; i < 80; ++i) {
      const dvec3 point = middle + dvec3(0, random.uniform(-0.4, 0.4), random.uniform(1, 8));
      const dvec3 way(random.uniform(2, 300), random.uniform(-300, 300), random.uniform(-0.5, 0.5));
      segments.push_back(segment(point - 0.3 * way, point + 0.7 * way, 1 + random.below(2)));
    }
    const std::vector<Crossing> found = cross(scene, kinds, segments);
    for (size_t i = 0; i < segments.size(); ++i) {
      Crossing expected;
      exact.settle(world, segments[i], expected);
      ASSERT_EQ(found[i].blocked, expected.blocked) << street << ' ' << i;
      if (expected.blocked) continue;
      ASSERT_EQ(found[i].walls, expected.walls) << street << ' ' << i;
      merged += expected.walls.size() == 1;
      apart += expected.walls.size() == 2;
    }
  }
  EXPECT_GT(merged, 300u);
  EXPECT_GT(apart, 300u);
}

TEST(CrossedWalls, PlanesReadByAddressGiveTheSameAnswers) {
  TinyScene tiny;
  for (int i = 0; i < 5; ++i) wall_at(tiny, 2.0 * i);
  const scene::Scene scene = tiny.build();
  const FacetKinds kinds = all_of(FacetKind::wall, scene);
  RandomStream random(3, 0x61646472u);
  std::vector<Segment> segments;
  for (int i = 0; i < 300; ++i)
    segments.push_back(segment({random.uniform(-2, 11), random.uniform(-9, 9), 2.0},
                               {random.uniform(-2, 11), random.uniform(-9, 9), 7.0}, random.below(5)));
  const auto bound = cross(scene, kinds, segments),
             far = cross(scene, kinds, segments, {Pose{}}, uint64_t{128} << 20, 64);
  size_t walls = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(bound[i].blocked, far[i].blocked) << i;
    EXPECT_EQ(bound[i].walls, far[i].walls) << i;
    walls += far[i].walls.size();
  }
  EXPECT_GT(walls, 100u);
}

}  // namespace
}  // namespace greatx::rf
