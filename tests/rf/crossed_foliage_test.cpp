// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/hash.h"
#include "core/random.h"
#include "rf/search/candidate_search.h"
#include "tests/rf/crossings_support.h"

namespace greatx::rf {
namespace {

using test::all_of;
using test::cross;
using test::segment;
using test::TinyScene;

/// Returns the metres of foliage along each segment, where all facets are foliage. Expects no open foliage
/// and no blocked segment.
std::vector<double> depths(const scene::Scene& scene, std::span<const Segment> segments,
                           const std::vector<Pose>& bodies = {Pose{}}) {
  std::vector<double> list;
  for (const Crossing& crossing : cross(scene, all_of(FacetKind::foliage, scene), segments, bodies)) {
    EXPECT_FALSE(crossing.blocked);
    EXPECT_FALSE(crossing.foliage_open) << "segment " << list.size();
    EXPECT_TRUE(crossing.walls.empty());
    list.push_back(crossing.foliage_m);
  }
  return list;
}

/// Returns the length of the segment inside a box.
double inside_box(const Segment& s, const dvec3& low, const dvec3& high) {
  double enter = 0.0, leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = s.b[axis] - s.a[axis];
    if (d == 0.0) {
      if (s.a[axis] <= low[axis] || s.a[axis] >= high[axis]) return 0.0;
      continue;
    }
    const double first = (low[axis] - s.a[axis]) / d, second = (high[axis] - s.a[axis]) / d;
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return std::max(0.0, leave - enter) * glm::distance(s.a, s.b);
}

/// Returns the length of the segment inside the convex body that the planes of the facets bound, moved
/// outwards by `margin`.
double inside_convex(const Segment& s, const scene::Scene& scene, double margin) {
  double enter = 0.0, leave = 1.0;
  for (const scene::Facet& facet : scene.facets) {
    const double from = glm::dot(facet.normal, s.a) - facet.offset - margin,
                 to = glm::dot(facet.normal, s.b) - facet.offset - margin;
    if (from >= 0 && to >= 0) return 0.0;
    if (from > 0) enter = std::max(enter, from / (from - to));
    if (to > 0) leave = std::min(leave, from / (from - to));
  }
  return std::max(0.0, leave - enter) * glm::distance(s.a, s.b);
}

/// Bounds of an expected depth. Near an edge or along a face, a small lateral error of the line changes the
/// depth much more. So the result must lie between the depths for volumes that are smaller and larger by
/// `margin`.
struct Range {
  double least, most;
};
Range box_range(const Segment& s, const dvec3& low, const dvec3& high, double margin) {
  return {inside_box(s, low + margin, high - margin) - margin,
          inside_box(s, low - margin, high + margin) + margin};
}
void expect_in(double found, const Range& range, size_t index) {
  EXPECT_GE(found, range.least) << index;
  EXPECT_LE(found, range.most) << index;
}

/// Returns a sphere of 8 * 4^levels triangles with vertices on the axes.
TinyScene sphere(const dvec3& center, double radius, int levels) {
  TinyScene tiny;
  const auto split = [&](const auto& self, const dvec3& a, const dvec3& b, const dvec3& c,
                         int level) -> void {
    if (level == 0) {
      tiny.triangle(center + radius * a, center + radius * b, center + radius * c);
      return;
    }
    const dvec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    self(self, a, ab, ca, level - 1);
    self(self, ab, b, bc, level - 1);
    self(self, ca, bc, c, level - 1);
    self(self, ab, bc, ca, level - 1);
  };
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0}) {
        const dvec3 a(x, 0, 0), b(0, y, 0), c(0, 0, z);
        if (x * y * z > 0)
          split(split, a, b, c, levels);
        else
          split(split, a, c, b, levels);
      }
  return tiny;
}

