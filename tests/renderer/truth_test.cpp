// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks normals and depth along the ray against fp64 rays and closed forms, and properties of the whole
// ground truth of a camera.
#include "renderer/camera/truth.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/renderer/truth_rig.h"

namespace greatx::test {
namespace {

TEST(Normals, AreTheInterpolatedOnesOnTheCamerasSide) {
  const CameraDesc desc = truth_camera();
  TinyScene tiny;
  tiny.object("board").quad({6, 4, -4}, {6, -4, -4}, {7, -4, 4}, {7, 4, 4});
  const uint32_t moving = tiny.body("fin");
  tiny.object("fin", moving).triangle({0, 0, 0}, {2, 1, 0}, {0, 0, 2});
  scene::Scene scene = tiny.build();
  // The vertex normals are unit vectors of a curved surface and may point to either side.
  for (size_t i = 0; i < scene.normals.size(); ++i)
    scene.normals[i] =
        glm::normalize(scene.normals[i] + 0.4f * vec3(std::sin(float(i)), std::cos(3.0f * float(i)), 0.3f));
  TruthRig rig(std::move(scene), desc);
  for (const double yaw : {20.0, 200.0}) {  // the fin is seen from both sides
    const Moment now{look({0, 0, 0}, 2, 1), {{}, look({3, -0.5, -1}, yaw, 5)}};
    const Picture picture = rig.shoot(now, now);
    int seen[3] = {0, 0, 0};
    for (uint32_t row = 0; row < desc.height; ++row)
      for (uint32_t column = 0; column < desc.width; ++column) {
        const size_t pixel = size_t{row} * desc.width + column;
        const vec3 normal(picture.truth.normals[3 * pixel], picture.truth.normals[3 * pixel + 1],
                          picture.truth.normals[3 * pixel + 2]);
        const dvec3 ray = now.camera.rotate(pixel_ray(desc, column, row));
        const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
        const uint32_t id = hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0;
        if (id != picture.images.instance[pixel]) continue;
        ++seen[id];
        if (id == 0) {
          ASSERT_EQ(normal, vec3(0.0f));
          continue;
        }
        dvec3 expected(0.0), corners[3];
        const double weights[3] = {1.0 - hit->barycentrics.x - hit->barycentrics.y, hit->barycentrics.x,
                                   hit->barycentrics.y};
        const Pose body = id == 2 ? now.bodies[1] : Pose{};
        for (uint32_t c = 0; c < 3; ++c) {
          const uint32_t vertex = rig.scene().indices[3 * hit->triangle + c];
          expected += weights[c] * dvec3(rig.scene().normals[vertex]);
          corners[c] = body.apply(dvec3(rig.scene().positions[vertex]));
        }
        expected = glm::normalize(body.rotate(expected));
        dvec3 facing = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::dot(facing, ray) > 0.0) facing = -facing;
        if (glm::dot(expected, facing) < 0.0) expected = -expected;
        ASSERT_LT(glm::length(dvec3(normal) - expected), 1e-5) << column << ' ' << row;
      }
    EXPECT_GT(seen[0], 100);
    EXPECT_GT(seen[1], 500);
    EXPECT_GT(seen[2], 50);
  }
}

TEST(DepthRay, IsTheDistanceToTheEye) {
  const CameraDesc desc = truth_camera(96, 4);
  TruthRig rig(street().build(), desc);
  const Moment now{look({0.3, -0.2, 0.1}, 3, 2, 5)};
  const Picture picture = rig.shoot(now, now);
  int compared = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t pixel = size_t{row} * desc.width + column;
      const dvec3 ray = now.camera.rotate(pixel_ray(desc, column, row));
      const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
      const uint32_t id = hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0;
      if (id != picture.images.instance[pixel]) continue;
      if (!hit) {
        ASSERT_TRUE(std::isinf(picture.truth.depth_ray[pixel]) && picture.truth.depth_ray[pixel] > 0.0f);
        continue;
      }
      const double distance = glm::length(hit->point - now.camera.position);
      // At grazing angles the ground is as accurate as its planar depth (docs/camera.md).
      ASSERT_NEAR(picture.truth.depth_ray[pixel], distance, (id == 1 ? 1e-4 : 1e-6) * distance);
      ASSERT_NEAR(picture.truth.depth_ray[pixel], picture.images.depth[pixel] * glm::length(ray),
                  3e-7 * distance);
      ++compared;
    }
  EXPECT_GT(compared, 4000);
}

TEST(HardCase, N64_TruthOfAnEmptyScene) {
  const CameraDesc desc = truth_camera(16);
  TruthRig rig(TinyScene().build(), desc);
  const Picture picture = rig.shoot({look({0, 0, 0})}, {look({1, 2, 3}, 1)});
  for (const float value : picture.truth.normals) EXPECT_EQ(value, 0.0f);
  for (const float value : picture.truth.depth_ray) EXPECT_TRUE(std::isinf(value) && value > 0.0f);
  for (const float value : picture.truth.flow) EXPECT_TRUE(std::isfinite(value));
}

