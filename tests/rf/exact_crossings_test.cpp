// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks segments that pass edges within the roundings of fp32. Whether they are blocked has to follow from
// the geometry in fp64, to the last micrometre, for paths of any list.
#include <cmath>

#include <gtest/gtest.h>

#include "core/units.h"
#include "rf/edges/diffraction.h"
#include "rf/geometry/geometry.h"
#include "rf/paths/radio_model.h"
#include "rf/reference/occluders.h"
#include "scene/description/wedges.h"
#include "tests/rf/crossings_support.h"
#include "tests/rf/random_scene.h"

namespace greatx::rf {
namespace {

using test::all_of;
using test::cross;
using test::segment;
using test::TinyScene;

/// A wall stands 300 m from the origin, where fp32 resolves 0.03 mm. Its free edge is at x = edge. Rays pass
/// the edge at distances down to a third of a micrometre.
TEST(ExactCrossings, ASegmentPassesAnEdgeOnTheSideOnWhichItIs) {
  const double edge = 300.125;
  TinyScene tiny;
  tiny.quad({edge, 200.0, -50.0}, {edge + 40.0, 200.0, -50.0}, {edge + 40.0, 200.0, 60.0},
            {edge, 200.0, 60.0});
  const scene::Scene scene = tiny.build();
  RandomStream random(3, 1);
  std::vector<Segment> segments;
  std::vector<bool> expected;
  for (int i = 0; i < 20'000; ++i) {
    // The facet is closed within 1.2e-7 m (PosedFacet::tolerance_m).
    const double beside = (i % 2 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-6.5, -3.3));
    const dvec3 at(edge + beside, 200.0, random.uniform(-49.0, 59.0));
    const dvec3 along(random.uniform(-40.0, 40.0), random.uniform(20.0, 90.0), random.uniform(-30.0, 30.0));
    segments.push_back(segment(at - along, at + random.uniform(0.2, 1.0) * along));
    expected.push_back(beside >= 0.0);
  }
  const std::vector<Crossing> found = cross(scene, all_of(FacetKind::opaque, scene), segments);
  size_t wrong = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    EXPECT_FALSE(found[i].undecided);
    wrong += found[i].blocked != expected[i];
  }
  EXPECT_EQ(wrong, 0u);
}

