// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks radar cross-sections with known closed forms at 77 GHz, for a = 0.1 m.
#include <gtest/gtest.h>

#include "tests/rf/radar_reflectors.h"

namespace greatx::rf {
namespace {

using namespace rf::testing;

TEST(RadarEchoRcs, PlateIsThatOfPhysicalOpticsUpTo60Degrees) {
  EXPECT_NEAR(plate_db_at(0.0), 19.185, 1e-3);
  EchoScene scene(plate());
  for (const double angle : {0.0, 0.3, 2.0, 5.0, 10.0, 20.0, 33.0, 45.0, 60.0}) {
    for (const uint32_t tubes : {30u, 100u}) {
      const EchoList list = scene.find(exact(0.09, tubes), looking(from(angle, 0.0), dvec3(0.0)));
      EXPECT_NEAR(section_db(field_of(list), range_m, range_m), plate_db_at(angle), 0.002)
          << angle << " deg, " << tubes;
    }
  }
}

TEST(RadarEchoRcs, PlateAcrossBothItsSides) {
  EchoScene scene(plate());
  const dvec3 at = from(7.0, 11.0), u = glm::normalize(at);
  const double expected = plate_db(u.x * sinc(k * a * u.y) * sinc(k * a * u.z));
  const EchoList list = scene.find(exact(0.09, 100), looking(at, dvec3(0.0)));
  EXPECT_NEAR(section_db(field_of(list), range_m, range_m), expected, 0.01);
}

/// Two polarizations are at one place. The search does not regard this as monostatic, but there is no direct
/// path between the elements.
TEST(RadarEchoRcs, CrossPolarizedElementsAtOnePlace) {
  EchoScene scene(plate());
  const Pose at = looking(from(5.0, 0.0), dvec3(0.0));
  const EchoEnd vertical, horizontal{.pattern = {}, .slant = 0.5 * pi};
  const auto field = [&](const EchoEnd& receiver) {
    EchoFinder finder(scene.gpu, scene.surfaces(), vertical, receiver, exact(0.09, 100));
    const EchoList list =
        testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), testing::at_rest(at, at));
    for (const Echo& echo : list.echoes) EXPECT_GT(echo.bounces, 0u);
    return field_of(list);
  };
  const Complex alone = field_of(scene.find(exact(0.09, 100), at));
  EXPECT_LT(std::abs(field(vertical) - alone), 1e-6 * std::abs(alone));
  EXPECT_LT(std::abs(field(horizontal)), 1e-6 * std::abs(alone));
}

/// In physical optics with the field perpendicular to the plane of incidence, the cross-section has the
/// factor cos(theta_i) of the currents and the phases of both directions.
TEST(RadarEchoRcs, BistaticPlate) {
  EchoScene scene(plate());
  for (const auto& [tx, rx] :
       {std::pair(20.0, -20.0), std::pair(20.0, -23.0), std::pair(0.0, 40.0), std::pair(50.0, -10.0)}) {
    const EchoList list =
        scene.find(exact(0.09, 100), looking(from(tx, 0.0), dvec3(0.0)), looking(from(rx, 0.0), dvec3(0.0)));
    Complex reflected(0.0);
    for (const Echo& echo : list.echoes)
      if (echo.bounces == 1)
        reflected +=
            echo.amplitude *
            std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * echo.delay.coefficients[0], 1.0));
    const double phase = 0.5 * k * a * (std::sin(radians(tx)) + std::sin(radians(rx)));
    EXPECT_NEAR(section_db(reflected, range_m, range_m), plate_db(std::cos(radians(tx)) * sinc(phase)), 0.01)
        << tx << " " << rx;
  }
}

/// Two reflections have the cross-section of a plate of the width 2 a min(sin, cos). In addition, the single
/// faces contribute their own edges, about -20 dBsm.
TEST(RadarEchoRcs, DihedralAtSeveralAngles) {
  EchoScene scene(dihedral());
  const dvec3 middle(0.0, 0.0, 0.5 * a);
  for (const double angle : {45.0, 40.0, 30.0, 60.0, 20.0}) {
    const EchoList list = scene.find(exact(0.12, 400), looking(middle + from(angle, 0.0), middle));
    const double width = 2.0 * a * std::min(std::sin(radians(angle)), std::cos(radians(angle)));
    const double expected =
        decibels(4.0 * pi * std::pow(width * a, 2) / (radar_wavelength_m * radar_wavelength_m));
    if (angle == 45.0) {
      EXPECT_NEAR(expected, 22.196, 1e-3);
    }
    EXPECT_NEAR(section_db(field_of(list, 2), range_m, range_m), expected, 0.003) << angle;
    EXPECT_NEAR(section_db(field_of(list), range_m, range_m), expected, 0.1) << angle;
    EXPECT_LT(section_db(field_of(list, 3), range_m, range_m), -60.0) << angle;
  }
}