TEST(HardCase, N57_TruthFromADecimetreToTenKilometres) {
  CameraDesc desc = truth_camera(32);
  desc.near_m = 0.1;
  for (const double z : {0.1001, 1.0, 1000.0, 10000.0}) {
    TinyScene tiny;
    tiny.object("wall").quad({z, 2 * z, -2 * z}, {z, -2 * z, -2 * z}, {z, -2 * z, 2 * z}, {z, 2 * z, 2 * z});
    TruthRig rig(tiny.build(), desc);
    const double step = 0.01 * z;
    const Picture picture = rig.shoot({look({0, 0, 0})}, {look({0, -step, 0})});
    for (uint32_t i = 0; i < 32 * 32; ++i) {
      ASSERT_NEAR(picture.truth.flow[2 * i], -desc.fx * 0.01, 1e-6) << z;
      const dvec3 ray = pixel_ray(desc, i % 32, i / 32);
      ASSERT_NEAR(picture.truth.depth_ray[i], z * glm::length(ray), 3e-7 * z * glm::length(ray)) << z;
    }
  }
}

TEST(Truth, SameBytesInTwoSlotsAndWhateverElseIsAsked) {
  const CameraDesc desc = truth_camera();
  TruthRig all(street().build(), desc), flow(street().build(), desc, {.flow = true});
  const Moment now{look({0.3, -0.2, 0.1}, 3, 2, 5)}, next{look({0.8, -0.1, 0.15}, 1, 3.5, 4)};
  const gpu::TickSlot& first = all.record(now, next);
  const gpu::TickSlot& second = all.record(now, next);
  const Picture a = all.collect(first), b = all.collect(second), c = flow.shoot(now, next);
  EXPECT_EQ(a.truth.flow, b.truth.flow);
  EXPECT_EQ(a.truth.normals, b.truth.normals);
  EXPECT_EQ(a.truth.depth_ray, b.truth.depth_ray);
  EXPECT_EQ(a.truth.flow, c.truth.flow);
  EXPECT_TRUE(c.truth.normals.empty() && c.truth.depth_ray.empty());
}

/// Depth and ids of two parallel cameras are displaced against each other by fx b / z.
TEST(Stereo, DisparityIsFxBOverZ) {
  CameraDesc desc = truth_camera(128);
  desc.cx = desc.cy = 64.0;
  desc.fx = desc.fy = 64.0;
  TinyScene tiny;
  // The disparity is 64 b / z pixels with b = 0.5; the depths are chosen for whole disparities.
  for (const int disparity : {2, 4, 8}) {
    const double z = 32.0 / disparity, y = 0.45 * z - 0.2 * disparity;
    tiny.object("board").quad({z, y, -1}, {z, y - 0.6 * z, -1}, {z, y - 0.6 * z, 0.21 * z}, {z, y, 0.21 * z});
  }
  TruthRig rig(tiny.build(), desc);
  const Moment left{look({0, 0.25, 0})}, right{look({0, -0.25, 0})};
  const Picture a = rig.shoot(left, right), b = rig.shoot(right, left);
  int compared = 0;
  for (uint32_t row = 0; row < 128; ++row)
    for (uint32_t column = 0; column < 128; ++column) {
      const size_t pixel = size_t{row} * 128 + column;
      const uint32_t id = a.images.instance[pixel];
      if (id == 0) continue;
      const double disparity = desc.fx * 0.5 / a.images.depth[pixel];
      const auto whole = static_cast<uint32_t>(std::lround(disparity));
      ASSERT_NEAR(disparity, whole, 1e-5);
      if (whole > column || b.images.instance[pixel - whole] != id) continue;  // hidden from the other camera
      ASSERT_NEAR(b.images.depth[pixel - whole], a.images.depth[pixel], 1e-6 * a.images.depth[pixel]);
      ++compared;
    }
  EXPECT_GT(compared, 1000);
}

/// Every instance, seen alone, has its own id, and no other id occurs.
TEST(Ids, AreOneToOneWithTheScenesInstances) {
  TinyScene tiny;
  const uint32_t moving = tiny.body("moving");
  std::vector<dvec3> centers;
  for (int i = 0; i < 12; ++i) {
    const dvec3 center(10.0 * i, 7.0 * (i % 3), 0.0);
    const bool carried = i >= 9;
    tiny.object("box " + std::to_string(i), carried ? moving : 0)
        .box(center - dvec3(0.5), center + dvec3(0.5));
    centers.push_back(center);
  }
  const Pose pose = look({0, 40, 3}, 90);
  CameraRig rig(tiny.build(), plain_light(), truth_camera(32));
  ASSERT_EQ(rig.scene().instances.size(), 12u);
  std::vector<bool> found(13, false);
  for (uint32_t i = 0; i < 12; ++i) {
    const uint32_t body = rig.scene().instances[i].body;
    const dvec3 target = body == 0 ? centers[i] : pose.apply(centers[i]);
    // Looks from above, where nothing else is in view.
    const render::CameraImages images = rig.shoot(look(target + dvec3(0, 0, 1.5), 0, 90), {pose});
    for (const uint32_t id : images.instance) {
      ASSERT_TRUE(id == 0 || id == i + 1) << id << " at instance " << i;
      found[id] = true;
    }
  }
  for (uint32_t id = 1; id <= 12; ++id) EXPECT_TRUE(found[id]) << id;
}

}  // namespace
}  // namespace greatx::test
