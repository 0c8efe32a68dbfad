// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the reference against closed forms and against the image tree with every sequence as a candidate.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/geometry/geometry.h"
#include "rf/reference/comparison.h"
#include "rf/reference/exhaustive_paths.h"
#include "rf/reference/occluders.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/random_scene.h"
#include "tests/rf/scenes.h"

namespace greatx::rf::reference {
namespace {

using rf::testing::build;
using rf::testing::exhaustive_candidates;
using rf::testing::HandScene;
using rf::testing::random_scene;
using rf::testing::RandomScene;
using rf::testing::solve_paths;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<Pose> at_rest{Pose{}};

ExhaustiveResult search(const scene::Scene& scene, const FacetKinds& kinds, const dvec3& transmitter,
                        const std::vector<dvec3>& receivers, const ExhaustiveOptions& options = {}) {
  const FacetWorld world(scene);
  return exhaustive_paths(scene, world, at_rest, kinds, transmitter, receivers, options);
}
ExhaustiveResult search(const scene::Scene& scene, const dvec3& transmitter,
                        const std::vector<dvec3>& receivers, const ExhaustiveOptions& options = {}) {
  return search(scene, FacetKinds(scene.facets.size(), FacetKind::opaque), transmitter, receivers, options);
}

std::vector<InteractionType> types(const GeometricPath& path) {
  std::vector<InteractionType> list;
  for (const Interaction& interaction : path.interactions) list.push_back(interaction.type);
  return list;
}

TEST(Reference, ShoeBoxHasEveryImageOnce) {
  HandScene hand;
  const dvec3 size(7.3, 5.1, 3.2), from(1.7, 2.9, 2.1), to(6.1, 1.3, 1.4);
  hand.room(size);
  // Images of the receiver are at +-x + 2 n a along each axis, of order |2 n| or |2 n - 1|.
  std::vector<std::vector<double>> lengths(5);
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const int order = std::abs(i) + std::abs(j) + std::abs(k);
        if (order > 4) continue;
        const auto image = [](int n, double x, double a) { return n * a + (n % 2 == 0 ? x : a - x); };
        const dvec3 at(image(i, to.x, size.x), image(j, to.y, size.y), image(k, to.z, size.z));
        lengths[order].push_back(glm::distance(from, at));
      }
  const ExhaustiveResult result = search(hand.scene, from, {to}, {.max_depth = 4});
  std::vector<std::vector<double>> found(5);
  for (const GeometricPath& path : result.paths[0]) found[path.interactions.size()].push_back(path.length_m);
  const std::vector<size_t> counts{1, 6, 18, 38, 66};
  for (size_t order = 0; order < 5; ++order) {
    ASSERT_EQ(lengths[order].size(), counts[order]);
    ASSERT_EQ(found[order].size(), counts[order]) << "order " << order;
    std::sort(lengths[order].begin(), lengths[order].end());
    std::sort(found[order].begin(), found[order].end());
    for (size_t i = 0; i < counts[order]; ++i)
      EXPECT_NEAR(found[order][i], lengths[order][i], 1e-12 * lengths[order][i]);
  }
}

TEST(Reference, OpaqueWallsBlockAndBudgetedOnesArePassedInOrder) {
  HandScene hand;
  hand.ground(50);
  hand.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10});
  hand.quad({4, -20, 0}, {4, 20, 0}, {4, 20, 10}, {4, -20, 10});
  const dvec3 from(10, 1, 3), to(-5, 2, 1);
  EXPECT_THAT(search(hand.scene, from, {to}, {.max_depth = 1}).paths[0], IsEmpty());
  const FacetKinds kinds{FacetKind::opaque, FacetKind::wall, FacetKind::wall};
  EXPECT_THAT(search(hand.scene, kinds, from, {to}, {.max_depth = 3, .max_transmissions = 1}).paths[0],
              IsEmpty());
  const auto paths = search(hand.scene, kinds, from, {to}, {.max_depth = 3, .max_transmissions = 2}).paths[0];
  ASSERT_THAT(paths, SizeIs(2));  // straight, and by the ground; a reflection by a wall exceeds the depth
  EXPECT_THAT(paths[0].interactions, ElementsAre(Interaction{InteractionType::transmission, 2},
                                                 Interaction{InteractionType::transmission, 1}));
  EXPECT_NEAR(paths[0].vertices[1].x, 4.0, 1e-12);
  EXPECT_NEAR(paths[0].vertices[2].x, 0.0, 1e-12);
  EXPECT_NEAR(paths[0].length_m, glm::distance(from, to), 1e-12);
  EXPECT_THAT(types(paths[1]), ElementsAre(InteractionType::transmission, InteractionType::transmission,
                                           InteractionType::reflection));
  // Walls count towards the depth, too.
  EXPECT_THAT(search(hand.scene, kinds, from, {to}, {.max_depth = 2, .max_transmissions = 2}).paths[0],
              SizeIs(1));
}

