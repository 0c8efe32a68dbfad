// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Normals, depth along the ray and optical flow against fp64 by other ways: rays against triangles, points moved and
// projected anew, closed forms.
#include "renderer/camera/truth.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "renderer/camera/lens.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

using render::CameraDesc;
using render::TruthImages;

struct Moment {
  Pose camera;
  std::vector<Pose> bodies{Pose{}};
};

struct Picture {
  render::CameraImages images;
  TruthImages truth;
};

class TruthRig {
 public:
  TruthRig(scene::Scene scene, CameraDesc desc, const render::TruthOutputs& outputs = {true, true, true})
      : scene_(std::move(scene)),
        gpu_(device(), scene_, {.acceleration_structure = false, .textures = true}),
        lighting_(gpu_, plain_light(), {}),
        camera_(lighting_, desc),
        truth_(lighting_, desc, outputs),
        ring_(device(), 2, 1 << 16, 1 << 20) {}

  gpu::TickSlot& record(Moment now, Moment next) {
    now.bodies.resize(scene_.bodies.size());
    next.bodies.resize(scene_.bodies.size());
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, now.bodies);
    lighting_.record(slot, now.bodies);
    camera_.record(slot, now.camera);
    truth_.record(slot, camera_.seen_image(), {now.camera, now.bodies}, {next.camera, next.bodies});
    ring_.submit(slot);
    return slot;
  }
  Picture collect(const gpu::TickSlot& slot) {
    ring_.wait(slot);
    return {camera_.collect(slot), truth_.collect(slot)};
  }
  Picture shoot(const Moment& now, const Moment& next) { return collect(record(now, next)); }
  const scene::Scene& scene() const { return scene_; }

 private:
  scene::Scene scene_;
  scene::GpuScene gpu_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  render::TruthPass truth_;
  gpu::TickRing ring_;
};

CameraDesc truth_camera(uint32_t size = 64, uint32_t msaa = 1) {
  CameraDesc desc = plain_camera(size, msaa);
  desc.outputs.hdr = desc.outputs.rgb = false;
  desc.outputs.seen = true;
  desc.cx += 3.25;  // not a special case
  desc.fy *= 1.125;
  return desc;
}

/// What a ray meets first, fp64: triangle, point, barycentrics.
struct Hit {
  uint32_t triangle = 0, primitive = 0;
  double distance = 0.0;
  dvec3 point{0.0};  ///< local
  dvec2 barycentrics{0.0};
};

std::optional<Hit> cast(const scene::Scene& scene, const std::vector<Pose>& bodies, const dvec3& eye,
                        const dvec3& ray) {
  std::optional<Hit> nearest;
  for (uint32_t p = 0; p < scene.primitives.size(); ++p) {
    const scene::Primitive& primitive = scene.primitives[p];
    const uint32_t body = scene.instances[primitive.instance].body;
    const Pose pose = body == 0 ? Pose{} : bodies[body];
    for (uint32_t i = 0; i < primitive.index_count; i += 3) {
      dvec3 corner[3];
      for (int c = 0; c < 3; ++c)
        corner[c] = pose.apply(dvec3(scene.positions[scene.indices[primitive.first_index + i + c]])) - eye;
      const dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], across = glm::cross(ray, e2);
      const double det = glm::dot(e1, across);
      if (std::abs(det) < 1e-14) continue;
      const double u = -glm::dot(corner[0], across) / det;
      const dvec3 q = glm::cross(-corner[0], e1);
      const double v = glm::dot(ray, q) / det, t = glm::dot(e2, q) / det;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || (nearest && nearest->distance <= t)) continue;
      nearest = {(primitive.first_index + i) / 3, p, t, eye + t * ray, {u, v}};
    }
  }
  return nearest;
}

/// Where a camera shows a local point; z <= 0: nowhere.
dvec3 project(const CameraDesc& desc, const Pose& camera, const dvec3& point) {
  const dvec3 in_sensor = glm::conjugate(camera.orientation) * (point - camera.position);
  return {desc.cx - desc.fx * in_sensor.y / in_sensor.x, desc.cy - desc.fy * in_sensor.z / in_sensor.x,
          in_sensor.x};
}

/// The point at which what is at `point` now will be.
dvec3 carried(const scene::Scene& scene, const Hit& hit, const Moment& now, const Moment& next) {
  const uint32_t body = scene.instances[scene.primitives[hit.primitive].instance].body;
  return body == 0 ? hit.point : next.bodies[body].apply(now.bodies[body].inverse().apply(hit.point));
}

/// The largest error of the flow against points found by fp64 rays, moved and projected; pixels compared.
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
      if (instance != picture.images.instance[pixel]) continue;  // on an edge
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

/// Ground, a wall a kilometre away, a tilted board near by; all about `center`.
TinyScene street(const dvec3& center = dvec3(0.0)) {
  TinyScene scene;
  const auto at = [&](double x, double y, double z) { return center + dvec3(x, y, z); };
  scene.object("ground").quad(at(-50, -800, -2), at(1500, -800, -2), at(1500, 800, -2), at(-50, 800, -2));
  scene.object("far wall")
      .quad(at(1000, -300, -2), at(1000, 200, -2), at(1000, 200, 150), at(1000, -300, 150));
  scene.object("board").quad(at(6, 1, -1), at(9, 3, -1.5), at(8.5, 3.5, 2), at(5.5, 1.5, 2));
  return scene;
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
  // A local origin that is not where the scene is: vertices are floats of 1/32 m there, and are what they are.
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
  // The body itself was looked at: its flow is another one than that of the world behind it.
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
      // Behind a lens the neighbour of a pixel may stand for it at the edge of a triangle: another plane then.
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
  // A half turn: the sky behind as well.
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

TEST(Normals, AreTheInterpolatedOnesOnTheCamerasSide) {
  const CameraDesc desc = truth_camera();
  TinyScene tiny;
  tiny.object("board").quad({6, 4, -4}, {6, -4, -4}, {7, -4, 4}, {7, 4, 4});
  const uint32_t moving = tiny.body("fin");
  tiny.object("fin", moving).triangle({0, 0, 0}, {2, 1, 0}, {0, 0, 2});
  scene::Scene scene = tiny.build();
  // Vertex normals of a curved surface, unit, to whichever side.
  for (size_t i = 0; i < scene.normals.size(); ++i)
    scene.normals[i] =
        glm::normalize(scene.normals[i] + 0.4f * vec3(std::sin(float(i)), std::cos(3.0f * float(i)), 0.3f));
  TruthRig rig(std::move(scene), desc);
  for (const double yaw : {20.0, 200.0}) {  // the fin from either side
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
      // Ground that is grazed is as good as its planar depth (docs/camera.md).
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

/// Whether depth and ids of two parallel cameras are shifted against each other by fx b / z.
TEST(Stereo, DisparityIsFxBOverZ) {
  CameraDesc desc = truth_camera(128);
  desc.cx = desc.cy = 64.0;
  desc.fx = desc.fy = 64.0;
  TinyScene tiny;
  // 64 b / z pixels with b = 0.5: depths of whole disparities.
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
      if (whole > column || b.images.instance[pixel - whole] != id) continue;  // hidden from the other
      ASSERT_NEAR(b.images.depth[pixel - whole], a.images.depth[pixel], 1e-6 * a.images.depth[pixel]);
      ++compared;
    }
  EXPECT_GT(compared, 1000);
}

/// Every instance, looked at alone, has its own id, and no other id occurs.
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
    // From above, where nothing else is in view.
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
