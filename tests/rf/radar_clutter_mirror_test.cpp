// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the clutter that a mirror shows against the radar equation of the radar's image.
#include <gtest/gtest.h>

#include "tests/rf/radar_clutter_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using testing::EchoScene;
using testing::patch_amplitude;
using testing::patch_range;
using testing::radar_carrier_hz;
using testing::radar_wavelength_m;
using testing::rough_material;
using testing::still_options;

constexpr double wall_y = 12.0, floor_z = -10.0, floor_low_y = -20.0, floor_end_x = 65.0;

/// A floor 10 m below the radar, up to a smooth wall at its left. Materials: default, floor.
TinyScene walled_floor(uint32_t wall_body = 0) {
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(rough_material("grass"));
  tiny.object("floor", 0, rough)
      .quad({5, floor_low_y, floor_z}, {floor_end_x, floor_low_y, floor_z}, {floor_end_x, wall_y, floor_z},
            {5, wall_y, floor_z});
  if (wall_body != 0) tiny.body("wall");
  tiny.object("wall", wall_body).quad({0, wall_y, -11}, {70, wall_y, -11}, {70, wall_y, 40}, {0, wall_y, 40});
  return tiny;
}

EchoOptions walled_options() { return still_options(80.0, -60.0, -5.0); }

/// How an end sees a patch of the floor: directly, or beyond the wall.
bool beyond_wall(const vec3& direction) {
  return double(direction.y) * floor_z / double(direction.z) > wall_y;
}
enum class Seen { directly, both, once };
Seen seen(const PatchList& list, size_t i) {
  const bool out = beyond_wall(list.departure[i]), home = beyond_wall(list.arrival_of(i));
  return out && home ? Seen::both : out || home ? Seen::once : Seen::directly;
}

struct WayPowers {
  double both = 0.0, once = 0.0;
};
WayPowers found_powers(const PatchList& list, double from_m, double to_m) {
  WayPowers powers;
  for (size_t i = 0; i < list.size(); ++i) {
    if (!(patch_range(list, i) > from_m && patch_range(list, i) < to_m)) continue;
    const double power = std::norm(patch_amplitude(list, i));
    if (seen(list, i) == Seen::both) powers.both += power;
    if (seen(list, i) == Seen::once) powers.once += power;
  }
  return powers;
}

bool in_view(const EchoOptions& options, const dvec3& direction) {
  const double azimuth = std::atan2(direction.y, direction.x),
               elevation = std::asin(direction.z / glm::length(direction));
  const FieldOfView& view = options.field_of_view;
  return azimuth > view.azimuth_min && azimuth < view.azimuth_max && elevation > view.elevation_min &&
         elevation < view.elevation_max;
}

/// The radar equation for elements of gain 1 with vertical polarization and a perfectly reflecting wall.
WayPowers expected_powers(const EchoOptions& options, double from_m, double to_m) {
  const scene::SurfaceClutter clutter = *scene::clutter_called("grass");
  WayPowers powers;
  constexpr double step = 0.05;
  for (double x = 5.0 + 0.5 * step; x < floor_end_x; x += step)
    for (double y = floor_low_y + 0.5 * step; y < wall_y; y += step) {
      const dvec3 direct(x, y, floor_z), over(x, 2.0 * wall_y - y, floor_z);
      if (!in_view(options, over)) continue;
      const double r = glm::length(direct), s = glm::length(over), height = -floor_z;
      const auto add = [&](double& power, double ways, double sine, double out, double home) {
        if (0.5 * (out + home) < from_m || 0.5 * (out + home) > to_m) return;
        const double sigma = scene::backscatter(clutter, sine, radar_carrier_hz).vv * step * step;
        power += ways * radar_wavelength_m * radar_wavelength_m * sigma / std::pow(4.0 * pi, 3) /
                 (out * out * home * home);
      };
      add(powers.both, 1.0, height / s, s, s);
      if (in_view(options, direct)) add(powers.once, 2.0, 0.5 * (height / r + height / s), r, s);
    }
  return powers;
}

TEST(RadarClutterMirror, PowerIsThatOfTheRadarEquationOfTheImage) {
  const TinyScene tiny = walled_floor();
  EchoScene scene(tiny);
  EchoOptions options = walled_options();
  constexpr int draws = 16;
  for (const auto& [from_m, to_m] : {std::pair(26.0, 36.0), {36.0, 56.0}}) {
    WayPowers mean;
    for (options.seed = 1; options.seed <= draws; ++options.seed) {
      const WayPowers one = found_powers(scene.find(options, Pose{}).patches, from_m, to_m);
      mean.both += one.both / draws, mean.once += one.once / draws;
    }
    // Some 3,000 Gaussian powers and more are added: 0.08 dB of standard deviation.
    const WayPowers expected = expected_powers(options, from_m, to_m);
    EXPECT_NEAR(decibels(mean.both), decibels(expected.both), 0.3) << from_m;
    EXPECT_NEAR(decibels(mean.once), decibels(expected.once), 0.3) << from_m;
  }
}