TEST(Reference, AWallThatIsThereTwiceIsPassedOnceAndReflectsOnce) {
  HandScene hand;
  hand.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10});
  hand.quad({0, -20, 0}, {0, -20, 10}, {0, 20, 10}, {0, 20, 0});
  const FacetKinds kinds(2, FacetKind::wall);
  const std::vector<dvec3> to{{-5, 2, 4}, {6, 3, 4}};
  const auto paths = search(hand.scene, kinds, {5, 0, 5}, to, {.max_depth = 2, .max_transmissions = 1}).paths;
  ASSERT_THAT(paths[0], SizeIs(1));
  EXPECT_THAT(paths[0][0].interactions, ElementsAre(Interaction{InteractionType::transmission, 0}));
  ASSERT_THAT(paths[1], SizeIs(2));
  EXPECT_THAT(paths[1][1].interactions, ElementsAre(Interaction{InteractionType::reflection, 0}));
}

TEST(Reference, FoliageAndWhatIsAbsentNeitherReflectNorBlock) {
  HandScene hand;
  hand.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10});
  for (const FacetKind kind : {FacetKind::foliage, FacetKind::absent})
    EXPECT_THAT(search(hand.scene, {kind}, {5, 0, 5}, {{-5, 2, 4}, {6, 3, 4}}).paths,
                ElementsAre(SizeIs(1), SizeIs(1)));
}

TEST(Reference, EndsInAPlaneAndInnerCorners) {
  HandScene hand;
  hand.room({6, 5, 3});
  // On the floor there is no reflection by the floor and none of zero length; the other five walls remain.
  EXPECT_THAT(search(hand.scene, {2, 2, 0}, {{4, 3, 1}}, {.max_depth = 1}).paths[0], SizeIs(6));
  // A path straight into the edge of two walls: xy and yx are one path.
  const auto corner = search(hand.scene, {2, 2, 1}, {{3, 3, 1}}, {.max_depth = 2}).paths[0];
  size_t at_edge = 0;
  for (const GeometricPath& path : corner)
    if (path.vertices.size() == 4 && glm::distance(path.vertices[1], path.vertices[2]) < 1e-9) ++at_edge;
  EXPECT_EQ(at_edge, 1u);
  EXPECT_THAT(corner, SizeIs(25));
}

TEST(Reference, MovingBodiesStandWhereTheyAre) {
  HandScene hand;
  hand.ground(50);
  const uint32_t body = hand.body();
  hand.quad({0, -2, 0}, {0, 2, 0}, {0, 2, 2}, {0, -2, 2}, 0, body);
  FacetWorld world(hand.scene);
  std::vector<Pose> poses{Pose{}, Pose{{10, 0, 0}, orientation_from_yaw_pitch_roll(0.3, 0, 0)}};
  world.move(body, {.pose = poses[1]});
  const std::vector<dvec3> to{{20, 3, 1}, {4, -4, 1}};
  const auto paths = [&](uint32_t transmitter_body) {
    return exhaustive_paths(hand.scene, world, poses, FacetKinds(2, FacetKind::opaque), {4, 0, 1}, to,
                            {.max_depth = 1, .transmitter_body = transmitter_body})
        .paths;
  };
  EXPECT_THAT(
      paths(0),
      ElementsAre(IsEmpty(), SizeIs(3)));  // the plate hides one receiver and reflects to the other one
  EXPECT_THAT(paths(body), ElementsAre(SizeIs(2), SizeIs(3)));
}

/// Returns the paths of the image tree with every sequence as a candidate, with the occlusion of the
/// reference.
std::vector<GeometricPath> by_image_tree(const scene::Scene& scene, const FacetKinds& kinds,
                                         const dvec3& from, const dvec3& to, uint32_t depth) {
  const FacetWorld world(scene);
  const Occluders occluders(scene, world, at_rest, kinds);
  std::vector<GeometricPath> lit;
  for (const GeometricPath& path :
       solve_paths(world, from, to, exhaustive_candidates(world.facet_count(), depth))) {
    bool free = true;
    std::vector<WallPassed> walls;
    for (size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      Stretch stretch{path.vertices[i], path.vertices[i + 1]};
      if (i > 0) stretch.facet_a = path.interactions[i - 1].element;
      if (i < path.interactions.size()) stretch.facet_b = path.interactions[i].element;
      free = free && occluders.free_but_for(stretch, 0, walls);
    }
    if (free) lit.push_back(path);
  }
  return lit;
}

