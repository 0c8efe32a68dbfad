// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks depth and ids behind distorting lenses against an fp64 ray through the centre of every pixel.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "renderer/lens/lens.h"
#include "tests/renderer/truth_rig.h"

namespace greatx::test {
namespace {

using render::Distortion;
using render::Lens;

const Distortion lenses[] = {
    {-0.22, 0.04, 0.002, -0.003, 0.0}, {0.25, 0.02, -0.004, 0.002, 0.01}, {.k1 = -0.05, .p2 = 0.01}};

CameraDesc lens_camera(const Distortion& distortion, uint32_t msaa, uint32_t width = 96,
                       uint32_t height = 72) {
  CameraDesc desc = truth_camera(width, msaa);
  desc.height = height;
  desc.cy = 0.5 * height + 1.625;
  desc.distortion = distortion;
  return desc;
}
Lens lens_of(const CameraDesc& desc) { return Lens(render::lens_geometry(desc)); }

/// Returns the ray through a point of the picture in local coordinates, with planar depth 1.
dvec3 lens_ray(const Lens& lens, const Pose& camera, const dvec2& pixel) {
  const dvec2 n = lens.undistorted(pixel);
  return camera.rotate(dvec3(1.0, -n.x, -n.y));
}

/// Returns the planar depths at which a ray meets an instance, including hidden ones.
std::vector<double> depths_of(const scene::Scene& scene, const Moment& now, const dvec3& ray, uint32_t id) {
  std::vector<double> depths;
  double from = 0.0;
  while (const std::optional<Hit> hit = cast(scene, now.bodies, now.camera.position + from * ray, ray)) {
    from += hit->distance;
    if (scene.primitives[hit->primitive].instance + 1 == id) depths.push_back(from);
    from += 1e-6 * from;
  }
  return depths;
}

/// Returns whether the instance has this depth within a pixel of `pixel`: the depth must lie between the
/// smallest and the largest one that a grid of rays finds, within one step of the grid. For id 0, returns
/// whether one of these rays meets nothing.
bool is_nearby(const scene::Scene& scene, const Lens& lens, const Moment& now, const dvec2& pixel,
               uint32_t id, double depth) {
  constexpr int steps = 6;
  double least = INFINITY, most = 0.0;
  for (int i = -steps; i <= steps; ++i)
    for (int j = -steps; j <= steps; ++j) {
      const dvec2 at = glm::clamp(pixel + dvec2(i, j) / double(steps), dvec2(0.0),
                                  dvec2(lens.geometry().width, lens.geometry().height));
      const dvec3 ray = lens_ray(lens, now.camera, at);
      if (id == 0 && !cast(scene, now.bodies, now.camera.position, ray)) return true;
      for (const double met : depths_of(scene, now, ray, id)) {
        least = std::min(least, met);
        most = std::max(most, met);
      }
    }
  // Inverse depth is linear in the picture.
  const double inverse = 1.0 / depth, low = 1.0 / most, high = 1.0 / least, step = (high - low) / steps;
  return inverse > 0.0 && inverse > 0.999 * low - step && inverse < 1.001 * high + step;
}

struct Comparison {
  int same = 0;                 ///< pixels with the surface that their ray meets
  int near = 0;                 ///< pixels with the surface that a ray within one pixel meets
  int wrong = 0;                ///< all other pixels
  int surfaces = 0, exact = 0;  ///< of `same`: nearer than 50 m; of these, depth within 1e-5
};
Comparison compare(TruthRig& rig, const CameraDesc& desc, const Moment& now) {
  const Picture picture = rig.shoot(now, now);
  const Lens lens = lens_of(desc);
  Comparison result;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t pixel = size_t{row} * desc.width + column;
      const dvec2 center(column + 0.5, row + 0.5);
      const dvec3 ray = lens_ray(lens, now.camera, center);
      const std::optional<Hit> hit = cast(rig.scene(), now.bodies, now.camera.position, ray);
      const uint32_t expected = hit ? rig.scene().primitives[hit->primitive].instance + 1 : 0,
                     id = picture.images.instance[pixel];
      const double depth = picture.images.depth[pixel],
                   error = hit                 ? std::abs(depth - hit->distance) / hit->distance
                           : std::isinf(depth) ? 0.0
                                               : 1.0;
      if (id == expected && error < 1e-3) {
        ++result.same;
        result.surfaces += depth < 50.0 ? 1 : 0;
        result.exact += depth < 50.0 && error < 1e-5 ? 1 : 0;
        const double distance = depth * glm::length(ray);
        if (hit) {
          EXPECT_NEAR(picture.truth.depth_ray[pixel], distance, 1e-6 * distance);
        }
        continue;
      }
      if (is_nearby(rig.scene(), lens, now, center, id, depth)) {
        ++result.near;
        continue;
      }
      ++result.wrong;
      if (result.wrong <= 10)
        ADD_FAILURE() << "pixel " << column << ' ' << row << ": id " << id << ", " << depth
                      << " m; its ray meets " << expected << " at " << (hit ? hit->distance : INFINITY);
    }
  return result;
}

/// Returns boards at grazing angles before ground, boxes and sky. An extrapolation of their planes past the
/// outlines leads far away.
TinyScene boards() {
  TinyScene scene = street();
  std::mt19937 draw(11);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(draw()) / static_cast<double>(std::mt19937::max());
  };
  for (int i = 0; i < 24; ++i) {
    const double range = uniform(3, 40), bearing = radians(uniform(-50, 50)),
                 turn = bearing + radians(uniform(-3, 3));
    const dvec3 at(range * std::cos(bearing), range * std::sin(bearing), uniform(-2, 2) * range / 10);
    const dvec3 along = uniform(1, 10) * dvec3(std::cos(turn), std::sin(turn), 0.0),
                up(0.0, 0.0, uniform(0.5, 3));
    scene.object("board " + std::to_string(i)).quad(at, at + along, at + along + up, at + up);
  }
  for (int i = 0; i < 16; ++i) {
    const dvec3 half(uniform(0.2, 1.5), uniform(0.2, 1.5), uniform(0.2, 1.5));
    const dvec3 at(uniform(4, 30), uniform(-15, 15), uniform(-2, 4));
    scene.object("box " + std::to_string(i)).box(at - half, at + half);
  }
  return scene;
}

