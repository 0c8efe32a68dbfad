// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares boxes with projected vertices, with dense samples of edges and with rays in fp64. Compares how
// much of an object is visible with closed forms and with counted pixels.
#include "sim/sensors/camera/boxes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

#include <gtest/gtest.h>

#include "core/units.h"
#include "renderer/lens/lens_rays.h"
#include "tests/renderer/camera_rig.h"
#include "tests/sim/box_camera.h"

namespace greatx::sim {
namespace {

using render::CameraDesc;
using test::box_camera;
using test::look;
using test::TinyScene;

scene::Scene labelled(const TinyScene& tiny,
                      scene::SemanticClass semantic_class = scene::SemanticClass::vehicle,
                      const dvec3& origin = dvec3(0.0)) {
  scene::Scene scene = tiny.build(origin);
  for (scene::Instance& instance : scene.instances) instance.semantic_class = semantic_class;
  return scene;
}

std::vector<uint32_t> nothing(const CameraDesc& desc) {
  return std::vector<uint32_t>(size_t{desc.width} * desc.height, 0);
}

dvec3 projected(const CameraDesc& desc, const Pose& camera, const dvec3& point) {
  const dvec3 p = camera.inverse().apply(point);
  return {desc.cx - desc.fx * p.y / p.x, desc.cy - desc.fy * p.z / p.x, p.x};
}

/// Returns whether a ray meets a triangle at `near` times the ray or beyond (Moeller and Trumbore), in fp64.
bool meets(const dvec3& eye, const dvec3& ray, const dvec3& a, const dvec3& b, const dvec3& c, double near) {
  const dvec3 e1 = b - a, e2 = c - a, across = glm::cross(ray, e2);
  const double det = glm::dot(e1, across);
  if (det == 0.0) return false;
  const dvec3 from = eye - a, q = glm::cross(from, e1);
  const double u = glm::dot(from, across) / det, v = glm::dot(ray, q) / det, t = glm::dot(e2, q) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= near;
}

uint32_t rays_that_meet(const Boxes::Object& object, const Pose& local_from_body, const CameraDesc& desc,
                        const Pose& camera, const render::Lens* lens = nullptr) {
  std::vector<dvec3> corners;
  for (const uint32_t i : object.indices) corners.push_back(local_from_body.apply(object.vertices[i]));
  uint32_t count = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      dvec3 in_sensor = test::pixel_ray(desc, column, row);
      if (lens != nullptr) {
        const dvec2 n = lens->undistorted({column + 0.5, row + 0.5});
        in_sensor = {1.0, -n.x, -n.y};
      }
      const dvec3 ray = camera.rotate(in_sensor);
      bool met = false;
      for (size_t i = 0; !met && i < corners.size(); i += 3)
        met = meets(camera.position, ray, corners[i], corners[i + 1], corners[i + 2], desc.near_m);
      count += met ? 1 : 0;
    }
  return count;
}

/// Holds boxes of all sizes and attitudes around the origin, one for each body, and the poses of the bodies.
struct Crowd {
  TinyScene tiny;
  std::vector<Pose> bodies{Pose{}};
};
Crowd crowd(int count, double nearest, double farthest) {
  Crowd crowd;
  std::mt19937 draw(7);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(draw()) / static_cast<double>(std::mt19937::max());
  };
  for (int i = 0; i < count; ++i) {
    const std::string name = "object " + std::to_string(i);
    const uint32_t body = crowd.tiny.body(name);
    const dvec3 half(uniform(0.05, 2), uniform(0.05, 2), uniform(0.05, 2));
    crowd.tiny.object(name, body).box(-half, half);
    const double range = uniform(nearest, farthest), bearing = uniform(-60, 60), turn = uniform(-180, 180);
    Pose pose = look({range * std::cos(radians(bearing)), range * std::sin(radians(bearing)), uniform(-4, 4)},
                     turn, uniform(-40, 40), uniform(-90, 90));
    crowd.bodies.push_back(pose);
  }
  return crowd;
}