TEST(Reference, AgreesWithTheImageTreeOnRandomScenes) {
  size_t paths = 0;
  for (uint64_t seed = 0; seed < 4; ++seed)
    for (uint32_t kind = 0; kind < rf::testing::random_scene_kinds; ++kind) {
      const RandomScene random = random_scene(seed, kind, 3);
      const scene::Scene scene = build(random);
      const FacetKinds kinds(scene.facets.size(), FacetKind::opaque);
      const ExhaustiveResult result = search(scene, kinds, random.transmitter, random.receivers);
      Comparison comparison(3);
      for (uint32_t r = 0; r < random.receivers.size(); ++r) {
        const auto other = by_image_tree(scene, kinds, random.transmitter, random.receivers[r], 3);
        comparison.add(r, polylines(other), polylines(result.paths[r]));
        paths += other.size();
      }
      EXPECT_TRUE(comparison.all().perfect())
          << random.name << ", seed " << seed << ": " << comparison.all().missing << " missing, "
          << comparison.all().doubled << " doubled, " << comparison.all().extra << " extra";
    }
  EXPECT_GT(paths, 500u);
}

TEST(Reference, ThreadsChangeNoBit) {
  const RandomScene random = random_scene(3, 2, 5);
  const scene::Scene scene = build(random);
  const ExhaustiveResult one = search(scene, random.transmitter, random.receivers, {.threads = 1});
  const ExhaustiveResult two = search(scene, random.transmitter, random.receivers, {.threads = 2});
  EXPECT_EQ(one.sequences, two.sequences);
  EXPECT_EQ(one.geometric_paths, two.geometric_paths);
  for (size_t r = 0; r < one.paths.size(); ++r) {
    ASSERT_EQ(one.paths[r].size(), two.paths[r].size());
    for (size_t i = 0; i < one.paths[r].size(); ++i) {
      EXPECT_EQ(one.paths[r][i].interactions, two.paths[r][i].interactions);
      EXPECT_EQ(one.paths[r][i].vertices, two.paths[r][i].vertices);
      EXPECT_EQ(one.paths[r][i].length_m, two.paths[r][i].length_m);
    }
  }
}

TEST(Reference, AReceiverThatIsNowhereIsAnErrorByNumber) {
  HandScene hand;
  hand.ground(50);
  try {
    search(hand.scene, {0, 0, 1}, {{1, 1, 1}, {1, std::nan(""), 1}});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("receiver 1"));
  }
}

TEST(Comparison, CountsWhatIsMissingDoubledAndExtra) {
  const auto path = [](std::vector<dvec3> vertices, double length) {
    GeometricPath made;
    made.vertices = std::move(vertices);
    made.length_m = length;
    return made;
  };
  const std::vector<GeometricPath> truth{path({{0, 0, 0}, {4, 0, 0}}, 4),
                                         path({{0, 0, 0}, {2, 1, 0}, {4, 0, 0}}, 5),
                                         path({{0, 0, 0}, {2, 2, 0}, {4, 0, 0}}, 6)};
  const std::vector<GeometricPath> found{
      path({{0, 0, 0}, {4, 0, 0}}, 4), path({{0, 0, 0}, {2, 1 + 5e-5, 0}, {4, 0, 0}}, 5 + 5e-7),
      path({{0, 0, 0}, {2, 1, 0}, {4, 0, 0}}, 5), path({{0, 0, 0}, {2, 2, 0}, {4, 0, 0}}, 6 + 2e-6)};
  Comparison comparison(1);
  comparison.add(7, polylines(truth), polylines(found));
  const Comparison::Counts direct = comparison.by_depth()[0], once = comparison.by_depth()[1];
  EXPECT_TRUE(direct.perfect());
  EXPECT_EQ(direct.found, 1u);
  EXPECT_EQ(once.reference, 2u);
  EXPECT_EQ(once.found, 1u);
  EXPECT_EQ(once.missing, 1u);
  EXPECT_EQ(once.doubled, 1u);
  EXPECT_EQ(once.extra, 1u);
  EXPECT_NEAR(comparison.all().recall(), 2.0 / 3.0, 1e-15);
  EXPECT_THAT(comparison.mismatches(), SizeIs(3));
}

}  // namespace
}  // namespace greatx::rf::reference
