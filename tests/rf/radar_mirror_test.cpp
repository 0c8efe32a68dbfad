// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks targets that a radar sees over a mirror in both directions. Each target has the echo that a radar at
// the image of this radar would receive.
#include <gtest/gtest.h>

#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

dvec3 mirrored(const dvec3& p, const dvec3& on, const dvec3& normal) {
  return p - 2.0 * glm::dot(normal, p - on) * normal;
}

/// Adds a mirror of 16 m a quarter of the way from `image` to `target`, at 45 degrees to this line and
/// upright as seen from there. Holds the position of the radar whose image in the mirror is `image`.
struct Mirror {
  dvec3 at, normal;
  dvec3 radar;
  Mirror(TinyScene& tiny, const dvec3& image, const dvec3& target, double half_m = 8.0) {
    const dvec3 u = glm::normalize(image - target), side = glm::normalize(glm::cross(dvec3(0, 0, 1), u));
    at = target + 0.75 * (image - target);
    normal = glm::normalize(u + side);
    const dvec3 v = glm::normalize(glm::cross(normal, u)), w = glm::cross(normal, v);
    radar = mirrored(image, at, normal);
    tiny.object("mirror").quad(at - half_m * (v + w), at + half_m * (v - w), at + half_m * (v + w),
                               at + half_m * (w - v));
  }
  Pose looking_at_it() const { return looking(radar, at); }
};

/// Returns the cross-section, dBsm, of the echoes over the mirror in both directions, with `on_target`
/// bounces on the target (0: any number).
double over_mirror_db(TinyScene tiny, const dvec3& image, const dvec3& target, const EchoOptions& options,
                      uint32_t on_target) {
  const Mirror mirror(tiny, image, target);
  EchoScene scene(tiny);
  const EchoList list = scene.find(options, mirror.looking_at_it());
  for (const Echo& echo : list.echoes) EXPECT_EQ(echo.instance, 2u) << "comes from the mirror";
  return section_db(field_of(list, on_target == 0 ? 0 : on_target + 2), range_m, range_m);
}

TEST(RadarMirror, PlateIsThatOfPhysicalOpticsUpTo60Degrees) {
  for (const double angle : {0.0, 0.3, 2.0, 10.0, 33.0, 60.0})
    EXPECT_NEAR(over_mirror_db(plate(), from(angle, 0.0), dvec3(0.0), exact(0.09, 100), 1),
                plate_db_at(angle), 0.002)
        << angle << " deg";
}

TEST(RadarMirror, DihedralAtSeveralAngles) {
  const dvec3 middle(0.0, 0.0, 0.5 * a);
  for (const double angle : {45.0, 30.0, 60.0}) {
    const double width = 2.0 * a * std::min(std::sin(radians(angle)), std::cos(radians(angle)));
    const double expected =
        decibels(4.0 * pi * std::pow(width * a, 2) / (radar_wavelength_m * radar_wavelength_m));
    EXPECT_NEAR(over_mirror_db(dihedral(), middle + from(angle, 0.0), middle, exact(0.12, 400), 2), expected,
                0.003)
        << angle;
  }
}

/// The path meets five surfaces with the default of three bounces: the mirror does not count.
TEST(RadarMirror, TrihedralAtSeveralAngles) {
  const double axis = degrees(std::atan(std::sqrt(0.5)));
  for (const auto& [az, el] : {std::pair(45.0, axis), std::pair(45.0, 25.0), std::pair(20.0, 20.0)}) {
    const dvec3 at = from(az, el), middle(a / 4);
    EXPECT_NEAR(over_mirror_db(trihedral(), middle + at, middle, exact(0.1, 6400), 3),
                trihedral_db(glm::normalize(at)), 0.01)
        << az << " " << el;
  }
}

TEST(RadarMirror, SphereByFacets) {
  EXPECT_NEAR(over_mirror_db(ball(0.1, 60), from(20.0, 0.0), dvec3(0.0), exact(0.105, 40000), 1), -15.029,
              0.15);
}

/// The sum over all orders is the same directly and over the mirror, tube by tube.
TEST(RadarMirror, AllOrdersTogetherAreThoseOfTheImage) {
  const dvec3 at = from(35.0, 40.0), middle(a / 4);
  EchoScene direct(trihedral());
  const double expected =
      section_db(field_of(direct.find(exact(0.1, 400), looking(middle + at, middle))), range_m, range_m);
  EXPECT_NEAR(over_mirror_db(trihedral(), middle + at, middle, exact(0.1, 400), 0), expected, 0.05);
}

