// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that a beam search of a town does not depend on the number of threads, and how its work grows.
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/search/beam_search.h"
#include "scene/description/wedges.h"
#include "tests/rf/search_scenes.h"

namespace greatx::rf {
namespace {

using rf::testing::SearchScene;

/// Returns a town of `blocks` x `blocks` houses, 30 m apart, on a ground that is one facet of small tiles.
/// The source stands over a crossing, lower than most roofs.
SearchScene town(int blocks) {
  constexpr double pitch_m = 30.0, tile_m = 6.0;
  const double half_m = 0.5 * pitch_m * blocks;
  const int tiles = static_cast<int>(2.0 * half_m / tile_m);
  SearchScene made;
  std::vector<scene::FacetTriangle> ground;
  for (int i = 0; i < tiles; ++i)
    for (int j = 0; j < tiles; ++j) {
      const double x = tile_m * i - half_m, y = tile_m * j - half_m;
      const dvec3 a(x, y, 0.0), b(x + tile_m, y, 0.0), c(x + tile_m, y + tile_m, 0.0), d(x, y + tile_m, 0.0);
      ground.push_back({{a, b, c}});
      ground.push_back({{a, c, d}});
    }
  made.hand.facet(ground, 0, 0);
  RandomStream random(5, 0x746f776eu);
  for (int i = 0; i < blocks; ++i)
    for (int j = 0; j < blocks; ++j) {
      const double x = pitch_m * i - half_m, y = pitch_m * j - half_m;
      made.box({x + 5.0, y + 5.0, 0.0}, {x + 25.0, y + 25.0, random.uniform(8.0, 20.0)});
    }
  made.source = {0.3, -0.4, 9.0};
  made.depth = 2;
  return made;
}

BeamSearchResult search(const SearchScene& scene, uint32_t threads) {
  const FacetWorld world(scene.scene());
  const FacetKinds kinds = scene.facet_kinds();
  BeamSearchOptions options = scene.options();
  options.threads = threads;
  const std::vector<scene::Wedge> wedges = scene::find_wedges(scene.scene());
  return BeamSearch(world, kinds, wedges, options).search(scene.source);
}

TEST(BeamGrowth, TheNumberOfThreadsChangesNothing) {
  const SearchScene scene = town(12);
  const BeamSearchResult one = search(scene, 1);
  for (const uint32_t threads : {2u, 5u}) {
    const BeamSearchResult many = search(scene, threads);
    EXPECT_TRUE(one.list == many.list) << threads;  // with windows and wedges
    EXPECT_EQ(one.found, many.found);
    EXPECT_EQ(one.cells, many.cells);
    EXPECT_EQ(one.work, many.work);
    ASSERT_EQ(one.beams.size(), many.beams.size());
    for (size_t i = 0; i < one.beams.size(); ++i)
      EXPECT_TRUE(one.beams[i].image == many.beams[i].image && one.beams[i].center == many.beams[i].center &&
                  one.beams[i].half_a == many.beams[i].half_a &&
                  one.beams[i].half_b == many.beams[i].half_b && one.beams[i].walls == many.beams[i].walls)
          << threads << " threads, beam " << i;
  }
}

/// Work is counted (polygons projected, pairs compared), so that no clock decides. It grows 6.1 times, since
/// the beams of the ground see the whole town near the horizon (docs/channel.md, what a search costs). A
/// larger figure is a step back.
TEST(BeamGrowth, WorkPerSequenceGrowsNoFasterThanItDid) {
  const auto per_sequence = [](int blocks) {
    const BeamSearchResult found = search(town(blocks), 0);
    return static_cast<double>(found.work) / static_cast<double>(found.found);
  };
  const double small = per_sequence(8), large = per_sequence(32);
  EXPECT_LT(large, 6.5 * small) << small << " " << large;
}

}  // namespace
}  // namespace greatx::rf
