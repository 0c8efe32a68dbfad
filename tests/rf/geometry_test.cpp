// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;
using testing::HandScene;
using testing::solve_paths;

std::vector<GeometricPath> solve_all(const HandScene& hand, const dvec3& tx, const dvec3& rx,
                                     uint32_t depth) {
  const FacetWorld world(hand.scene);
  return solve_paths(world, tx, rx, exhaustive_candidates(world.facet_count(), depth));
}

bool same_bits(const std::vector<GeometricPath>& a, const std::vector<GeometricPath>& b) {
  if (a.size() != b.size()) return false;
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].facets() != b[i].facets() || a[i].vertices.size() != b[i].vertices.size()) return false;
    if (std::memcmp(&a[i].length_m, &b[i].length_m, sizeof(double)) != 0) return false;
    if (std::memcmp(a[i].vertices.data(), b[i].vertices.data(), a[i].vertices.size() * sizeof(dvec3)) != 0)
      return false;
  }
  return true;
}

/// Expects that the segments add up to the length, that vertices lie on their facets and that angles of
/// reflection equal angles of incidence.
void expect_specular(const FacetWorld& world, const GeometricPath& path) {
  ASSERT_EQ(path.vertices.size(), path.facets().size() + 2);
  double sum = 0.0;
  for (size_t i = 1; i < path.vertices.size(); ++i)
    sum += glm::length(path.vertices[i] - path.vertices[i - 1]);
  EXPECT_NEAR(sum / path.length_m, 1.0, 1e-12);
  for (size_t i = 0; i < path.facets().size(); ++i) {
    const PosedFacet& facet = world.facet(path.facets()[i]);
    const dvec3 in = glm::normalize(path.vertices[i + 1] - path.vertices[i]);
    const dvec3 out = glm::normalize(path.vertices[i + 2] - path.vertices[i + 1]);
    EXPECT_NEAR(facet.distance(path.vertices[i + 1]), 0.0, 1e-9);
    EXPECT_LT(glm::length(in - 2.0 * glm::dot(in, facet.normal) * facet.normal - out), 1e-9);
  }
}

TEST(Candidates, CanonicalOrderAndNoDuplicates) {
  CandidateList list;
  const std::vector<std::vector<uint32_t>> sequences{{2, 1}, {1}, {}, {1, 2}, {1}, {0, 3, 0}, {2, 1}, {10}};
  for (const auto& sequence : sequences) list.add(sequence);
  EXPECT_FALSE(list.is_canonical());
  list.make_canonical();
  EXPECT_TRUE(list.is_canonical());
  ASSERT_EQ(list.size(), 6u);
  EXPECT_TRUE(list.sequence(0).empty());
  EXPECT_EQ(list.sequence(2)[0], 10u);
  EXPECT_EQ(list.sequence(5).size(), 3u);
  CandidateList copy = list;
  copy.make_canonical();
  EXPECT_EQ(copy, list);
}

TEST(Candidates, ExhaustiveCounts) {
  const CandidateList list = exhaustive_candidates(6, 4);
  EXPECT_EQ(list.size(), 1u + 6 + 30 + 150 + 750);
  EXPECT_TRUE(list.is_canonical());
  EXPECT_EQ(exhaustive_candidates(0, 3).size(), 1u);
  EXPECT_EQ(exhaustive_candidates(1, 3).size(), 2u);
  EXPECT_EQ(exhaustive_candidates(5, 0).size(), 1u);
  EXPECT_EQ(exhaustive_candidates(10, 2).size(), 101u);
}

TEST(ImageMethod, RefusesCandidatesOutOfOrderOrRange) {
  HandScene hand;
  hand.ground(5.0);
  const FacetWorld world(hand.scene);
  CandidateList list;
  list.add(std::vector<uint32_t>{0});
  list.add({});
  EXPECT_THROW(ImageTree(world, dvec3(0, 0, 1), list), ContractError);
  CandidateList far;
  far.add(std::vector<uint32_t>{1});
  EXPECT_THROW(ImageTree(world, dvec3(0, 0, 1), far), ContractError);
}

