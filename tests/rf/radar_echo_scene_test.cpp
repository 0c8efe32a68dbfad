// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks echoes in scenes: ghosts, occlusion, motion, merging and refused options.
#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using ::testing::HasSubstr;
using namespace rf::testing;

double range_of(const Echo& echo) { return 0.5 * speed_of_light * echo.delay.coefficients[0]; }

/// Returns the power of the echoes with `bounces` bounces whose range is within `room` of `range_m`.
double power_at(const EchoList& list, double range_m, double room, uint32_t bounces) {
  Complex sum(0.0);
  for (const Echo& echo : list.echoes)
    if (echo.bounces == bounces && std::abs(range_of(echo) - range_m) < room)
      sum += echo.amplitude *
             std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * echo.delay.coefficients[0], 1.0));
  return std::norm(sum);
}

EchoOptions sector(double half_azimuth_deg, double half_elevation_deg, uint32_t tubes) {
  EchoOptions options;
  options.field_of_view = {radians(-half_azimuth_deg), radians(half_azimuth_deg),
                           radians(-half_elevation_deg), radians(half_elevation_deg)};
  options.tubes = tubes;
  return options;
}

/// Returns a corner reflector with its apex at (20, 0, 0) that faces the origin, and a wall in the plane y =
/// 6. `hides` adds a screen between the radar and the reflector.
TinyScene corner_by_a_wall(bool hides = false) {
  TinyScene tiny;
  const dvec3 o(20.0, 0.0, 0.0);
  dvec3 e[3];
  for (int i = 0; i < 3; ++i)
    e[i] = o + 0.2 * (dvec3(-1, 0, 0) / std::sqrt(3.0) +
                      std::sqrt(2.0 / 3.0) *
                          dvec3(0, std::cos(2.0 * pi * i / 3.0), std::sin(2.0 * pi * i / 3.0)));
  tiny.object("corner").triangle(o, e[0], e[1]).triangle(o, e[1], e[2]).triangle(o, e[2], e[0]);
  tiny.object("wall").quad({0, 6, -3}, {30, 6, -3}, {30, 6, 3}, {0, 6, 3});
  if (hides) tiny.object("screen").quad({8, -2, -2}, {8, 0.5, -2}, {8, 0.5, 2}, {8, -2, 2});
  return tiny;
}

/// Adds a ball of facets, which scatters waves from any direction to any direction.
TinyScene ball_at(const dvec3& center, double radius, TinyScene tiny) {
  tiny.object("ball");
  const int n = 24;
  const auto at = [&](int i, int j) {
    const double theta = pi * i / n, phi = pi * j / n;
    return center +
           radius * dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      if (i + 1 < n) tiny.triangle(at(i, j), at(i + 1, j), at(i + 1, j + 1));
      if (i > 0) tiny.triangle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return tiny;
}

TinyScene wall_alone() {
  TinyScene tiny;
  tiny.object("wall").quad({0, 6, -3}, {30, 6, -3}, {30, 6, 3}, {0, 6, 3});
  return tiny;
}

/// A plate with a side of 0.1 m at (15, 0, 0) reflects waves from the image of the radar in the wall, (0, 12,
/// 0), to the radar. The range of the echo is the mean of 15 m and 19.21 m. If the wave arrives over the
/// wall, the echo appears behind the wall.
TEST(RadarEchoScene, GhostsOverAWallAreWhereGeometrySaysBothWays) {
  const dvec3 center(15, 0, 0), image(0, 12, 0);
  const dvec3 normal = glm::normalize(glm::normalize(-center) + glm::normalize(image - center));
  const dvec3 u = 0.05 * glm::normalize(glm::cross(dvec3(0, 0, 1), normal)), v(0, 0, 0.05);
  TinyScene tiny = wall_alone();
  tiny.object("plate").quad(center - u - v, center + u - v, center + u + v, center - u + v);
  EchoScene scene(tiny);
  EchoOptions options = sector(60.0, 8.0, 20000);
  options.merge_share = 0.0;
  options.targets = {1};
  const EchoList list = scene.find(options, Pose{});
  const double direct = 15.0, over_wall = std::hypot(15.0, 12.0), ghost = 0.5 * (direct + over_wall);
  const double half = 0.5 * std::atan2(12.0, 15.0);
  Complex in_over_wall(0.0), out_over_wall(0.0);
  for (const Echo& echo : list.echoes) {
    if (echo.bounces != 2 || std::abs(range_of(echo) - ghost) > 0.05) continue;
    const Complex field =
        echo.amplitude *
        std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * echo.delay.coefficients[0], 1.0));
    const bool last_is_wall = echo.instance == 1;
    (last_is_wall ? in_over_wall : out_over_wall) += field;
    // The direction that leads over the wall points at the image of the plate, the other direction at the
    // plate.
    const dvec3& side = last_is_wall ? echo.arrival : echo.departure;
    EXPECT_NEAR(degrees(std::atan2(side.y, side.x)), degrees(2.0 * half), 1.0);
    EXPECT_NEAR((last_is_wall ? echo.departure : echo.arrival).y, 0.0, 0.01);
  }
  // lambda/(4 pi) (a^2 cos/lambda)/(r1 r2): physical optics of the plate for the two distances.
  const double expected = decibels(std::pow(0.01 * std::cos(half) / (4.0 * pi * direct * over_wall), 2));
  EXPECT_NEAR(decibels(std::norm(out_over_wall)), expected, 0.2);
  EXPECT_NEAR(decibels(std::norm(in_over_wall)), expected, 0.2);
}