/// The line of sight ends where UTD's shadow begins, so that the total field neither doubles nor vanishes.
TEST(ExactCrossings, TheShadowBeginsWhereDiffractionSaysSo) {
  TinyScene tiny;
  tiny.quad({-250.0, 0.0, 0.0}, {-250.0, 0.0, 12.0}, {-290.0, 0.0, 12.0}, {-290.0, 0.0, 0.0});
  const scene::Scene scene = tiny.build();
  scene::WedgeOptions options;
  options.free_edges = true;
  const std::vector<scene::Wedge> wedges = scene::find_wedges(scene, options);
  const FacetWorld world(scene);
  const dvec3 transmitter(-270.0, -35.5, 9.25);
  RandomStream random(4, 1);
  std::vector<Segment> segments;
  std::vector<bool> shadowed;
  const auto top = std::find_if(wedges.begin(), wedges.end(),
                                [](const scene::Wedge& w) { return w.a.z == 12.0 && w.b.z == 12.0; });
  ASSERT_NE(top, wedges.end());
  for (int i = 0; i < 20'000; ++i) {
    const double beside = (i % 2 ? 1.0 : -1.0) * std::pow(10.0, random.uniform(-6.5, -3.7));
    const dvec3 over(random.uniform(-289.0, -251.0), 0.0, 12.0 + beside);
    const dvec3 receiver = over + random.uniform(0.3, 2.0) * (over - transmitter);
    segments.push_back(segment(transmitter, receiver));
    shadowed.push_back(in_shadow(posed(*top, world), transmitter, receiver));
  }
  const std::vector<Crossing> found = cross(scene, all_of(FacetKind::opaque, scene), segments);
  size_t differ = 0, dark = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    differ += found[i].blocked != shadowed[i];
    dark += found[i].blocked;
  }
  EXPECT_EQ(differ, 0u);
  EXPECT_GT(dark, 9'000u);
  EXPECT_LT(dark, 11'000u);
}

/// A path that meets the inside of a lid 0.04 mm from its edge passes through the front below the edge. No
/// list may contain it.
TEST(ExactCrossings, TheFarSideOfAnEdgeIsDarkForEveryList) {
  TinyScene tiny;
  tiny.box({-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = tiny.build();
  const FacetWorld world(scene);
  constexpr uint32_t top = 1;
  for (const double behind : {1e-6, 4e-5, 1e-4, 1e-3}) {
    const dvec3 at(-1.0 + behind, 0.25, 1.0);
    Segment there = segment(at - dvec3(3.0, 0.0, 3.0), at), back = segment(at, at + dvec3(0.5, 0.0, -0.5));
    there.facet_b = back.facet_a = top;
    const std::vector<Crossing> found =
        cross(scene, all_of(FacetKind::opaque, scene), std::vector{there, back});
    EXPECT_TRUE(found[0].blocked) << behind;
    EXPECT_FALSE(found[1].blocked) << behind;
    // From above, nothing is behind anything.
    Segment above = segment(at + dvec3(-2.0, 0.0, 2.0), at);
    above.facet_b = top;
    EXPECT_FALSE(cross(scene, all_of(FacetKind::opaque, scene), std::vector{above})[0].blocked) << behind;
  }
}

/// Segments graze edges of random scenes within 0.1 mm. The reference decides every triangle in fp64.
TEST(ExactCrossings, GrazingSegmentsOfRandomScenesAreThoseOfTheReference) {
  size_t all = 0, blocked = 0, walls = 0;
  for (uint64_t seed = 300; seed < 306; ++seed)
    for (const uint32_t kind : {0u, 1u, 2u}) {
      const scene::Scene scene = testing::build(testing::random_scene(seed, kind, 0));
      RadioEffects effects;
      effects.transmission = true;
      const FacetKinds kinds = facet_kinds(scene, effects);
      const FacetWorld world(scene);
      const reference::Occluders occluders(scene, world, std::vector{Pose{}}, kinds);
      RandomStream random(seed, kind);
      std::vector<Segment> segments;
      for (int i = 0; i < 1500; ++i) {
        const scene::FacetTriangle& triangle =
            scene.facet_triangles[random.below(static_cast<uint32_t>(scene.facet_triangles.size()))];
        const uint32_t corner = random.below(3);
        const double share = random.uniform();
        dvec3 at = glm::mix(triangle.corners[corner], triangle.corners[(corner + 1) % 3], share);
        for (int axis = 0; axis < 3; ++axis) at[axis] += random.uniform(-1e-4, 1e-4);
        dvec3 along(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
        segments.push_back(segment(at - along, at + random.uniform(0.5, 1.5) * along, 3));
      }
      const std::vector<Crossing> found = cross(scene, kinds, segments);
      for (size_t i = 0; i < segments.size(); ++i) {
        std::vector<reference::WallPassed> passed;
        const bool free = occluders.free_but_for({segments[i].a, segments[i].b}, 3, passed);
        ASSERT_EQ(found[i].blocked, !free) << seed << ' ' << kind << ' ' << i;
        ++all;
        blocked += found[i].blocked;
        if (!free) continue;
        std::vector<uint32_t> expected;
        for (const reference::WallPassed& wall : passed) expected.push_back(wall.facet);
        std::sort(expected.begin(), expected.end());
        ASSERT_EQ(found[i].walls, expected) << seed << ' ' << kind << ' ' << i;
        walls += expected.size();
      }
    }
  EXPECT_GT(blocked, all / 10);
  EXPECT_LT(blocked, 9 * all / 10);
  EXPECT_GT(walls, 1000u);
}

/// A body that moves has the edges of its pose.
TEST(ExactCrossings, MovingBodiesAreAtTheirPoses) {
  TinyScene tiny;
  const uint32_t body = tiny.body("box");
  tiny.object("box", body).box({-1, -1, -1}, {1, 1, 1});
  const scene::Scene scene = tiny.build();
  const std::vector<Pose> bodies{Pose{}, Pose{{40.0, 7.0, 2.0}, orientation_from_yaw_pitch_roll(0.3, 0, 0)}};
  for (const double beside : {-1e-5, -1e-6, 1e-6, 1e-5}) {
    // The ray runs along the body's x axis, just above or below its top.
    const dvec3 a = bodies[1].apply({-5.0, 0.1, 1.0 + beside}), b = bodies[1].apply({5.0, 0.2, 1.0 + beside});
    EXPECT_EQ(cross(scene, all_of(FacetKind::opaque, scene), std::vector{segment(a, b)}, bodies)[0].blocked,
              beside < 0.0)
        << beside;
  }
}

}  // namespace
}  // namespace greatx::rf
