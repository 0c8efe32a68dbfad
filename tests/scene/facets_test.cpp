// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks edges that many triangles share against a merge that compares every triangle with every other one.
#include "scene/build/facets.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"

namespace greatx::scene {
namespace {

constexpr uint32_t nobody = std::numeric_limits<uint32_t>::max();

/// Triangles around the edge from `a` to `b`, each with its own apex.
class Fan {
 public:
  Fan(const dvec3& a, const dvec3& b) : a_(a), b_(b) {
    const dvec3 along = glm::normalize(b - a);
    x_ = glm::normalize(glm::cross(along, dvec3(0.3, -0.5, 0.8)));
    y_ = glm::cross(along, x_);
  }
  void add(double angle, double radius, double along, bool backwards) {
    const dvec3 apex = a_ + along * (b_ - a_) + radius * (std::cos(angle) * x_ + std::sin(angle) * y_);
    const uint32_t third = 2 + static_cast<uint32_t>(input.corners.size() / 3);
    if (backwards)
      put(b_, a_, apex, {1, 0, third});
    else
      put(a_, b_, apex, {0, 1, third});
  }
  FacetInput input;

 private:
  void put(const dvec3& p, const dvec3& q, const dvec3& r, std::initializer_list<uint32_t> vertices) {
    input.corners.insert(input.corners.end(), {p, q, r});
    input.vertices.insert(input.vertices.end(), vertices);
  }
  dvec3 a_, b_, x_, y_;
};

void expect_same(const FacetInput& input, const BuildOptions& options, uint32_t crowd) {
  const FacetGroups fast = merge_coplanar(input, options, crowd),
                    slow = merge_coplanar(input, options, nobody);
  ASSERT_EQ(fast.groups.size(), slow.groups.size());
  EXPECT_EQ(fast.triangles, slow.triangles);
  for (size_t i = 0; i < fast.groups.size(); ++i) {
    EXPECT_EQ(fast.groups[i].count, slow.groups[i].count) << i;
    EXPECT_EQ(fast.groups[i].normal, slow.groups[i].normal) << i;
    EXPECT_EQ(fast.groups[i].offset, slow.groups[i].offset) << i;
  }
}

// The angles form clusters about the allowed ones, sizes extend over two decades, edges are long or almost
// zero, and the noise is zero or large.
TEST(Facets, ACrowdedEdgeGivesTheSameFacets) {
  RandomStream random(5, 17);
  BuildOptions options;
  size_t merged = 0, apart = 0;
  for (int round = 0; round < 60; ++round) {
    const double length = std::pow(10.0, random.uniform(-2.5, 1.0));
    Fan fan({3.0, -20.0, 5.0}, {3.0 + 0.6 * length, -20.0, 5.0 + 0.8 * length});
    const double spread = std::pow(10.0, random.uniform(-4.0, 0.0));
    for (int i = 0; i < 150; ++i) {
      const double cluster = 2.0 * pi * std::floor(random.uniform(0.0, 5.0)) / 5.0;
      const double angle = cluster + spread * random.uniform(-1.0, 1.0);
      const double radius = std::pow(10.0, random.uniform(-2.0, 0.5));
      const double along = random.uniform(-0.5, 1.5);
      fan.add(angle, radius, along, random.uniform() < 0.3);
    }
    fan.input.noise_m = round % 3 == 0 ? 0.0 : std::pow(10.0, random.uniform(-6.0, -2.0));
    options.coplanar_angle_rad = round % 2 == 0 ? BuildOptions{}.coplanar_angle_rad : 0.1;
    options.coplanar_distance_m = round % 4 < 2 ? BuildOptions{}.coplanar_distance_m : 0.02;
    expect_same(fan.input, options, 2);
    const size_t facets = merge_coplanar(fan.input, options, 2).groups.size();
    merged += facets < 100;
    apart += facets > 50;
  }
  EXPECT_GT(merged, 5u);
  EXPECT_GT(apart, 5u);
}

// Every edge of a bumpy mesh counts as crowded.
TEST(Facets, ANetWhoseEdgesAllCountAsCrowdedGivesTheSame) {
  constexpr uint32_t side = 24;
  RandomStream random(6, 1);
  std::vector<dvec3> points;
  for (uint32_t i = 0; i <= side; ++i)
    for (uint32_t j = 0; j <= side; ++j) {
      const double bump = (i / 6 + j / 6) % 2 == 0 ? 0.0 : random.uniform(-0.05, 0.05);
      points.push_back({0.5 * i, 0.5 * j, bump});
    }
  FacetInput input;
  for (uint32_t i = 0; i < side; ++i)
    for (uint32_t j = 0; j < side; ++j) {
      const uint32_t a = i * (side + 1) + j, b = a + side + 1;
      for (const uint32_t corner : {a, b, b + 1, a, b + 1, a + 1}) {
        input.corners.push_back(points[corner]);
        input.vertices.push_back(corner);
      }
    }
  expect_same(input, {}, 0);
  EXPECT_LT(merge_coplanar(input, {}, 0).groups.size(), 1000u);
}

TEST(Facets, TwentyThousandTrianglesOnOneEdge) {
  Fan fan({0, 0, 0}, {0, 1, 0});
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) fan.add(2.0 * pi * i / count, 3.0, 0.5, false);
  fan.input.noise_m = 1e-7;
  EXPECT_EQ(merge_coplanar(fan.input, {}).groups.size(), size_t{count});
}

}  // namespace
}  // namespace greatx::scene