TEST(Boxes, AreTheBoundsOfProjectedVertices) {
  const CameraDesc desc = box_camera();
  Crowd around = crowd(60, 6, 60);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  ASSERT_EQ(boxes.objects().size(), 60u);
  const Pose camera = look({0.3, -0.2, 0.1}, 4, 3, 2);
  const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, nothing(desc));
  EXPECT_GT(found.size(), 20u);
  int cut = 0;
  for (const ObjectBox& box : found) {
    const Boxes::Object& object = boxes.objects()[box.object];
    dvec4 bounds(1e300, 1e300, -1e300, -1e300);
    for (const dvec3& vertex : object.vertices) {
      const dvec3 p = projected(desc, camera, around.bodies[object.body].apply(vertex));
      bounds = {std::min(bounds.x, p.x), std::min(bounds.y, p.y), std::max(bounds.z, p.x),
                std::max(bounds.w, p.y)};
    }
    for (int side = 0; side < 4; ++side) {
      EXPECT_NEAR(box.unclipped[side], bounds[side], 1e-9);
      EXPECT_NEAR(box.amodal[side], std::clamp(bounds[side], 0.0, side % 2 == 0 ? 96.0 : 64.0), 1e-9);
    }
    const double inside = (box.amodal.z - box.amodal.x) * (box.amodal.w - box.amodal.y),
                 whole = (bounds.z - bounds.x) * (bounds.w - bounds.y);
    EXPECT_NEAR(box.truncation(), 1.0 - inside / whole, 1e-9);
    cut += box.truncation() > 0.01 ? 1 : 0;
    EXPECT_FALSE(box.crosses_near);
    EXPECT_EQ(box.visible, 0u);
    EXPECT_EQ(box.visibility(), 0.0);
    // The corners of the 3-D box are the vertices.
    const Pose local_from_box = box.world_from_box;
    for (const dvec3& vertex : object.vertices) {
      const dvec3 in_box = local_from_box.inverse().apply(around.bodies[object.body].apply(vertex));
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(std::abs(in_box[axis]), 0.5 * object.size[axis], 1e-6);
      const dvec3 in_sensor = box.sensor_from_box.apply(in_box);
      EXPECT_LT(glm::length(camera.apply(in_sensor) - around.bodies[object.body].apply(vertex)), 1e-9);
    }
  }
  EXPECT_GT(cut, 2);
}

TEST(Boxes, CountThePixelsWhoseRaysMeetTheObject) {
  const CameraDesc desc = box_camera();
  Crowd around = crowd(40, 1, 30);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  for (const Pose& camera : {look({0, 0, 0}), look({3, 1, 0.5}, 20, -5, 70)}) {
    const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, nothing(desc));
    size_t at = 0, near = 0;
    for (uint32_t i = 0; i < boxes.objects().size(); ++i) {
      const Boxes::Object& object = boxes.objects()[i];
      const uint32_t expected = rays_that_meet(object, around.bodies[object.body], desc, camera);
      const bool is_found = at < found.size() && found[at].object == i;
      ASSERT_EQ(is_found, expected > 0) << i;
      if (!is_found) continue;
      EXPECT_EQ(found[at].alone, expected) << i;
      near += found[at].crosses_near ? 1 : 0;
      ++at;
    }
    EXPECT_EQ(at, found.size());
    EXPECT_GT(at, 10u);
  }
}

