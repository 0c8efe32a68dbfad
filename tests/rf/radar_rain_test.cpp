// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the patches of rain against the weather radar equation, and their speckle against its statistics.
#include <cstring>

#include <gtest/gtest.h>

#include "tests/rf/radar_echo_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using testing::EchoScene;
using testing::radar_carrier_hz;
using testing::radar_wavelength_m;

constexpr double eta = 1e-4;  ///< m^2/m^3

/// Options of a radar at rest with one slot, whose range cell is 1 m and whose span is 256 m.
EchoOptions rain_options() {
  EchoOptions options;
  options.field_of_view = {radians(-30.0), radians(30.0), radians(-10.0), radians(10.0)};
  options.tubes = 500;
  options.waveform.carrier_hz = radar_carrier_hz;
  options.waveform.slope_hz_per_s = 3.5128e12;
  options.waveform.slots = options.waveform.transmitters = 1;
  options.beam_rad = 0.1;
  options.rain = {eta, 5.0, 1.0, 0.5};
  return options;
}

/// A plate far behind the radar, which no ray meets.
TinyScene empty_scene() {
  TinyScene tiny;
  const uint32_t metal = tiny.material("metal", 0.5f);
  tiny.object("plate", 0, metal).quad({-50, -1, -1}, {-50, 1, -1}, {-50, 1, 1}, {-50, -1, 1});
  return tiny;
}

double rain_range(const PatchList& list, size_t i) { return 0.5 * speed_of_light * list.delay_s[i]; }

double rain_power(const PatchList& list, double from_m, double to_m) {
  double power = 0.0;
  for (size_t i = 0; i < list.size(); ++i)
    if (rain_range(list, i) > from_m && rain_range(list, i) < to_m)
      power += double(list.re[i]) * list.re[i] + double(list.im[i]) * list.im[i];
  return power;
}

/// Finds the rain of a frame.
PatchList rain_of(EchoScene& scene, const EchoOptions& options, uint64_t frame = 0,
                  dvec3 velocity = dvec3(0.0)) {
  EchoMotion motion = testing::at_rest(Pose{}, Pose{});
  motion.transmitter = motion.receiver = [velocity](double time_s) {
    return Pose{velocity * time_s, dquat(1, 0, 0, 0)};
  };
  motion.slot_s = 1e-3;
  motion.frame = frame;
  EchoFinder finder(scene.gpu, scene.surfaces(), {}, std::nullopt, options);
  return testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), motion).patches;
}

TEST(RadarRain, PowerIsThatOfTheWeatherRadarEquation) {
  // For elements of gain 1: P_r/P_t = lambda^2 eta Omega/((4 pi)^3) (1/r_1 - 1/r_2), for all ranges of a
  // solid angle. 3 degrees of elevation and more of the view stay the same.
  const TinyScene tiny = empty_scene();
  EchoScene scene(tiny);
  const EchoOptions options = rain_options();
  const double omega = 2.0 * radians(30.0) * 2.0 * std::sin(radians(10.0));
  double near = 0.0, far = 0.0;
  constexpr int draws = 40;
  for (uint64_t frame = 0; frame < draws; ++frame) {
    const PatchList rain = rain_of(scene, options, frame);
    ASSERT_GT(rain.size(), 5000u);
    near += rain_power(rain, 10.0, 20.0) / draws, far += rain_power(rain, 100.0, 120.0) / draws;
  }
  const double scale = radar_wavelength_m * radar_wavelength_m * eta * omega / std::pow(4.0 * pi, 3);
  // The ends of a range are known to a range bin, from which drops come at random.
  EXPECT_NEAR(decibels(near), decibels(scale * (1.0 / 10.0 - 1.0 / 20.0)), 0.2);
  EXPECT_NEAR(decibels(far), decibels(scale * (1.0 / 100.0 - 1.0 / 120.0)), 0.2);
}

TEST(RadarRain, CellsAreThoseOfRayleigh) {
  const TinyScene tiny = empty_scene();
  EchoScene scene(tiny);
  const EchoOptions options = rain_options();
  double power = 0.0, squares = 0.0;
  Complex mean = 0.0;
  int count = 0;
  for (uint64_t frame = 0; frame < 12; ++frame) {
    const PatchList rain = rain_of(scene, options, frame);
    std::vector<Complex> cells(100);
    for (size_t i = 0; i < rain.size(); ++i)
      if (const double r = rain_range(rain, i); r >= 20.0 && r < 120.0)
        cells[static_cast<size_t>(r - 20.0)] +=
            Complex(rain.re[i], rain.im[i]) * r *
            std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * rain.delay_s[i], 1.0));
    for (const Complex& cell : cells) {
      power += std::norm(cell), squares += std::norm(cell) * std::norm(cell), mean += cell;
      ++count;
    }
  }
  // <I^2>/<I>^2 = 2 for Rayleigh's amplitudes, to within 2 sqrt(5/1200).
  EXPECT_NEAR(squares / count / std::pow(power / count, 2), 2.0, 0.4);
  EXPECT_LT(std::norm(mean) / count, 9.0 * power / count);
}

