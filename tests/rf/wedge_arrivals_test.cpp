// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that the places beside the edges lose no wedge at which a path may bend, and that they sort out most
// of the others.
#include "rf/paths/wedge_arrivals.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "rf/edges/diffraction.h"
#include "rf/facets/facet_world.h"
#include "rf/paths/path_solver.h"
#include "rf/search/beam_search.h"
#include "tests/rf/random_scene.h"

namespace greatx::rf {
namespace {

/// A random scene with everything that leads from its transmitter to its wedges.
struct Yard {
  explicit Yard(uint64_t seed, const dvec3& shift = dvec3(0.0))
      : draw(testing::SceneDraw(seed).draw(static_cast<uint32_t>(seed % 5), 12)),
        scene(testing::build(draw, {.shift = shift})) {
    RadioEffects effects;
    effects.diffraction = true;
    model.emplace(scene, 3.5e9, effects);
    BeamSearchOptions search;
    search.max_depth = 3;
    source = draw.transmitter + shift;
    list = BeamSearch(model->facets, model->kinds, model->wedges, search).search(source).list;
  }

  testing::RandomScene draw;
  scene::Scene scene;
  std::optional<RadioModel> model;
  dvec3 source{0.0};
  CandidateList list;
};

/// Returns the sequences of a wedge that bend towards `after`, by the definition alone.
std::vector<uint32_t> bending(const Yard& yard, const ImageTree& tree, uint32_t index, const dvec3& after,
                              uint32_t most_depth) {
  const scene::Wedge& wedge = yard.model->wedges[index];
  std::vector<uint32_t> sequences;
  for (uint32_t i = 0; i < yard.list.size(); ++i) {
    const auto facets = yard.list.sequence(i);
    const auto wedges = yard.list.wedges_of(i);
    if (facets.size() > most_depth || !std::ranges::binary_search(wedges, index)) continue;
    if (!facets.empty() && (facets.back() == wedge.facet_0 || facets.back() == wedge.facet_n)) continue;
    if (keller_point(posed(wedge, yard.model->facets), tree.image(i), after)) sequences.push_back(i);
  }
  return sequences;
}

class WedgeArrivalsOf : public ::testing::TestWithParam<double> {};

TEST_P(WedgeArrivalsOf, RandomScenesHoldEveryBendAndFewMore) {
  size_t all = 0, kept = 0, needed = 0;
  for (uint64_t seed = 0; seed < 10; ++seed) {
    const dvec3 shift(GetParam(), -GetParam(), 0.0);
    const Yard yard(seed, shift);
    const ImageTree tree(yard.model->facets, yard.source, yard.list);
    WedgeArrivals arrivals(yard.list, yard.model->wedges);
    arrivals.place(tree, yard.model->wedges);
    EXPECT_TRUE(std::ranges::is_sorted(arrivals.wedges()));
    std::vector<uint32_t> found;
    for (const dvec3& receiver : yard.draw.receivers)
      for (const uint32_t wedge : arrivals.wedges())
        for (const uint32_t most_depth : {0u, 2u}) {
          arrivals.joined(wedge, receiver + shift, most_depth, 0.0, found);
          const auto expected = bending(yard, tree, wedge, receiver + shift, most_depth);
          ASSERT_TRUE(std::ranges::is_sorted(found));
          EXPECT_TRUE(std::ranges::includes(found, expected)) << "seed " << seed << ", wedge " << wedge;
          for (const uint32_t sequence : found) EXPECT_LE(yard.list.sequence(sequence).size(), most_depth);
          if (most_depth == 2)
            all += arrivals.of(wedge).size(), kept += found.size(), needed += expected.size();
        }
  }
  EXPECT_GT(needed, 1000u);
  EXPECT_LE(kept, needed + needed / 100);
  EXPECT_LT(kept, all);
}

INSTANTIATE_TEST_SUITE_P(NearAndFar, WedgeArrivalsOf, ::testing::Values(0.0, 1e5));

TEST(WedgeArrivals, FollowTheImagesOfASourceThatMoves) {
  const Yard yard(1);
  const dvec3 moved = yard.source + dvec3(0.5, -0.25, 0.125);
  ImageTree tree(yard.model->facets, yard.source, yard.list);
  WedgeArrivals arrivals(yard.list, yard.model->wedges), anew(yard.list, yard.model->wedges);
  arrivals.place(tree, yard.model->wedges);
  tree.update(moved);
  arrivals.place(tree, yard.model->wedges);
  anew.place(tree, yard.model->wedges);
  std::vector<uint32_t> found, expected;
  size_t count = 0;
  for (const uint32_t wedge : arrivals.wedges()) {
    arrivals.joined(wedge, yard.draw.receivers[0], 3, 0.0, found);
    anew.joined(wedge, yard.draw.receivers[0], 3, 0.0, expected);
    EXPECT_EQ(found, expected) << wedge;
    count += found.size();
  }
  EXPECT_GE(count, 10u);
}

TEST(WedgeArrivals, ThreadsChangeNoPath) {
  const Yard yard(2);
  PathLimits limits;
  limits.max_depth = 3;
  PathSolver solver(*yard.model, limits);
  solver.set_candidates(yard.list, yard.source, Source::transmitter);
  for (const dvec3& receiver : yard.draw.receivers) {
    const EndState end{.position = receiver};
    const LinkGeometry one = solver.geometry(end, 1), three = solver.geometry(end, 3);
    ASSERT_EQ(one.paths.size(), three.paths.size());
    for (size_t i = 0; i < one.paths.size(); ++i) {
      EXPECT_EQ(one.paths[i].interactions, three.paths[i].interactions);
      EXPECT_EQ(one.paths[i].vertices, three.paths[i].vertices);
    }
  }
}

}  // namespace
}  // namespace greatx::rf