void check_lens(const render::Distortion& distortion) {
  CameraDesc desc = box_camera();
  desc.distortion = distortion;
  const render::Lens lens(
      {"camera", desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy, desc.distortion});
  Crowd around = crowd(40, 1, 30);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  const Pose camera = look({3, 1, 0.5}, 20, -5, 70);
  const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, nothing(desc));
  size_t at = 0;
  for (uint32_t i = 0; i < boxes.objects().size(); ++i) {
    const Boxes::Object& object = boxes.objects()[i];
    const uint32_t expected = rays_that_meet(object, around.bodies[object.body], desc, camera, &lens);
    const bool is_found = at < found.size() && found[at].object == i;
    ASSERT_EQ(is_found, expected > 0) << i;
    if (!is_found) continue;
    EXPECT_EQ(found[at].alone, expected) << i;
    const ObjectBox& box = found[at++];
    if (box.crosses_near) continue;
    // Points along the edges, seen through the lens, reach the sides of the rectangle but not beyond them.
    dvec4 bounds(1e300, 1e300, -1e300, -1e300);
    for (size_t t = 0; t < object.indices.size(); ++t) {
      const dvec3 &a = object.vertices[object.indices[t]],
                  &b = object.vertices[object.indices[t - t % 3 + (t + 1) % 3]];
      for (double s = 0.0; s < 1.0; s += 1.0 / 512) {
        const dvec3 p = camera.inverse().apply(around.bodies[object.body].apply(a + s * (b - a)));
        dvec2 n(-p.y / p.x, -p.z / p.x);
        if (const double r = glm::length(n), fold = desc.distortion.fold_radius(); r > fold) n *= fold / r;
        const dvec2 pixel = lens.pixel(n);
        bounds = {std::min(bounds.x, pixel.x), std::min(bounds.y, pixel.y), std::max(bounds.z, pixel.x),
                  std::max(bounds.w, pixel.y)};
      }
    }
    for (int side = 0; side < 4; ++side) {
      const double tolerance = 1e-3 * (1.0 + bounds.z - bounds.x + bounds.w - bounds.y);
      EXPECT_NEAR(box.unclipped[side], bounds[side], tolerance) << i << ' ' << side;
    }
  }
  EXPECT_GT(at, 10u);
}

TEST(Boxes, BehindALensThatDistorts) {
  check_lens({-0.22, 0.04, 0.002, -0.003, 0.0});
  check_lens({0.25, 0.02, -0.004, 0.002, 0.01});
}

/// Returns objects as long as a street and objects below the camera, beside others near and far.
Crowd crowd_of_long_things() {
  Crowd around = crowd(40, 2, 30);
  const auto add = [&](const char* name, const dvec3& low, const dvec3& high) {
    around.tiny.object(name, around.tiny.body(name)).box(low, high);
    around.bodies.push_back({});
  };
  add("pavement", {-60, -9, -1.7}, {400, -6, -1.6});
  add("plank", {-5, -0.4, -1.4}, {8, 0.4, -1.3});
  add("fence", {-30, 5, -1.6}, {300, 5.1, 0.4});
  add("cable", {-500, -3, 6}, {900, -2.95, 6.05});
  add("slab", {14, -200, -1.6}, {18, 200, -1.5});
  add("mast", {9, 3.5, -300}, {9.4, 3.9, 300});
  add("bridge", {11, -80, 5}, {16, 80, 6});
  return around;
}

/// Returns the first column and row and the last column and row of the pixels whose rays meet the object, or
/// nothing if no ray does.
std::optional<std::array<uint32_t, 4>> mask_by_rays(const Boxes::Object& object, const Pose& local_from_body,
                                                    const CameraDesc& desc, const Pose& camera,
                                                    const std::vector<dvec2>& undistorted) {
  std::vector<dvec3> corners;
  for (const uint32_t i : object.indices) corners.push_back(local_from_body.apply(object.vertices[i]));
  std::optional<std::array<uint32_t, 4>> mask;
  for (uint32_t pixel = 0; pixel < undistorted.size(); ++pixel) {
    const uint32_t column = pixel % desc.width, row = pixel / desc.width;
    const dvec3 ray = camera.rotate({1.0, -undistorted[pixel].x, -undistorted[pixel].y});
    bool met = false;
    for (size_t i = 0; !met && i < corners.size(); i += 3)
      met = meets(camera.position, ray, corners[i], corners[i + 1], corners[i + 2], desc.near_m);
    if (!met) continue;
    if (!mask) mask = {column, row, column, row};
    mask = {std::min((*mask)[0], column), (*mask)[1], std::max((*mask)[2], column), row};
  }
  return mask;
}

