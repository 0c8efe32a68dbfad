// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks optical flow against independent fp64 methods (points found by rays, moved and projected again) and
// closed forms.
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "renderer/camera/truth.h"
#include "renderer/lens/lens.h"
#include "tests/renderer/truth_rig.h"

namespace greatx::test {
namespace {

/// Holds the largest difference of the flow from points that are found by fp64 rays, moved and projected, and
/// the number of compared pixels by kind.
struct FlowError {
  double largest = 0.0;
  int surfaces = 0, sky = 0, hidden = 0;
};
FlowError flow_error(TruthRig& rig, const CameraDesc& desc, const Moment& now, const Moment& next) {
  const Picture picture = rig.shoot(now, next);
  FlowError error;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t pixel = size_t{row} * desc.width + column;
      const dvec3 ray = now.camera.rotate(pixel_ray(desc, column, row));
      const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
      const uint32_t instance = hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0;
      if (instance != picture.images.instance[pixel]) continue;  // a pixel on an edge
      const dvec2 flow(picture.truth.flow[2 * pixel], picture.truth.flow[2 * pixel + 1]);
      dvec3 there;
      if (hit)
        there = project(desc, next.camera, carried(rig.scene(), *hit, now, next));
      else
        there = project(desc, {now.camera.position, next.camera.orientation}, now.camera.position + ray);
      if (there.z <= (hit ? desc.near_m : 0.0)) {
        EXPECT_TRUE(std::isnan(flow.x) && std::isnan(flow.y)) << column << ' ' << row;
        ++error.hidden;
        continue;
      }
      const dvec2 expected = dvec2(there) - dvec2(column + 0.5, row + 0.5);
      error.largest = std::max(error.largest, glm::length(flow - expected));
      if (std::isnan(flow.x)) ADD_FAILURE() << column << ' ' << row;
      ++(hit ? error.surfaces : error.sky);
    }
  return error;
}

TEST(Flow, OfAStaticSceneIsThePointProjectedAnew) {
  const CameraDesc desc = truth_camera(96);
  TruthRig rig(street().build(), desc);
  const FlowError error =
      flow_error(rig, desc, {look({0.3, -0.2, 0.1}, 3, 2, 5)}, {look({0.8, -0.1, 0.15}, 1, 3.5, 4)});
  EXPECT_GT(error.surfaces, 3000);
  EXPECT_GT(error.sky, 1000);
  EXPECT_LT(error.largest, 5e-5);
}

TEST(Flow, IsAsGoodFarFromTheOrigin) {
  const CameraDesc desc = truth_camera(96);
  // The scene is far from its local origin. Vertices there are floats with a step of 1/32 to 1/16 m; the
  // reference uses the same rounded vertices.
  const dvec3 far(524288.0, 4194304.0 / 8.0, 128.0);
  TruthRig rig(street(far).build(), desc);
  const FlowError error = flow_error(rig, desc, {look(far + dvec3(0.3, -0.2, 0.1), 3, 2, 5)},
                                     {look(far + dvec3(0.8, -0.1, 0.15), 1, 3.5, 4)});
  EXPECT_GT(error.surfaces, 3000);
  EXPECT_LT(error.largest, 1e-3);
}

TEST(Flow, OfUtmCoordinatesHasTheBytesOfTheOrigin) {
  const CameraDesc desc = truth_camera();
  const dvec3 utm(448320.0, 5411904.0, 128.0);
  TruthRig here(street().build(), desc), there(street(utm).build(utm), desc);
  const Moment now{look({0.25, -0.5, 0.125}, 3, 2, 5)}, next{look({0.75, -0.125, 0.25}, 1, 3.5, 4)};
  const Picture a = here.shoot(now, next), b = there.shoot(now, next);
  EXPECT_EQ(a.truth.flow, b.truth.flow);
  EXPECT_EQ(a.truth.normals, b.truth.normals);
}

TEST(Flow, OfMovingBodiesFollowsThem) {
  const CameraDesc desc = truth_camera(96);
  TinyScene tiny = street();
  const uint32_t car = tiny.body("car"), drone = tiny.body("drone");
  tiny.object("car", car).box({-1, -1, -1}, {1, 1, 1});
  tiny.object("drone", drone).box({-0.5, -2, -0.25}, {0.5, 2, 0.25});
  TruthRig rig(tiny.build(), desc);
  const Moment now{look({0, 0, 0}, 3, 2, 5), {{}, look({12, -3, -1}, 30), look({900, 150, 60}, 10, 20, 30)}};
  const Moment next{look({0.4, 0.1, 0}, 2, 2, 5),
                    {{}, look({12.5, -2, -1}, 41), look({890, 160, 66}, 190, 25, 35)}};
  const FlowError error = flow_error(rig, desc, now, next);
  EXPECT_GT(error.surfaces, 3000);
  EXPECT_LT(error.largest, 1e-4);
  // The body itself is visible: its flow differs from that of the world behind it.
  const Picture picture = rig.shoot(now, next), still = rig.shoot(now, {next.camera, now.bodies});
  int moved = 0;
  for (size_t i = 0; i < picture.images.instance.size(); ++i) {
    const bool same = picture.truth.flow[2 * i] == still.truth.flow[2 * i];
    if (picture.images.instance[i] <= 3) {
      EXPECT_TRUE(same || std::isnan(still.truth.flow[2 * i]));
    } else {
      moved += same ? 0 : 1;
    }
  }
  EXPECT_GT(moved, 50);
}

TEST(Flow, OfATurnAloneDoesNotDependOnDepth) {
  const CameraDesc desc = truth_camera();
  TruthRig full(street().build(), desc), empty(TinyScene().build(), desc);
  const Moment now{look({0, 0, 0})}, next{look({0, 0, 0}, 4, -3, 2)};
  const Picture a = full.shoot(now, next), b = empty.shoot(now, next);
  for (size_t i = 0; i < a.truth.flow.size(); ++i) ASSERT_NEAR(a.truth.flow[i], b.truth.flow[i], 2e-5);
}

TEST(Flow, AgreesWithTheReprojectedDepthPicture) {
  const CameraDesc desc = truth_camera(96, 4);
  TruthRig rig(street().build(), desc);
  const Moment now{look({0.3, -0.2, 0.1}, 3, 2, 5)}, next{look({0.8, -0.1, 0.15}, 1, 3.5, 4)};
  const Picture picture = rig.shoot(now, next);
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t pixel = size_t{row} * desc.width + column;
      if (std::isinf(picture.images.depth[pixel])) continue;
      const dvec3 point =
          now.camera.apply(double(picture.images.depth[pixel]) * pixel_ray(desc, column, row));
      const dvec3 there = project(desc, next.camera, point);
      ASSERT_NEAR(picture.truth.flow[2 * pixel], there.x - (column + 0.5), 1e-4);
      ASSERT_NEAR(picture.truth.flow[2 * pixel + 1], there.y - (row + 0.5), 1e-4);
    }
}

