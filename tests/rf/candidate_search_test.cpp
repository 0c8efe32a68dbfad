// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "rf/geometry/geometry.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using ::testing::ElementsAre;

CandidateSearchResult search(const scene::Scene& scene, const CandidateSearchOptions& options,
                             const dvec3& source, const std::vector<Pose>& bodies = {Pose{}},
                             const FacetKinds& kinds = {}) {
  gpu::Device& device = test::device();
  scene::GpuScene gpu_scene(device, scene, {});
  CandidateSearch pass(gpu_scene, options, kinds);
  gpu::TickRing ring(device, 1, 1u << 16, 1u << 20);
  gpu::TickSlot& slot = ring.begin();
  gpu_scene.record_update(slot, bodies);
  const CandidateSearch::Pending pending = pass.record(slot, source);
  ring.submit(slot);
  ring.wait(slot);
  return pass.collect(pending);
}

std::vector<std::vector<uint32_t>> sequences(const CandidateList& list) {
  std::vector<std::vector<uint32_t>> all;
  for (size_t i = 0; i < list.size(); ++i) all.emplace_back(list.sequence(i).begin(), list.sequence(i).end());
  return all;
}

/// Size of a room with normals outwards. Rays inside meet the backs of its facets, which reflect as well.
const dvec3 room_size(7.0, 5.0, 3.0);
scene::Scene room(const dvec3& corner = dvec3(0.0), const dvec3& origin = dvec3(0.0)) {
  TinyScene tiny;
  tiny.box(corner, corner + room_size);
  return tiny.build(origin);
}

TEST(FibonacciLattice, IsUniformUnitAndTheSameEveryTime) {
  constexpr uint32_t count = 10000;
  const std::vector<vec3> lattice = fibonacci_lattice(count);
  ASSERT_EQ(lattice.size(), count);
  EXPECT_EQ(lattice, fibonacci_lattice(count));
  dvec3 sum(0.0);
  for (const vec3& direction : lattice) {
    ASSERT_NEAR(glm::length(direction), 1.0f, 1e-6f);
    sum += dvec3(direction);
  }
  EXPECT_LT(glm::length(sum), 1.0);
  // Caps of 1 % of the sphere (cos = 0.98) hold 1 % of the points.
  RandomStream random(1, 1);
  for (int i = 0; i < 50; ++i) {
    const double z = random.uniform(-1, 1), azimuth = random.uniform(0, 6.28), r = std::sqrt(1 - z * z);
    const vec3 axis(r * std::cos(azimuth), r * std::sin(azimuth), z);
    const auto inside = std::count_if(lattice.begin(), lattice.end(),
                                      [&](const vec3& d) { return glm::dot(d, axis) > 0.98f; });
    EXPECT_NEAR(static_cast<double>(inside), 100.0, 8.0);
  }
  // Neighbours in the order are neighbours on the sphere: the mean step is a few spacings of sqrt(4 pi / n) =
  // 0.035 rad.
  double steps = 0.0;
  for (uint32_t i = 1; i < count; ++i) steps += glm::length(lattice[i] - lattice[i - 1]);
  EXPECT_LT(steps / count, 0.07);
}

TEST(CandidatesFromKeys, PrefixesOnceInCanonicalOrder) {
  constexpr uint32_t n = shared::rf_none;
  const std::vector<uint32_t> keys{5, 2, n, 1, n, n, 5, 2, 7, n, n, n, 1, n, n, 5, 3, 5, 0, 9, n, 5, 2, 7};
  const CandidateSearchResult result = candidates_from_keys(keys, 3, 100);
  EXPECT_THAT(sequences(result.list),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(5), ElementsAre(0, 9),
                          ElementsAre(5, 2), ElementsAre(5, 3), ElementsAre(5, 2, 7), ElementsAre(5, 3, 5)));
  EXPECT_TRUE(result.list.is_canonical());
  EXPECT_EQ(result.found, 8u);
  EXPECT_EQ(result.overflow(), 0u);
}