TEST(ImageMethod, OnlyTheCandidatesAreLookedAt) {
  HandScene hand;
  hand.ground(50.0);
  const FacetWorld world(hand.scene);
  CandidateList list;
  list.add(std::vector<uint32_t>{0});
  const auto paths = solve_paths(world, {0, 0, 3}, {4, 0, 3}, list);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].length_m, std::sqrt(16.0 + 36.0));
  EXPECT_LT(glm::length(paths[0].vertices[1] - dvec3(2, 0, 0)), 1e-15);
}

TEST(ImageMethodHardCase, N07_UtmShift) {
  RandomStream random(11, 0);
  const dvec3 shift(500'000.0, -500'000.0, 300.0);
  HandScene here, there;
  here.room({8, 5, 3});
  there.room({8, 5, 3}, shift);
  // As the loader does, subtracts the local origin from world coordinates. The differences are exact.
  for (scene::FacetTriangle& triangle : there.scene.facet_triangles)
    for (dvec3& corner : triangle.corners) corner -= shift;
  for (scene::Facet& facet : there.scene.facets) {
    const dvec3* corners = there.scene.facet_triangles[facet.first_triangle].corners;
    facet.offset = glm::dot(facet.normal, corners[0]);
  }
  const dvec3 tx(1.3, 2.2, 1.1), rx(6.7, 3.3, 2.4);
  const auto a = solve_all(here, tx, rx, 3), b = solve_all(there, tx + shift - shift, rx + shift - shift, 3);
  ASSERT_EQ(a.size(), 63u);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].facets(), b[i].facets());
    for (size_t k = 0; k < a[i].vertices.size(); ++k)
      EXPECT_LT(glm::length(a[i].vertices[k] - b[i].vertices[k]), 1e-9);
  }
  // Without a local origin, 500 km away, the paths are the same to the rounding of the coordinates (6e-11 m).
  HandScene far;
  const dvec3 off(500'000.0, -500'000.0, 0.0);
  far.room({8, 5, 3}, off);
  const auto c = solve_all(far, tx + off, rx + off, 3);
  ASSERT_EQ(a.size(), c.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].facets(), c[i].facets());
    EXPECT_NEAR(a[i].length_m, c[i].length_m, 1e-9);
    for (size_t k = 0; k < a[i].vertices.size(); ++k)
      EXPECT_LT(glm::length(a[i].vertices[k] + off - c[i].vertices[k]), 2e-9);
  }
}

TEST(ImageMethodHardCase, N15_N16_EndInTheReflectingPlane) {
  HandScene hand;
  hand.ground(50.0);
  for (const auto& [tx, rx] :
       {std::pair{dvec3(0, 0, 0), dvec3(5, 0, 2)}, std::pair{dvec3(5, 0, 2), dvec3(0, 0, 0)},
        std::pair{dvec3(0, 0, 0), dvec3(5, 0, 0)}}) {
    const auto paths = solve_all(hand, tx, rx, 3);
    ASSERT_EQ(paths.size(), 1u);  // the line of sight
    EXPECT_TRUE(paths[0].facets().empty());
  }
  // A point in the plane, but beside the facet, gives the same result.
  EXPECT_EQ(solve_all(hand, {80, 0, 0}, {5, 0, 2}, 2).size(), 1u);
  // A point 5 mm above the facet (hard case 12) has a path that is accurate to the last digit.
  const auto paths = solve_all(hand, {0, 0, 0.005}, {5, 0, 2}, 1);
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_NEAR(paths[1].length_m / std::sqrt(25 + 2.005 * 2.005), 1.0, 1e-15);
  EXPECT_NEAR(paths[1].vertices[1].x, 5 * 0.005 / 2.005, 1e-14);
}

TEST(ImageMethodHardCase, N17_TransmitterIsReceiver) {
  HandScene hand;
  hand.ground(50.0);
  const auto paths = solve_all(hand, {1, 2, 3}, {1, 2, 3}, 2);
  ASSERT_EQ(paths.size(), 1u);  // no line of sight of zero length, but the echo
  EXPECT_EQ(paths[0].length_m, 6.0);
  EXPECT_EQ(paths[0].vertices[1], dvec3(1, 2, 0));
}