TEST(Boxes, BehindALensHoldTheirMasks) {
  const Crowd around = crowd_of_long_things();
  const scene::Scene scene = labelled(around.tiny);
  const std::vector<Pose> moving(around.bodies.begin() + 1, around.bodies.end());
  const Pose camera = look({0.3, -0.2, 0.1}, 4, 3, 2);
  for (const render::Distortion& distortion : {render::Distortion{-0.22, 0.04, 0.002, -0.003, 0.0},
                                               {.k1 = -0.1, .p2 = 0.01},
                                               {0.25, 0.02, -0.004, 0.002, 0.01}}) {
    CameraDesc desc = box_camera(160, 120);
    desc.distortion = distortion;
    const std::vector<dvec2> undistorted = render::Lens(render::lens_geometry(desc)).centers();
    Boxes boxes(scene, desc, {});
    test::CameraRig rig(scene, test::plain_light(), desc);
    const std::vector<ObjectBox> found =
        boxes.find(camera, around.bodies, rig.shoot(camera, moving).instance);
    size_t at = 0, seen = 0;
    for (uint32_t i = 0; i < boxes.objects().size(); ++i) {
      const Boxes::Object& object = boxes.objects()[i];
      const auto mask = mask_by_rays(object, around.bodies[object.body], desc, camera, undistorted);
      const bool is_found = at < found.size() && found[at].object == i;
      EXPECT_TRUE(is_found || !mask) << i;
      if (!is_found) continue;
      const ObjectBox& box = found[at++];
      // The box of the object alone holds every pixel's centre. No side lies far beyond the last centre,
      // though corners reach between centres.
      constexpr double small = 1.0 / 128, nearest = 0.75;
      for (size_t side = 0; mask && side < 4; ++side) {
        const double center = (*mask)[side] + 0.5, edge = box.amodal[static_cast<int>(side)],
                     out = side < 2 ? center - edge : edge - center;
        EXPECT_GE(out, -small) << scene.instances[object.first_instance].name << ", side " << side;
        // If the object lies within the picture, no side is far from its pixels.
        if (box.unclipped == box.amodal && (*mask)[2] - (*mask)[0] > 8 && (*mask)[3] - (*mask)[1] > 8) {
          EXPECT_LT(out, 3.0) << scene.instances[object.first_instance].name << ", side " << side;
        }
      }
      // The rasteriser takes the nearest sample for faces that are less than a pixel across.
      if (box.visible == 0) continue;
      ++seen;
      EXPECT_GE(box.modal[0] + 0.5, box.amodal.x - nearest) << i;
      EXPECT_GE(box.modal[1] + 0.5, box.amodal.y - nearest) << i;
      EXPECT_LE(box.modal[2] - 0.5, box.amodal.z + nearest) << i;
      EXPECT_LE(box.modal[3] - 0.5, box.amodal.w + nearest) << i;
    }
    EXPECT_EQ(at, found.size());
    EXPECT_GT(seen, 20u);
  }
}