TEST(CandidatesFromKeys, OrderOfTheRaysDoesNotMatter) {
  RandomStream random(3, 1);
  std::vector<std::vector<uint32_t>> rays;
  for (int i = 0; i < 3000; ++i) {
    std::vector<uint32_t> key(3, shared::rf_none);
    for (uint32_t d = 0; d < random.below(4); ++d) key[d] = random.below(12);
    rays.push_back(key);
  }
  const auto flat = [&] {
    std::vector<uint32_t> keys;
    for (const auto& key : rays) keys.insert(keys.end(), key.begin(), key.end());
    return keys;
  };
  const CandidateSearchResult first = candidates_from_keys(flat(), 3, 1u << 20);
  for (size_t i = rays.size() - 1; i > 0; --i)
    std::swap(rays[i], rays[random.below(static_cast<uint32_t>(i + 1))]);
  EXPECT_EQ(first.list, candidates_from_keys(flat(), 3, 1u << 20).list);
  // The reference sorts every prefix with the list's own function.
  CandidateList reference;
  for (const auto& key : rays)
    for (uint32_t d = 1; d <= 3 && key[d - 1] != shared::rf_none; ++d) reference.add(std::span(key).first(d));
  reference.make_canonical();
  EXPECT_EQ(first.list, reference);
}

TEST(CandidatesFromKeys, WhatIsBeyondTheCapacityIsCountedDeepestFirst) {
  constexpr uint32_t n = shared::rf_none;
  const std::vector<uint32_t> keys{4, 2, 1, n, 2, 1, 3, n};
  const CandidateSearchResult result = candidates_from_keys(keys, 2, 4);
  EXPECT_THAT(sequences(result.list),
              ElementsAre(ElementsAre(1), ElementsAre(2), ElementsAre(3), ElementsAre(4)));
  EXPECT_EQ(result.found, 6u);
  EXPECT_EQ(result.overflow(), 2u);
}

TEST(CandidateSearch, FindsEveryImageOfAShoeBox) {
  // A shoe-box room has 1 + 6 + 18 + 38 paths of the orders 0 to 3 (docs: physics of the image method) for
  // any receiver.
  const scene::Scene scene = room();
  const dvec3 source(2.1, 1.3, 1.7);
  CandidateSearchOptions options;
  options.rays = 1u << 14;
  const CandidateSearchResult result = search(scene, options, source);
  EXPECT_TRUE(result.list.is_canonical());
  CandidateList list;
  list.add({});
  for (const auto& sequence : sequences(result.list)) list.add(sequence);
  ASSERT_TRUE(list.is_canonical());
  const FacetWorld world(scene);
  const ImageTree tree(world, source, list);
  RandomStream random(1, 2);
  for (int i = 0; i < 20; ++i) {
    const dvec3 target = dvec3(random.uniform(0.3, 6.7), random.uniform(0.3, 4.7), random.uniform(0.3, 2.7));
    size_t count[4] = {};
    for (const GeometricPath& path : tree.solve(target)) ++count[path.facets().size()];
    EXPECT_THAT(count, ElementsAre(1, 6, 18, 38));
  }
}

TEST(CandidateSearch, BothSidesReflect) {
  TinyScene tiny;
  tiny.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0})
      .quad({-9, -9, 4}, {9, -9, 4}, {9, 9, 4}, {-9, 9, 4});
  CandidateSearchOptions options;
  options.rays = 4096;
  EXPECT_THAT(sequences(search(tiny.build(), options, {0, 0, 1}).list),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(0, 1), ElementsAre(1, 0),
                          ElementsAre(0, 1, 0), ElementsAre(1, 0, 1)));
}

TEST(CandidateSearch, BodiesAreWhereTheyAre) {
  TinyScene tiny;
  tiny.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0});
  const uint32_t car = tiny.body("car");
  tiny.object("car", car).quad({-2, 0, -2}, {2, 0, -2}, {2, 0, 2}, {-2, 0, 2});
  CandidateSearchOptions options;
  options.rays = 4096;
  options.max_depth = 2;
  const auto at = [](const dvec3& position) { return std::vector{Pose{}, Pose{position, {1, 0, 0, 0}}}; };
  EXPECT_THAT(sequences(search(tiny.build(), options, {0, 0, 1}, at({0, 5, 2})).list),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(0, 1), ElementsAre(1, 0)));
  EXPECT_THAT(sequences(search(tiny.build(), options, {0, 0, 1}, at({0, 5, -9})).list),
              ElementsAre(ElementsAre(0)));
}