TEST(RadarEchoScene, WhatIsHiddenIsNotSeen) {
  EchoOptions options = sector(8.0, 4.0, 20000);
  EchoScene open(corner_by_a_wall()), hidden(corner_by_a_wall(true));
  // The expected power is lambda^2 4 pi a^4/(3 lambda^2)/((4 pi)^3 R^4) = 2.1e-11.
  EXPECT_GT(power_at(open.find(options, Pose{}), 20.0, 0.1, 3), 1e-11);
  EXPECT_EQ(power_at(hidden.find(options, Pose{}), 20.0, 0.1, 3), 0.0);
  EXPECT_GT(power_at(hidden.find(options, Pose{}), 8.0, 0.1, 1), 1e-11);  // the echo of the screen
}

/// If the border of a large smooth wall is out of view, only the specular echo remains: lambda/(4 pi 2 R),
/// the field of the image.
TEST(RadarEchoScene, LargeWallReflectsAsItsImageWhateverTheTubes) {
  TinyScene tiny;
  tiny.object("wall").quad({10, 40, -40}, {10, -40, -40}, {10, -40, 40}, {10, 40, 40});
  EchoScene scene(tiny);
  for (const uint32_t tubes : {300u, 3000u, 30000u}) {
    const EchoList list = scene.find(sector(50.0, 20.0, tubes), Pose{});
    EXPECT_NEAR(decibels(std::norm(field_of(list))),
                decibels(std::pow(radar_wavelength_m / (4.0 * pi * 20.0), 2)), 0.1)
        << tubes;
    Complex elsewhere(0.0);
    for (const Echo& echo : list.echoes)
      if (range_of(echo) > 10.2) elsewhere += echo.amplitude;
    EXPECT_LT(decibels(std::norm(elsewhere)), decibels(std::norm(field_of(list))) - 35.0) << tubes;
  }
}

/// The ends are swapped. The field is reciprocal where the surface reflects from one end to the other.
/// Elsewhere physical optics is not reciprocal (cos(theta_i) instead of cos(theta_s)).
TEST(RadarEchoScene, Reciprocity) {
  TinyScene tiny;
  tiny.object("plate").quad({0, -0.2, -0.2}, {0, 0.2, -0.2}, {0, 0.2, 0.2}, {0, -0.2, 0.2});
  EchoScene scene(tiny);
  const dvec3 a = 60.0 * dvec3(std::cos(0.5), std::sin(0.5), 0.0),
              b = 45.0 * dvec3(std::cos(0.5), -std::sin(0.5), 0.0);
  EchoOptions options = sector(1.0, 1.0, 400);
  options.merge_share = 0.0;
  const Complex ab = field_of(scene.find(options, looking(a, dvec3(0.0)), looking(b, dvec3(0.0))));
  const Complex ba = field_of(scene.find(options, looking(b, dvec3(0.0)), looking(a, dvec3(0.0))));
  EXPECT_LT(std::abs(ab - ba), 2e-3 * std::abs(ab));
}

