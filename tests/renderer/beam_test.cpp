// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the passing beam of vehicles against the points of the regulation, and pictures against the formula.
#include "shaders/shared/beam.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "renderer/light/lamp_shadow.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {
namespace {

double tangent(double degrees) { return std::tan(radians(degrees)); }

/// Returns the intensity of a lamp of 12000 cd, cd, at angles from the horizon and straight ahead. Its elbow
/// lies 1 % below the horizon.
double candelas(double right_deg, double up_deg) {
  return 12000.0 * double(shared::passing_beam(float(tangent(right_deg)), float(tangent(up_deg) + 0.01)));
}

TEST(PassingBeam, MeetsTheMainPointsOfRegulation112) {
  // UN Regulation 112, class B, right-hand traffic: lux on a screen 25 m away, times 625 m^2.
  EXPECT_LE(candelas(-3.43, 0.57), 0.4 * 625) << "B 50 L, the eyes of an oncoming driver";
  EXPECT_GE(candelas(1.15, -0.57), 12.0 * 625) << "75 R";
  EXPECT_LE(candelas(-3.43, -0.57), 12.0 * 625) << "75 L";
  EXPECT_LE(candelas(-3.43, -0.86), 15.0 * 625) << "50 L";
  EXPECT_GE(candelas(1.72, -0.86), 12.0 * 625) << "50 R";
  EXPECT_GE(candelas(0.0, -0.86), 6.0 * 625) << "50 V";
  EXPECT_GE(candelas(-9.0, -1.72), 2.0 * 625) << "25 L";
  EXPECT_GE(candelas(9.0, -1.72), 2.0 * 625) << "25 R";
  for (double right = -5.14; right <= 5.14; right += 0.257)
    for (double up = -1.72; up <= -0.86; up += 0.086)
      EXPECT_GE(candelas(right, up), 3.0 * 625) << "zone IV at " << right << ", " << up;
  for (double right = -8.0; right <= 8.0; right += 0.25)
    for (double up = 0.0; up <= 4.0; up += 0.25) {
      if (right > 0.0 && tangent(up) <= 0.26794919 * tangent(right)) continue;
      EXPECT_LE(candelas(right, up), 0.7 * 625) << "zone III at " << right << ", " << up;
    }
}

TEST(PassingBeam, HasItsCutOffAndAPeakOfOne) {
  float most = 0.0f;
  for (int i = -400; i <= 400; ++i)
    for (int k = -300; k <= 100; ++k)
      most = std::max(most, shared::passing_beam(0.002f * float(i), 0.002f * float(k)));
  EXPECT_NEAR(most, 1.0f, 2e-3f);
  // Half of the step lies on the line that is level on the left and rises by 15 degrees on the right.
  const double middle = 0.5 * double(shared::beam_edge_low + shared::beam_edge_high);
  for (const double right : {-0.1, -0.03, 0.0, 0.03, 0.08}) {
    const double line = right > 0.0 ? right * std::tan(radians(15.0)) : 0.0;
    const auto at = [&](double above) {
      return double(shared::passing_beam(float(right), float(line + above)));
    };
    EXPECT_NEAR(at(0.004), double(shared::beam_stray), 1e-6) << right;
    EXPECT_GT(at(-0.006), 8.0 * at(0.004)) << right;
    EXPECT_NEAR(at(middle) / at(double(shared::beam_edge_low)), 0.5, 0.12) << right;
  }
}

TEST(PassingBeam, LightsAWallAsTheFormulaSays) {
  // A lamp 0.65 m above the ground of a body that has turned shines onto a wall 25 m ahead of it.
  TinyScene tiny;
  const uint32_t car = tiny.body("car");
  tiny.object("wall", 0, tiny.material_as(optical_material("white", 0.8f)))
      .quad({25, 12, -6}, {25, -12, -6}, {25, -12, 6}, {25, 12, 6});
  tiny.object("car", car).box({-1, -0.1, -0.1}, {-0.5, 0.1, 0.1});
  scene::Scene scene = tiny.build();
  scene::PunctualLight lamp;
  lamp.type = scene::PunctualLight::Type::spot;
  lamp.beam = scene::PunctualLight::Beam::passing;
  lamp.direction = glm::normalize(dvec3(0.0, 1.0, -0.01));
  lamp.intensity = 12000.0f;
  lamp.range_m = 200.0f;
  lamp.inner_cone = float(radians(20.0));
  lamp.outer_cone = float(radians(35.0));
  lamp.body = car;
  scene.lights = {lamp};
  render::CameraEffects effects = lambertian();
  effects.sun = effects.sky = false;
  effects.lamp_shadows = true;
  render::CameraDesc desc = plain_camera(240, 1);
  desc.exposure_ev100 = 5.0;
  CameraRig rig(std::move(scene), plain_light(), desc, effects);
  const Pose sensor = look({10, 0, 0});
  // The body's y becomes the local x.
  const Pose turned{{0.0, 0.0, 0.0}, orientation_from_yaw_pitch_roll(radians(-90.0), 0.0, 0.0)};
  const render::CameraImages images = rig.shoot(sensor, {turned});
  size_t seen = 0, dark = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      const size_t i = size_t(row) * desc.width + column;
      if (images.instance[i] != 1) continue;
      const dvec3 p = sensor.apply(pixel_ray(desc, column, row) * double(images.depth[i]));
      const double d = glm::length(p), cosine = p.x / d;
      const dvec3 axis = glm::normalize(dvec3(1.0, 0.0, -0.01)), up(0.01 / std::sqrt(1.0001), 0.0, axis.x);
      const double along = glm::dot(p, axis);
      if (along / d < std::cos(radians(20.0))) continue;
      const double share = double(shared::passing_beam(float(-p.y / along), float(glm::dot(p, up) / along)));
      const double window = 1.0 - std::pow(d / 200.0, 4.0);
      const double expected = 0.8 / pi * 12000.0 * share * window * cosine / (d * d);
      EXPECT_NEAR(luminance_at(images, i), expected, 2e-3 * expected + 2e-3) << p.y << " " << p.z;
      ++seen;
      dark += share < 0.02;
    }
  EXPECT_GT(seen, 5000u);
  EXPECT_GT(dark, 2000u);
}

}  // namespace
}  // namespace greatx::test