TEST(CrossedFoliage, BoxesAgainstTheClosedForm) {
  const dvec3 low(-4, -3, 2), high(4, 3, 8);
  TinyScene tiny;
  tiny.box(low, high);
  const scene::Scene scene = tiny.build();
  std::vector<Segment> segments{
      segment({-9, 0.3, 4}, {9, 0.3, 4}),     // through: 8 m
      segment({0, 0.3, 4}, {9, 0.3, 4}),      // from inside: 4 m
      segment({9, 0.3, 4}, {0, 0.3, 4}),      // to inside
      segment({-1, 0.3, 4}, {2.5, 0.3, 4}),   // wholly inside: 3.5 m
      segment({9, 0.3, 4}, {20, 0.3, 4}),     // outside, on the same line
      segment({9, 0.3, 9}, {-9, 0.3, 9}),     // above
      segment({0, 0, 2}, {0, 0, 8}),          // from face to face, with both ends on faces: 6 m
      segment({0, 0, 2}, {0, 0, -5}),         // away from a face
      segment({-4, -3, 2}, {4, 3, 8}),        // from corner to corner
      segment({-9, 0, 5}, {-4, 0, 5}),        // up to a face
      segment({0, 0, 5}, {0, 0, 5}),          // a point
      segment({0, 0, 5}, {1e-3, 1e-3, 5}),    // a millimetre inside
      segment({-9000, 1, 5}, {9000, 1, 5.5})  // 8 m of 18 km
  };
  std::vector<double> found = depths(scene, segments);
  for (size_t i = 0; i < segments.size(); ++i)
    EXPECT_NEAR(found[i], inside_box(segments[i], low, high), i + 1 < segments.size() ? 2e-5 : 5e-3) << i;
  EXPECT_NEAR(found[0], 8.0, 1e-5);
  EXPECT_NEAR(found[3], 3.5, 1e-5);

  segments.clear();
  RandomStream random(6, 1);
  // Points on a coarse grid meet edges, corners and faces exactly.
  for (int i = 0; i < 2000; ++i) {
    const auto point = [&] {
      return dvec3(random.below(13) - 6.0, random.below(13) - 6.0, random.below(11) - 1.0);
    };
    segments.push_back(segment(point(), point()));
  }
  found = depths(scene, segments);
  size_t along = 0;  // number of segments along a face or an edge, where inside and outside are both right
  for (size_t i = 0; i < segments.size(); ++i) {
    const Range range = box_range(segments[i], low, high, 1e-4);
    along += range.most - range.least > 0.01;
    expect_in(found[i], range, i);
  }
  EXPECT_LT(along, 100u);
}

TEST(CrossedFoliage, ASphereAgainstItsChords) {
  const dvec3 center(3, -2, 12);
  const scene::Scene scene = sphere(center, 5.0, 4).build();
  std::vector<Segment> segments{
      segment({3, -2, 30}, {3, -2, -3}),  // through both poles, where eight triangles meet
      segment({3, -2, 12}, {3, -2, 40}),  // from the centre
      segment({-9, -2, 12}, {30, -2, 12})};
  std::vector<double> found = depths(scene, segments);
  EXPECT_NEAR(found[0], 10.0, 2e-5);
  EXPECT_NEAR(found[1], 5.0, 2e-5);
  EXPECT_NEAR(found[2], 10.0, 2e-5);

  RandomStream random(6, 2);
  segments.clear();
  for (int i = 0; i < 3000; ++i) {
    const auto point = [&] {
      return center + dvec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    };
    segments.push_back(segment(point(), point()));
    // A segment towards a vertex of the mesh.
    const scene::FacetTriangle& triangle =
        scene.facet_triangles[random.below(static_cast<uint32_t>(scene.facet_triangles.size()))];
    const dvec3 from = point();
    segments.push_back(segment(from, from + 1.7 * (triangle.corners[i % 3] - from)));
  }
  found = depths(scene, segments);
  size_t inside = 0;
  for (size_t i = 0; i < segments.size(); ++i) {
    expect_in(
        found[i],
        {inside_convex(segments[i], scene, -1e-4) - 1e-4, inside_convex(segments[i], scene, 1e-4) + 1e-4}, i);
    const double h = glm::length(glm::cross(segments[i].b - segments[i].a, center - segments[i].a)) /
                     glm::distance(segments[i].a, segments[i].b);
    inside += found[i] > 0.0;
    if (h > 5.0) {
      ASSERT_EQ(found[i], 0.0) << i;
    }
  }
  EXPECT_GT(inside, 1000u);
}

TEST(CrossedFoliage, OverlappingVolumesAddUp) {
  TinyScene tiny;
  tiny.box({0, -3, 0}, {6, 3, 6}).box({4, -3, 0}, {10, 3, 6}).box({4.5, -1, 1}, {5.5, 1, 5});
  const std::vector<Segment> segments{segment({-3, 0.2, 3}, {20, 0.2, 3}), segment({5, 0.2, 3}, {20, 0.2, 3}),
                                      segment({5, 0.2, 3}, {5.2, 0.3, 3.1})};
  const std::vector<double> found = depths(tiny.build(), segments);
  EXPECT_NEAR(found[0], 13.0, 2e-5);
  EXPECT_NEAR(found[1], 1.0 + 5.0 + 0.5, 2e-5);
  EXPECT_NEAR(found[2], 3.0 * glm::length(dvec3(0.2, 0.1, 0.1)), 2e-5);
}