TEST(ImageMethodHardCase, N18_DiagonalOfAQuad) {
  // The reflection point lies on the diagonal or about one rounding error beside it, or on the edge between
  // two facets.
  HandScene merged, apart;
  merged.ground(10.0);
  apart.triangle({-10, -10, 0}, {10, -10, 0}, {10, 10, 0});
  apart.triangle({-10, -10, 0}, {10, 10, 0}, {-10, 10, 0});
  RandomStream random(5, 0);
  for (int i = 0; i < 200; ++i) {
    const double at = random.uniform(-9, 9), nudge = random.uniform(-1, 1) * 1e-15;
    const dvec3 offset(random.uniform(-3, 3), random.uniform(-3, 3), 0.0),
        height(0, 0, random.uniform(0.1, 20));
    const dvec3 point(at + nudge, at, 0);
    EXPECT_EQ(solve_all(merged, point + offset + height, point - offset + height, 2).size(), 2u);
    const auto paths = solve_all(apart, point + offset + height, point - offset + height, 2);
    ASSERT_EQ(paths.size(), 2u);
  }
  // Exactly on the common edge, the lower index is kept.
  const auto paths = solve_all(apart, {0, 4, 2}, {4, 0, 2}, 1);
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_EQ(paths[1].facets(), FacetSequence{0});
}

TEST(ImageMethodHardCase, N19_DuplicateFacets) {
  HandScene hand;
  hand.ground(10.0);
  hand.ground(10.0);
  hand.quad({-10, 10, 0}, {10, 10, 0}, {10, -10, 0}, {-10, -10, 0});  // once more, facing down
  hand.quad({10, -10, 0}, {10, 10, 0}, {10, 10, 5}, {10, -10, 5});
  const auto paths = solve_all(hand, {0, 1, 2}, {3, 2, 4}, 2);
  ASSERT_EQ(paths.size(), 4u);  // line of sight, ground, wall, and ground and wall in one order only
  EXPECT_EQ(paths[1].facets(), FacetSequence{0});
  EXPECT_EQ(paths[2].facets(), FacetSequence{3});
  EXPECT_EQ(paths[3].facets(), (FacetSequence{0, 3}));
}

TEST(ImageMethodHardCase, N20_CornerTie) {
  // A right-angled corner reflects every ray back to where it came from. If both ends and the edge are
  // collinear as seen from above, the double reflection meets the edge itself; xy and yx are then one path.
  HandScene hand;
  hand.quad({0, 0, 0}, {0, 10, 0}, {0, 10, 10}, {0, 0, 10});  // x = 0, facing +x
  hand.quad({0, 0, 0}, {0, 0, 10}, {10, 0, 10}, {10, 0, 0});  // y = 0, facing +y
  const FacetWorld world(hand.scene);
  EXPECT_EQ(world.facet(0).normal, dvec3(1, 0, 0));
  EXPECT_EQ(world.facet(1).normal, dvec3(0, 1, 0));
  RandomStream random(9, 0);
  for (int i = 0; i < 200; ++i) {
    const double azimuth = random.uniform(0.1, 1.4), near = random.uniform(0.5, 5),
                 far = random.uniform(0.5, 5);
    const dvec3 along(std::cos(azimuth), std::sin(azimuth), 0);
    const dvec3 tx = near * along + dvec3(0, 0, random.uniform(1, 9)), rx = far * along + dvec3(0, 0, 5);
    const auto paths = solve_paths(world, tx, rx, exhaustive_candidates(2, 2));
    ASSERT_EQ(paths.size(), 4u) << azimuth;
    EXPECT_NEAR(std::hypot(paths[3].vertices[1].x, paths[3].vertices[1].y), 0.0, 1e-7);
    EXPECT_NEAR(paths[3].length_m, glm::length(rx - tx * dvec3(-1, -1, 1)), 1e-12);
  }
  // With exactly representable coordinates both orders are equal to the bit, and the first one is kept.
  const auto exact = solve_paths(world, {1, 1, 2}, {3, 3, 6}, exhaustive_candidates(2, 2));
  const auto back = solve_paths(world, {3, 3, 6}, {1, 1, 2}, exhaustive_candidates(2, 2));
  ASSERT_EQ(back.size(), 4u);
  EXPECT_EQ(back[3].facets(), (FacetSequence{1, 0})) << "the same in the other direction";
  ASSERT_EQ(exact.size(), 4u);
  EXPECT_EQ(exact[3].facets(), (FacetSequence{0, 1}));
  // Beside the tie exactly one order exists.
  EXPECT_EQ(solve_paths(world, {1, 1.001, 2}, {3, 3, 6}, exhaustive_candidates(2, 2)).size(), 4u);
  EXPECT_EQ(solve_paths(world, {1, 0.999, 2}, {3, 3, 6}, exhaustive_candidates(2, 2)).size(), 4u);
}

