// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the upright box around points and the pixels that triangles cover, in closed form.
#include "sim/sensors/camera/coverage.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "renderer/lens/lens.h"
#include "sim/sensors/camera/boxes.h"
#include "tests/renderer/camera_rig.h"
#include "tests/sim/box_camera.h"

namespace greatx::sim {
namespace {

using render::CameraDesc;
using test::box_camera;
using test::look;

TEST(UprightBox, FindsATurnedBox) {
  for (const double yaw_deg : {0.0, 17.0, 89.0, 90.0, -30.0, -89.5}) {
    const Pose pose = look({100, -50, 3}, yaw_deg);
    std::vector<dvec3> points;
    for (int i = 0; i < 8; ++i)
      points.push_back(pose.apply({i & 1 ? 2.0 : -2.0, i & 2 ? 0.9 : -0.9, i & 4 ? 0.7 : -0.7}));
    points.push_back(pose.apply({0.3, 0.2, 0.1}));
    dvec3 size;
    const Pose box = upright_box(points, size);
    EXPECT_LT(glm::length(size - dvec3(4, 1.8, 1.4)), 1e-9) << yaw_deg;
    EXPECT_LT(glm::length(box.position - pose.position), 1e-9) << yaw_deg;
    EXPECT_NEAR(std::abs(glm::dot(box.rotate({1, 0, 0}), pose.rotate({1, 0, 0}))), 1.0, 1e-12) << yaw_deg;
    EXPECT_GE(box.rotate({1, 0, 0}).x, -1e-12) << yaw_deg;  // yaw within (-90, 90]
  }
}

TEST(UprightBox, OfAPointOrALineIsFlat) {
  dvec3 size;
  EXPECT_EQ(upright_box(std::vector<dvec3>{{1, 2, 3}}, size).position, dvec3(1, 2, 3));
  EXPECT_EQ(size, dvec3(0.0));
  upright_box(std::vector<dvec3>{{0, 0, 0}, {1, 1, 0}, {2, 2, 5}}, size);
  EXPECT_NEAR(size.x, 2.0 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(size.y, 0.0, 1e-12);
  EXPECT_EQ(size.z, 5.0);
}

TEST(Coverage, NeighboursShareNoPixelAndLeaveNone) {
  const CameraDesc desc = box_camera(130, 40);
  const Projection projection(desc);
  Coverage one(projection), sum(projection);
  // A fan of triangles covers the whole picture. Its centre may be a pixel's centre.
  for (const dvec2& center : {dvec2(64.5, 20.5), dvec2(31.337, 7.25)}) {
    const std::vector<dvec2> rim{{-1, -1},  {70.5, -1}, {131, -1}, {131, 20.5},
                                 {131, 41}, {10, 41},   {-1, 41},  {-1, 8}};
    uint32_t total = 0;
    sum.clear();
    for (size_t i = 0; i < rim.size(); ++i) {
      const dvec2 triangle[] = {center, rim[i], rim[(i + 1) % rim.size()]};
      one.clear();
      one.add(triangle, projection.bounds(triangle));
      total += one.count();
      sum.add(triangle, projection.bounds(triangle));
    }
    EXPECT_EQ(total, 130u * 40u);
    EXPECT_EQ(sum.count(), 130u * 40u);
  }
  one.clear();
  EXPECT_EQ(one.count(), 0u);
  one.add(64, 39);
  EXPECT_TRUE(one.contains(64, 39));
  EXPECT_EQ(one.count(), 1u);
}

}  // namespace
}  // namespace greatx::sim
