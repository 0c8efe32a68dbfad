// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Radar cross-sections that closed forms are known for, at 77 GHz, a = 0.1 m.
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using namespace rf::testing;

constexpr double a = 0.1, range_m = 400.0, k = 2.0 * pi / radar_wavelength_m;

TinyScene plate() {
  TinyScene tiny;
  const double h = 0.5 * a;
  tiny.object("plate").quad({0, -h, -h}, {0, h, -h}, {0, h, h}, {0, -h, h});
  return tiny;
}

TinyScene dihedral() {
  TinyScene tiny;
  tiny.object("dihedral")
      .quad({0, 0, 0}, {a, 0, 0}, {a, 0, a}, {0, 0, a})
      .quad({0, 0, 0}, {0, 0, a}, {0, a, a}, {0, a, 0});
  return tiny;
}

TinyScene trihedral() {
  TinyScene tiny;
  const dvec3 o(0.0), x(a, 0, 0), y(0, a, 0), z(0, 0, a);
  tiny.object("trihedral").triangle(o, x, y).triangle(o, z, x).triangle(o, y, z);
  return tiny;
}

/// A sphere of some 24 n^2 triangles about a step of r pi/(2 n) wide: a cube of n x n squares a face, blown up, and turned
/// and shaken so that no rows of facets stand half a wavelength behind each other (those of a regular mesh do somewhere near
/// the shadow's edge, and send back their own Bragg reflection: up to .7 dB).
TinyScene ball(double radius, int n) {
  TinyScene tiny;
  tiny.object("ball");
  const dquat turn = orientation_from_yaw_pitch_roll(0.4, 0.7, 1.1);
  for (int face = 0; face < 6; ++face) {
    const auto at = [&](int i, int j) {
      const double u = std::tan(0.25 * pi * (2.0 * i / n - 1.0)),
                   v = std::tan(0.25 * pi * (2.0 * j / n - 1.0));
      const double sign = face < 3 ? 1.0 : -1.0;
      dvec3 p(sign, sign * u, v);
      p = glm::normalize(face % 3 == 0 ? p : face % 3 == 1 ? dvec3(p.z, p.x, p.y) : dvec3(p.y, p.z, p.x));
      const dvec3 place = glm::floor(p * 1e6 + 0.5);  // what faces share is shaken the same way
      RandomStream random(1, static_cast<uint32_t>(int64_t(place.x) * 7919 + int64_t(place.y)),
                          static_cast<uint32_t>(int64_t(place.z)));
      const double step = 0.25 * 0.5 * pi / n;
      p += step * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      return radius * (turn * glm::normalize(p));
    };
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        tiny.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1))
            .triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
  }
  return tiny;
}

/// Physical optics of a convex mesh of conductors by brute force: quadrature over 2 m^2 points of every lit triangle.
double brute_force_db(const scene::Scene& scene, const dvec3& radar, int m) {
  Complex sum(0.0);
  const double distance = glm::length(radar);
  for (const scene::FacetTriangle& t : scene.facet_triangles) {
    const dvec3 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0], cross = glm::cross(u, v);
    const double area = 0.5 * glm::length(cross);
    const dvec3 normal = cross / (2.0 * area);
    if (glm::dot(normal, radar - t.corners[0]) <= 0.0) continue;
    for (int i = 0; i < m; ++i)
      for (int h = 0; h < 2 * (m - i) - 1; ++h) {
        const double third = (h % 2 + 1) / 3.0, b = (i + third) / m, c = (h / 2 + third) / m;
        const dvec3 arm = radar - (t.corners[0] + b * u + c * v);
        const double r = glm::length(arm);
        sum += std::polar(area / (m * m) * glm::dot(normal, arm) / r * std::pow(distance / r, 2),
                          -2.0 * k * (r - distance));
      }
  }
  return decibels(4.0 * pi / (radar_wavelength_m * radar_wavelength_m) * std::norm(sum));
}

dvec3 from(double azimuth_deg, double elevation_deg, double distance = range_m) {
  const double az = radians(azimuth_deg), el = radians(elevation_deg);
  return distance * dvec3(std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el));
}

double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

double plate_db(double pattern) {
  return decibels(4.0 * pi * std::pow(a, 4) / (radar_wavelength_m * radar_wavelength_m) * pattern * pattern);
}