TEST(ImageMethod, OuterCornerAndFlatSeamReflectOnce) {
  // The same walls seen from outside (a house, not a room) give no double reflection at the edge.
  HandScene house;
  house.quad({0, 0, 0}, {0, -10, 0}, {0, -10, 10}, {0, 0, 10});
  house.quad({0, 0, 0}, {0, 0, 10}, {-10, 0, 10}, {-10, 0, 0});
  for (const auto& path : solve_all(house, {1, 1, 2}, {3, 3, 6}, 3)) EXPECT_LE(path.facets().size(), 1u);
  // Two facets of one plane touch: a point on their seam is one reflection, never two.
  HandScene seam;
  seam.quad({-5, -5, 0}, {0, -5, 0}, {0, 5, 0}, {-5, 5, 0});
  seam.quad({0, -5, 0}, {5, -5, 0}, {5, 5, 0}, {0, 5, 0});
  EXPECT_EQ(solve_all(seam, {-1, 0, 2}, {1, 1, 2}, 3).size(), 2u);
  EXPECT_EQ(solve_all(seam, {-1, 0, 2}, {1, 1, -2}, 3).size(),
            1u);  // the ends are on different sides: no reflection
}

TEST(ImageMethodHardCase, N21_ShoeBox) {
  const dvec3 size(7.3, 4.1, 2.9), tx(1.234, 2.345, 1.111), rx(5.432, 0.987, 2.013);
  HandScene hand;
  hand.room(size);
  const auto paths = solve_all(hand, tx, rx, 4);
  std::array<std::vector<double>, 5> found, expected;
  const FacetWorld world(hand.scene);
  for (const GeometricPath& path : paths) {
    expect_specular(world, path);
    found[path.facets().size()].push_back(path.length_m / speed_of_light);
  }
  // Images lie at n l + x for even n and at (n + 1) l - x for odd n. |n| is the number of reflections on
  // walls of that axis.
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j)
      for (int k = -4; k <= 4; ++k) {
        const int order = std::abs(i) + std::abs(j) + std::abs(k);
        if (order > 4) continue;
        dvec3 image;
        const int counts[3]{i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          const int n = counts[axis];
          image[axis] = n % 2 == 0 ? n * size[axis] + tx[axis] : (n + 1) * size[axis] - tx[axis];
        }
        expected[static_cast<size_t>(order)].push_back(glm::length(image - rx) / speed_of_light);
      }
  const size_t counts[5]{1, 6, 18, 38, 66};
  for (size_t order = 0; order <= 4; ++order) {
    ASSERT_EQ(found[order].size(), counts[order]);
    ASSERT_EQ(expected[order].size(), counts[order]);
    std::sort(found[order].begin(), found[order].end());
    std::sort(expected[order].begin(), expected[order].end());
    for (size_t i = 0; i < counts[order]; ++i) EXPECT_NEAR(found[order][i] / expected[order][i], 1.0, 1e-12);
  }
  for (size_t i = 1; i < paths.size(); ++i)
    EXPECT_TRUE(sequence_less(paths[i - 1].facets(), paths[i].facets()));
}

TEST(ImageMethodHardCase, N22_PlanesAtRoundCoordinates) {
  // The planes have round coordinates (whole numbers, powers of two), where the bins of a hash would end, and
  // consist of many coplanar facets. No path is found twice.
  HandScene hand;
  for (int i = -4; i < 4; ++i)
    for (int j = -4; j < 4; ++j) hand.quad({i, j, 0}, {i + 1, j, 0}, {i + 1, j + 1, 0}, {i, j + 1, 0});
  RandomStream random(2, 0);
  for (int i = 0; i < 50; ++i) {
    // Points on corners of four facets, on edges of two facets, and inside a facet.
    const dvec3 point(random.below(7) - 3.0, i % 3 == 0 ? random.below(7) - 3.0 : random.uniform(-3.9, 3.9),
                      0.0);
    const dvec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), 0), up(0, 0, random.uniform(0.5, 2));
    EXPECT_EQ(solve_all(hand, point + offset + up, point - offset + up, 1).size(), 2u);
  }
}

