// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares boxes behind lenses with dense samples of edges and with rays in fp64.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "tests/sim/box_crowd.h"

namespace greatx::sim {
namespace {

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

/// The boxes of a crowd through the lens of a camera that sees all of it.
struct Seen {
  Seen(const Crowd& around, const scene::Scene& scene, const CameraDesc& desc, const Pose& camera)
      : boxes(scene, desc, {}) {
    const std::vector<Pose> moving(around.bodies.begin() + 1, around.bodies.end());
    test::CameraRig rig(scene, test::plain_light(), desc);
    found = boxes.find(camera, around.bodies, rig.shoot(camera, moving).instance);
  }
  Boxes boxes;
  std::vector<ObjectBox> found;
};

TEST(Boxes, BehindALensHoldTheirMasks) {
  const Crowd around = crowd_of_long_things();
  const scene::Scene scene = labelled(around.tiny);
  const Pose camera = look({0.3, -0.2, 0.1}, 4, 3, 2);
  for (const render::Distortion& distortion : {render::Distortion{-0.22, 0.04, 0.002, -0.003, 0.0},
                                               {.k1 = -0.1, .p2 = 0.01},
                                               {0.25, 0.02, -0.004, 0.002, 0.01}}) {
    CameraDesc desc = box_camera(160, 120);
    desc.distortion = distortion;
    const std::vector<dvec2> undistorted = render::Lens(render::lens_geometry(desc)).centers();
    const auto [boxes, found] = Seen(around, scene, desc, camera);
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
    const auto [boxes, found] = Seen(around, scene, desc, camera);
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

}  // namespace
}  // namespace greatx::sim