TEST(RadarEchoScene, BistaticDirectPathIsFriis) {
  EchoScene scene(corner_by_a_wall());
  const EchoList list = scene.find(sector(1.0, 1.0, 10), Pose{{0, -20, 0}, dquat(1, 0, 0, 0)},
                                   Pose{{30, -20, 0}, dquat(1, 0, 0, 0)});
  ASSERT_EQ(list.echoes.size(), 1u);
  EXPECT_EQ(list.echoes[0].bounces, 0u);
  EXPECT_EQ(list.echoes[0].instance, 0u);
  EXPECT_NEAR(list.echoes[0].delay.coefficients[0] * speed_of_light, 30.0, 1e-9);
  EXPECT_NEAR(std::abs(list.echoes[0].amplitude), radar_wavelength_m / (4.0 * pi * 30.0), 1e-15);
}

TEST(RadarEchoScene, HardCase64NothingHitIsAnEmptyList) {
  EchoScene scene(corner_by_a_wall());
  EchoStatistics statistics;
  const EchoList list = scene.find(sector(20.0, 5.0, 500), looking({0, 0, 0}, {-1, 0, 0}), {}, &statistics);
  EXPECT_TRUE(list.echoes.empty());
  EXPECT_TRUE(list.tables.empty());
  EXPECT_EQ(statistics.contributions, 0u);
}

TEST(RadarEchoScene, TargetInsideTheAntennaIsRefusedByName) {
  EchoScene scene(corner_by_a_wall());
  try {
    scene.find(sector(20.0, 5.0, 500), looking({10, 5.99, 0}, {10, 6.5, 0}));
    FAIL();
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("radar 'radar': expected nothing within 0.02 m of its antenna, found 'wall'"));
  }
}