TEST(ImageMethodHardCase, N23_TwoWallsFourMillimetresApart) {
  HandScene hand;
  hand.quad({0, -5, 0}, {0, 5, 0}, {0, 5, 5}, {0, -5, 5});
  hand.quad({-0.004, -5, 0}, {-0.004, 5, 0}, {-0.004, 5, 5}, {-0.004, -5, 5});
  const auto paths = solve_all(hand, {3, -1, 2}, {3, 1, 2}, 1);
  ASSERT_EQ(paths.size(), 3u);
  EXPECT_NEAR(paths[1].length_m, std::sqrt(4 + 36.0), 1e-14);
  EXPECT_NEAR(paths[2].length_m, std::sqrt(4 + 6.008 * 6.008), 1e-14);
  // Both ends lie in the gap between the walls; paths are reflected to and fro.
  const FacetWorld world(hand.scene);
  for (const auto& path : solve_all(hand, {-0.001, -1, 2}, {-0.002, 1, 2}, 4)) expect_specular(world, path);
  EXPECT_EQ(solve_all(hand, {-0.001, -1, 2}, {-0.002, 1, 2}, 4).size(), 9u);
}

TEST(ImageMethodHardCase, N24_Grazing) {
  // 89.99 degrees of incidence: a height of 1.745 m over 2 x 10 km.
  HandScene hand;
  hand.ground(15'000.0);
  const double run = 10'000.0, height = run / std::tan(radians(89.99));
  const auto paths = solve_all(hand, {-run, 7.0, height}, {run, 7.0, height}, 1);
  ASSERT_EQ(paths.size(), 2u);
  EXPECT_LT(glm::length(paths[1].vertices[1] - dvec3(0, 7, 0)), 1e-9);
  EXPECT_NEAR(paths[1].length_m / (2 * std::hypot(run, height)), 1.0, 1e-12);
  // The reflection point is inside a facet that ends 1 um behind the point, and outside a facet that ends 1
  // um before it.
  for (const double edge : {1e-6, -1e-6}) {
    HandScene half;
    half.quad({-100, -100, 0}, {edge, -100, 0}, {edge, 100, 0}, {-100, 100, 0});
    EXPECT_EQ(solve_all(half, {-run, 7.0, height}, {run, 7.0, height}, 1).size(), edge > 0 ? 2u : 1u);
  }
}

TEST(ImageMethodHardCase, N25_AReceiverAloneIsTheSameAmongAHundred) {
  HandScene hand;
  hand.room({20, 15, 6});
  hand.quad({8, 5, 0}, {8, 9, 0}, {8, 9, 4}, {8, 5, 4});
  const FacetWorld world(hand.scene);
  const CandidateList candidates = exhaustive_candidates(world.facet_count(), 3);
  const dvec3 tx(3, 4, 2);
  const ImageTree tree(world, tx, candidates);
  RandomStream random(1, 0);
  std::vector<dvec3> receivers;
  std::vector<std::vector<GeometricPath>> together;
  for (int i = 0; i < 100; ++i)
    receivers.emplace_back(random.uniform(1, 19), random.uniform(1, 14), random.uniform(1, 5));
  for (const dvec3& rx : receivers) together.push_back(tree.solve(rx));
  for (const size_t i : {0u, 41u, 99u})
    EXPECT_TRUE(same_bits(together[i], ImageTree(world, tx, candidates).solve(receivers[i])));
}

TEST(ImageMethod, EitherEndMayBeTheSource) {
  HandScene hand;
  hand.room({20, 15, 6});
  hand.quad({8, 5, 0}, {8, 9, 0}, {8, 9, 4}, {8, 5, 4});
  const FacetWorld world(hand.scene);
  const CandidateList candidates = exhaustive_candidates(world.facet_count(), 3);
  const dvec3 tx(3, 4, 2), rx(16, 9, 3.3);
  const auto forward = ImageTree(world, tx, candidates).solve(rx);
  const auto backward = ImageTree(world, rx, candidates, Source::receiver).solve(tx);
  ASSERT_EQ(forward.size(), backward.size());
  ASSERT_GT(forward.size(), 60u);
  for (size_t i = 0; i < forward.size(); ++i) {
    EXPECT_EQ(forward[i].facets(), backward[i].facets());
    EXPECT_EQ(backward[i].vertices.front(), tx);
    EXPECT_EQ(backward[i].vertices.back(), rx);
    EXPECT_NEAR(forward[i].length_m, backward[i].length_m, 1e-12);
    for (size_t k = 0; k < forward[i].vertices.size(); ++k)
      EXPECT_LT(glm::length(forward[i].vertices[k] - backward[i].vertices[k]), 1e-12);
  }
}

TEST(ImageMethod, MovingBodiesAndSources) {
  HandScene hand;
  hand.ground(50.0);
  const uint32_t body = hand.body();
  // A plate that faces +x in the frame of its body.
  const uint32_t plate = hand.quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, 0, body);
  FacetWorld world(hand.scene);
  Motion motion;
  motion.pose = {{10, 0, 3}, orientation_from_yaw_pitch_roll(pi, 0, 0)};  // faces -x now
  motion.velocity = {-2, 0, 0};
  motion.angular_velocity = {0, 0, 0.5};
  world.move(body, motion);
  EXPECT_LT(glm::length(world.facet(plate).normal - dvec3(-1, 0, 0)), 1e-15);
  EXPECT_LT(glm::length(world.velocity(plate, {10, 1, 3}) - dvec3(-2.5, 0, 0)), 1e-15);
  EXPECT_EQ(world.velocity(0, {1, 2, 0}), dvec3(0.0));

  ImageTree tree(world, {0, -0.5, 3}, exhaustive_candidates(2, 1));
  auto paths = tree.solve({0, 0.5, 3});
  ASSERT_EQ(paths.size(), 3u);
  EXPECT_NEAR(paths[2].length_m, std::sqrt(400 + 1.0), 1e-12);
  motion.pose.position.x = 8;
  world.move(body, motion);
  tree.update({0, -0.5, 3.5});
  paths = tree.solve({0, 0.5, 3});
  ASSERT_EQ(paths.size(), 3u);
  EXPECT_NEAR(paths[2].length_m, std::sqrt(256 + 1.0 + 0.25), 1e-12);
  EXPECT_THROW(world.move(0, motion), ContractError);
}

