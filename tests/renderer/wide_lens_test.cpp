// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the models of fisheye and equirectangular lenses on the host: closed forms, round trips, folds.
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "renderer/lens/lens_rays.h"

namespace greatx::test {
namespace {

using render::LensGeometry;
using render::LensModel;
using render::LensRays;
using render::WideLens;

LensGeometry fisheye(const WideLens& k, double circle_deg = 220.0) {
  LensGeometry g{"rig/eye", 640, 480, 190.0, 200.0, 322.5, 237.25, {}, k};
  g.wide.model = LensModel::fisheye;
  g.wide.half_angle = 0.5 * radians(circle_deg);
  return g;
}
LensGeometry equirectangular(uint32_t height) {
  LensGeometry g{"rig/ball",   2 * height,   height, height / pi, height / pi,
                 1.0 * height, 0.5 * height, {},     {}};
  g.wide.model = LensModel::equirectangular;
  return g;
}
dvec3 direction(double angle, double around) {
  return {std::sin(angle) * std::cos(around), std::sin(angle) * std::sin(around), std::cos(angle)};
}

// A calibration of a lens of 185 degrees, of the size that OpenCV's fisheye finds.
constexpr WideLens calibrated{.k1 = -0.0284, .k2 = 0.00743, .k3 = -0.00395, .k4 = 0.00046};

TEST(WideLens, AnEquidistantFisheyeShowsAnglesByTheirSize) {
  const LensRays lens(fisheye({}));
  for (const double angle : {0.0, 0.3, 0.5 * pi, radians(109.9)})
    for (const double around : {0.0, 0.7, 2.0, 4.5}) {
      const auto at = lens.pixel(direction(angle, around));
      ASSERT_TRUE(at.has_value());
      EXPECT_NEAR(at->x, 322.5 + 190.0 * angle * std::cos(around), 1e-10);
      EXPECT_NEAR(at->y, 237.25 + 200.0 * angle * std::sin(around), 1e-10);
    }
  EXPECT_FALSE(lens.pixel(direction(radians(110.1), 1.0)).has_value());
}

/// The values are OpenCV's formula, written out: theta_d = theta (1 + k1 theta^2 + ...).
TEST(WideLens, KannalaBrandtHasTheSignsOfOpenCv) {
  const LensRays lens(fisheye(calibrated));
  const dvec3 point(0.6, -0.8, 0.5);  // r = 1
  const double t = std::atan(1.0 / 0.5);
  const double t_d = t + calibrated.k1 * std::pow(t, 3) + calibrated.k2 * std::pow(t, 5) +
                     calibrated.k3 * std::pow(t, 7) + calibrated.k4 * std::pow(t, 9);
  EXPECT_NEAR(lens.pixel(point)->x, 322.5 + 190.0 * t_d * 0.6, 1e-10);
  EXPECT_NEAR(lens.pixel(point)->y, 237.25 - 200.0 * t_d * 0.8, 1e-10);
}

TEST(WideLens, PixelsAndDirectionsAreEachOthersInverse) {
  for (const LensGeometry& g : {fisheye({}), fisheye(calibrated), equirectangular(240)}) {
    const LensRays lens(g);
    const std::vector<dvec3> rays = lens.centers();
    int shown = 0;
    for (uint32_t i = 0; i < rays.size(); ++i) {
      if (rays[i] == dvec3(0.0)) continue;
      ++shown;
      const dvec2 at(i % g.width + 0.5, i / g.width + 0.5);
      EXPECT_NEAR(glm::length(rays[i]), 1.0, 1e-15);
      const auto back = lens.pixel(3.0 * rays[i]);
      ASSERT_TRUE(back.has_value());
      ASSERT_LT(glm::length(*back - at), 1e-10);
    }
    EXPECT_GT(shown, 100000);
  }
}

TEST(WideLens, EquirectangularHasForwardInTheMiddleAndRightOnTheRight) {
  const LensRays lens(equirectangular(180));  // half a pixel a degree
  const auto is = [&](const dvec3& optical, double u, double v) {
    EXPECT_NEAR(lens.pixel(optical)->x, u, 1e-12);
    EXPECT_NEAR(lens.pixel(optical)->y, v, 1e-12);
  };
  is({0, 0, 1}, 180, 90);
  is({1, 0, 0}, 270, 90);
  is({-1, 0, 0}, 90, 90);
  is({0, -1, 1}, 180, 45);  // 45 degrees up
  is({0, 1, 0}, 180, 180);  // straight down
  is({-1e-30, 0, -1}, 0, 90);
  is({1e-30, 0, -1}, 360, 90);
}

TEST(WideLens, TheImageCircleEndsTheFisheye) {
  const LensRays lens(fisheye({}, 100.0));
  const double rim = radians(50.0);
  EXPECT_NE(lens.ray({322.5 + 190.0 * (rim - 1e-9), 237.25}), dvec3(0.0));
  EXPECT_EQ(lens.ray({322.5 + 190.0 * (rim + 1e-9), 237.25}), dvec3(0.0));
}

std::string message_of(const LensGeometry& g) {
  try {
    LensRays{g};
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

TEST(WideLens, AFoldNamesTheCameraAndTheRadius) {
  // 1 + 3 k1 t^2 = 0 at t = 1: t_d = 2/3, which is 0.6667 sqrt(190 200) = 130 pixels.
  LensGeometry g = fisheye({.k1 = -1.0 / 3.0});
  EXPECT_NEAR(g.wide.fold_angle(), 1.0, 1e-12);
  EXPECT_EQ(message_of(g).find("camera rig/eye: lens: expected a model that does not fold"), 0u);
  EXPECT_NE(message_of(g).find("114.592 degrees (130 pixels from the principal point)"), std::string::npos)
      << message_of(g);
  g.wide.half_angle = radians(60.0);
  g.wide.circle_given = true;
  EXPECT_NE(message_of(g).find("image circle of 120 degrees"), std::string::npos) << message_of(g);
  g.wide.half_angle = radians(57.0);
  EXPECT_EQ(message_of(g), "");
  LensGeometry ball = equirectangular(100);
  ball.width = 201;
  EXPECT_NE(message_of(ball).find("twice as wide as high"), std::string::npos);
}

/// The density is the root of the pixels per steradian: here from three rays half a pixel around.
TEST(WideLens, TheDensityIsThatOfThePixels) {
  const LensRays lens(fisheye(calibrated));
  for (const dvec2& at : {dvec2(322.6, 237.3), dvec2(400, 100), dvec2(150, 300)}) {
    const double h = 1e-3;
    const dvec3 x = (lens.ray(at + dvec2(h, 0)) - lens.ray(at - dvec2(h, 0))) / (2.0 * h),
                y = (lens.ray(at + dvec2(0, h)) - lens.ray(at - dvec2(0, h))) / (2.0 * h);
    EXPECT_NEAR(lens.density(lens.ray(at)), 1.0 / std::sqrt(glm::length(glm::cross(x, y))), 2e-3);
  }
}

}  // namespace
}  // namespace greatx::test