/// 4 pi a^4/lambda^2 (cos(theta) sinc(k a sin(theta)))^2 (C. A. Balanis, Advanced Engineering Electromagnetics, 11.3).
double plate_db_at(double degrees) {
  return plate_db(std::cos(radians(degrees)) * sinc(k * a * std::sin(radians(degrees))));
}

EchoOptions exact(double half_m, uint32_t tubes) {
  EchoOptions options = around(half_m, range_m, tubes);
  options.border_floor_m2 = 0.0;
  options.max_echoes = 1u << 24;
  return options;
}

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

/// One place, two polarizations: not monostatic for the search, but no way leads from one element to the other.
TEST(RadarEchoRcs, CrossPolarizedElementsAtOnePlace) {
  EchoScene scene(plate());
  const Pose at = looking(from(5.0, 0.0), dvec3(0.0));
  const EchoEnd vertical, horizontal{.pattern = {}, .slant = 0.5 * pi};
  const auto field = [&](const EchoEnd& receiver) {
    EchoFinder finder(scene.gpu, scene.surfaces(), vertical, receiver, exact(0.09, 100));
    const EchoList list = finder.find(at, at, std::vector<Pose>(scene.scene.bodies.size()));
    for (const Echo& echo : list.echoes) EXPECT_GT(echo.bounces, 0u);
    return field_of(list);
  };
  const Complex alone = field_of(scene.find(exact(0.09, 100), at));
  EXPECT_LT(std::abs(field(vertical) - alone), 1e-6 * std::abs(alone));
  EXPECT_LT(std::abs(field(horizontal)), 1e-6 * std::abs(alone));
}

/// Physical optics with the field across the plane of incidence: cos(theta_i) from the currents, and the phases of both ways.
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

/// Two reflections send back what a plate of the width 2 a min(sin, cos) would. The faces by themselves add their own edges,
/// which are some -20 dBsm.
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

/// 4 pi A^2/lambda^2 of the part of the aperture whose mirror image in the apex is in it, too (A. C. Bonkowski et al. 1953;
/// for direction cosines (l, m, n), ascending, A = a^2 4 l m/(l + m + n) if l + m <= n, else a^2 (l + m + n - 2/(l + m + n))).
double trihedral_db(dvec3 d) {
  const double low = std::min({d.x, d.y, d.z}), high = std::max({d.x, d.y, d.z}), sum = d.x + d.y + d.z,
               mid = sum - low - high;
  const double area = a * a * (low + mid <= high ? 4.0 * low * mid / sum : sum - 2.0 / sum);
  return decibels(4.0 * pi * area * area / (radar_wavelength_m * radar_wavelength_m));
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

/// pi r^2 within 1/(k r) = .6 %, what the shadow's edge adds to the lit half in physical optics.
TEST(RadarEchoRcs, SphereByFacets) {
  EchoScene scene(ball(0.1, 60));
  EchoOptions options = exact(0.105, 40000);
  options.max_bounces = 1;
  const dvec3 radar(range_m, 0.0, 0.0);
  const EchoList list = scene.find(options, looking(radar, dvec3(0.0)));
  EXPECT_NEAR(section_db(field_of(list), range_m, range_m), -15.029, 0.15);
}

/// Tubes that are wider than the facets of a mesh miss some; from a third of a facet on the rest is in the silhouette.
TEST(RadarEchoRcs, ErrorFallsWithTheWidthOfTubes) {
  EchoScene scene(ball(0.1, 20));
  const dvec3 radar(range_m, 0.0, 0.0);
  const double expected = brute_force_db(scene.scene, radar, 24);
  std::vector<double> errors;
  for (const uint32_t tubes : {400u, 1600u, 6400u, 25600u}) {
    EchoOptions options = exact(0.105, tubes);
    options.max_bounces = 1;
    errors.push_back(std::abs(
        section_db(field_of(scene.find(options, looking(radar, dvec3(0.0)))), range_m, range_m) - expected));
  }
  // Of the facets' 7.9 mm these tubes are 10.5, 5.2, 2.6 and 1.3 mm wide.
  EXPECT_GT(errors[0], errors[1]);
  EXPECT_GT(errors[1], errors[2]);
  EXPECT_LT(errors[1], 1.0);
  EXPECT_LT(errors[2], 0.1);
  EXPECT_LT(errors[3], 0.05);
}

/// P_r/P_t = G^2 lambda^2 sigma/((4 pi)^3 R^4): 40 dB a decade; the far field is 2 a^2/lambda = 5 m away.
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

/// Power reflected by a half-space at normal incidence: ((1 - n)/(1 + n))^2.
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
