// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths that are continued to other ends, against paths that are solved there. Surfaces with other values.
#include <map>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "rf/edges/keller_points.h"
#include "rf/gradient/changed_surfaces.h"
#include "rf/gradient/path_continuation.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;
using Kind = ChannelParameter::Kind;

void expect_same_way(const GeometricPath& found, const GeometricPath& expected) {
  ASSERT_EQ(found.vertices.size(), expected.vertices.size());
  EXPECT_EQ(found.interactions, expected.interactions);
  EXPECT_NEAR(found.length_m, expected.length_m, 1e-12 * expected.length_m);
  for (size_t i = 0; i < expected.vertices.size(); ++i)
    EXPECT_LT(glm::distance(found.vertices[i], expected.vertices[i]), 1e-11) << i;
}

/// Returns the path of these interactions over these points.
GeometricPath bent(const std::vector<Interaction>& interactions, std::vector<dvec3> vertices) {
  GeometricPath path{interactions, std::move(vertices)};
  for (size_t i = 0; i + 1 < path.vertices.size(); ++i)
    path.length_m += glm::distance(path.vertices[i], path.vertices[i + 1]);
  return path;
}

TEST(PathContinuation, ReflectionsInARoomAreThoseThatAreSolvedThere) {
  HandScene hand;
  hand.itu_material("concrete");
  hand.room({7.0, 5.0, 3.0});
  const FacetWorld world(hand.scene);
  const CandidateList all = exhaustive_candidates(world.facet_count(), 3);
  RandomStream random(71, 0);
  size_t compared = 0;
  for (int n = 0; n < 20; ++n) {
    const auto place = [&] {
      return dvec3(random.uniform(0.2, 6.8), random.uniform(0.2, 4.8), random.uniform(0.2, 2.8));
    };
    const dvec3 tx = place(), rx = place(), new_tx = place(), new_rx = place();
    std::map<std::vector<Interaction>, GeometricPath> there;
    for (GeometricPath& path : solve_paths(world, new_tx, new_rx, all)) there[path.interactions] = path;
    for (const GeometricPath& path : solve_paths(world, tx, rx, all)) {
      const ContinuedPath moved = continued_path(path, world, {}, new_tx, new_rx);
      const auto known = there.find(path.interactions);
      // In a convex room each sequence that leads there is a path; others leave their facets.
      EXPECT_EQ(moved.state == Continuation::exists, known != there.end());
      if (known == there.end()) continue;
      expect_same_way(moved.path, known->second);
      ++compared;
    }
  }
  EXPECT_GT(compared, 200u);
}

TEST(PathContinuation, ThePathOfTheSameEndsIsItself) {
  HandScene hand;
  hand.itu_material("concrete");
  hand.room({7.0, 5.0, 3.0});
  const FacetWorld world(hand.scene);
  const dvec3 tx(1.0, 2.0, 1.5), rx(5.0, 3.5, 1.0);
  for (const GeometricPath& path : solve_paths(world, tx, rx, exhaustive_candidates(6, 2))) {
    const ContinuedPath same = continued_path(path, world, {}, tx, rx);
    EXPECT_EQ(same.path.vertices, path.vertices);
    EXPECT_EQ(same.path.length_m, path.length_m);
  }
}

TEST(PathContinuation, BeyondTheMirrorAPathGoesOnAndBehindItIsLost) {
  HandScene hand;
  hand.itu_material("metal");
  hand.ground(1.0);
  const FacetWorld world(hand.scene);
  const GeometricPath path = bent({{InteractionType::reflection, 0}}, {{-1, 0, 1}, {0, 0, 0}, {1, 0, 1}});
  const ContinuedPath beyond = continued_path(path, world, {}, {-1, 0, 1}, {9, 0, 1});
  EXPECT_EQ(beyond.state, Continuation::beyond);
  expect_same_way(beyond.path, bent(path.interactions, {{-1, 0, 1}, {4, 0, 0}, {9, 0, 1}}));
  EXPECT_EQ(continued_path(path, world, {}, {-1, 0, 1}, {1, 0, -1}).state, Continuation::lost);
  // Below the mirror both ends have a reflection again.
  EXPECT_EQ(continued_path(path, world, {}, {-1, 0, -1}, {1, 0, -1}).state, Continuation::exists);
}