TEST(Flow, OfAStereoBaselineIsMinusTheDisparity) {
  const CameraDesc desc = truth_camera();
  TruthRig rig(street().build(), desc);
  const double baseline = 0.54;
  const Picture picture = rig.shoot({look({0, 0, 0})}, {look({0, -baseline, 0})});
  for (size_t i = 0; i < picture.images.depth.size(); ++i) {
    ASSERT_NEAR(picture.truth.flow[2 * i], -desc.fx * baseline / picture.images.depth[i], 1e-5);
    ASSERT_EQ(picture.truth.flow[2 * i + 1], 0.0f);
  }
}

TEST(Flow, BehindALensGoesThroughItTwice) {
  CameraDesc desc = truth_camera(96);
  desc.distortion = {-0.2, 0.04, 0.002, -0.003, 0.0};
  const render::Lens lens(
      {desc.name, desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy, desc.distortion});
  TruthRig rig(street().build(), desc);
  const Moment now{look({0.3, -0.2, 0.1}, 3, 2, 5)}, next{look({0.8, -0.1, 0.15}, 1, 3.5, 4)};
  const Picture picture = rig.shoot(now, next);
  int compared = 0, at_edges = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t pixel = size_t{row} * desc.width + column;
      const dvec2 n = lens.undistorted({column + 0.5, row + 0.5});
      const dvec3 ray = now.camera.rotate({1.0, -n.x, -n.y});
      const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
      const uint32_t id = hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0;
      if (id == 0 || id != picture.images.instance[pixel]) continue;
      // Behind a lens, a neighbouring pixel may stand for a pixel at the edge of a triangle, which then shows
      // another plane.
      if (std::abs(picture.images.depth[pixel] / hit->distance - 1.0) > 1e-4) {
        ++at_edges;
        continue;
      }
      const dvec3 there = glm::conjugate(next.camera.orientation) * (hit->point - next.camera.position);
      if (there.x <= desc.near_m) continue;
      const dvec2 m(-there.y / there.x, -there.z / there.x);
      if (glm::length(m) > 0.9 * desc.distortion.fold_radius()) continue;
      const dvec2 flow = lens.pixel(m) - dvec2(column + 0.5, row + 0.5);
      ASSERT_NEAR(picture.truth.flow[2 * pixel], flow.x, 1e-4) << column << ' ' << row;
      ASSERT_NEAR(picture.truth.flow[2 * pixel + 1], flow.y, 1e-4) << column << ' ' << row;
      ++compared;
    }
  EXPECT_GT(compared, 3000);
  EXPECT_LT(at_edges, 20);
}