TEST(RadarRain, MovesAsDropsFall) {
  const TinyScene tiny = empty_scene();
  EchoScene scene(tiny);
  EchoOptions options = rain_options();
  options.field_of_view = {radians(-5.0), radians(5.0), radians(60.0), radians(80.0)};
  const dvec3 own(3.0, 0.0, 0.0);
  double sum = 0.0, squares = 0.0, expected = 0.0;
  size_t count = 0;
  for (uint64_t frame = 0; frame < 10; ++frame) {
    const PatchList rain = rain_of(scene, options, frame, own);
    for (size_t i = 0; i < rain.size(); ++i, ++count) {
      const dvec3 u(rain.departure[i]);
      const double off = 0.5 * speed_of_light * rain.rate[i] - (-u.z * 5.0 - glm::dot(u, own));
      sum += off, squares += off * off;
      expected += u.z * u.z + 0.25;
    }
  }
  const double spread = std::sqrt(expected / double(count));
  EXPECT_NEAR(sum / double(count), 0.0, 5.0 * spread / std::sqrt(double(count)));
  EXPECT_NEAR(std::sqrt(squares / double(count)) / spread, 1.0, 0.05);
}

TEST(RadarRain, EndsAtWallsAndDependsOnItsFrameAlone) {
  TinyScene tiny;
  const uint32_t metal = tiny.material("metal", 0.5f);
  tiny.object("wall", 0, metal).quad({40, -60, -60}, {40, 60, -60}, {40, 60, 60}, {40, -60, 60});
  EchoScene scene(tiny);
  EchoOptions options = rain_options();
  options.threads = 1;
  const PatchList one = rain_of(scene, options, 3);
  for (size_t i = 0; i < one.size(); ++i) {
    const double x = rain_range(one, i) * one.departure[i].x;
    EXPECT_LT(x, 40.0);
  }
  EXPECT_GT(rain_power(one, 30.0, 40.0), 0.0);
  EXPECT_EQ(rain_power(one, 50.0, 1e3), 0.0);
  options.threads = 4;
  const PatchList two = rain_of(scene, options, 3), other = rain_of(scene, options, 4);
  EXPECT_EQ(one.re, two.re);
  EXPECT_EQ(one.delay_s, two.delay_s);
  EXPECT_EQ(one.rate, two.rate);
  EXPECT_NE(one.re, other.re);
  options.rain = {};
  EXPECT_TRUE(rain_of(scene, options, 3).empty());
}

TEST(RadarDirect, IsFriisUnlessSomethingIsBetween) {
  TinyScene tiny;
  const uint32_t metal = tiny.material("metal", 0.5f);
  tiny.object("wall", 0, metal).quad({40, -10, -60}, {40, 10, -60}, {40, 10, 60}, {40, -10, 60});
  EchoScene scene(tiny);
  EchoFinder finder(scene.gpu, scene.surfaces(), {}, std::nullopt, rain_options());
  EchoFinder::Pending pending;
  pending.body_poses.resize(scene.scene.bodies.size());
  const double friis = radar_wavelength_m / (4.0 * pi);
  for (const dvec3& at : {dvec3(30, 5, 0), dvec3(-20, 3, 8), dvec3(50, 40, 0)}) {
    const Complex amplitude = finder.direct(pending, EchoEnd{}, Pose{at, dquat(1, 0, 0, 0)});
    // Vertical elements see each other with the cosine between their polarizations, 1 in one plane.
    EXPECT_NEAR(std::abs(amplitude), friis / glm::length(at), 1e-9 * friis) << at.x;
  }
  EXPECT_EQ(finder.direct(pending, EchoEnd{}, Pose{{50, 5, 0}, dquat(1, 0, 0, 0)}), Complex(0.0));
  // Horizontal and vertical elements do not hear each other.
  EchoEnd crossed;
  crossed.slant = 0.5 * pi;
  EXPECT_LT(std::abs(finder.direct(pending, crossed, Pose{{30, 0, 0}, dquat(1, 0, 0, 0)})), 1e-9 * friis);
}

}  // namespace
}  // namespace greatx::rf
