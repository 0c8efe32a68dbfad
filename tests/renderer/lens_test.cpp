// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lens/lens.h"

#include <cmath>
#include <functional>

#include <gmock/gmock.h>

#include "core/error.h"
#include "core/units.h"

namespace greatx::render {
namespace {

/// Returns a picture of 640x480, 90 degrees across, with the principal point away from its centre.
LensGeometry picture(const Distortion& distortion) {
  LensGeometry g;
  g.name = "front";
  g.width = 640;
  g.height = 480;
  g.fx = 320.0;
  g.fy = 318.0;
  g.cx = 327.0;
  g.cy = 236.5;
  g.distortion = distortion;
  return g;
}

constexpr Distortion barrel{.k1 = -0.25, .k2 = 0.08, .k3 = -0.01};
constexpr Distortion pincushion{.k1 = 0.12, .k2 = 0.03, .k3 = 0.005};
constexpr Distortion tangential{.p1 = 0.012, .p2 = -0.009};
constexpr Distortion everything{.k1 = -0.2, .k2 = 0.05, .p1 = 0.004, .p2 = -0.003, .k3 = -0.005};

TEST(Lens, DistortsAsTheModelSays) {
  // Computed by hand: r^2 = 0.25, radial factor 1 + 0.1/4 + 0.2/16 + 0.3/64 = 1.0421875.
  const Distortion d{.k1 = 0.1, .k2 = 0.2, .p1 = 0.01, .p2 = 0.02, .k3 = 0.3};
  const dvec2 u(0.3, 0.4), seen = d.distort(u);
  EXPECT_NEAR(seen.x, 0.3 * 1.0421875 + 2 * 0.01 * 0.12 + 0.02 * (0.25 + 0.18), 1e-15);
  EXPECT_NEAR(seen.y, 0.4 * 1.0421875 + 0.01 * (0.25 + 0.32) + 2 * 0.02 * 0.12, 1e-15);
}

TEST(Lens, JacobianIsTheDerivative) {
  for (const dvec2 u : {dvec2(0.0), dvec2(0.4, -0.3), dvec2(-0.9, 0.7)}) {
    const glm::dmat2 jacobian = everything.jacobian(u);
    constexpr double h = 1e-6;
    for (int i = 0; i < 2; ++i) {
      dvec2 step(0.0);
      step[i] = h;
      const dvec2 slope = (everything.distort(u + step) - everything.distort(u - step)) / (2.0 * h);
      EXPECT_NEAR(jacobian[i].x, slope.x, 1e-9);
      EXPECT_NEAR(jacobian[i].y, slope.y, 1e-9);
    }
  }
}

TEST(Lens, RoundTripOverTheWholePicture) {
  for (const Distortion& d : {Distortion{}, barrel, pincushion, tangential, everything}) {
    const Lens lens(picture(d));
    double worst = 0.0, worst_back = 0.0;
    for (double y = 0.0; y <= 480.0; y += 4.0) {
      for (double x = 0.0; x <= 640.0; x += 4.0) {
        const dvec2 u = lens.undistorted({x, y});
        const dvec2 seen((x - 327.0) / 320.0, (y - 236.5) / 318.0);
        worst = std::max(worst, glm::length(d.distort(u) - seen));
        const dvec2 pixel = lens.pixel(u);
        worst_back = std::max(worst_back, glm::length(lens.undistorted(pixel) - u));
      }
    }
    EXPECT_LT(worst, 1e-10);
    EXPECT_LT(worst_back, 1e-10);
  }
}

TEST(Lens, BoundsHoldEveryRayOfThePicture) {
  for (const Distortion& d : {Distortion{}, barrel, pincushion, tangential, everything}) {
    const Lens lens(picture(d));
    dvec2 least(1e9), most(-1e9);
    for (double y = 0.0; y <= 480.0; y += 0.25) {
      for (const double x : {0.0, 640.0}) {
        least = glm::min(least, lens.undistorted({x, y}));
        most = glm::max(most, lens.undistorted({x, y}));
      }
    }
    for (double x = 0.0; x <= 640.0; x += 0.25) {
      for (const double y : {0.0, 480.0}) {
        least = glm::min(least, lens.undistorted({x, y}));
        most = glm::max(most, lens.undistorted({x, y}));
      }
    }
    for (int i = 0; i < 2; ++i) {
      EXPECT_LE(lens.bounds().least[i], least[i]);
      EXPECT_GE(lens.bounds().most[i], most[i]);
      // The bounds are less than a quarter of a pixel too wide, where the barrel bends most.
      EXPECT_NEAR(lens.bounds().least[i], least[i], 0.25 / 318.0);
      EXPECT_NEAR(lens.bounds().most[i], most[i], 0.25 / 318.0);
    }
  }
}

TEST(Lens, CentersAreTheInverseAtPixelCentres) {
  const Lens lens(picture(everything));
  const std::vector<dvec2> centers = lens.centers();
  ASSERT_EQ(centers.size(), 640u * 480u);
  double worst = 0.0;
  for (size_t i = 0; i < centers.size(); i += 97)
    worst = std::max(
        worst, glm::length(centers[i] - lens.undistorted({double(i % 640) + 0.5, double(i / 640) + 0.5})));
  EXPECT_LE(worst, 2.0 * Lens::tolerance);
}

TEST(Lens, FoldRadiusIsTheFirstRootOfTheSlope) {
  EXPECT_EQ(Distortion{}.fold_radius(), INFINITY);
  EXPECT_EQ(pincushion.fold_radius(), INFINITY);
  EXPECT_NEAR((Distortion{.k1 = -1.0 / 3.0}).fold_radius(), 1.0, 1e-12);
  // With s = r^2 the slope is 1 + 3 k1 s + 5 k2 s^2 + 7 k3 s^3. Roots at s = 1/2, 1, 2: (1 - 2 s)(1 - s)(1 -
  // s/2) = 1 - 3.5 s + 3.5 s^2 - s^3.
  EXPECT_NEAR((Distortion{.k1 = -3.5 / 3.0, .k2 = 3.5 / 5.0, .k3 = -1.0 / 7.0}).fold_radius(), std::sqrt(0.5),
              1e-12);
  // The only root of the slope 1 - s^3 is s = 1.
  EXPECT_NEAR((Distortion{.k3 = -1.0 / 7.0}).fold_radius(), 1.0, 1e-12);
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const UserError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Lens, AModelThatFoldsIsRefusedByName) {
  // The model folds at r = 0.9129, where the picture shows r' = 0.6086: 194 pixels of the 400 to the corner.
  const std::string radial = message_of([] { Lens lens(picture({.k1 = -0.4})); });
  EXPECT_THAT(radial, testing::HasSubstr("camera front: distortion"));
  EXPECT_THAT(radial, testing::HasSubstr("0.91"));
  EXPECT_THAT(radial, testing::HasSubstr("194."));
  EXPECT_THAT(message_of([] { Lens lens(picture({.p1 = 0.5})); }),
              testing::HasSubstr("camera front: distortion"));
  // The same lens is accepted for a narrow picture.
  LensGeometry narrow = picture({.k1 = -0.4});
  narrow.fx = narrow.fy = 1000.0;
  EXPECT_NO_THROW(Lens{narrow});
}

TEST(Lens, NaturalVignettingIsTheFourthPowerOfTheCosine) {
  const LensGeometry g = picture({});
  const std::vector<float> field = flat_field({.natural = true}, g);
  for (const auto& [x, y] : {std::pair{0, 0}, {639, 479}, {327, 236}, {100, 400}}) {
    const double tx = (x + 0.5 - g.cx) / g.fx, ty = (y + 0.5 - g.cy) / g.fy;
    const double angle = std::atan(std::hypot(tx, ty));
    EXPECT_NEAR(field[size_t(y) * 640 + x], std::pow(std::cos(angle), 4.0), 1e-7);
  }
  // Behind a distorting lens, the angle is that of the ray that the pixel sees.
  const Lens lens(picture(barrel));
  const std::vector<float> behind = flat_field({.natural = true}, picture(barrel));
  const dvec2 u = lens.undistorted({0.5, 0.5});
  EXPECT_NEAR(behind[0], std::pow(std::cos(std::atan(glm::length(u))), 4.0), 1e-7);
}

TEST(Lens, RadialVignettingIsThePolynomialAndStaysALoss) {
  LensGeometry g = picture({});
  g.cx = 320.0;
  g.cy = 240.0;
  const std::vector<float> field = flat_field({.radial = {-0.3, -0.2, 0.1}}, g);
  const double q = std::hypot(319.5, 239.5) / 400.0;
  EXPECT_NEAR(field[0], 1.0 - 0.3 * q * q - 0.2 * std::pow(q, 4.0) + 0.1 * std::pow(q, 6.0), 1e-7);
  EXPECT_THAT(message_of([&] {
                flat_field({.radial = {-1.2, 0.0, 0.0}}, g);
              }),
              testing::HasSubstr("camera front: vignetting"));
  EXPECT_THAT(message_of([&] {
                flat_field({.radial = {0.1, 0.0, 0.0}}, g);
              }),
              testing::HasSubstr("camera front: vignetting"));
}

}  // namespace
}  // namespace greatx::render