TEST(CrossedFoliage, DoesNotDependOnTheOrderOfTheTrianglesOrTheDirection) {
  TinyScene forwards, backwards;
  RandomStream random(6, 3);
  std::vector<std::array<dvec3, 2>> boxes;
  for (int i = 0; i < 30; ++i) {
    const dvec3 low(random.uniform(-20, 15), random.uniform(-20, 15), random.uniform(0, 5));
    boxes.push_back({low, low + dvec3(random.uniform(1, 9), random.uniform(1, 9), random.uniform(1, 9))});
  }
  for (const auto& [low, high] : boxes) forwards.box(low, high);
  std::reverse(boxes.begin(), boxes.end());
  for (const auto& [low, high] : boxes) backwards.box(low, high);
  std::vector<Segment> segments, reversed;
  for (int i = 0; i < 500; ++i) {
    const auto point = [&] {
      return dvec3(random.uniform(-25, 25), random.uniform(-25, 25), random.uniform(0, 14));
    };
    segments.push_back(segment(point(), point()));
    reversed.push_back(segment(segments.back().b, segments.back().a));
  }
  const std::vector<double> found = depths(forwards.build(), segments),
                            back = depths(forwards.build(), reversed);
  EXPECT_EQ(found, depths(backwards.build(), segments));
  for (size_t i = 0; i < segments.size(); ++i) {
    Range sum{0.0, 0.0};
    for (const auto& [low, high] : boxes) {
      const Range range = box_range(segments[i], low, high, 1e-4);
      sum = {sum.least + range.least, sum.most + range.most};
    }
    expect_in(found[i], sum, i);
    expect_in(back[i], sum, i);
  }
}

TEST(CrossedFoliage, StandsAmongWallsAndOpaqueThings) {
  TinyScene tiny;
  tiny.box({0, -3, 0}, {6, 3, 6})                                 // facets 0 to 5: foliage
      .quad({3, -9, 0}, {3, 9, 0}, {3, 9, 9}, {3, -9, 9})         // 6: a wall inside the foliage
      .quad({8, -9, 0}, {8, 9, 0}, {8, 9, 9}, {8, -9, 9})         // 7: opaque
      .quad({-8, 20, 0}, {-8, 40, 0}, {-8, 40, 9}, {-8, 20, 9});  // 8: opaque, far away
  FacetKinds kinds(9, FacetKind::foliage);
  kinds[6] = FacetKind::wall;
  kinds[7] = kinds[8] = FacetKind::opaque;
  const std::vector<Segment> segments{
      segment({-3, 0.2, 3}, {7, 0.2, 3}, 1), segment({-3, 0.2, 3}, {7, 0.2, 3}, 0),
      segment({-3, 0.2, 3}, {9, 0.2, 3}, 1), segment({-3, 0.2, 3}, {2, 0.2, 3}, 0)};
  const std::vector<Crossing> found = cross(tiny.build(), kinds, segments);
  EXPECT_FALSE(found[0].blocked);
  EXPECT_THAT(found[0].walls, ::testing::ElementsAre(6));
  EXPECT_NEAR(found[0].foliage_m, 6.0, 1e-5);
  EXPECT_TRUE(found[1].blocked);
  EXPECT_TRUE(found[2].blocked);
  EXPECT_NEAR(found[3].foliage_m, 2.0, 1e-5);
}

TEST(CrossedFoliage, OfMovingBodiesIsWhereTheBodyIsAndNotCountedForItsOwnNode) {
  TinyScene tiny;
  tiny.box({50, -3, 0}, {56, 3, 6});
  const uint32_t truck = tiny.body("truck");
  tiny.object("truck", truck).box({-5, -1, 0}, {5, 1, 2});
  Segment plain = segment({0, 0.3, 1}, {100, 0.2, 1.5}), own = plain;
  own.body_a = truck;
  const std::vector<Segment> segments{plain, own, segment({20, 0, 1}, {20, 0, 1.5})};
  const auto turned = orientation_from_yaw_pitch_roll(0.5 * 3.14159265358979, 0, 0);
  const auto at = [&](const dvec3& position, const dquat& orientation) {
    return depths(tiny.build(), segments, {Pose{}, Pose{position, orientation}});
  };
  const double scale = glm::length(plain.b - plain.a) / 100.0;
  const std::vector<double> along = at({20, 0, 0}, {1, 0, 0, 0}), across = at({20, 0, 0}, turned),
                            away = at({20, 90, 0}, turned),
                            about = at({20, 0, 0}, orientation_from_yaw_pitch_roll(3.14159265358979, 0, 0));
  EXPECT_NEAR(along[0], 16.0 * scale, 1e-4);
  EXPECT_NEAR(about[0], 16.0 * scale, 1e-4);
  EXPECT_NEAR(across[0], 8.0 * scale, 1e-4);
  EXPECT_NEAR(away[0], 6.0 * scale, 1e-4);
  for (const auto& found : {along, across, away}) EXPECT_NEAR(found[1], 6.0 * scale, 1e-4);
  EXPECT_NEAR(along[2], 0.5, 1e-5);
  EXPECT_EQ(away[2], 0.0);
}

