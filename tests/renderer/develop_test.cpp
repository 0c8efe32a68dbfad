// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks development on the GPU against the same functions on the host, and the exposure meter against closed
// forms.
#include "renderer/camera/develop.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include "core/error.h"
#include "shaders/shared/develop.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

using render::CameraDesc;
using render::CameraImages;

/// Returns boxes of several greys in the sun below the sky, from dark to bright.
TinyScene boxes() {
  TinyScene tiny;
  for (int i = 0; i < 6; ++i) {
    const uint32_t material =
        tiny.material_as(optical_material("grey " + std::to_string(i), 0.02f + 0.18f * float(i)));
    tiny.object("box " + std::to_string(i), 0, material)
        .box({4, -6 + 2 * i, -2}, {6, -4.4 + 2 * i, -1 + 0.5 * i});
  }
  return tiny;
}

CameraDesc camera(uint32_t width = 101, uint32_t height = 67) {
  CameraDesc desc = plain_camera(64, 1);
  desc.width = width;
  desc.height = height;
  desc.fx = desc.fy = 0.5 * width;
  desc.cx = 0.5 * width;
  desc.cy = 0.5 * height;
  return desc;
}

CameraImages shoot(const CameraDesc& desc, const render::FrameNumber& frame = {}) {
  CameraRig rig(boxes().build(), plain_light(30.0, 50.0), desc);
  return rig.collect(rig.record(look({0, 0, 0}), {}, frame));
}

/// Returns the stored light of a pixel relative to L_max.
vec3 light_of(const CameraImages& images, size_t pixel, double saturation) {
  vec3 light;
  for (int c = 0; c < 3; ++c) light[c] = static_cast<float>(images.hdr[3 * pixel + size_t(c)] / saturation);
  return light;
}

/// Holds the fraction of bytes that differ from the developed `light(pixel)`, and the largest difference.
struct Difference {
  double fraction = 0.0;
  int most = 0;
};
Difference difference(const CameraImages& images, const std::function<vec3(size_t)>& light) {
  Difference d;
  for (size_t i = 0; i < size_t{images.width} * images.height; ++i) {
    const vec3 mapped = shared::tone_map(light(i));
    for (int c = 0; c < 3; ++c) {
      const int off = std::abs(int(shared::srgb_byte(mapped[c])) - int(images.rgb[3 * i + size_t(c)]));
      d.fraction += off != 0;
      d.most = std::max(d.most, off);
    }
  }
  d.fraction /= 3.0 * images.width * images.height;
  return d;
}

TEST(Develop, BytesAreThoseOfTheHostsFunctions) {
  const CameraDesc desc = camera();
  const CameraImages images = shoot(desc);
  const double saturation = render::saturation_luminance(desc.exposure_ev100);
  const Difference d = difference(images, [&](size_t i) { return light_of(images, i, saturation); });
  EXPECT_LE(d.most, 1);  // a tie may round either way
  EXPECT_LE(d.fraction, 1e-3);
  EXPECT_EQ(images.ev100, 15.0f);
}

TEST(Develop, VignettingActsOnRgbAlone) {
  CameraDesc desc = camera();
  const CameraImages plain = shoot(desc);
  desc.vignetting = {.natural = true, .radial = {-0.1, -0.05, 0.0}};
  const CameraImages images = shoot(desc);
  EXPECT_EQ(images.hdr, plain.hdr);
  EXPECT_EQ(images.depth, plain.depth);
  const std::vector<float> field = render::flat_field(
      desc.vignetting, {desc.name, desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy, {}});
  const double saturation = render::saturation_luminance(desc.exposure_ev100);
  const Difference d =
      difference(images, [&](size_t i) { return light_of(images, i, saturation) * field[i]; });
  EXPECT_LE(d.most, 1);
  EXPECT_LE(d.fraction, 1e-3);
  EXPECT_LT(images.rgb[0], plain.rgb[0]);
}

TEST(Develop, NoiseIsTheHostsFunctionOfSeedSensorTickAndPixel) {
  CameraDesc desc = camera();
  desc.exposure_ev100 = 13.0;
  desc.noise =
      render::SensorNoise{.full_well_e = 400.0, .read_noise_e = 3.0, .bits = 10, .seed = 5, .stream = 9};
  const render::FrameNumber frame{2, 31};
  const CameraImages images = shoot(desc, frame);
  const shared::SensorConstants sensor = render::sensor_constants(*desc.noise, frame);
  const double saturation = render::saturation_luminance(desc.exposure_ev100);
  const Difference d = difference(images, [&](size_t i) {
    return shared::sensed_color(light_of(images, i, saturation), sensor, static_cast<uint32_t>(i));
  });
  // Logarithms and roots differ by a few ulp between devices, so that a digital number may become its
  // neighbour.
  EXPECT_LE(d.fraction, 2e-3);

  EXPECT_EQ(shoot(desc, frame).rgb, images.rgb);
  EXPECT_NE(shoot(desc, {2, 32}).rgb, images.rgb);
  EXPECT_NE(shoot(desc, {3, 31}).rgb, images.rgb);
  CameraDesc other = desc;
  other.noise->stream = 10;
  EXPECT_NE(shoot(other, frame).rgb, images.rgb);
  other = desc;
  other.noise->seed = 6;
  EXPECT_NE(shoot(other, frame).rgb, images.rgb);
  // Radiance, depth and ids equal those without noise.
  CameraDesc clean = desc;
  clean.noise.reset();
  const CameraImages without = shoot(clean, frame);
  EXPECT_EQ(without.hdr, images.hdr);
  EXPECT_EQ(without.instance, images.instance);
  EXPECT_NE(without.rgb, images.rgb);
}