TEST(RadarEchoRcs, TrihedralAtSeveralAngles) {
  const double axis = degrees(std::atan(std::sqrt(0.5)));
  EXPECT_NEAR(trihedral_db(from(45.0, axis, 1.0)), 14.414, 1e-3);
  EchoScene scene(trihedral());
  for (const auto& [az, el] :
       {std::pair(45.0, axis), std::pair(45.0, 25.0), std::pair(35.0, 40.0), std::pair(20.0, 20.0)}) {
    const dvec3 at = from(az, el);
    const EchoList list = scene.find(exact(0.1, 400), looking(at, dvec3(a / 4)));
    EXPECT_NEAR(section_db(field_of(list, 3), range_m, range_m), trihedral_db(glm::normalize(at)), 0.01)
        << az << " " << el;
    EXPECT_NEAR(section_db(field_of(list), range_m, range_m), trihedral_db(glm::normalize(at)), 0.35)
        << az << " " << el;
  }
}

/// The cross-section is pi r^2 within 1/(k r) = 0.6 %, the contribution of the shadow boundary to the lit
/// half in physical optics.
TEST(RadarEchoRcs, SphereByFacets) {
  EchoScene scene(ball(0.1, 60));
  EchoOptions options = exact(0.105, 40000);
  options.max_bounces = 1;
  const dvec3 radar(range_m, 0.0, 0.0);
  const EchoList list = scene.find(options, looking(radar, dvec3(0.0)));
  EXPECT_NEAR(section_db(field_of(list), range_m, range_m), -15.029, 0.15);
}

/// The facets have a side of 7.9 mm. Tubes of 2 m, 10.5 mm and 1.3 mm give the same, because each facet that
/// is smaller than the tubes has a beam of its own.
TEST(RadarEchoRcs, SectionOfAMeshDoesNotDependOnTheWidthOfTubes) {
  EchoScene scene(ball(0.1, 20));
  const dvec3 radar(range_m, 0.0, 0.0);
  const double expected = brute_force_db(scene.scene, radar, 24);
  for (const auto& [half_m, tubes] :
       {std::pair(40.0, 1600u), std::pair(0.105, 400u), std::pair(0.105, 25600u)}) {
    EchoOptions options = exact(half_m, tubes);
    options.max_bounces = 1;
    EXPECT_NEAR(section_db(field_of(scene.find(options, looking(radar, dvec3(0.0)))), range_m, range_m),
                expected, 0.05)
        << half_m << " m, " << tubes;
  }
}

/// P_r/P_t = G^2 lambda^2 sigma/((4 pi)^3 R^4) is 40 dB per decade. The far field begins at 2 a^2/lambda = 5
/// m.
TEST(RadarEchoRcs, RadarEquation) {
  EchoScene scene(plate());
  EchoEnd end;
  end.pattern = ElementPattern(Pattern::tr38901);
  for (const double range : {100.0, 1000.0, 3000.0}) {
    const dvec3 at(range, 0.0, 0.0);
    EchoOptions options = around(0.09, range, 100);
    const double power = std::norm(field_of(scene.find(options, looking(at, dvec3(0.0)), {}, nullptr, end)));
    const double gain = std::pow(10.0, 0.8), four_pi = 4.0 * pi, sigma = std::pow(10.0, 1.9185);
    const double expected =
        gain * gain * std::pow(radar_wavelength_m, 2) * sigma / (std::pow(four_pi, 3) * std::pow(range, 4));
    EXPECT_NEAR(decibels(power), decibels(expected), 0.01) << range;
  }
}

/// A half-space at normal incidence reflects the share ((1 - n)/(1 + n))^2 of the power.
TEST(RadarEchoRcs, DielectricPlate) {
  RadioSurface surface;
  surface.front = surface.back = {{Complex(4.0, 0.0), 0.0}};
  EchoScene scene(plate(), {surface, surface});
  const EchoList list = scene.find(exact(0.09, 100), looking(from(0.0, 0.0), dvec3(0.0)));
  EXPECT_NEAR(section_db(field_of(list), range_m, range_m), 19.1855 - decibels(9.0), 0.002);
}

TEST(RadarEchoRcs, GrazingAndEdgeOnPlatesAreFinite) {
  EchoScene scene(plate());
  for (const double angle : {80.0, 89.0, 89.99, 89.999999, 90.0, 90.01}) {
    const EchoList list = scene.find(exact(0.09, 400), looking(from(angle, 0.0), dvec3(0.0)));
    for (const Echo& echo : list.echoes) EXPECT_TRUE(std::isfinite(std::abs(echo.amplitude)));
    const double sigma = section_db(field_of(list), range_m, range_m);
    EXPECT_LT(sigma, -30.0) << angle;
  }
}

}  // namespace
}  // namespace greatx::rf