TEST(CrossedFoliage, TenKilometresFromTheOriginWithinAFewRoundings) {
  const dvec3 there(10000, -7000, 100);
  TinyScene tiny;
  tiny.box(there + dvec3(-4, -3, 2), there + dvec3(4, 3, 8));
  RandomStream random(6, 4);
  std::vector<Segment> segments;
  for (int i = 0; i < 500; ++i) {
    const auto point = [&] {
      return there + dvec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 10));
    };
    segments.push_back(segment(point(), point()));
  }
  const std::vector<double> found = depths(tiny.build(), segments);
  for (size_t i = 0; i < segments.size(); ++i)
    expect_in(found[i], box_range(segments[i], there + dvec3(-4, -3, 2), there + dvec3(4, 3, 8), 0.01), i);
}

TEST(CrossedFoliage, WhatIsNotClosedSaysSo) {
  TinyScene sheet;
  sheet.quad({0, -9, 0}, {0, 9, 0}, {0, 9, 9}, {0, -9, 9});
  const std::vector<Segment> segments{segment({5, 1, 4}, {-5, 1, 5}), segment({5, 1, 14}, {-5, 1, 15})};
  const scene::Scene scene = sheet.build();
  const std::vector<Crossing> found = cross(scene, all_of(FacetKind::foliage, scene), segments);
  EXPECT_TRUE(found[0].foliage_open);
  EXPECT_FALSE(found[1].foliage_open);
  EXPECT_EQ(found[1].foliage_m, 0.0);
  TinyScene inside_out;
  inside_out.box({4, 9, 9}, {-4, -9, -9});  // mirrored in three axes: its normals point inwards
  const scene::Scene inwards = inside_out.build();
  EXPECT_TRUE(cross(inwards, all_of(FacetKind::foliage, inwards), segments)[0].foliage_open);
}

/// Returns a digest of all answers of the pass for a mixed scene and of the candidates that a search finds in
/// it.
std::string digest_of_answers() {
  TinyScene tiny = sphere({0, 0, 5}, 6.0, 2);
  FacetKinds kinds(8 * 16, FacetKind::foliage);
  RandomStream random(63, 1);
  const auto vector = [&](double size) {
    return dvec3(random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size));
  };
  for (int i = 0; i < 60; ++i) {
    const dvec3 corner = vector(20), u = vector(8), v = vector(8);
    tiny.quad(corner, corner + u, corner + u + v, corner + v);
    kinds.push_back(i % 4 == 0 ? FacetKind::opaque : FacetKind::wall);
  }
  std::vector<Segment> segments;
  for (int i = 0; i < 20000; ++i) segments.push_back(segment(vector(25), vector(25), 4));
  const scene::Scene scene = tiny.build();
  std::string text;
  for (const Crossing& crossing : cross(scene, kinds, segments)) {
    text += crossing.blocked ? "blocked" : std::to_string(crossing.foliage_m * 1e9);
    for (const uint32_t wall : crossing.walls) text.append(" ").append(std::to_string(wall));
    text.append("\n");
  }
  scene::GpuScene gpu_scene(test::device(), scene, {});
  CandidateSearchOptions options;
  options.rays = 1u << 14;
  options.max_transmissions = 2;
  for (const uint32_t facet :
       CandidateSearch(gpu_scene, options, kinds).search(std::vector{Pose{}}, {0, 0, 5}).list.facets)
    text.append(" ").append(std::to_string(facet));
  return sha256_hex(std::as_bytes(std::span(text)));
}

/// The next test runs this test in processes with other numbers of driver threads.
TEST(CrossedFoliage, DigestOfAnswersIsTheSameTwice) {
  const std::string digest = digest_of_answers();
  EXPECT_EQ(digest, digest_of_answers());
  std::printf("digest %s\n", digest.c_str());
}

TEST(HardCase, N63_CrossingsAndCandidatesAreTheSameWithOneTwoAndSixteenThreads) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  const std::string expected = "digest " + digest_of_answers();
  for (const char* threads : {"1", "2", "16"}) {
    const std::string command =
        std::string("LP_NUM_THREADS=") + threads + " '" + program + "' --gtest_filter='*DigestOfAnswers*'";
    FILE* pipe = popen(command.c_str(), "r");
    ASSERT_NE(pipe, nullptr);
    std::string output;
    for (char part[256]; std::fgets(part, sizeof part, pipe) != nullptr;) output += part;
    EXPECT_EQ(pclose(pipe), 0) << output;
    EXPECT_THAT(output, ::testing::HasSubstr(expected)) << threads;
  }
}

}  // namespace
}  // namespace greatx::rf
