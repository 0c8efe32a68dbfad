// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the candidate search through walls and foliage.
#include <algorithm>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/geometry/geometry.h"
#include "rf/search/candidate_search.h"
#include "tests/rf/crossings_support.h"
#include "tests/rf/exhaustive.h"

namespace greatx::rf {
namespace {

using test::all_of;
using test::cross;
using test::TinyScene;
using testing::exhaustive_candidates;

using Sequences = std::set<std::vector<uint32_t>>;

CandidateSearchResult search(const scene::Scene& scene, const FacetKinds& kinds,
                             const CandidateSearchOptions& options, const dvec3& source) {
  scene::GpuScene gpu_scene(test::device(), scene, {});
  return CandidateSearch(gpu_scene, options, kinds).search(std::vector<Pose>(scene.bodies.size()), source);
}

Sequences walled_sequences(const CandidateList& list) {
  Sequences all;
  for (size_t i = 0; i < list.size(); ++i)
    all.insert(std::vector(list.sequence(i).begin(), list.sequence(i).end()));
  EXPECT_EQ(all.size(), list.size());
  return all;
}

/// Describes plates across the x axis: plate 0 at x = 0, plate 1 at x = 3, plate 2 at x = 6, ... Computes the
/// candidates between them from the definition.
struct Plates {
  FacetKinds kinds;
  uint32_t max_depth = 0, max_transmissions = 0;