/// Takes a picture of a sky of uniform luminance.
CameraImages uniform(double luminance, const std::function<void(CameraDesc&)>& change = {}) {
  const render::Lighting light = white_world(pi * luminance);
  CameraDesc desc = camera();
  desc.automatic_exposure = true;
  if (change) change(desc);
  CameraRig rig(TinyScene().build(), light, desc);
  return rig.shoot(look({0, 0, 0}));
}

TEST(Meter, AUniformPictureGetsTheExposureOfItsLuminance) {
  for (const double luminance : {0.02, 1.0, 250.0, 8000.0}) {
    const CameraImages images = uniform(luminance);
    // The key value of Krawczyk et al. 2005, eq. 11, over 0.18: 0.19 at 0.02 cd/m^2, 0.894 at 1 cd/m^2.
    const double key = std::min((1.03 - 2.0 / (2.0 + std::log10(luminance + 1.0))) / 0.18, 1.0);
    EXPECT_NEAR(images.ev100, render::metered_ev100(luminance) - std::log2(key), 0.02) << luminance;
    // The exposure maps the mean to 12.5 / 120 of L_max, and less by night.
    const uint32_t expected = shared::srgb_byte(shared::tone_map(vec3(12.5f / 120.0f * float(key))).x);
    EXPECT_NEAR(images.rgb[0], expected, 2.0);
    EXPECT_NEAR(luminance_at(images, 0), luminance, 2e-3 * luminance);
  }
  EXPECT_NEAR(uniform(250.0, [](CameraDesc& d) { d.compensation_ev = 1.5; }).ev100,
              render::metered_ev100(250.0) - 1.5, 0.02);
}

TEST(Meter, EndsWhereCamerasDo) {
  EXPECT_EQ(uniform(1e-3).ev100, shared::meter_least_ev100);
  EXPECT_EQ(uniform(8000.0, [](CameraDesc& d) { d.compensation_ev = -10.0; }).ev100,
            shared::meter_most_ev100);
}

TEST(Meter, IsTheTrimmedMeanOfLogarithmsOverItsGrid) {
  CameraDesc desc = camera(320, 200);
  desc.automatic_exposure = true;
  const CameraImages images = shoot(desc);
  std::vector<double> logs;
  for (uint32_t y = 0; y < 200; ++y)
    for (uint32_t x = 0; x < 320; ++x) {
      if (size_t{320} * 200 > shared::meter_most_samples && (x % 2 != 1 || y % 2 != 1)) continue;
      const size_t i = size_t{y} * 320 + x;
      if (const double l = luminance_at(images, i); l > 0.0)
        logs.insert(logs.end(), images.instance[i] != 0 ? 8 : 1, std::log2(l));
    }
  std::ranges::sort(logs);
  const size_t cut = size_t(0.05 * double(logs.size()));
  double mean = 0.0;
  for (size_t i = cut; i < logs.size() - cut; ++i) mean += logs[i];
  mean /= double(logs.size() - 2 * cut);
  // The trimming does not know the order within a bin of a sixth of a stop.
  EXPECT_NEAR(images.ev100, render::metered_ev100(std::exp2(mean)), 0.03);
  // A second picture is equal.
  const CameraImages again = shoot(desc);
  EXPECT_EQ(again.ev100, images.ev100);
  EXPECT_EQ(again.rgb, images.rgb);
}

TEST(Meter, AutomaticExposureStoresRadianceForTheLight) {
  // The same formats serve day and night: stored radiance keeps three digits from a thousandth of the mean to
  // a thousand times the mean.
  EXPECT_NEAR(render::anchor_luminance(100000.0), 1.2 * 8.0 * 0.18 / pi * 100000.0, 1.0);
  EXPECT_EQ(render::anchor_luminance(0.0), render::anchor_luminance(1.0));
  const double night = render::anchor_luminance(0.0);
  EXPECT_LT(night * 0x1.0p-14, 1e-4);
  EXPECT_GT(night * 65504.0, 3e4);
}

TEST(Develop, BadInputIsRefusedByName) {
  const scene::Scene scene = boxes().build();
  const scene::GpuScene gpu(device(), scene, {.acceleration_structure = false, .textures = true});
  const render::SceneLighting lighting(gpu, plain_light(), {});
  const auto message = [&](const std::function<void(CameraDesc&)>& spoil) -> std::string {
    CameraDesc desc = camera();
    desc.name = "front";
    desc.noise.emplace();
    spoil(desc);
    try {
      render::DevelopPass pass(lighting, desc);
    } catch (const UserError& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  using testing::HasSubstr;
  EXPECT_THAT(message([](CameraDesc& d) { d.noise->full_well_e = 0.0; }),
              HasSubstr("camera front: noise.full_well_e"));
  EXPECT_THAT(message([](CameraDesc& d) { d.noise->read_noise_e = -1.0; }), HasSubstr("noise.read_noise_e"));
  EXPECT_THAT(message([](CameraDesc& d) { d.noise->bits = 0; }), HasSubstr("noise.bits"));
  EXPECT_THAT(message([](CameraDesc& d) { d.noise->bits = 17; }), HasSubstr("noise.bits"));
  EXPECT_THAT(message([](CameraDesc& d) { d.compensation_ev = NAN; }), HasSubstr("compensation_ev"));
  EXPECT_THAT(message([](CameraDesc& d) { d.vignetting.radial[0] = -9.0; }),
              HasSubstr("camera front: vignetting"));
}

}  // namespace
}  // namespace greatx::test
