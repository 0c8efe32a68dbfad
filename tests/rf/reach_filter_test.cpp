// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/reach_filter.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/geometry/geometry.h"
#include "tests/rf/exhaustive.h"
#include "tests/rf/scenes.h"

namespace greatx::rf {
namespace {

using testing::exhaustive_candidates;

/// Returns whether the line from the image to the point passes the window, in fp64.
bool passes(const ImageWindow& image, double distance, double u, double v) {
  if (image.distance * distance >= 0.0) return false;
  const double t = image.distance / (image.distance - distance);
  const double at_u = image.u + t * (u - image.u), at_v = image.v + t * (v - image.v);
  return at_u >= image.min_u && at_u <= image.max_u && at_v >= image.min_v && at_v <= image.max_v;
}

/// Draws a number with a magnitude from 1e-7 to 1e5 and either sign, or sometimes 0.
double draw(RandomStream& random) {
  const double magnitude = std::pow(10.0, random.uniform(-7.0, 5.0));
  return random.below(50) == 0 ? 0.0 : random.below(2) == 0 ? magnitude : -magnitude;
}

std::vector<ImageWindow> draw_images(RandomStream& random, uint32_t groups, size_t count) {
  std::vector<ImageWindow> images;
  for (size_t i = 0; i < count; ++i) {
    ImageWindow image{random.below(groups), draw(random), draw(random), draw(random)};
    image.min_u = draw(random), image.min_v = draw(random);
    image.max_u = image.min_u + std::abs(draw(random));
    image.max_v = image.min_v + std::abs(draw(random));
    images.push_back(image);
  }
  return images;
}

TEST(ReachFilter, LosesNothingAndKeepsLittleMore) {
  constexpr uint32_t groups = 7;
  RandomStream random(5, 0x66696c74u, 0);
  const std::vector<ImageWindow> images = draw_images(random, groups, 3000);
  ReachFilter filter;
  filter.build(images, groups);
  size_t passing = 0, kept = 0;
  for (int k = 0; k < 300; ++k) {
    const uint32_t group = random.below(groups);
    const double distance = draw(random), u = draw(random), v = draw(random);
    std::vector<uint32_t> indices;
    filter.collect(group, distance, u, v, indices);
    for (uint32_t i = 0; i < images.size(); ++i) {
      if (images[i].group != group || !passes(images[i], distance, u, v)) continue;
      ++passing;
      EXPECT_TRUE(std::ranges::find(indices, i) != indices.end()) << i << " from " << distance;
    }
    for (const uint32_t i : indices) EXPECT_EQ(images[i].group, group);
    kept += indices.size();
  }
  EXPECT_GT(passing, 1000u);
  EXPECT_LT(static_cast<double>(kept), 1.05 * static_cast<double>(passing));
}

TEST(ReachFilter, LosesNothingOnTheWindowsBorder) {
  RandomStream random(6, 0x66696c74u, 0);
  size_t passing = 0;
  for (int k = 0; k < 20000; ++k) {
    std::vector<ImageWindow> images = draw_images(random, 1, 1);
    ImageWindow& image = images[0];
    if (image.distance == 0.0) continue;
    // The line from the image to this point meets the corner of the window to the precision of fp64.
    const double beyond = std::pow(10.0, random.uniform(-3.0, 3.0));
    const double u = image.max_u + beyond * (image.max_u - image.u),
                 v = image.min_v + beyond * (image.min_v - image.v);
    const double distance = -beyond * image.distance;
    if (!passes(image, distance, u, v)) continue;
    ++passing;
    ReachFilter filter;
    filter.build(images, 1);
    std::vector<uint32_t> indices;
    filter.collect(0, distance, u, v, indices);
    EXPECT_EQ(indices.size(), 1u) << k;
  }
  EXPECT_GT(passing, 2000u);
}

TEST(ReachFilter, NothingIsSeenFromThePlaneOrFromTheImagesOwnSide) {
  ReachFilter filter;
  const std::vector<ImageWindow> images{{1, -2.0, 0.0, 0.0, -1.0, 1.0, -1.0, 1.0},
                                        {1, 0.0, 0.0, 0.0, -1.0, 1.0, -1.0, 1.0}};
  filter.build(images, 3);
  const auto seen = [&](uint32_t group, double distance) {
    std::vector<uint32_t> indices;
    filter.collect(group, distance, 0.0, 0.0, indices);
    return indices;
  };
  EXPECT_EQ(seen(1, 3.0), std::vector<uint32_t>{0});
  EXPECT_TRUE(seen(1, 0.0).empty());
  EXPECT_TRUE(seen(1, -3.0).empty());
  EXPECT_TRUE(seen(0, 3.0).empty());
  EXPECT_TRUE(seen(2, 3.0).empty());
}

// The filter in fp32 changes no path: solve() uses it, reach() does not.
TEST(ImageTree, SolvesWhatEachSequenceReaches) {
  testing::HandScene hand;
  hand.room({9.0, 7.0, 3.0});
  hand.quad({2, 2, 0.5}, {4, 2.5, 0.5}, {4, 2.5, 2.0}, {2, 2, 2.0});
  const FacetWorld world(hand.scene);
  const CandidateList candidates = exhaustive_candidates(world.facet_count(), 4);
  ImageTree tree(world, {1.1, 1.3, 1.7}, candidates);
  RandomStream random(7, 0x66696c74u, 0);
  size_t paths = 0;
  for (int k = 0; k < 30; ++k) {
    const double x = random.uniform(0.0, 9.0), y = random.uniform(0.0, 7.0), z = random.uniform(0.0, 3.0);
    const dvec3 target(x, y, z);
    if (k == 15) tree.update({6.1, 5.3, 0.4});
    const std::vector<GeometricPath> solved = tree.solve(target);
    std::vector<FacetSequence> reached;
    for (size_t i = 0; i < tree.sequence_count(); ++i) {
      GeometricPath path;
      if (!tree.reach(i, target, path)) continue;
      const auto sequence = candidates.sequence(i);
      reached.emplace_back(sequence.begin(), sequence.end());
    }
    ASSERT_EQ(solved.size(), reached.size()) << k;
    for (size_t i = 0; i < solved.size(); ++i) EXPECT_EQ(solved[i].facets(), reached[i]);
    paths += solved.size();
  }
  EXPECT_GT(paths, 1000u);
}

}  // namespace
}  // namespace greatx::rf