/// Describes a scene with a wide view and the default numbers of tubes. Cells are ten times as wide as the
/// target.
struct Street {
  static constexpr double wall_y = 6.0;
  const dvec3 center{15, 0, 0}, image{0, 2.0 * wall_y, 0};
  double range() const { return glm::distance(center, image); }

  static EchoOptions wide() {
    EchoOptions options;
    options.field_of_view = {radians(-60.0), radians(60.0), radians(-15.0), radians(15.0)};
    options.merge_share = 0.0;
    options.targets = {1};
    return options;
  }
  /// Returns a plate with a side of `side_m` whose normal is turned by `turn_deg` from the direction of the
  /// radar's image. `screen` adds a screen between the wall and the plate.
  TinyScene with_plate(double side_m, double turn_deg, bool screen = false) const {
    TinyScene tiny;
    tiny.object("wall").quad({0, wall_y, -3}, {30, wall_y, -3}, {30, wall_y, 3}, {0, wall_y, 3});
    const dvec3 to = glm::normalize(image - center);
    const double t = std::atan2(to.y, to.x) + radians(turn_deg);
    const dvec3 u = 0.5 * side_m * dvec3(-std::sin(t), std::cos(t), 0), v(0, 0, 0.5 * side_m);
    tiny.object("plate").quad(center - u - v, center + u - v, center + u + v, center - u + v);
    if (screen) tiny.object("screen").quad({8, 3, -1}, {14, 3, -1}, {14, 3, 1}, {8, 3, 1});
    return tiny;
  }
  /// Returns the power of the echoes over the wall in both directions.
  double power(const EchoList& list) const {
    Complex sum(0.0);
    for (const Echo& echo : list.echoes)
      if (echo.bounces == 3 && std::abs(0.5 * speed_of_light * echo.delay.coefficients[0] - range()) < 0.2)
        sum +=
            echo.amplitude *
            std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * echo.delay.coefficients[0], 1.0));
    return std::norm(sum);
  }
};

TEST(RadarMirror, GhostsBothWaysInAWideViewAtSeveralAspects) {
  const Street street;
  constexpr double side = 0.05;
  for (const double turn : {0.0, 1.0, 5.0}) {
    EchoScene scene(street.with_plate(side, turn));
    EchoStatistics statistics;
    const double power = street.power(scene.find(Street::wide(), Pose{}, {}, &statistics));
    const double shape = std::cos(radians(turn)) * sinc(k * side * std::sin(radians(turn)));
    // lambda/(4 pi) a^2/(lambda R^2): physical optics of a plate as seen from the image.
    const double expected = std::pow(side * side * shape / (4.0 * pi * street.range() * street.range()), 2);
    EXPECT_NEAR(decibels(power), decibels(expected), 0.2) << turn;
    EXPECT_EQ(statistics.images, 1u);
  }
}

TEST(RadarMirror, WhatStandsBetweenMirrorAndTargetHidesTheImage) {
  const Street street;
  EchoScene hidden(street.with_plate(0.05, 0.0, true));
  EchoStatistics statistics;
  EXPECT_EQ(street.power(hidden.find(Street::wide(), Pose{}, {}, &statistics)), 0.0);
  EXPECT_EQ(statistics.images, 0u) << "no beam for what cannot be seen";
}

TEST(RadarMirror, FewerBouncesHaveNoGhosts) {
  const Street street;
  EchoScene scene(street.with_plate(0.05, 0.0));
  EchoOptions options = Street::wide();
  options.max_bounces = 2;
  EchoStatistics none;
  EXPECT_EQ(street.power(scene.find(options, Pose{}, {}, &none)), 0.0);
  EXPECT_EQ(none.images, 0u);
}

/// Tracing on the device and on the host yields the same tubes and the same bounces beyond the limit.
TEST(RadarMirror, DeviceAndHostMeetTheSame) {
  const Street street;
  EchoScene scene(street.with_plate(0.3, 0.7));
  const Pose radar{{0.013, -0.021, 0.017}};
  EchoOptions options = Street::wide();
  options.tracing = EchoTracing::device;
  const EchoList device = scene.find(options, radar);
  options.tracing = EchoTracing::host;
  const EchoList host = scene.find(options, radar);
  ASSERT_GT(street.power(host), 0.0);
  EXPECT_NEAR(decibels(street.power(device)), decibels(street.power(host)), 1e-3);
}

}  // namespace
}  // namespace greatx::rf
