// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks that a white sphere in a uniformly white world is invisible: it reflects all incident light at every
// angle.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "scene/build/build.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns a sphere that shades as a round one: its vertex normals are those of the sphere, so that all
/// angles from 0 to 90 degrees occur.
scene::Scene sphere(const scene::Material& material) {
  constexpr int rings = 24, sectors = 48;
  const auto point = [](int ring, int sector) {
    const double polar = pi * ring / rings, azimuth = 2.0 * pi * sector / sectors;
    return dvec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
  };
  TinyScene tiny;
  tiny.object("sphere", 0, tiny.material_as(material));
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const dvec3 a = point(ring, sector), b = point(ring + 1, sector), c = point(ring + 1, sector + 1),
                  d = point(ring, sector + 1);
      if (ring + 1 < rings) tiny.triangle(a, b, c);
      if (ring > 0) tiny.triangle(a, c, d);
    }
  scene::Scene scene = tiny.build();
  for (size_t i = 0; i < scene.positions.size(); ++i) scene.normals[i] = glm::normalize(scene.positions[i]);
  return scene;
}

struct Contrast {
  size_t pixels = 0;     ///< pixels of the sphere
  double largest = 0.0;  ///< |L / L_world - 1|
};

Contrast contrast_of(const scene::Material& material) {
  CameraRig rig(sphere(material), white_world(), plain_camera(64));
  const render::CameraImages images = rig.shoot(look({-1.8, 0, 0}));
  Contrast contrast;
  for (size_t i = 0; i < images.depth.size(); ++i) {
    contrast.pixels += std::isfinite(images.depth[i]);
    contrast.largest = std::max(contrast.largest, std::abs(luminance_at(images, i) / (15000.0 / pi) - 1.0));
  }
  return contrast;
}

TEST(Furnace, WhiteSphereDisappears) {
  for (const float metallic : {0.0f, 1.0f})
    for (const float roughness : {0.1f, 0.25f, 0.5f, 0.75f, 1.0f}) {
      const Contrast contrast = contrast_of(optical_material("white", 1.0f, metallic, roughness));
      EXPECT_GT(contrast.pixels, 500u);
      EXPECT_LT(contrast.largest, 4e-3) << metallic << " " << roughness;
    }
}

TEST(Furnace, GreySphereDoesNot) { EXPECT_GT(contrast_of(optical_material("grey", 0.5f)).largest, 0.3); }

TEST(Furnace, NothingElseGains) {
  // Grey metal, and a white material between dielectric and metal. The latter loses up to a sixth because the
  // lobe is not linear in F0.
  for (const auto& [grey, metallic, roughness] : {std::array{0.7f, 1.0f, 0.1f},
                                                  {0.7f, 1.0f, 0.5f},
                                                  {0.7f, 1.0f, 1.0f},
                                                  {1.0f, 0.5f, 0.1f},
                                                  {1.0f, 0.5f, 1.0f}}) {
    CameraRig rig(sphere(optical_material("grey", grey, metallic, roughness)), white_world(),
                  plain_camera(64));
    const render::CameraImages images = rig.shoot(look({-1.8, 0, 0}));
    for (size_t i = 0; i < images.depth.size(); ++i) {
      const double least = metallic < 1.0f ? 0.8 : 0.55;
      EXPECT_LE(luminance_at(images, i) / (15000.0 / pi), 1.004) << metallic << " " << roughness << " " << i;
      EXPECT_GE(luminance_at(images, i) / (15000.0 / pi), least) << metallic << " " << roughness << " " << i;
    }
  }
}

}  // namespace
}  // namespace greatx::test
