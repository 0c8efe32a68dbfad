// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks on the device that absent facets (foliage while its effect is off) have no influence.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rf/search/candidate_search.h"
#include "tests/rf/crossings_support.h"

namespace greatx::rf {
namespace {

using test::cross;
using test::segment;
using test::TinyScene;

/// Returns a mirror and a crown in front of it. The facets are numbered in this order.
TinyScene mirror_behind_a_box() {
  TinyScene tiny;
  tiny.object("mirror").quad({0, -9, -9}, {0, 9, -9}, {0, 9, 9}, {0, -9, 9});
  tiny.object("crown").box({2, -5, -5}, {6, 5, 5});
  return tiny;
}
FacetKinds kinds_with(FacetKind crown) {
  FacetKinds kinds(7, crown);
  kinds[0] = FacetKind::opaque;
  return kinds;
}

TEST(AbsentFacets, StandInNobodysWay) {
  const scene::Scene scene = mirror_behind_a_box().build();
  const std::vector<Segment> segments{segment({9, 0, 0}, {1, 0, 0}),    // through the crown
                                      segment({4, 0, 0}, {1, 0, 0}),    // out of the crown
                                      segment({9, 0, 0}, {-1, 0, 0}),   // through the crown and the mirror
                                      segment({2, -9, 0}, {2, 9, 0})};  // in the plane of a face of the crown
  std::vector<bool> blocked;
  for (const Crossing& crossing : cross(scene, kinds_with(FacetKind::absent), segments)) {
    blocked.push_back(crossing.blocked);
    EXPECT_TRUE(crossing.walls.empty());
    EXPECT_EQ(crossing.foliage_m, 0.0);
  }
  EXPECT_THAT(blocked, ::testing::ElementsAre(false, false, true, false));
  // As walls the facets block, as foliage they attenuate.
  EXPECT_THAT(cross(scene, kinds_with(FacetKind::wall), segments)[0].blocked, true);
  EXPECT_NEAR(cross(scene, kinds_with(FacetKind::foliage), segments)[0].foliage_m, 4.0, 1e-3);
}

TEST(AbsentFacets, RaysMeetWhatIsBehindThem) {
  const scene::Scene scene = mirror_behind_a_box().build();
  scene::GpuScene gpu_scene(test::device(), scene, {});
  const auto sequences = [&](FacetKind crown) {
    CandidateSearchOptions options;
    options.rays = 1 << 12;
    options.max_depth = 2;
    CandidateSearch search(gpu_scene, options, kinds_with(crown));
    const CandidateList list = search.search(std::vector{Pose{}}, {9, 0.3, 0.2}).list;
    std::vector<std::vector<uint32_t>> all;
    for (size_t i = 0; i < list.size(); ++i)
      if (!list.sequence(i).empty()) all.emplace_back(list.sequence(i).begin(), list.sequence(i).end());
    return all;
  };
  EXPECT_THAT(sequences(FacetKind::absent), ::testing::ElementsAre(std::vector<uint32_t>{0}));
  EXPECT_THAT(sequences(FacetKind::foliage), ::testing::ElementsAre(std::vector<uint32_t>{0}));
  EXPECT_THAT(sequences(FacetKind::opaque), ::testing::Contains(std::vector<uint32_t>{6}));
}

}  // namespace
}  // namespace greatx::rf