TEST(Boxes, BehindAWideLensHoldTheirMasks) {
  Crowd around = crowd_of_long_things();
  // Things behind the eye, one of them across the rims of the panorama.
  for (const double bearing : {140.0, 181.0, 215.0}) {
    const std::string name = "behind " + std::to_string(int(bearing));
    around.tiny.object(name, around.tiny.body(name)).box({-1, -1, -1}, {1, 1, 1});
    around.bodies.push_back(
        look({7 * std::cos(radians(bearing)), 7 * std::sin(radians(bearing)), bearing / 100 - 2}, bearing, 20,
             10));
  }
  const scene::Scene scene = labelled(around.tiny);
  const std::vector<Pose> moving(around.bodies.begin() + 1, around.bodies.end());
  const Pose camera = look({0.3, -0.2, 0.1}, 4, 3, 2);
  CameraDesc fisheye = box_camera(120, 120), panorama = box_camera(160, 80);
  fisheye.wide = {.model = render::LensModel::fisheye, .k1 = -0.02, .half_angle = radians(100.0)};
  fisheye.fx = fisheye.fy = 60.0 / fisheye.wide.shown(radians(95.0));
  panorama.wide.model = render::LensModel::equirectangular;
  panorama.fx = panorama.fy = 80.0 / pi;
  panorama.cx = 80.0;
  panorama.cy = 40.0;
  for (const CameraDesc& desc : {fisheye, panorama}) {
    const std::vector<dvec3> directions = render::LensRays(render::lens_geometry(desc)).centers();
    Boxes boxes(scene, desc, {});
    test::CameraRig rig(scene, test::plain_light(), desc);
    const std::vector<ObjectBox> found =
        boxes.find(camera, around.bodies, rig.shoot(camera, moving).instance);
    size_t at = 0, seen = 0;
    for (uint32_t i = 0; i < boxes.objects().size(); ++i) {
      const Boxes::Object& object = boxes.objects()[i];
      const std::string& name = scene.instances[object.first_instance].name;
      std::vector<dvec3> corners;
      for (const uint32_t k : object.indices)
        corners.push_back(around.bodies[object.body].apply(object.vertices[k]));
      uint32_t alone = 0;
      std::array<double, 4> mask{1e9, 1e9, -1e9, -1e9};
      for (uint32_t pixel = 0; pixel < directions.size(); ++pixel) {
        // Scaled so that the ray parameter is the depth within the face of the cube.
        dvec3 d = directions[pixel];
        if (d == dvec3(0.0)) continue;
        d /= std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
        const dvec3 ray = camera.rotate({d.z, -d.x, -d.y});
        bool met = false;
        for (size_t k = 0; !met && k < corners.size(); k += 3)
          met = meets(camera.position, ray, corners[k], corners[k + 1], corners[k + 2], desc.near_m);
        if (!met) continue;
        ++alone;
        const double u = pixel % desc.width + 0.5, v = pixel / desc.width + 0.5;
        mask = {std::min(mask[0], u), std::min(mask[1], v), std::max(mask[2], u), std::max(mask[3], v)};
      }
      const bool is_found = at < found.size() && found[at].object == i;
      EXPECT_TRUE(is_found || alone == 0) << name;
      if (!is_found) continue;
      const ObjectBox& box = found[at++];
      // The rasteriser also shows things less than a pixel wide where no ray meets them, and these pixels
      // are added. The ends of long things reach far between the centres of pixels, as at a pole.
      const bool compact = std::max({object.size.x, object.size.y, object.size.z}) < 5.0;
      if (compact) {
        EXPECT_NEAR(box.alone, alone, 2.0 + 0.02 * alone) << name;
      }
      seen += box.visible > 0 ? 1 : 0;
      constexpr double small = 1.0 / 128;
      for (int side = 0; alone > 0 && side < 4; ++side) {
        const double edge = box.amodal[side],
                     out = side < 2 ? mask[size_t(side)] - edge : edge - mask[size_t(side)];
        EXPECT_GE(out, -small) << name << ", side " << side;
        if (compact && alone > 60) {
          EXPECT_LT(out, 3.0) << name << ", side " << side;
        }
      }
    }
    EXPECT_EQ(at, found.size());
    EXPECT_GT(seen, 25u);
  }
}

TEST(Boxes, OfWhatCrossesTheNearPlaneReachToIt) {
  CameraDesc desc = box_camera();
  desc.near_m = 0.25;
  TinyScene tiny;
  // A plank below the camera that reaches from behind the camera to ahead of it.
  tiny.object("plank").quad({-5, -0.5, -1.5}, {8, -0.5, -1.5}, {8, 0.5, -1.5}, {-5, 0.5, -1.5});
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  const std::vector<ObjectBox> found = boxes.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc));
  ASSERT_EQ(found.size(), 1u);
  const ObjectBox& box = found[0];
  EXPECT_TRUE(box.crosses_near);
  EXPECT_NEAR(box.unclipped.x, desc.cx - desc.fx * 0.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.unclipped.y, desc.cy + desc.fy * 1.5 / 8.0, 1e-9);
  EXPECT_NEAR(box.unclipped.z, desc.cx + desc.fx * 0.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.unclipped.w, desc.cy + desc.fy * 1.5 / 0.25, 1e-9);
  EXPECT_NEAR(box.amodal.w, 64.0, 0.0);
  EXPECT_EQ(box.alone, rays_that_meet(boxes.objects()[0], {}, desc, look({0, 0, 0})));
}

TEST(Boxes, OfWhatIsBehindTheCameraAreNone) {
  const CameraDesc desc = box_camera();
  TinyScene tiny;
  tiny.object("behind").box({-9, -1, -1}, {-7, 1, 1});
  tiny.object("beside").box({1, 30, -1}, {2, 32, 1});
  tiny.object("far", 0).box({1e5, 0, 0}, {1e5 + 0.1, 0.1, 0.1});  // covers no pixel's centre
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  EXPECT_TRUE(boxes.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).empty());
}