TEST(RadarClutterMirror, TheWallTakesItsReflectionOnceOrTwice) {
  // The radar is 1 m above the floor, so that its vertical field is nearly along the wall: r_te counts.
  const TinyScene tiny = walled_floor();
  RadioSurface glass;
  glass.front = glass.back = {{Complex(6.31, -0.01), 0.0}};
  EchoScene mirror(tiny), window(tiny, {glass, testing::conductor()});
  EchoOptions options = still_options(80.0, -15.0, -0.5);
  const Pose low{{0, 0, floor_z + 1.0}, {1, 0, 0, 0}};
  const PatchList strong = mirror.find(options, low).patches, weak = window.find(options, low).patches;
  ASSERT_EQ(strong.size(), weak.size());
  int both = 0, once = 0;
  for (size_t i = 0; i < strong.size(); ++i) {
    const double drop = std::abs(patch_amplitude(weak, i)) / std::abs(patch_amplitude(strong, i));
    const vec3 &out = strong.departure[i], &home = strong.arrival_of(i);
    const auto beyond = [&](const vec3& to) { return double(to.y) * -1.0 / double(to.z) > wall_y; };
    if (!beyond(out) && !beyond(home)) {
      EXPECT_NEAR(drop, 1.0, 1e-6);
      continue;
    }
    const double cosine = double(beyond(out) ? out.y : home.y);
    const double once_r = std::abs(window.surfaces().reflect(0, true, cosine).r_te);
    const bool twice = beyond(out) && beyond(home);
    EXPECT_NEAR(drop, twice ? once_r * once_r : once_r, 0.02);
    ++(twice ? both : once);
  }
  EXPECT_GT(both, 100);
  EXPECT_GT(once, 100);
}

/// Returns the rates of the path lengths of all patches, m/s, for a radar and a wall that move.
PatchList moving_patches(EchoScene& scene, const dvec3& radar_mps, const dvec3& wall_mps) {
  EchoOptions options = walled_options();
  options.waveform.slots = 32;
  options.waveform.interval_s = 50e-6;
  EchoFinder finder(scene.gpu, scene.surfaces(), EchoEnd{}, std::nullopt, options);
  EchoMotion motion;
  motion.transmitter = motion.receiver = [&](double t) { return Pose{t * radar_mps, {1, 0, 0, 0}}; };
  motion.body = [&](uint32_t, double t) { return Pose{t * wall_mps, {1, 0, 0, 0}}; };
  for (uint32_t slot = 0; slot < options.waveform.slots; ++slot)
    motion.slot_start_s.push_back(slot * options.waveform.interval_s);
  motion.slot_s = options.waveform.interval_s;
  return testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), motion).patches;
}

TEST(RadarClutterMirror, RatesAreThoseOfRadarAndWall) {
  const TinyScene tiny = walled_floor(1);
  EchoScene scene(tiny);
  const dvec3 radar(9.0, 2.0, -1.0), wall(3.0, -4.0, 0.0);
  const PatchList list = moving_patches(scene, radar, wall);
  ASSERT_EQ(list.blocks, 1u);
  int over = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    const dvec3 out(list.departure[i]), home(list.arrival_of(i));
    double expected = -glm::dot(radar, out) - glm::dot(radar, home);
    // The wall shortens each way over it by twice the way that it comes towards the radar, times the cosine.
    if (beyond_wall(list.departure[i])) expected += 2.0 * wall.y * out.y, ++over;
    if (beyond_wall(list.arrival_of(i))) expected += 2.0 * wall.y * home.y;
    // Everything moves by 16 mm within the frame; the middle of the block is 0.8 ms from the traced poses.
    EXPECT_NEAR(speed_of_light * list.rate[i], expected, 0.03) << i;
  }
  EXPECT_GT(over, 300);
}

TEST(RadarClutterMirror, WhatTheRadarDoesNotSeeItselfComesBackOverTheMirrorAlone) {
  TinyScene tiny = walled_floor();
  // Hides the floor at the right from the radar, but not from its image.
  tiny.object("screen").quad({2, -30, -11}, {2, -0.5, -11}, {2, -0.5, 5}, {2, -30, 5});
  EchoScene scene(tiny);
  const PatchList list = scene.find(walled_options(), Pose{}).patches;
  const auto direct_y = [](const vec3& direction) {
    const double y = double(direction.y) * floor_z / double(direction.z);
    return y > wall_y ? 2.0 * wall_y - y : y;
  };
  size_t both = 0;
  for (size_t i = 0; i < list.size(); ++i) {
    // The edge of the screen hides all points of the floor with y < -x/4.
    const vec3& to = list.departure[i];
    const double x = double(to.x) * floor_z / double(to.z), y = direct_y(to);
    const bool hidden = y < -0.25 * x - 1e-3;
    if (seen(list, i) == Seen::both)
      both += hidden;
    else
      EXPECT_FALSE(hidden) << x << ' ' << y;
  }
  EXPECT_GT(both, 100u);
}