TEST(LensTruth, DepthAndIdsAreThoseOfThePixelsRays) {
  for (const uint32_t msaa : {1u, 4u})
    for (const Distortion& distortion : lenses) {
      const CameraDesc desc = lens_camera(distortion, msaa);
      TruthRig rig(boards().build(), desc, {.normals = false, .depth_ray = true, .flow = false});
      const Comparison found = compare(rig, desc, {look({0.3, -0.2, 0.1}, 3, 2, 5)});
      EXPECT_EQ(found.wrong, 0);
      // No sample of the pinhole picture sees these pixels: corners, and boards less than a pixel across.
      EXPECT_LT(found.near, 0.01 * desc.width * desc.height) << msaa;
      EXPECT_GT(found.exact, 0.98 * found.surfaces) << msaa;  // the others are seen at grazing angles
      EXPECT_GT(found.surfaces, 2000);
    }
}

/// The share of the picture that surfaces smaller than a pixel cover equals that of the rays.
TEST(LensTruth, LeavesSmallerThanPixelsCoverTheirShare) {
  const CameraDesc desc = lens_camera(lenses[0], 1, 64, 48);
  TinyScene tiny;
  tiny.object("wall").quad({20, 60, -60}, {20, -60, -60}, {20, -60, 60}, {20, 60, 60});
  tiny.object("leaves");
  std::mt19937 draw(5);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(draw()) / static_cast<double>(std::mt19937::max());
  };
  const double pixel = 10.0 / desc.fx;
  for (int i = 0; i < 4000; ++i) {
    const dvec3 at(10.0 + uniform(-1, 1), uniform(-10, 10), uniform(-8, 8));
    const auto corner = [&] {
      return at + 0.8 * pixel * dvec3(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
    };
    const dvec3 a = corner(), b = corner(), c = corner();
    tiny.triangle(a, b, c);
  }
  TruthRig rig(tiny.build(), desc, {.normals = false, .depth_ray = true, .flow = false});
  const Moment now{look({0, 0, 0})};
  const Picture picture = rig.shoot(now, now);
  const Lens lens = lens_of(desc);
  int leaves = 0, expected = 0;
  for (uint32_t i = 0; i < desc.width * desc.height; ++i) {
    const dvec2 center(i % desc.width + 0.5, i / desc.width + 0.5);
    const std::optional<Hit> hit =
        cast(rig.scene(), now.bodies, now.camera.position, lens_ray(lens, now.camera, center));
    expected += hit && rig.scene().primitives[hit->primitive].instance == 1 ? 1 : 0;
    leaves += picture.images.instance[i] == 2 ? 1 : 0;
    if (picture.images.instance[i] == 2) {
      ASSERT_GT(picture.images.depth[i], 8.5f);
      ASSERT_LT(picture.images.depth[i], 11.5f);
    }
  }
  EXPECT_GT(expected, 500);
  EXPECT_NEAR(leaves, expected, 0.06 * expected);
}

}  // namespace
}  // namespace greatx::test