TEST(Boxes, OfWhatIsLargerThanThePictureFillIt) {
  const CameraDesc desc = box_camera();
  TinyScene tiny;
  tiny.object("wall").quad({5, 50, -50}, {5, -50, -50}, {5, -50, 50}, {5, 50, 50});
  const scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  std::vector<uint32_t> all(96 * 64, 1);
  const std::vector<ObjectBox> found = boxes.find(look({0, 0, 0}), std::vector<Pose>(1), all);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].amodal, dvec4(0, 0, 96, 64));
  EXPECT_EQ(found[0].modal, (std::array<int32_t, 4>{0, 0, 96, 64}));
  EXPECT_EQ(found[0].alone, 96u * 64u);
  EXPECT_EQ(found[0].visibility(), 1.0);
  EXPECT_NEAR(found[0].truncation(), 1.0 - 96.0 * 64.0 / (desc.fx * 20.0 * desc.fy * 20.0), 1e-9);
}

TEST(Boxes, ASquareHalfHiddenIsHalfVisible) {
  CameraDesc desc = box_camera(64, 64);
  desc.fx = desc.fy = desc.cx = desc.cy = 32.0;
  TinyScene tiny;
  // The square covers 16 x 16 pixels at 8 m. A board at 4 m hides its left half.
  tiny.object("square").quad({8, 2, -2}, {8, -2, -2}, {8, -2, 2}, {8, 2, 2});
  tiny.object("board").quad({4, 2, -2}, {4, 0, -2}, {4, 0, 2}, {4, 2, 2});
  scene::Scene scene = labelled(tiny);
  Boxes boxes(scene, desc, {});
  test::CameraRig rig(scene, test::plain_light(), desc);
  const Pose camera = look({0, 0, 0});
  const std::vector<ObjectBox> found = boxes.find(camera, std::vector<Pose>(1), rig.shoot(camera).instance);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].alone, 256u);
  EXPECT_EQ(found[0].visible, 128u);
  EXPECT_EQ(found[0].visibility(), 0.5);
  EXPECT_EQ(found[0].amodal, dvec4(24, 24, 40, 40));
  EXPECT_EQ(found[0].modal, (std::array<int32_t, 4>{32, 24, 40, 40}));
  EXPECT_EQ(found[1].visibility(), 1.0);
  EXPECT_EQ(found[1].alone, 16u * 32u);
}

/// Compares each object's pixels in the picture with a picture of the object alone by the same rasteriser.
TEST(Boxes, VisibilityAgainstPicturesOfEachObjectAlone) {
  const CameraDesc desc = box_camera();
  const Crowd around = crowd(30, 4, 25);
  const scene::Scene scene = labelled(around.tiny);
  Boxes boxes(scene, desc, {});
  const Pose camera = look({0, 0, 0}, 3, 2, 1);
  test::CameraRig rig(scene, test::plain_light(), desc);
  const std::vector<Pose> moving(around.bodies.begin() + 1, around.bodies.end());
  const render::CameraImages all = rig.shoot(camera, moving);
  const std::vector<ObjectBox> found = boxes.find(camera, around.bodies, all.instance);
  EXPECT_GT(found.size(), 10u);
  int partly = 0;
  for (const ObjectBox& box : found) {
    const Boxes::Object& object = boxes.objects()[box.object];
    const uint32_t id = object.first_instance + 1;
    std::vector<Pose> alone(moving.size(), look({-1000, 0, 0}));
    alone[object.body - 1] = moving[object.body - 1];
    const std::vector<uint32_t> picture = rig.shoot(camera, alone).instance;
    const auto count = [&](const std::vector<uint32_t>& ids) { return std::ranges::count(ids, id); };
    EXPECT_EQ(box.visible, count(all.instance));
    // The rasteriser snaps vertices to 1/256 pixel, so that a pixel at the rim may fall to either side.
    EXPECT_NEAR(box.alone, static_cast<double>(count(picture)), 2.0);
    EXPECT_GE(box.alone, box.visible);
    EXPECT_GE(box.visibility(), 0.0);
    EXPECT_LE(box.visibility(), 1.0);
    partly += box.visibility() > 0.0 && box.visibility() < 0.99 ? 1 : 0;
  }
  EXPECT_GT(partly, 3);
  // Every id in the picture has a box.
  for (const uint32_t id : all.instance)
    EXPECT_TRUE(id == 0 || std::ranges::any_of(found, [&](const ObjectBox& box) {
                  return boxes.objects()[box.object].first_instance + 1 == id;
                }));
}