TEST(CandidateSearch, OutsideTheTicksIsTheSame) {
  const scene::Scene scene = room();
  CandidateSearchOptions options;
  options.rays = 1u << 12;
  const CandidateSearchResult in_tick = search(scene, options, {2, 1, 1});
  scene::GpuScene gpu_scene(test::device(), scene, {});
  const uint64_t submits = test::device().counters().submits;
  CandidateSearch pass(gpu_scene, options);
  const CandidateSearchResult alone = pass.search(std::vector{Pose{}}, {2, 1, 1});
  EXPECT_EQ(in_tick.list, alone.list);
  EXPECT_EQ(test::device().counters().submits, submits);
  EXPECT_EQ(pass.search(std::vector{Pose{}}, {2, 1, 1}).list, alone.list);
}

TEST(CandidateSearch, MoreRaysThanTheDeviceHoldsAreRefusedByNumber) {
  const scene::Scene scene = room();
  scene::GpuScene gpu_scene(test::device(), scene, {});
  CandidateSearchOptions options;
  options.rays = 1u << 31;
  try {
    const CandidateSearch pass(gpu_scene, options);
    FAIL() << "2^31 rays were taken";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("rays: expected at most"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("2147483648"));
  }
}

TEST(HardCase, N07_CandidatesAtUtmCoordinatesAreTheSame) {
  const dvec3 utm(500000.0, 5411000.0, 35.0);
  CandidateSearchOptions options;
  options.rays = 1u << 13;
  const CandidateSearchResult near = search(room(), options, {2.1, 1.3, 1.7});
  EXPECT_EQ(near.list, search(room(utm, utm), options, {2.1, 1.3, 1.7}).list);
  EXPECT_GT(near.list.size(), 100u);
}

TEST(HardCase, N10_ReflectedRaysDoNotMeetTheirOwnFacetAgain) {
  // In closed rooms with sizes from millimetres to kilometres, a sequence never repeats a facet at once.
  for (const double scale : {1e-3, 1.0, 1e3}) {
    TinyScene tiny;
    tiny.box(dvec3(0.0), scale * room_size);
    CandidateSearchOptions options;
    options.rays = 1u << 13;
    options.max_depth = 6;
    const scene::Scene scene = tiny.build();
    const CandidateSearchResult result = search(scene, options, scale * dvec3(2.1, 1.3, 1.7));
    size_t repeats = 0;
    for (const auto& sequence : sequences(result.list))
      repeats += std::adjacent_find(sequence.begin(), sequence.end()) != sequence.end();
    EXPECT_EQ(repeats, 0u) << scale;
    EXPECT_GT(result.list.size(), 1000u) << scale;
  }
}

TEST(HardCase, N12_SourceFiveMillimetresFromAWallFindsItsReflection) {
  TinyScene tiny;
  tiny.quad({0, -20, 0}, {0, 20, 0}, {0, 20, 10}, {0, -20, 10})
      .quad({30, -20, 0}, {30, 20, 0}, {30, 20, 10}, {30, -20, 10});
  CandidateSearchOptions options;
  options.rays = 1u << 14;
  options.max_depth = 2;
  EXPECT_THAT(sequences(search(tiny.build(), options, {0.005, 0, 5}).list),
              ElementsAre(ElementsAre(0), ElementsAre(1), ElementsAre(0, 1), ElementsAre(1, 0)));
}

TEST(HardCase, N64_NoCandidatesInAnEmptyScene) {
  CandidateSearchOptions options;
  options.rays = 1024;
  const CandidateSearchResult result = search(TinyScene().build(), options, {0, 0, 0});
  EXPECT_EQ(result.list.size(), 0u);
  EXPECT_EQ(result.found, 0u);
}

}  // namespace
}  // namespace greatx::rf