TEST(RadarEchoScene, OptionsOutOfRangeAreRefused) {
  EchoScene scene(corner_by_a_wall());
  const auto refused = [&](auto change, const char* message) {
    EchoOptions options = sector(20.0, 5.0, 500);
    change(options);
    try {
      scene.find(options, Pose{});
      FAIL() << message;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  };
  refused([](EchoOptions& o) { o.max_bounces = 0; }, "bounces: expected 1 to 6, found 0");
  refused([](EchoOptions& o) { o.field_of_view.azimuth_max = -1.0; }, "azimuths");
  refused([](EchoOptions& o) { o.field_of_view.elevation_max = 2.0; }, "elevations");
  refused(
      [](EchoOptions& o) {
        o.tubes = 1;
        o.field_of_view = {-3.0, 3.0, -1.0, 1.0};
      },
      "tubes");
}

TEST(RadarEchoScene, HardCase7FarFromTheOriginNothingChanges) {
  const dvec3 origin(500000.0, 5400000.0, 100.0);
  TinyScene here, there;
  const auto plate = [](TinyScene& tiny, const dvec3& o) {
    tiny.object("plate").quad(o + dvec3(9, 0.5, -0.5), o + dvec3(9, -0.5, -0.5), o + dvec3(9.25, -0.5, 0.5),
                              o + dvec3(9.25, 0.5, 0.5));
  };
  plate(here, dvec3(0.0)), plate(there, origin);
  EchoScene near(here), far(there, {}, origin);
  const EchoOptions options = sector(10.0, 10.0, 500);
  const Complex a = field_of(near.find(options, Pose{})), b = field_of(far.find(options, Pose{}));
  EXPECT_LT(std::abs(a - b), 1e-5 * std::abs(a));
}

TEST(RadarEchoScene, PartsOfTheOwnBodyAreNotSeen) {
  TinyScene tiny;
  const uint32_t carrier = tiny.body("carrier"), part = tiny.body("part");
  const auto plate = [](TinyScene& to, double x, double half) {
    to.quad({x, half, -half}, {x, -half, -half}, {x, -half, half}, {x, half, half});
  };
  plate(tiny.object("target"), 20.0, 3.0);
  plate(tiny.object("carrier", carrier), -1.0, 0.5);
  plate(tiny.object("blade", part), 2.0, 0.5);
  scene::Scene scene = tiny.build();
  scene.bodies[part].joint = scene::Joint{carrier};
  scene::GpuScene gpu(test::device(), scene, {});
  const RadioSurfaces surfaces(std::vector<RadioSurface>(scene.materials.size(), conductor()),
                               radar_carrier_hz);
  EchoOptions options = sector(20.0, 20.0, 1000);
  for (const EchoTracing tracing : {EchoTracing::device, EchoTracing::host})
    for (const uint32_t own : {0u, carrier}) {
      options.tracing = tracing;
      EchoEnd end;
      end.own_body = own;
      EchoFinder finder(gpu, surfaces, end, std::nullopt, options);
      const EchoList list =
          testing::trace_echoes(finder, gpu, scene.bodies.size(), testing::at_rest(Pose{}, Pose{}));
      ASSERT_FALSE(list.echoes.empty());
      for (const Echo& echo : list.echoes) EXPECT_NEAR(echo.point.x, own == 0 ? 2.0 : 20.0, 1e-9);
    }
}

TEST(RadarEchoScene, DeviceAndHostMeetTheSame) {
  EchoScene scene(ball_at({15, 0, 0}, 0.3, wall_alone()));
  EchoOptions options = sector(60.0, 8.0, 4000);
  options.border_floor_m2 = 1e-6;  // keeps the contributions of three bounces
  options.targets = {1};
  const Pose radar{{0.013, -0.021, 0.017}};  // in no plane of symmetry: no ray meets an edge
  const std::vector<std::optional<Pose>> receivers{std::nullopt, Pose{{2, 3, 1}}};
  for (const std::optional<Pose>& receiver : receivers) {
    options.tracing = EchoTracing::device;
    const EchoList device = scene.find(options, radar, receiver);
    options.tracing = EchoTracing::host;
    const EchoList host = scene.find(options, radar, receiver);
    ASSERT_GT(device.echoes.size(), 10u);
    EXPECT_NEAR(double(host.echoes.size()), double(device.echoes.size()),
                0.002 * double(device.echoes.size()));
    for (const uint32_t bounces : {1u, 2u, 3u})
      EXPECT_LT(std::abs(field_of(host, bounces) - field_of(device, bounces)),
                1e-4 * std::abs(field_of(device, bounces)))
          << bounces << " bounces";
    const auto direct = [](const EchoList& list) {
      return std::count_if(list.echoes.begin(), list.echoes.end(),
                           [](const Echo& e) { return e.bounces == 0; });
    };
    EXPECT_EQ(direct(host), direct(device));
  }
}

TEST(RadarEchoScene, HardCase63ThreadsChangeNoByte) {
  EchoScene scene(ball_at({15, 0, 0}, 0.3, wall_alone()));
  EchoOptions options = sector(60.0, 8.0, 4000);
  options.targets = {1};
  options.edges = true;
  std::vector<EchoList> lists;
  for (const uint32_t threads : {1u, 2u, 16u}) {
    options.threads = threads;
    lists.push_back(scene.find(options, Pose{}));
  }
  ASSERT_GT(lists[0].echoes.size(), 10u);
  for (const EchoList& list : lists) {
    ASSERT_EQ(list.echoes.size(), lists[0].echoes.size());
    for (size_t i = 0; i < list.echoes.size(); ++i) {
      EXPECT_EQ(list.echoes[i].amplitude, lists[0].echoes[i].amplitude);
      EXPECT_EQ(list.echoes[i].delay.coefficients, lists[0].echoes[i].delay.coefficients);
      EXPECT_EQ(list.echoes[i].point, lists[0].echoes[i].point);
    }
  }
}

/// Compares the field of merged echoes with that of all tubes, over the band and over an aperture as wide as
/// the beam requires.
TEST(RadarEchoScene, MergingStaysWithinItsBound) {
  EchoScene scene(ball_at({15, 0, 0}, 0.6, wall_alone()));
  EchoOptions options = sector(60.0, 8.0, 8000);
  options.targets = {1};
  options.bandwidth_hz = 1e9;
  options.beam_rad = 0.1;
  const EchoList merged = scene.find(options, Pose{});
  options.merge_share = 0.0;
  const EchoList all = scene.find(options, Pose{});
  EXPECT_LT(merged.echoes.size() * 4, all.echoes.size());
  const auto field = [&](const EchoList& list, double offset_hz, double aperture_m) {
    Complex sum(0.0);
    for (const Echo& e : list.echoes)
      sum +=
          e.amplitude *
          std::polar(1.0, -2.0 * pi *
                              (std::remainder((radar_carrier_hz + offset_hz) * e.delay.coefficients[0], 1.0) -
                               aperture_m / radar_wavelength_m * e.arrival.y));
    return sum;
  };
  EXPECT_LT(std::abs(field(merged, 0, 0) - field(all, 0, 0)), 1e-6 * std::abs(field(all, 0, 0)));
  const double half_aperture = 0.5 * radar_wavelength_m / options.beam_rad;
  for (const double offset : {-0.5e9, 0.5e9})
    for (const double aperture : {-half_aperture, half_aperture}) {
      // A merged echo is displaced by at most one cell: by phases of pi B share/B and pi share, on average by
      // a third of their sum.
      const Complex expected = field(all, offset, aperture);
      EXPECT_LT(std::abs(field(merged, offset, aperture) - expected), 0.25 * std::abs(field(all, 0, 0)));
    }
}

TEST(RadarEchoScene, BeyondTheCapTheWeakestAreCounted) {
  EchoScene scene(ball_at({15, 0, 0}, 0.3, wall_alone()));
  EchoOptions options = sector(10.0, 8.0, 4000);
  options.merge_share = 0.0;
  const EchoList all = scene.find(options, Pose{});
  options.max_echoes = 50;
  EchoStatistics statistics;
  const EchoList few = scene.find(options, Pose{}, {}, &statistics);
  EXPECT_EQ(few.echoes.size(), 50u);
  EXPECT_EQ(statistics.left_out, all.echoes.size() - 50u);
  EXPECT_GT(statistics.left_out_power, 0.0);
}

/// The floor removes edges and corners that are weaker than a body of 1 mm^2.
TEST(RadarEchoScene, FloorOfEdgesIsWhatItSays) {
  TinyScene tiny;
  tiny.object("plate").quad({10, 0.5, -0.5}, {11, -0.5, -0.5}, {11, -0.5, 0.5}, {10, 0.5, 0.5});
  EchoScene scene(tiny);
  EchoOptions options = sector(10.0, 10.0, 500);
  EchoStatistics statistics;
  const Complex above = field_of(scene.find(options, Pose{}, {}, &statistics));
  EXPECT_GT(statistics.below_floor, 0u);
  options.border_floor_m2 = 0.0;
  const Complex all = field_of(scene.find(options, Pose{}));
  const double bound = std::sqrt(double(statistics.below_floor)) *
                       std::sqrt(1e-6 * std::pow(radar_wavelength_m, 2) / (std::pow(4.0 * pi, 3) * 1e4));
  EXPECT_LT(std::abs(all - above), bound);
}

TEST(RadarEchoScene, HiddenFloorGrowsWithTheFourthPowerOfDistance) {
  // Compares border contributions of a slanted plate at 10 m with those of a plate that is ten times as large
  // and as far away. At the same aspect their cross-sections are those of edges, which grow with the square
  // of the size.
  const auto find = [](double scale, double border_m2, double hidden_m2, EchoStatistics* statistics) {
    TinyScene tiny;
    tiny.object("plate").quad(dvec3(10, 0.5, -0.5) * scale, dvec3(11, -0.5, -0.5) * scale,
                              dvec3(11, -0.5, 0.5) * scale, dvec3(10, 0.5, 0.5) * scale);
    EchoScene scene(tiny);
    EchoOptions options = sector(10.0, 10.0, 500);
    options.border_floor_m2 = border_m2;
    options.hidden_floor_m2 = hidden_m2;
    return scene.find(options, Pose{}, {}, statistics).echoes.size();
  };
  for (const double scale : {1.0, 10.0}) {
    const double r4 = std::pow(10.0 * scale, 4.0);  // for the nearest corners, at 10.01 m and beyond
    EchoStatistics none, below, above, fixed_below, fixed_above;
    const size_t all = find(scale, 0.0, 0.0, &none);
    EXPECT_EQ(none.below_floor, 0u);
    // The nearest and the farthest corner, (10.012/10)^4 and (11.023/10)^4, bracket the floor of every piece.
    find(scale, 1e-5 * 1.0048, 0.0, &fixed_below);
    find(scale, 1e-5 * 1.4768, 0.0, &fixed_above);
    const size_t kept = find(scale, 0.0, 1e-5 / r4, &below);
    EXPECT_GE(below.below_floor, fixed_below.below_floor);
    EXPECT_LE(below.below_floor, fixed_above.below_floor);
    EXPECT_LE(kept, all);
    find(scale, 1e-5 * 1.4768, 1e-5 / r4, &above);
    EXPECT_EQ(above.below_floor, fixed_above.below_floor) << "the larger of the two counts";
  }
}

TEST(RadarEchoScene, DiffuseIsOffByDefaultAndHasThePowerOfItsModel) {
  TinyScene tiny;
  tiny.object("ground").quad({5, -5, -2}, {25, -5, -2}, {25, 5, -2}, {5, 5, -2});
  RadioSurface rough = conductor();
  rough.scattering.coefficient = 0.5;
  EchoScene scene(tiny, {rough, rough});
  EchoOptions options = sector(20.0, 25.0, 8000);
  const auto clutter = [](const EchoList& list) {
    double power = 0.0;
    const PatchList& patches = list.patches;
    for (size_t i = 0; i < patches.size(); ++i) {
      const double range = 0.5 * speed_of_light * patches.delay_s[i];
      if (range > 10.0 && range < 12.0)
        power += patches.re[i] * patches.re[i] + patches.im[i] * patches.im[i];
    }
    return power;
  };
  options.waveform.slots = options.waveform.transmitters = 1;
  EXPECT_TRUE(scene.find(options, Pose{}).patches.empty());
  options.diffuse = true;
  options.diffuse_patch_m = 0.02;  // 5,000 scatterers: their Gaussian draws leave 0.06 dB of the power
  const double on = clutter(scene.find(options, Pose{}));
  // Lambert's law: the integral of S^2 cos(theta_s) cos(theta_i)/pi over the ground with cos = 2/R, times
  // (lambda/4 pi)^2/R^4. It covers ranges from 10 to 12 m within |y| < 5 m and 20 degrees of azimuth.
  double expected = 0.0;
  for (double x = 5.0; x < 25.0; x += 0.02)
    for (double y = -5.0; y < 5.0; y += 0.02) {
      const double r = std::sqrt(x * x + y * y + 4.0);
      if (r < 10.0 || r > 12.0 || std::abs(std::atan2(y, x)) > radians(20.0)) continue;
      expected += 0.25 * (2.0 / r) * (2.0 / r) / pi * std::pow(radar_wavelength_m / (4.0 * pi), 2) /
                  std::pow(r, 4) * 4e-4;
    }
  EXPECT_NEAR(decibels(on), decibels(expected), 0.25);
}

}  // namespace
}  // namespace greatx::rf