TEST(Boxes, PartsOfABodyAreOneObjectAndClassesChoose) {
  TinyScene tiny;
  const uint32_t car = tiny.body("car"), own = tiny.body("own");
  tiny.object("house").box({10, 5, 0}, {14, 9, 8});
  tiny.object("lamp").box({9, -3, 0}, {9.2, -2.8, 5});
  tiny.object("chassis", car).box({-2, -1, 0}, {2, 1, 1});
  tiny.object("roof", car).box({-1, -0.9, 1}, {1, 0.9, 1.5});
  tiny.object("bonnet", own).box({0.5, -1, -1}, {1, 1, -0.5});
  scene::Scene scene = tiny.build();
  using enum scene::SemanticClass;
  const scene::SemanticClass classes[] = {building, street_lamp, vehicle, vehicle, vehicle};
  for (size_t i = 0; i < 5; ++i) scene.instances[i].semantic_class = classes[i];
  CameraDesc desc = box_camera();
  desc.excluded_body = own;
  {
    Boxes boxes(scene, desc, {});
    ASSERT_EQ(boxes.objects().size(), 2u);
    EXPECT_EQ(boxes.objects()[0].first_instance, 1u);
    const Boxes::Object& object = boxes.objects()[1];
    EXPECT_EQ(object.first_instance, 2u);
    EXPECT_EQ(object.instance_count, 2u);
    EXPECT_EQ(object.semantic_class, vehicle);
    EXPECT_EQ(object.size, dvec3(4, 2, 1.5));
    EXPECT_EQ(object.body_from_box.position, dvec3(0, 0, 0.75));
    std::vector<uint32_t> ids = nothing(desc);
    ids[0] = 3, ids[1] = 4, ids[2] = 1, ids[96] = 4;  // chassis, roof, house
    const std::vector<ObjectBox> found =
        boxes.find(look({0, 0, 1}), std::vector<Pose>{{}, look({12, 0, 0}, 30), {}}, ids);
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[1].visible, 3u);
    EXPECT_EQ(found[1].modal, (std::array<int32_t, 4>{0, 0, 2, 2}));
    EXPECT_NEAR(glm::length(found[1].world_from_box.position - dvec3(12, 0, 0.75)), 0.0, 1e-12);
  }
  const std::vector<std::string> wanted{"building"};
  Boxes boxes(scene, desc, wanted);
  ASSERT_EQ(boxes.objects().size(), 1u);
  EXPECT_EQ(boxes.objects()[0].first_instance, 0u);
}

TEST(Boxes, OfUtmCoordinatesAreThoseOfTheOrigin) {
  const CameraDesc desc = box_camera();
  const dvec3 utm(448320.0, 5411904.0, 128.0);
  const auto make = [&](const dvec3& at) {
    TinyScene tiny;
    tiny.object("crate").box(at + dvec3(5, -1, -1), at + dvec3(7, 0.5, 1));
    return labelled(tiny, scene::SemanticClass::furniture, at);
  };
  const scene::Scene a = make(dvec3(0.0)), b = make(utm);
  Boxes here(a, desc, {}), there(b, desc, {});
  const ObjectBox x = here.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).at(0),
                  y = there.find(look({0, 0, 0}), std::vector<Pose>(1), nothing(desc)).at(0);
  EXPECT_EQ(x.unclipped, y.unclipped);
  EXPECT_EQ(x.alone, y.alone);
  EXPECT_LT(glm::length(y.world_from_box.position - x.world_from_box.position - utm), 1e-8);
  EXPECT_EQ(x.sensor_from_box.position, y.sensor_from_box.position);
}

}  // namespace
}  // namespace greatx::sim