TEST(PathContinuation, WallsArePassedOnTheNewWay) {
  HandScene hand;
  hand.itu_material("plasterboard", 0.013);
  hand.quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1});
  hand.quad({1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1});
  const FacetWorld world(hand.scene);
  const GeometricPath path = bent({{InteractionType::transmission, 0}, {InteractionType::transmission, 1}},
                                  {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const ContinuedPath moved = continued_path(path, world, {}, {-1, 0.5, 0}, {2, -0.25, 0});
  EXPECT_EQ(moved.state, Continuation::exists);
  expect_same_way(moved.path,
                  bent(path.interactions, {{-1, 0.5, 0}, {0, 0.25, 0}, {1, 0, 0}, {2, -0.25, 0}}));
  EXPECT_EQ(continued_path(path, world, {}, {-1, 9, 0}, {2, 0, 0}).state, Continuation::beyond);
  EXPECT_EQ(continued_path(path, world, {}, {-1, 0, 0}, {0.5, 0, 0}).state, Continuation::beyond);
}

/// A block with four upright edges on a ground, and its wedges.
struct Block {
  HandScene hand;
  FacetWorld world;
  std::vector<scene::Wedge> wedges;
  static HandScene make() {
    HandScene hand;
    hand.itu_material("concrete");
    const dvec3 p[4] = {{0, 0, 0}, {3, 0, 0}, {3, 2, 0}, {0, 2, 0}};
    const dvec3 up(0, 0, 10);
    for (int i = 0; i < 4; ++i) {
      const dvec3 &a = p[i], &b = p[(i + 1) % 4];
      hand.quad(a, b, b + up, a + up);
    }
    hand.ground(60.0);
    return hand;
  }
  Block() : hand(make()), world(hand.scene), wedges(scene::find_wedges(hand.scene)) {}
  /// Returns the upright edge at a corner of the block.
  uint32_t upright(double x, double y) const {
    for (uint32_t i = 0; i < wedges.size(); ++i)
      if (glm::length(dvec2(wedges[i].a) - dvec2(x, y)) < 1e-9 &&
          glm::length(dvec2(wedges[i].b) - dvec2(x, y)) < 1e-9)
        return i;
    ADD_FAILURE() << "no edge at " << x << " " << y;
    return 0;
  }
};

TEST(PathContinuation, KellersPointsAreThoseThatAreSolvedThere) {
  const Block block;
  const uint32_t edge = block.upright(0, 0), other = block.upright(0, 2);
  const scene::Wedge &first = block.wedges[edge], &second = block.wedges[other];
  const dvec3 tx(4.0, -3.0, 2.0), rx(-5.0, 1.0, 4.0), new_tx(5.0, -1.5, 3.5), new_rx(-3.0, 0.3, 6.0);
  const auto over_one = [&](const dvec3& from, const dvec3& to) {
    return bent({{InteractionType::diffraction, edge}}, {from, keller_point(first, from, to).value(), to});
  };
  const ContinuedPath one = continued_path(over_one(tx, rx), block.world, block.wedges, new_tx, new_rx);
  EXPECT_EQ(one.state, Continuation::exists);
  expect_same_way(one.path, over_one(new_tx, new_rx));

  const dvec3 behind(4.0, 6.0, 7.0), new_behind(3.5, 4.0, 3.0);
  const auto over_two = [&](const dvec3& from, const dvec3& to) {
    const KellerPoints points = keller_points(first, second, from, to).value();
    return bent({{InteractionType::diffraction, edge}, {InteractionType::diffraction, other}},
                {from, points.first, points.second, to});
  };
  const ContinuedPath two =
      continued_path(over_two(tx, behind), block.world, block.wedges, new_tx, new_behind);
  EXPECT_EQ(two.state, Continuation::exists);
  expect_same_way(two.path, over_two(new_tx, new_behind));

  // With a reflection in the ground before the edge: Keller's point of the image.
  const auto over_ground = [&](const dvec3& from, const dvec3& to) {
    const dvec3 image(from.x, from.y, -from.z), point = keller_point(first, image, to).value();
    const dvec3 mirror = image + image.z / (image.z - point.z) * (point - image);
    return bent({{InteractionType::reflection, 4}, {InteractionType::diffraction, edge}},
                {from, mirror, point, to});
  };
  const ContinuedPath ground = continued_path(over_ground(tx, rx), block.world, block.wedges, new_tx, new_rx);
  EXPECT_EQ(ground.state, Continuation::exists);
  expect_same_way(ground.path, over_ground(new_tx, new_rx));

  // Above the end of the edge the point is beyond it; the end of an edge stays.
  EXPECT_EQ(continued_path(over_one(tx, rx), block.world, block.wedges, {4, -3, 15}, {-5, 1, 15}).state,
            Continuation::beyond);
  GeometricPath corner = bent({{InteractionType::diffraction, edge, 2}}, {tx, first.b, rx});
  const ContinuedPath end = continued_path(corner, block.world, block.wedges, new_tx, new_rx);
  expect_same_way(end.path, bent(corner.interactions, {new_tx, first.b, new_rx}));
}

TEST(PathContinuation, APatchStaysWhereItIs) {
  const Block block;
  GeometricPath path = bent({{InteractionType::scattering, 4, 3}, {InteractionType::reflection, 0}},
                            {{1, -9, 3}, {1.0, -5.0, 0.0}, {1.5, 0.0, 1.0}, {2.0, -5.0, 2.0}});
  path.patch_area_m2 = 0.3;
  const ContinuedPath moved = continued_path(path, block.world, block.wedges, {2, -8, 3}, {2.0, -5.0, 4.0});
  EXPECT_EQ(moved.state, Continuation::exists);
  EXPECT_EQ(moved.path.vertices[1], path.vertices[1]);
  expect_same_way(moved.path, bent(path.interactions, {{2, -8, 3}, {1, -5, 0}, {1.5, 0, 2}, {2, -5, 4}}));
  EXPECT_EQ(moved.path.patch_area_m2, 0.3);
}

TEST(ChangedSurfaces, HaveTheirValuesFromBothSides) {
  const double carrier_hz = 3.5e9;
  RadioSurface pane;
  pane.front = {{{6.0, -0.1}, 0.006}, {{1.0, 0.0}, 0.016}, {{5.0, -0.2}, 0.004}};
  pane.back = {pane.front.rbegin(), pane.front.rend()};
  RadioSurface ground;
  ground.front = {{{3.0, -0.5}, 0.02}, {{8.0, -2.0}, 0.0}};
  ground.back = {ground.front.back()};
  const RadioSurfaces surfaces({pane, ground}, carrier_hz);
  const auto name = [](const ChannelParameter&) { return std::string("the parameter"); };
  const auto with = [&](const std::vector<MaterialValue>& values) {
    return changed_surfaces(surfaces, 2, values, name);
  };
  const RadioSurfaces changed = with({{{Kind::permittivity, 0, 2}, 4.5},
                                      {{Kind::thickness, 0, 2}, 0.005},
                                      {{Kind::conductivity, 1, 1}, 0.7},
                                      {{Kind::roughness, 1}, 0.01}});
  EXPECT_EQ(changed.surface(0).front[2].eta, Complex(4.5, -0.2));
  EXPECT_EQ(changed.surface(0).back[0].eta, Complex(4.5, -0.2));
  EXPECT_EQ(changed.surface(0).back[0].thickness_m, 0.005);
  EXPECT_EQ(changed.surface(0).front[0].eta, pane.front[0].eta);
  const double loss = 0.7 / (2.0 * pi * carrier_hz * vacuum_permittivity);
  EXPECT_EQ(changed.surface(1).front[1].eta, Complex(8.0, -loss));
  EXPECT_EQ(changed.surface(1).back[0].eta, Complex(8.0, -loss));
  EXPECT_EQ(changed.surface(1).roughness_m, 0.01);
  // The layer in front of a half-space is not seen from behind.
  EXPECT_EQ(with({{{Kind::permittivity, 1, 0}, 2.5}}).surface(1).back[0].eta, Complex(8.0, -2.0));
  for (const auto& [parameter, value] :
       std::vector<MaterialValue>{{{Kind::permittivity, 0, 2}, 4.5}, {{Kind::conductivity, 1, 1}, 0.7}})
    EXPECT_NEAR(parameter_value(changed.surface(parameter.index), parameter, carrier_hz), value, 1e-15);
  EXPECT_FALSE(has_parameter(ground, {Kind::thickness, 1, 1}));
  EXPECT_FALSE(has_parameter(ground, {Kind::permittivity, 1, 2}));
  EXPECT_FALSE(has_parameter(ground, {.kind = Kind::permittivity, .index = 1, .windows = true}));
  for (const MaterialValue& bad : std::vector<MaterialValue>{{{Kind::permittivity, 0}, 0.0},
                                                             {{Kind::conductivity, 0}, -1.0},
                                                             {{Kind::thickness, 0}, 0.0},
                                                             {{Kind::roughness, 0}, -1e-3},
                                                             {{Kind::scattering, 0}, 1.5},
                                                             {{Kind::permittivity, 0}, std::nan("")}})
    EXPECT_THROW(with({bad}), UserError) << bad.value;
}

}  // namespace
}  // namespace greatx::rf