TEST(Flow, IsNoNumberForWhatTheCameraPassesBy) {
  const CameraDesc desc = truth_camera();
  TruthRig rig(street().build(), desc);
  const FlowError past = flow_error(rig, desc, {look({0, 0, 0})}, {look({8.05, 0, 0})});
  EXPECT_GT(past.hidden, 50);
  EXPECT_GT(past.surfaces, 100);
  // After a half turn the sky lies behind the camera, too.
  const FlowError turned = flow_error(rig, desc, {look({0, 0, 0})}, {look({0, 0, 0}, 180)});
  EXPECT_EQ(turned.hidden, 64 * 64);
}

TEST(Flow, AtRestIsExactlyZero) {
  const CameraDesc desc = truth_camera();
  TruthRig rig(street().build(), desc);
  const Pose pose = look({0.3, -0.2, 0.1}, 33, 2, 5);
  const Picture picture = rig.shoot({pose}, {pose});
  for (const float value : picture.truth.flow) ASSERT_NEAR(value, 0.0f, 1e-12f);
}

TEST(Flow, MotionOfABodyCancelsLargeCoordinatesExactly) {
  const dvec3 far(5e5, 4e6, 300);
  const Pose camera = look(far, 20, 3), next_camera = look(far + dvec3(1, 2, 0.5), 22, 4);
  const Pose body = look(far + dvec3(10, 5, 0), 90), next_body = look(far + dvec3(11, 4, 0), 100);
  const auto near = [&](const Pose& p) { return Pose{p.position - far, p.orientation}; };
  const shared::GpuBodyMotion a = render::body_motion(camera, body, next_camera, next_body),
                              b = render::body_motion(near(camera), near(body), near(next_camera),
                                                      near(next_body));
  for (int c = 0; c < 4; ++c) {
    EXPECT_NEAR(a.row0[c], b.row0[c], 1e-7);
    EXPECT_NEAR(a.row1[c], b.row1[c], 1e-7);
    EXPECT_NEAR(a.row2[c], b.row2[c], 1e-7);
  }
}

}  // namespace
}  // namespace greatx::test