TEST(FacetWorld, ACopyStaysWhereItIsUntilItTakesPoses) {
  HandScene hand;
  hand.ground(50.0);
  const uint32_t body = hand.body();
  const uint32_t plate = hand.quad({0, -1, -1}, {0, 1, -1}, {0, 1, 1}, {0, -1, 1}, 0, body);
  FacetWorld world(hand.scene);
  world.move(body, {{{10, 0, 3}, orientation_from_yaw_pitch_roll(0.3, 0, 0)}, {1, 0, 0}, {}, {}});
  FacetWorld snapshot = world;
  const dvec3 normal = world.facet(plate).normal, corner = world.corners(plate, 0)[0];
  world.move(body, {{{-4, 2, 3}, orientation_from_yaw_pitch_roll(1.3, 0, 0)}, {2, 0, 0}, {}, {}});
  EXPECT_EQ(snapshot.facet(plate).normal, normal);
  EXPECT_EQ(snapshot.corners(plate, 0)[0], corner);
  EXPECT_EQ(snapshot.velocity(plate, {10, 0, 3}), dvec3(1, 0, 0));
  EXPECT_NE(world.facet(plate).normal, normal);
  snapshot.take_poses(world);
  EXPECT_EQ(snapshot.facet(plate).normal, world.facet(plate).normal);
  EXPECT_EQ(snapshot.corners(plate, 0), world.corners(plate, 0));
  EXPECT_EQ(snapshot.velocity(plate, {0, 0, 0}), dvec3(2, 0, 0));
  EXPECT_EQ(snapshot.facet(0).offset, world.facet(0).offset);
  EXPECT_THROW(snapshot.take_poses(FacetWorld(hand.scene)), ContractError);
}

TEST(ImageMethod, NothingToHit) {
  HandScene hand;
  const auto paths = solve_all(hand, {0, 0, 1}, {3, 4, 1}, 3);
  ASSERT_EQ(paths.size(), 1u);
  EXPECT_EQ(paths[0].length_m, 5.0);
  EXPECT_TRUE(ImageTree(FacetWorld(hand.scene), dvec3(0.0), CandidateList{}).node_count() == 0);
}

}  // namespace
}  // namespace greatx::rf
