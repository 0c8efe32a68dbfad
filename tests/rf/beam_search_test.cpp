// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares the beam search with the paths of all possible sequences on small scenes that are hard to search.
#include "rf/search/beam_search.h"

#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "rf/paths/radio_model.h"
#include "rf/reference/exhaustive_paths.h"
#include "scene/description/wedges.h"
#include "tests/rf/random_scene.h"
#include "tests/rf/search_scenes.h"

namespace greatx::rf {
namespace {

using rf::testing::expect_perfect;
using rf::testing::HandScene;
using rf::testing::SearchScene;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;

BeamSearchResult search(const SearchScene& scene, const BeamSearchOptions& options) {
  const FacetWorld world(scene.scene());
  const FacetKinds kinds = scene.facet_kinds();
  return BeamSearch(world, kinds, {}, options).search(scene.source);
}
BeamSearchResult search(const SearchScene& scene) { return search(scene, scene.options()); }

bool lists(const CandidateList& list, const FacetSequence& sequence) {
  for (size_t i = 0; i < list.size(); ++i)
    if (std::ranges::equal(list.sequence(i), sequence)) return true;
  return false;
}

/// Returns a street along y on a ground between two rows of three houses with gaps.
SearchScene canyon() {
  SearchScene street;
  street.hand.ground(60.0);
  for (const double x : {-14.0, 8.0})
    for (const double y : {-22.0, -6.0, 9.0}) street.box({x, y, 0.0}, {x + 6.0, y + 12.0, 9.0 + 0.2 * y});
  street.source = {0.7, -11.3, 6.1};
  street.low = {-16.0, -24.0, 0.2};
  street.high = {16.0, 24.0, 14.0};
  return street;
}

TEST(BeamSearch, AClosedBoxHasEveryImageOfEveryOrder) {
  for (uint32_t depth = 0; depth <= 4; ++depth) {
    SearchScene box;
    box.hand.room({7.3, 5.1, 3.2});
    box.source = {1.7, 2.9, 2.1};
    box.receivers = {{6.1, 1.3, 1.4}};
    box.drawn = 0;
    box.depth = depth;
    const std::vector<size_t> all{1, 6, 18, 38, 66};
    EXPECT_EQ(expect_perfect(box, fmt::format("box, depth {}", depth)),
              std::vector<size_t>(all.begin(), all.begin() + depth + 1));
  }
}

TEST(BeamSearch, AStreetCanyonAtEveryDepth) {
  SearchScene street = canyon();
  for (street.depth = 0; street.depth <= 4; ++street.depth) {
    street.drawn = street.depth == 4 ? 6 : 40;
    const std::vector<size_t> counts = expect_perfect(street, fmt::format("canyon, depth {}", street.depth));
    EXPECT_THAT(counts, Each(Ge(street.depth < 4 ? 5u : 1u))) << "depth " << street.depth;
  }
}

TEST(BeamSearch, ThroughWallsOfAStreetCanyon) {
  SearchScene street = canyon();
  street.kinds.assign(street.scene().facets.size(), FacetKind::wall);
  street.kinds[0] = FacetKind::opaque;
  for (street.walls = 1; street.walls <= 3; ++street.walls)
    EXPECT_GT(expect_perfect(street, fmt::format("canyon, {} walls", street.walls))[2], 40u);
}

TEST(BeamSearch, WallsOneBehindTheOther) {
  // Reflections may occur before, between and behind the passed walls.
  SearchScene row;
  for (const double x : {0.0, 2.0, 3.0, 5.0}) {
    row.hand.quad({x, -9, 0}, {x, 9, 0}, {x, 9, 8}, {x, -9, 8});
    row.kinds.push_back(FacetKind::wall);
  }
  row.source = {-2.3, 0.4, 3.7};
  row.depth = 4;
  row.receivers = {{7.0, 1.0, 4.0}, {4.1, -1.0, 4.0}};
  std::vector<size_t> last;
  for (row.walls = 1; row.walls <= 3; ++row.walls) {
    const std::vector<size_t> counts = expect_perfect(row, fmt::format("{} of four walls", row.walls));
    if (!last.empty()) {
      EXPECT_GT(counts[3] + counts[4], last[3] + last[4]);
    }
    last = counts;
  }
}

TEST(BeamSearch, TwoBoxesWithTouchingFaces) {
  for (const bool same_height : {true, false})
    for (const double shift : {0.0, 1.5}) {
      SearchScene boxes;
      boxes.hand.ground(40.0);
      boxes.box({-6, -3, 0}, {0, 3, 6});
      boxes.box({0, -3 + shift, 0}, {5, 3 + shift, same_height ? 6 : 4});
      boxes.source = {-1.0, -8.2, 4.5};
      boxes.low = {-12, -12, 0.2}, boxes.high = {12, 12, 10};
      EXPECT_GT(expect_perfect(boxes, fmt::format("boxes, {} {}", same_height, shift))[1], 20u);
    }
}

TEST(BeamSearch, DuplicatesInOnePlane) {
  SearchScene twice;
  twice.hand.ground(20.0);
  twice.hand.ground(20.0);
  twice.hand.quad({5, -9, 0}, {5, 9, 0}, {5, 9, 7}, {5, -9, 7});
  twice.hand.quad({5, -9, 0}, {5, -9, 7}, {5, 9, 7}, {5, 9, 0});    // the same quad with the opposite normal
  twice.hand.quad({5, -4, 2}, {5, 12, 2}, {5, 12, 9}, {5, -4, 9});  // a quad that overlaps it in part
  twice.source = {-3.0, 1.0, 2.5};
  twice.high.x = 4.9;
  EXPECT_GT(expect_perfect(twice, "duplicates")[2], 20u);
  twice.kinds.assign(5, FacetKind::wall);
  twice.walls = 2;
  twice.high.x = 10.0;
  EXPECT_GT(expect_perfect(twice, "duplicates that let pass")[2], 20u);
}

TEST(BeamSearch, TJunctionsCloseAWallAndHideWhatIsBehind) {
  // A wall consists of a large panel and of three panels beside it, whose corners lie in the middle of its
  // edge. A mirror stands behind the wall.
  SearchScene wall;
  wall.hand.quad({0, -40, -40}, {0, 0, -40}, {0, 0, 40}, {0, -40, 40});
  wall.hand.quad({0, 0, -40}, {0, 40, -40}, {0, 40, 1.7}, {0, 0, 1.7});
  wall.hand.quad({0, 0, 1.7}, {0, 40, 1.7}, {0, 40, 3.3}, {0, 0, 3.3});
  wall.hand.quad({0, 0, 3.3}, {0, 40, 3.3}, {0, 40, 40}, {0, 0, 40});
  const uint32_t behind = wall.hand.quad({-5, -3, 0}, {-5, 3, 0}, {-5, 3, 5}, {-5, -3, 5});
  wall.hand.quad({9, -9, 0}, {9, -9, 8}, {9, 9, 8}, {9, 9, 0});
  wall.source = {4.0, 0.0, 2.5};
  wall.low.x = 0.1, wall.high.x = 8.9;
  EXPECT_GT(expect_perfect(wall, "junctions")[1], 40u);
  const CandidateList list = search(wall).list;
  for (const uint32_t facet : list.facets) EXPECT_NE(facet, behind);
}

TEST(BeamSearch, LittleOutsideAClosedRoomIsListed) {
  SearchScene room;
  room.hand.room({8, 6, 3}, {-4, -3, 0});
  const size_t inside = room.scene().facets.size();
  room.box({6, -2, 0}, {9, 2, 5});
  room.hand.ground(50.0, -1.0);
  room.source = {1.3, -0.4, 1.1};
  room.low = {-3.9, -2.9, 0.1}, room.high = {3.9, 2.9, 2.9};
  expect_perfect(room, "room");
  // First hits are exact. Beams that are mirrored at an edge keep a sliver beside the edge (the clearance),
  // which leads out of the room.
  const CandidateList list = search(room).list;
  size_t leaked = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    const bool out = std::ranges::any_of(list.sequence(i), [&](uint32_t facet) { return facet >= inside; });
    EXPECT_FALSE(out && list.sequence(i).size() < 2) << i;
    leaked += out;
  }
  EXPECT_LT(2 * leaked, list.size()) << leaked << " of " << list.size();
}

TEST(BeamSearch, Slivers) {
  // A wall consists of strips with widths from 0.1 mm to 1 m; a fan consists of needles.
  SearchScene wall;
  double y = -4.0;
  for (const double width : {1.0, 1e-4, 0.5, 2e-4, 1e-3, 1.0, 1e-4, 1e-4, 2.0}) {
    wall.hand.quad({0, y, 0}, {0, y + width, 0}, {0, y + width, 6}, {0, y, 6});
    y += width;
  }
  for (int i = 0; i < 12; ++i)
    wall.hand.triangle({9, 0, 3}, {9, 6 * std::cos(0.02 * i), 3 + 6 * std::sin(0.02 * i)},
                       {9, 6 * std::cos(0.02 * (i + 1)), 3 + 6 * std::sin(0.02 * (i + 1))});
  wall.source = {3.0, -0.7, 2.2};
  wall.low = {0.5, -4, 0.2}, wall.high = {8.5, 6, 6};
  wall.drawn = 120;
  EXPECT_GT(expect_perfect(wall, "slivers")[1], 40u);
}

TEST(BeamSearch, ThroughTheHoleOfAFacet) {
  // One facet surrounds a window. Mirrors stand on both sides of the facet.
  SearchScene wall;
  const dvec3 outer[] = {{0, -8, 0}, {0, 8, 0}, {0, 8, 8}, {0, -8, 8}};
  const dvec3 inner[] = {{0, -1, 3}, {0, 1.5, 3}, {0, 1.5, 5}, {0, -1, 5}};
  std::vector<scene::FacetTriangle> frame;
  for (int i = 0; i < 4; ++i) {
    const int next = (i + 1) % 4;
    frame.push_back({{outer[i], outer[next], inner[next]}});
    frame.push_back({{outer[i], inner[next], inner[i]}});
  }
  wall.hand.facet(frame, 0, 0);
  wall.hand.quad({-6, -8, 0}, {-6, 8, 0}, {-6, 8, 8}, {-6, -8, 8});
  wall.hand.quad({7, -8, 0}, {7, -8, 8}, {7, 8, 8}, {7, 8, 0});
  wall.source = {4.0, 0.6, 3.5};
  wall.low = {-5.9, -7, 0.2}, wall.high = {6.9, 7, 8};
  wall.drawn = 80;
  EXPECT_GT(expect_perfect(wall, "frame")[2], 40u);
  EXPECT_TRUE(lists(search(wall).list, {1})) << "the mirror behind the window";
  EXPECT_TRUE(lists(search(wall).list, {1, 2})) << "and back";
}

TEST(BeamSearch, SourcesOnSurfacesInPlanesAndCloseToWalls) {
  SearchScene scene;
  scene.hand.ground(30.0);
  scene.box({0, 0, 0}, {6, 5, 4});
  scene.hand.quad({-8, -9, 0}, {-8, -9, 7}, {-8, 9, 7}, {-8, 9, 0});
  scene.low = {-12, -12, 0.2}, scene.high = {12, 12, 9};
  const std::pair<const char*, dvec3> sources[] = {
      {"on the ground", {-3, 1, 0}},
      {"on a wall", {0, 2, 3}},
      {"on a roof", {2, 2, 4}},
      {"1 mm from a wall", {-1e-3, 2, 3}},
      {"1 mm above the ground", {-3, 1, 1e-3}},
      {"in the plane of a wall", {0, -4, 2}},
      {"in the planes of two walls", {0, 0, 7}},
      {"in the plane of the roof", {-5, -5, 4}},
      {"on an edge", {0, 0, 2}},
      {"at a corner", {0, 0, 4}},
  };
  for (const auto& [name, source] : sources) {
    scene.source = source;
    EXPECT_GT(expect_perfect(scene, name)[1], 10u) << name;
  }
}

TEST(BeamSearch, ReceiversOnSurfacesAndEdges) {
  SearchScene scene;
  scene.hand.ground(30.0);
  scene.box({0, 0, 0}, {6, 5, 4});
  scene.hand.quad({-8, -9, 0}, {-8, -9, 7}, {-8, 9, 7}, {-8, 9, 0});
  scene.source = {-4.1, -3.3, 5.2};
  scene.drawn = 0;
  scene.receivers = {{-3, 1, 0}, {0, 2, 3}, {2, 2, 4}, {-1e-3, 2, 3}, {0, -4, 2},
                     {0, 0, 7},  {0, 0, 2}, {0, 0, 4}, {-8, 1, 1},    scene.source};
  expect_perfect(scene, "receivers");
}

TEST(BeamSearch, FarFromTheOrigin) {
  // The street is ten kilometres away from the local origin. Tolerances grow to millimetres; nothing else
  // changes.
  SearchScene near = canyon(), far;
  const dvec3 away(8192.0, -4096.0, 512.0);
  const auto moved = [&](SearchScene scene) {
    for (scene::FacetTriangle& triangle : scene.hand.scene.facet_triangles)
      for (dvec3& corner : triangle.corners) corner += away;
    for (scene::Facet& facet : scene.hand.scene.facets) facet.offset += glm::dot(facet.normal, away);
    for (dvec3* point : {&scene.source, &scene.low, &scene.high}) *point += away;
    return scene;
  };
  far = moved(near);
  EXPECT_EQ(expect_perfect(near, "near"), expect_perfect(far, "far"));
}

TEST(BeamSearch, NothingAndNextToNothing) {
  SearchScene empty;
  EXPECT_THAT(expect_perfect(empty, "empty"), ElementsAre(40, 0, 0, 0));
  EXPECT_EQ(search(empty).list.size(), 1u);
  SearchScene one;
  one.hand.quad({2, -3, 0}, {2, 3, 0}, {2, 3, 5}, {2, -3, 5});
  one.high.x = 1.9;
  one.source = {-1, 0.5, 2};
  EXPECT_GT(expect_perfect(one, "one")[1], 5u);
  EXPECT_EQ(search(one).list.size(), 2u);
  one.source = {2, 0.5, 2};  // in the plane of the facet
  EXPECT_EQ(expect_perfect(one, "in it")[1], 0u);
  for (const FacetKind kind : {FacetKind::foliage, FacetKind::absent}) {
    one.kinds = {kind};
    one.source = {-1, 0.5, 2};
    EXPECT_EQ(search(one).list.size(), 1u);
  }
}

TEST(BeamSearch, WhatIsBeyondTheCapacityIsCounted) {
  SearchScene street = canyon();
  const BeamSearchResult all = search(street);
  ASSERT_GT(all.list.size(), 200u);
  EXPECT_EQ(all.found, all.list.size());
  for (const uint64_t capacity : {1u, 17u, 120u}) {
    BeamSearchOptions options = street.options();
    options.capacity = capacity;
    const BeamSearchResult some = search(street, options);
    EXPECT_EQ(some.list.size(), capacity);
    EXPECT_GT(some.overflow(), 0u);
    EXPECT_LE(some.found, all.found);
    // Up to the depth that the search states as complete, all sequences are listed.
    const uint32_t complete = some.complete_depth();
    EXPECT_LT(complete, 3u);
    const auto up_to = [&](const BeamSearchResult& result) {
      size_t count = 0;
      for (size_t i = 0; i < result.list.size(); ++i) count += result.list.sequence(i).size() <= complete;
      return count;
    };
    EXPECT_EQ(up_to(some), up_to(all));
    for (size_t i = 0; i < some.list.size(); ++i)
      EXPECT_TRUE(std::ranges::equal(some.list.sequence(i), all.list.sequence(i))) << i;
  }
  BeamSearchOptions exact = street.options();
  exact.capacity = all.list.size();
  EXPECT_EQ(search(street, exact).overflow(), 0u);
  EXPECT_EQ(search(street, exact).complete_depth(), ~0u);
}

TEST(BeamSearch, EveryWedgeThatASequenceReachesIsListed) {
  // The test checks the paths of the reference to points on the edges themselves.
  for (const uint32_t walls : {0u, 1u}) {
    SearchScene street = canyon();
    street.depth = 2, street.walls = walls;
    if (walls > 0) street.kinds.assign(street.scene().facets.size(), FacetKind::wall);
    const FacetKinds kinds = street.facet_kinds();
    const FacetWorld world(street.scene());
    const std::vector<scene::Wedge> wedges = scene::find_wedges(street.scene());
    ASSERT_GT(wedges.size(), 40u);
    std::vector<dvec3> points;
    constexpr int per_wedge = 5;
    for (const scene::Wedge& wedge : wedges)
      for (int i = 0; i < per_wedge; ++i) points.push_back(wedge.a + (0.09 + 0.2 * i) * (wedge.b - wedge.a));
    const auto paths =
        reference::exhaustive_paths(street.scene(), world, std::vector{Pose{}}, kinds, street.source, points,
                                    {.max_depth = street.depth, .max_transmissions = walls})
            .paths;
    const CandidateList list = BeamSearch(world, kinds, wedges, street.options()).search(street.source).list;
    ASSERT_EQ(list.wedge_offsets.size(), list.size() + 1);
    size_t reached = 0;
    for (size_t i = 0; i < list.size(); ++i)
      EXPECT_TRUE(std::ranges::is_sorted(list.wedges_of(i), std::less_equal<>())) << "once each, ascending";
    for (size_t point = 0; point < points.size(); ++point)
      for (const GeometricPath& path : paths[point]) {
        // The diffraction is an interaction, too.
        if (path.interactions.size() + 1 > street.depth) continue;
        const FacetSequence sequence = path.facets();
        for (size_t i = 0; i < list.size(); ++i) {
          if (!std::ranges::equal(list.sequence(i), sequence)) continue;
          EXPECT_TRUE(std::ranges::binary_search(list.wedges_of(i), static_cast<uint32_t>(point / per_wedge)))
              << walls << " walls, wedge " << point / per_wedge << ", point " << point % per_wedge
              << ", after " << ::testing::PrintToString(sequence);
          ++reached;
          break;
        }
      }
    EXPECT_GT(reached, 100u);
  }
}

// Numbered hard cases, for the search and all steps after it.

TEST(BeamSearchHardCase, N18_APathByTheDiagonalOfAQuadIsOne) {
  SearchScene scene;
  scene.hand.quad({0, -4, 0}, {0, 4, 0}, {0, 4, 8}, {0, -4, 8});
  scene.source = {3, 1, 5};
  scene.receivers = {{3, -1, 3}, {6, -2, 2}};  // both paths meet the diagonal, one of them in its middle
  scene.drawn = 0;
  EXPECT_THAT(expect_perfect(scene, "diagonal"), ElementsAre(2, 2, 0, 0));
}

TEST(BeamSearchHardCase, N20_ACornerIsMetOnce) {
  SearchScene scene;
  scene.hand.room({8, 7, 4});
  scene.source = {1.5, 1.0, 1.2};
  // The sequences xy and yx are one path through the corner itself.
  scene.receivers = {{4.5, 3.0, 1.2}, {6.0, 4.0, 2.2}};
  scene.drawn = 0;
  scene.depth = 2;
  EXPECT_THAT(expect_perfect(scene, "corner"), ElementsAre(2, 12, 36));
}

TEST(BeamSearchHardCase, N23_TwoWallsFourMillimetresApartAreBothKept) {
  SearchScene scene;
  scene.hand.quad({0, -9, 0}, {0, 9, 0}, {0, 9, 9}, {0, -9, 9});
  scene.hand.quad({-0.004, -9, 0}, {-0.004, 9, 0}, {-0.004, 9, 9}, {-0.004, -9, 9});
  scene.low = {0.5, -3, 3}, scene.high = {6, 3, 6};
  scene.source = {3, 1, 5};
  EXPECT_EQ(expect_perfect(scene, "opaque")[1], 40u) << "the one in front";
  scene.kinds.assign(2, FacetKind::wall);
  scene.walls = 2;
  EXPECT_EQ(expect_perfect(scene, "walls")[3], 40u) << "the one behind, through the other twice";
  scene.kinds[0] = FacetKind::absent;
  EXPECT_EQ(expect_perfect(scene, "the one behind")[1], 40u);
}

TEST(BeamSearch, RandomScenes) {
  size_t paths = 0, deep = 0;
  for (uint64_t seed = 300; seed < 320; ++seed)
    for (uint32_t kind = 0; kind < rf::testing::random_scene_kinds; ++kind)
      for (const uint32_t walls : {0u, 2u}) {
        const rf::testing::RandomScene random = rf::testing::random_scene(seed, kind, 12);
        SearchScene scene;
        scene.hand.scene = rf::testing::build(random);
        scene.kinds = facet_kinds(scene.scene(), {.transmission = walls > 0});
        scene.source = random.transmitter;
        scene.receivers = random.receivers;
        scene.drawn = 0;
        scene.walls = walls;
        const std::vector<size_t> counts =
            expect_perfect(scene, fmt::format("{}, seed {}, {} walls", random.name, seed, walls));
        paths += counts[0] + counts[1] + counts[2] + counts[3];
        deep += counts[3];
      }
  EXPECT_GT(paths, 5000u);
  EXPECT_GT(deep, 1000u);
}

TEST(BeamSearch, TheGuaranteeSaysWhatHolds) {
  const SearchScene street = canyon();
  const FacetWorld world(street.scene());
  const FacetKinds kinds = street.facet_kinds();
  const std::string text = BeamSearch(world, kinds, {}, street.options()).guarantee();
  EXPECT_THAT(text, ::testing::HasSubstr("3"));
  EXPECT_EQ(text.find('\n'), std::string::npos);
  EXPECT_THAT(text, ::testing::HasSubstr("a path of up to 3 reflections"));
  EXPECT_THAT(text, ::testing::Not(::testing::HasSubstr("are left out")));
  BeamSearchOptions options = street.options();
  options.capacity = 40;
  EXPECT_THAT(
      BeamSearch(world, kinds, {}, options).guarantee(1234, 1),
      ::testing::AllOf(::testing::HasSubstr("a path of up to 1 reflections"),
                       ::testing::HasSubstr("of longer ones 1234 at least are left out, beyond the 40")));
}

}  // namespace
}  // namespace greatx::rf
