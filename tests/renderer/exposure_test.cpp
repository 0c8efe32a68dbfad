// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks smooth edges and exposures of finite duration.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

/// Returns a glowing half plane in the dark, 10 m away. `slope` is the inclination of its edge.
scene::Scene half_plane(double slope) {
  TinyScene tiny;
  scene::Material glow = optical_material("glow", 0.0f);
  glow.pbr.emissive = vec3(0.1f);
  tiny.object("plate", 0, tiny.material_as(glow))
      .quad({10, 0.13, -30}, {10, 0.13, 30}, {10, 40, 30}, {10, 40, -30});
  scene::Scene scene = tiny.build();
  for (vec3& p : scene.positions)
    if (p.y < 1.0f) p.y += float(slope) * p.z;
  return scene;
}

render::CameraDesc hdr_camera(uint32_t size, uint32_t msaa, bool smooth) {
  render::CameraDesc desc = plain_camera(size, msaa);
  desc.smooth_edges = smooth;
  desc.exposure_ev100 = 6.0;
  return desc;
}

/// Returns the root mean square of (radiance / glow - share of the pixel that the plate covers) over the
/// pixels of the edge.
double coverage_error(double slope, uint32_t msaa, bool smooth) {
  constexpr uint32_t size = 96;
  render::Lighting dark = plain_light(0.0, -30.0);
  dark.sky_illuminance_lux = 0.0;
  CameraRig rig(half_plane(slope), dark, hdr_camera(size, msaa, smooth));
  const render::CameraImages images = rig.shoot(look({0, 0, 0}));
  double sum = 0.0;
  size_t count = 0;
  for (uint32_t row = 0; row < size; ++row)
    for (uint32_t column = 0; column < size; ++column) {
      double covered = 0.0;  // y > 0.13 + slope z at x = 10, by 16 x 16 samples
      for (int k = 0; k < 256; ++k) {
        const double u = column + (k % 16 + 0.5) / 16.0, v = row + (k / 16 + 0.5) / 16.0;
        const double y = -10.0 * (u - 48.0) / 48.0, z = -10.0 * (v - 48.0) / 48.0;
        covered += (y > 0.13 + slope * z) / 256.0;
      }
      if (covered == 0.0 || covered == 1.0) continue;
      const double seen = images.hdr[3 * (size_t{row} * size + column)] / 100.0;
      sum += (seen - covered) * (seen - covered);
      ++count;
    }
  EXPECT_GT(count, 50u);
  return std::sqrt(sum / double(count));
}

TEST(Edges, SmoothOnesComeNearTheShareThatAPixelCovers) {
  for (const double slope : {0.07, 0.4, 0.9}) {
    const double plain = coverage_error(slope, 1, false), smooth = coverage_error(slope, 1, true);
    EXPECT_GT(plain, 0.2) << slope;  // a step compared with a ramp: 1 / sqrt(12)
    EXPECT_LT(smooth, 0.09) << slope;
    EXPECT_LT(smooth, coverage_error(slope, 4, false) + 0.03) << slope;
  }
}

TEST(Edges, FlatFacesHaveNoneBetweenTheirTriangles) {
  TinyScene tiny;
  tiny.quad({-20, -20, 0}, {20, -20, 0}, {20, 20, 0}, {-20, 20, 0});
  const auto hdr = [&](bool smooth) {
    CameraRig rig(tiny.build(), plain_light(30, 40), hdr_camera(64, 1, smooth));
    return rig.shoot(look({0, 0, 5}, 20.0, 90.0)).hdr;
  };
  EXPECT_EQ(hdr(true), hdr(false));
}

TEST(Edges, LeaveDepthAndIdsAlone) {
  const auto shot = [&](bool smooth) {
    CameraRig rig(half_plane(0.3), plain_light(), hdr_camera(48, 1, smooth));
    return rig.shoot(look({0, 0, 0}));
  };
  const render::CameraImages plain = shot(false), smooth = shot(true);
  EXPECT_EQ(plain.depth, smooth.depth);
  EXPECT_EQ(plain.instance, smooth.instance);
  EXPECT_NE(plain.hdr, smooth.hdr);
}

class Blur : public ::testing::Test {
 protected:
  Blur()
      : scene_(half_plane(0.0)), gpu_(device(), scene_, {.acceleration_structure = false, .textures = true}) {
    light_ = plain_light(0.0, -30.0);
    light_.sky_illuminance_lux = 0.0;
  }
  /// Returns the mean of pictures from these positions.
  render::CameraImages expose(const std::vector<dvec3>& eyes) {
    render::SceneLighting lighting(gpu_, light_, {});
    render::CameraDesc desc = hdr_camera(64, 1, false);
    desc.parts = true;
    render::CameraPass camera(lighting, desc);
    gpu::TickRing ring(device(), 2, 1 << 16, 1 << 20);
    gpu::TickSlot& slot = ring.begin();
    gpu_.record_update(slot, std::vector<Pose>(1));
    lighting.record(slot, std::vector<Pose>(1));
    for (size_t i = 0; i < eyes.size(); ++i)
      camera.record(slot, look(eyes[i]), {},
                    {.weight = 1.0f / float(eyes.size()), .first = i == 0, .last = i + 1 == eyes.size()});
    ring.submit(slot);
    ring.wait(slot);
    return camera.collect(slot);
  }

  scene::Scene scene_;
  scene::GpuScene gpu_;
  render::Lighting light_;
};

TEST_F(Blur, IsTheMeanOfItsInstants) {
  const std::vector<dvec3> eyes{{0, -2, 0}, {0, 1, 0}, {0, 3, 0}};
  const render::CameraImages blurred = expose(eyes);
  std::vector<double> mean(blurred.hdr.size());
  for (const dvec3& eye : eyes) {
    const render::CameraImages one = expose({eye});
    for (size_t i = 0; i < mean.size(); ++i) mean[i] += one.hdr[i] / 3.0;
  }
  size_t between = 0;
  for (size_t i = 0; i < mean.size(); ++i) {
    EXPECT_NEAR(blurred.hdr[i], mean[i], 0.2);  // of 100 cd/m^2, rounded to fp16 three times
    between += mean[i] > 20.0 && mean[i] < 80.0;
  }
  EXPECT_GT(between, 500u);
}

TEST_F(Blur, DepthAndIdsAreTheLastInstants) {
  const render::CameraImages blurred = expose({{0, -2, 0}, {0, 3, 0}, {0, 1, 0}}), last = expose({{0, 1, 0}});
  EXPECT_EQ(blurred.depth, last.depth);
  EXPECT_EQ(blurred.instance, last.instance);
}

TEST_F(Blur, OfWhatStandsStillIsThePicture) {
  const render::CameraImages blurred = expose({{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}});
  const render::CameraImages sharp = expose({{0, 1, 0}});
  for (size_t i = 0; i < sharp.hdr.size(); ++i) EXPECT_NEAR(blurred.hdr[i], sharp.hdr[i], 0.2);
}

}  // namespace
}  // namespace greatx::test