  TinyScene scene() const {
    TinyScene tiny;
    for (size_t i = 0; i < kinds.size(); ++i) {
      const double x = 3.0 * static_cast<double>(i);
      tiny.quad({x, -40, -40}, {x, 40, -40}, {x, 40, 40}, {x, -40, 40});
    }
    return tiny;
  }
  /// Adds the candidates of a ray between the plates `before` and `before` + 1 that travels in the direction
  /// `step`.
  void follow(int before, int step, std::vector<uint32_t>& key, uint32_t met, uint32_t passed,
              Sequences& found) const {
    if (!key.empty()) found.insert(key);
    const int next = step > 0 ? before + 1 : before;
    if (met == max_depth || next < 0 || next >= static_cast<int>(kinds.size())) return;
    const FacetKind kind = kinds[static_cast<size_t>(next)];
    const int beyond = before + step;
    if (kind == FacetKind::foliage) return follow(beyond, step, key, met, passed, found);
    key.push_back(static_cast<uint32_t>(next));
    follow(before, -step, key, met + 1, passed, found);
    key.pop_back();
    if (kind == FacetKind::wall && passed < max_transmissions)
      follow(beyond, step, key, met + 1, passed + 1, found);
  }
  /// Returns the number of ways of a ray that never leaves sideways. `fresh` tells whether the ray has been
  /// reflected since it last passed a wall.
  uint32_t ways(int before, int step, uint32_t met, uint32_t passed, bool fresh) const {
    const int next = step > 0 ? before + 1 : before;
    if (met == max_depth || next < 0 || next >= static_cast<int>(kinds.size())) return fresh ? 1 : 0;
    const FacetKind kind = kinds[static_cast<size_t>(next)];
    if (kind == FacetKind::foliage) return ways(before + step, step, met, passed, fresh);
    const uint32_t reflected = ways(before, -step, met + 1, passed, true);
    if (kind != FacetKind::wall || passed == max_transmissions) return reflected;
    return reflected + ways(before + step, step, met + 1, passed + 1, false);
  }
  Sequences expected(int before) const {
    Sequences found;
    std::vector<uint32_t> key;
    follow(before, 1, key, 0, 0, found);
    follow(before, -1, key, 0, 0, found);
    return found;
  }
};

TEST(CandidateWalls, WaysAreTheOrdersThatEndWithAReflection) {
  EXPECT_EQ(ways_per_ray(1, 9), 1u);
  EXPECT_EQ(ways_per_ray(3, 0), 1u);
  EXPECT_EQ(ways_per_ray(2, 1), 2u);
  EXPECT_EQ(ways_per_ray(3, 1), 3u);  // RRR, TRR, RTR
  EXPECT_EQ(ways_per_ray(3, 2), 4u);  // and also TTR
  EXPECT_EQ(ways_per_ray(5, 3), 1u + 4u + 6u + 4u);
  EXPECT_EQ(ways_per_ray(9, 99), 256u);
  EXPECT_EQ(ways_per_ray(70, 40), ~0u);
}

TEST(CandidateWalls, BetweenPlatesBothWaysAreFollowed) {
  RandomStream random(4, 40);
  for (int trial = 0; trial < 12; ++trial) {
    Plates plates;
    for (int i = 0; i < 6; ++i) plates.kinds.push_back(static_cast<FacetKind>(random.below(3)));
    plates.max_depth = 1 + random.below(5);
    plates.max_transmissions = random.below(4);
    CandidateSearchOptions options;
    options.rays = 4096;
    options.max_depth = plates.max_depth;
    options.max_transmissions = plates.max_transmissions;
    const int before = static_cast<int>(random.below(7)) - 1;
    const CandidateSearchResult result =
        search(plates.scene().build(), plates.kinds, options, {3.0 * before + 1.3, 0, 0});
    EXPECT_TRUE(result.list.is_canonical());
    EXPECT_EQ(result.overflow(), 0u);
    EXPECT_EQ(walled_sequences(result.list), plates.expected(before)) << "trial " << trial;
  }
}

TEST(CandidateWalls, WithoutTransmissionsWallsAreOpaque) {
  TinyScene tiny;
  tiny.box({0, 0, 0}, {9, 7, 5}).box({2, 2, 0.5}, {6, 5, 3});
  const scene::Scene scene = tiny.build();
  CandidateSearchOptions options;
  options.rays = 1u << 13;
  const dvec3 source(1.1, 1.3, 1.7);
  const CandidateList opaque = search(scene, {}, options, source).list;
  EXPECT_EQ(search(scene, all_of(FacetKind::wall, scene), options, source).list, opaque);
  options.max_transmissions = 2;
  EXPECT_EQ(search(scene, all_of(FacetKind::opaque, scene), options, source).list, opaque);
  const CandidateSearchResult through = search(scene, all_of(FacetKind::wall, scene), options, source);
  // All sequences without passed walls are found with passed walls, too.
  const Sequences more = walled_sequences(through.list), fewer = walled_sequences(opaque);
  EXPECT_TRUE(std::includes(more.begin(), more.end(), fewer.begin(), fewer.end()));
  EXPECT_GT(more.size(), fewer.size());
}

/// Returns, for each target, the reflecting facets of the paths from `source` with at most `depth`
/// interactions and `transmissions` walls.
std::vector<Sequences> paths(const scene::Scene& scene, const FacetKinds& kinds, const CandidateList& list,
                             const dvec3& source, const std::vector<dvec3>& targets, uint32_t depth,
                             uint32_t transmissions, size_t& through_walls) {
  const FacetWorld world(scene);
  const ImageTree tree(world, source, list);
  std::vector<Sequences> found;
  for (const dvec3& target : targets) {
    const std::vector<GeometricPath> candidates = tree.solve(target);
    std::vector<Segment> segments;
    for (const GeometricPath& path : candidates) {
      const FacetSequence facets = path.facets();
      for (size_t i = 0; i <= facets.size(); ++i) {
        segments.push_back(test::segment(path.vertices[i], path.vertices[i + 1], transmissions));
        if (i > 0) segments.back().facet_a = facets[i - 1];
        if (i < facets.size()) segments.back().facet_b = facets[i];
      }
    }
    const std::vector<Crossing> crossings = cross(scene, kinds, segments);
    size_t next = 0;
    found.emplace_back();
    for (const GeometricPath& path : candidates) {
      const FacetSequence facets = path.facets();
      bool clear = true;
      size_t walls = 0;
      for (size_t i = 0; i <= facets.size(); ++i, ++next) {
        clear &= !crossings[next].blocked;
        walls += crossings[next].walls.size();
      }
      if (!clear || walls > transmissions || facets.size() + walls > depth) continue;
      found.back().insert(std::vector<uint32_t>(facets.begin(), facets.end()));
      through_walls += walls > 0 && !facets.empty();
    }
  }
  return found;
}

TEST(CandidateWalls, ABoxInABoxAsTheExhaustiveSearchFindsIt) {
  TinyScene tiny;
  tiny.box({0, 0, 0}, {14, 10, 6}).box({4, 3, 0.5}, {9, 7, 4});
  const scene::Scene scene = tiny.build();
  FacetKinds kinds(12, FacetKind::opaque);
  std::fill(kinds.begin() + 6, kinds.end(), FacetKind::wall);
  RandomStream random(4, 41);
  std::vector<dvec3> targets;
  for (int i = 0; i < 12; ++i)
    targets.push_back({random.uniform(0.3, 13.7), random.uniform(0.3, 9.7), random.uniform(0.3, 5.7)});
  for (int i = 0; i < 6; ++i)
    targets.push_back({random.uniform(4.3, 8.7), random.uniform(3.3, 6.7), random.uniform(0.8, 3.7)});
  CandidateSearchOptions options;
  options.rays = 1u << 17;
  options.max_depth = 3;
  options.max_transmissions = 2;
  // The sources are outside and inside the inner box.
  for (const dvec3& source : {dvec3(2.1, 1.3, 1.7), dvec3(6.2, 4.4, 2.9)}) {
    CandidateList list = search(scene, kinds, options, source).list;
    list.add({});
    list.make_canonical();
    const CandidateList all = exhaustive_candidates(12, 3);
    EXPECT_LT(list.size(), all.size() / 2);
    size_t through = 0, reference_through = 0;
    const auto found = paths(scene, kinds, list, source, targets, 3, 2, through);
    const auto expected = paths(scene, kinds, all, source, targets, 3, 2, reference_through);
    EXPECT_EQ(through, reference_through);
    EXPECT_GT(through, 100u);
    for (size_t i = 0; i < targets.size(); ++i) EXPECT_EQ(found[i], expected[i]) << "target " << i;
  }
}

TEST(CandidateWalls, WaysBeyondTheBoundAreCounted) {
  Plates plates;
  plates.kinds = FacetKinds(6, FacetKind::wall);
  plates.max_depth = 5;
  plates.max_transmissions = 3;
  CandidateSearchOptions options;
  options.rays = 1000;
  options.max_depth = 5;
  options.max_transmissions = 3;
  const scene::Scene scene = plates.scene().build();
  const CandidateSearchResult whole = search(scene, plates.kinds, options, {7.3, 0, 0});
  EXPECT_EQ(whole.left_out, 0u);
  const uint32_t most = std::max(plates.ways(2, 1, 0, 0, false), plates.ways(2, -1, 0, 0, false));
  EXPECT_LE(most, ways_per_ray(5, 3));
  options.max_ways = most;
  EXPECT_EQ(search(scene, plates.kinds, options, {7.3, 0, 0}).left_out, 0u);
  uint64_t before = 0;
  for (const uint32_t ways : {most - 1, most / 2, 2u, 1u}) {
    options.max_ways = ways;
    const CandidateSearchResult part = search(scene, plates.kinds, options, {7.3, 0, 0});
    EXPECT_GT(part.left_out, before) << ways;
    EXPECT_EQ(part.overflow(), part.left_out);
    EXPECT_LE(part.found, whole.found);
    before = part.left_out;
  }
  // Each ray keeps one way, and some rays leave the plates sideways.
  EXPECT_LE(before, uint64_t{most - 1} * options.rays);
  EXPECT_GT(before, options.rays);
  options.max_ways = 1;
  options.capacity = 2;
  const CandidateSearchResult both = search(scene, plates.kinds, options, {7.3, 0, 0});
  EXPECT_EQ(both.list.size(), 2u);
  EXPECT_EQ(both.overflow(), both.found - 2 + before);
}

TEST(CandidateWalls, InPartsItIsTheSame) {
  TinyScene tiny;
  tiny.box({0, 0, 0}, {9, 7, 5}).box({2, 2, 0.5}, {6, 5, 3});
  const scene::Scene scene = tiny.build();
  const FacetKinds kinds = all_of(FacetKind::wall, scene);
  const dvec3 source(1.1, 1.3, 1.7);
  CandidateSearchOptions options;
  options.rays = 5000;
  options.max_depth = 4;
  options.max_transmissions = 3;
  options.max_ways = 2;
  const CandidateSearchResult at_once = search(scene, kinds, options, source);
  EXPECT_GT(at_once.left_out, 0u);
  for (const uint64_t bytes : {1u, 4096u, 100000u}) {
    if (bytes == 1u) options.rays = 5;
    options.part_bytes = bytes;
    CandidateSearchOptions whole = options;
    whole.part_bytes = 64u << 20;
    const CandidateSearchResult expected = search(scene, kinds, whole, source),
                                in_parts = search(scene, kinds, options, source);
    EXPECT_EQ(in_parts.list, expected.list) << bytes;
    EXPECT_EQ(in_parts.found, expected.found);
    EXPECT_EQ(in_parts.left_out, expected.left_out);

    scene::GpuScene gpu_scene(test::device(), scene, {});
    CandidateSearch pass(gpu_scene, options, kinds);
    gpu::TickRing ring(test::device(), 1, 1u << 16, 1u << 16);
    gpu::TickSlot& slot = ring.begin();
    gpu_scene.record_update(slot, std::vector{Pose{}});
    const CandidateSearch::Pending pending = pass.record(slot, source);
    ring.submit(slot);
    ring.wait(slot);
    EXPECT_EQ(pass.collect(pending).list, expected.list) << bytes;
    EXPECT_EQ(pass.collect(pending).left_out, expected.left_out);
    options.rays = 5000;
  }
}

TEST(CandidateWalls, AWallThatIsThereTwiceIsPassedOnce) {
  TinyScene tiny;
  for (const double x : {7.3, 7.3, 9.0}) tiny.quad({x, -20, -20}, {x, 20, -20}, {x, 20, 20}, {x, -20, 20});
  CandidateSearchOptions options;
  options.rays = 4096;
  options.max_depth = 2;
  options.max_transmissions = 1;
  const FacetKinds kinds{FacetKind::wall, FacetKind::wall, FacetKind::opaque};
  for (const double x : {5.0, 8.0})
    EXPECT_TRUE(walled_sequences(search(tiny.build(), kinds, options, {x, 0, 0}).list).contains({2})) << x;
}

TEST(CandidateWalls, FourMillimetresApartBothArePassed) {
  for (const double shift : {0.0, 300.0, 10000.0}) {
    TinyScene tiny;
    for (const double x : {0.0, 0.004, 3.0})
      tiny.quad({shift + x, shift - 20, -20}, {shift + x, shift + 20, -20}, {shift + x, shift + 20, 20},
                {shift + x, shift - 20, 20});
    CandidateSearchOptions options;
    options.rays = 4096;
    options.max_transmissions = 2;
    const FacetKinds kinds{FacetKind::wall, FacetKind::wall, FacetKind::opaque};
    const Sequences found =
        walled_sequences(search(tiny.build(), kinds, options, {shift - 2, shift, 0}).list);
    EXPECT_TRUE(found.contains({2})) << shift;
    EXPECT_TRUE(found.contains({1})) << shift;
    EXPECT_TRUE(found.contains({0})) << shift;
    // Ten kilometres from the origin, a ray continues some millimetres behind a wall because of rounding in
    // fp32. It may count two walls as one; then the search finds more than it needs to.
    options.max_transmissions = 1;
    if (shift < 1000.0) {
      EXPECT_FALSE(
          walled_sequences(search(tiny.build(), kinds, options, {shift - 2, shift, 0}).list).contains({2}));
    }
  }
}

}  // namespace
}  // namespace greatx::rf