TEST(RadarClutterMirror, BouncesLimitTheWays) {
  const TinyScene tiny = walled_floor();
  EchoScene scene(tiny);
  EchoOptions options = walled_options();
  const auto count = [&](Seen wanted) {
    const PatchList list = scene.find(options, Pose{}).patches;
    size_t number = 0;
    for (size_t i = 0; i < list.size(); ++i) number += seen(list, i) == wanted;
    return number;
  };
  options.max_bounces = 3;
  const size_t both = count(Seen::both), once = count(Seen::once);
  EXPECT_GT(both, 100u);
  EXPECT_GT(once, 100u);
  options.max_bounces = 2;  // mirror and floor
  EXPECT_EQ(count(Seen::both), 0u);
  EXPECT_EQ(count(Seen::once), once);
  options.max_bounces = 1;
  EXPECT_EQ(count(Seen::both) + count(Seen::once), 0u);
  EXPECT_TRUE(scene.find(options, Pose{}).patches.arrival.empty());
}

TEST(RadarClutterMirror, NoiseHidesWhatTheMirrorWeakens) {
  // The noise limit is set so that a good mirror's floor is seen, and a poor mirror's is not.
  const TinyScene tiny = walled_floor();
  RadioSurface poor;
  poor.front = poor.back = {{Complex(1.1, -0.001), 0.0}};
  EchoScene mirror(tiny), weak(tiny, {poor, testing::conductor()});
  EchoOptions options = still_options(60.0, -60.0, -5.0);
  const double range = 40.0, sine = 10.0 / range;
  const double area =
      options.waveform.range_bin_m() / std::sqrt(1.0 - sine * sine) * range * options.beam_rad;
  options.hidden_floor_m2 = scene::backscatter(*scene::clutter_called("grass"), sine, radar_carrier_hz).vv *
                            area / std::pow(range, 4);
  const PatchList strong = mirror.find(options, Pose{}).patches, none = weak.find(options, Pose{}).patches;
  size_t both = 0;
  for (size_t i = 0; i < strong.size(); ++i) both += seen(strong, i) == Seen::both;
  EXPECT_GT(both, 100u);
  for (size_t i = 0; i < none.size(); ++i) EXPECT_NE(seen(none, i), Seen::both);
}

TEST(RadarClutterMirror, FastScatterersOverMirrorsBecomeEchoes) {
  // A rough plate that turns at 100 Hz, beside the wall: no constant rate follows it.
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(rough_material("grass")), body = tiny.body("rotor");
  tiny.object("wall").quad({0, wall_y, -40}, {70, wall_y, -40}, {70, wall_y, 40}, {0, wall_y, 40});
  tiny.object("rotor", body, rough).quad({0, -6, -6}, {0, -6, 6}, {0, 6, 6}, {0, 6, -6});
  EchoScene scene(tiny);
  EchoOptions options = still_options(80.0, -20.0, 20.0);
  options.diffuse_patch_m = 0.5;
  options.waveform.slots = 128;
  options.waveform.interval_s = 50e-6;
  EchoFinder finder(scene.gpu, scene.surfaces(), EchoEnd{}, std::nullopt, options);
  EchoMotion motion = testing::at_rest(Pose{}, Pose{});
  motion.body = [](uint32_t, double t) {
    return Pose{{30, 0, 0}, orientation_from_yaw_pitch_roll(2.0 * pi * 100.0 * t, 0.0, 0.0)};
  };
  motion.slot_start_s.clear();
  for (uint32_t slot = 0; slot < 128; ++slot) motion.slot_start_s.push_back(slot * 50e-6);
  motion.slot_s = 50e-6;
  const EchoList list = testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), motion);
  size_t once = 0, both = 0;
  for (const Echo& echo : list.echoes) {
    if (echo.material != rough + 1 && echo.bounces < 2) continue;
    const bool out = echo.departure.y > 0.05, home = echo.arrival.y > 0.05;
    if (echo.bounces == 2 && out != home) ++once;
    if (echo.bounces == 3 && out && home) ++both;
  }
  EXPECT_GT(once, 50u);
  EXPECT_GT(both, 20u);
}

TEST(RadarClutterMirror, BytesDoNotDependOnThreads) {
  const TinyScene tiny = walled_floor();
  EchoScene scene(tiny);
  testing::expect_same_on_all_threads(scene, walled_options());
}

}  // namespace
}  // namespace greatx::rf
