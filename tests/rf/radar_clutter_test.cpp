// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the patches of rough surfaces against the radar equation, and their speckle against its statistics.
#include <gtest/gtest.h>

#include "tests/rf/radar_clutter_scenes.h"

namespace greatx::rf {
namespace {

using test::TinyScene;
using testing::EchoScene;
using testing::looking;
using testing::patch_amplitude;
using testing::patch_range;
using testing::power_between;
using testing::radar_carrier_hz;
using testing::radar_wavelength_m;
using testing::rough_material;
using testing::still_options;

/// A floor of 60 m x 40 m, 10 m below the radar.
TinyScene floor_scene(const scene::Material& material) {
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(material);
  tiny.object("floor", 0, rough).quad({5, -20, -10}, {65, -20, -10}, {65, 20, -10}, {5, 20, -10});
  return tiny;
}

/// The radar equation over the floor, for elements of gain 1 with vertical polarization.
double floor_power(const scene::SurfaceClutter& clutter, double half_azimuth, double from_m, double to_m) {
  double power = 0.0;
  constexpr double step = 0.05;
  for (double x = 5.0 + 0.5 * step; x < 65.0; x += step)
    for (double y = -20.0 + 0.5 * step; y < 20.0; y += step) {
      const double r = std::sqrt(x * x + y * y + 100.0);
      if (r < from_m || r > to_m || std::abs(std::atan2(y, x)) > half_azimuth) continue;
      const double sigma = scene::backscatter(clutter, 10.0 / r, radar_carrier_hz).vv * step * step;
      power += radar_wavelength_m * radar_wavelength_m * sigma / std::pow(4.0 * pi, 3) / std::pow(r, 4);
    }
  return power;
}

TEST(RadarClutter, PowerIsThatOfTheRadarEquation) {
  for (const char* name : {"grass", "asphalt", "foliage"}) {
    const TinyScene tiny = floor_scene(rough_material(name));
    EchoScene scene(tiny);
    EchoOptions options = still_options(30.0, -60.0, -5.0);
    double near = 0.0, far = 0.0;
    constexpr int draws = 16;
    for (options.seed = 1; options.seed <= draws; ++options.seed) {
      const PatchList patches = scene.find(options, Pose{}).patches;
      ASSERT_GT(patches.size(), 300u) << name;
      near += power_between(patches, 15.0, 25.0) / draws, far += power_between(patches, 25.0, 45.0) / draws;
    }
    // Some 3,000 Gaussian powers and more are added: 0.08 dB of standard deviation.
    const scene::SurfaceClutter clutter = *scene::clutter_called(name);
    EXPECT_NEAR(decibels(near), decibels(floor_power(clutter, radians(30.0), 15.0, 25.0)), 0.25) << name;
    EXPECT_NEAR(decibels(far), decibels(floor_power(clutter, radians(30.0), 25.0, 45.0)), 0.25) << name;
  }
}

/// Sums the patches at the carrier between two ranges for a pose of the radar.
Complex cell_of(const PatchList& list, double from_m, double to_m) {
  Complex sum = 0.0;
  for (size_t i = 0; i < list.size(); ++i)
    if (patch_range(list, i) > from_m && patch_range(list, i) < to_m)
      sum += patch_amplitude(list, i) *
             std::polar(1.0, -2.0 * pi * std::remainder(radar_carrier_hz * list.delay_s[i], 1.0));
  return sum;
}

/// Plates of 6 cm at 20 m are seen by beams of their own with tubes of 0.3 m, and by the tubes with those of
/// 1 cm. Scatterers belong to the surface, so that both see the same ones.
TEST(RadarClutter, SmallFacetsSendBackTheSameWhateverTheTubesAre) {
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(rough_material("grass"));
  for (int i = 0; i < 12; ++i) {
    const dvec3 at(20.0 + 0.05 * i, 0.15 * (i % 4) - 0.26, 0.22 * (i / 4) - 0.21), side(0.02, 0.06, 0.0),
        up(-0.01, 0.0, 0.06);
    tiny.object("plate", 0, rough).quad(at, at + side, at + side + up, at + up);
  }
  EchoScene scene(tiny);
  EchoOptions options = still_options(3.0, -3.0, 3.0);
  options.diffuse_patch_m = 0.005;
  const auto sum = [&](uint32_t tubes, size_t& count) {
    options.tubes = tubes;
    const PatchList patches = scene.find(options, Pose{}).patches;
    count = patches.size();
    return cell_of(patches, 1.0, 100.0);
  };
  size_t few = 0, many = 0;
  const Complex coarse = sum(49, few), fine = sum(44100, many);
  EXPECT_GT(many, 1000u);
  EXPECT_EQ(few, many);
  EXPECT_LT(std::abs(coarse - fine), 1e-3 * std::abs(fine));
}

TEST(RadarClutter, SpecklesAreThoseOfRayleigh) {
  const TinyScene tiny = floor_scene(rough_material("grass"));
  EchoScene scene(tiny);
  EchoOptions options = still_options(5.0, -40.0, -10.0);
  double power = 0.0, squares = 0.0;
  int count = 0;
  for (options.seed = 1; options.seed <= 60; ++options.seed) {
    const PatchList patches = scene.find(options, Pose{}).patches;
    for (double range = 20.0; range < 40.0; range += 1.0) {
      // The mean over the draws is taken out: it falls with range.
      const double mean = floor_power(*scene::clutter_called("grass"), radians(5.0), range, range + 1.0);
      const double drawn = std::norm(cell_of(patches, range, range + 1.0)) / mean;
      power += drawn, squares += drawn * drawn, ++count;
    }
  }
  power /= count, squares /= count;
  // 1,200 exponential numbers: the mean is right to 0.03, and that of the squares to 0.13.
  EXPECT_NEAR(power, 1.0, 0.12);
  EXPECT_NEAR(squares / (power * power), 2.0, 0.4);
}

TEST(RadarClutter, SpeckleChangesWithTheAspectAsItsWidthSays) {
  // A strip of 2 m across the line of sight and 0.2 m along it, 50 m away: two aspects that differ by d see
  // fields whose correlation is sinc(2 L d/lambda) (M. A. Richards, "Fundamentals of Radar Signal
  // Processing", 2nd ed., 2.2).
  constexpr double width_m = 2.0, distance_m = 50.0;
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(rough_material("grass"));
  tiny.object("strip", 0, rough)
      .quad({50.0, -0.5 * width_m, -0.1}, {50.0, 0.5 * width_m, -0.1}, {50.0, 0.5 * width_m, 0.1},
            {50.0, -0.5 * width_m, 0.1});
  EchoScene scene(tiny);
  EchoOptions options = still_options(2.0, -1.0, 1.0);
  options.tubes = 400;
  options.diffuse_patch_m = 0.05;
  for (const double share : {0.0, 0.25, 0.5, 1.0, 1.5}) {
    const double turned = share * radar_wavelength_m / (2.0 * width_m);
    const dvec3 place(distance_m - distance_m * std::cos(turned), distance_m * std::sin(turned), 0.0);
    Complex product = 0.0;
    double first = 0.0, second = 0.0;
    for (options.seed = 1; options.seed <= 100; ++options.seed) {
      const Complex a = cell_of(scene.find(options, Pose{}).patches, 1.0, 100.0),
                    b = cell_of(scene.find(options, looking(place, {50, 0, 0})).patches, 1.0, 100.0);
      product += a * std::conj(b), first += std::norm(a), second += std::norm(b);
    }
    const double expected = share == 0.0 ? 1.0 : std::abs(std::sin(pi * share) / (pi * share));
    // The estimate of a correlation from 100 draws has a standard deviation of 0.1 or less.
    EXPECT_NEAR(std::abs(product) / std::sqrt(first * second), expected, 0.25) << share;
  }
}

TEST(RadarClutter, ScatterersStayOnTheirSurface) {
  // A plate that moves together with the radar sends back the same field; a static one does not.
  TinyScene tiny;
  const uint32_t rough = tiny.material_as(rough_material("soil"));
  const uint32_t body = tiny.body("plate");
  tiny.object("plate", body, rough).quad({0, -2, -2}, {0, -2, 2}, {0, 2, 2}, {0, 2, -2});
  EchoScene scene(tiny);
  EchoOptions options = still_options(10.0, -10.0, 10.0);
  options.diffuse_patch_m = 0.2;
  const EchoEnd end;
  const auto patches_at = [&](const Pose& radar, const Pose& plate) {
    EchoFinder finder(scene.gpu, scene.surfaces(), end, std::nullopt, options);
    EchoMotion motion = testing::at_rest(radar, radar);
    motion.body = [plate](uint32_t, double) { return plate; };
    return testing::trace_echoes(finder, scene.gpu, scene.scene.bodies.size(), motion).patches;
  };
  const dquat turn = orientation_from_yaw_pitch_roll(1.0, 0.2, 0.0);
  const PatchList still = patches_at(Pose{}, {{30, 0, 0}, {1, 0, 0, 0}});
  const PatchList moved =
      patches_at({{100, 50, 5}, turn}, {dvec3(100, 50, 5) + turn * dvec3(30, 0, 0), turn});
  ASSERT_EQ(still.size(), moved.size());
  ASSERT_GT(still.size(), 50u);
  for (size_t i = 0; i < still.size(); ++i) {
    // The radar's element is vertical in its own frame, so that the fields turn with it.
    EXPECT_NEAR(std::abs(patch_amplitude(still, i)), std::abs(patch_amplitude(moved, i)),
                1e-5 * std::abs(patch_amplitude(still, i)));
    EXPECT_NEAR(patch_range(still, i), patch_range(moved, i), 1e-9);
  }
}

TEST(RadarClutter, ShadowsAreExact) {
  TinyScene tiny = floor_scene(rough_material("grass"));
  tiny.object("wall").quad({20, -20, -10}, {20, -20, -5}, {20, 20, -5}, {20, 20, -10});
  EchoScene scene(tiny);
  EchoOptions options = still_options(20.0, -60.0, -5.0);
  options.max_bounces = 1;  // the wall mirrors the floor before it
  const PatchList patches = scene.find(options, Pose{}).patches;
  // The top of the wall, 5 m below the radar and 20 m away, hides the floor from x = 20 m to x = 40 m.
  size_t before = 0, behind = 0, beyond = 0;
  for (size_t i = 0; i < patches.size(); ++i) {
    const double x = patch_range(patches, i) * double(patches.departure[i].x);
    before += x<20.0 - 1e-4, behind += x> 20.0 + 1e-4 && x<40.0 - 1e-4, beyond += x> 40.0 + 1e-4;
  }
  EXPECT_GT(before, 100u);
  EXPECT_EQ(behind, 0u);
  EXPECT_GT(beyond, 100u);
}

TEST(RadarClutter, TubesAtTheBorderOfTheViewEndWithTheFloor) {
  // The highest row of tubes looks 0.5 to 1.5 degrees down from 1 m above a floor that ends after 65 m, where
  // it is seen 0.9 degrees down.
  const TinyScene tiny = floor_scene(rough_material("grass"));
  EchoScene scene(tiny);
  const Pose low{{0, 0, -9}, {1, 0, 0, 0}};
  const PatchList patches = scene.find(still_options(30.0, -10.0, -0.5), low).patches;
  ASSERT_GT(patches.size(), 100u);
  for (size_t i = 0; i < patches.size(); ++i)
    EXPECT_LT(patch_range(patches, i) * double(patches.departure[i].x), 65.0 + 1e-4) << i;
}

TEST(RadarClutter, NoiseHidesOnlyWhatStaysBelowIt) {
  const TinyScene tiny = floor_scene(rough_material("grass"));
  EchoScene scene(tiny);
  EchoOptions options = still_options(30.0, -60.0, -5.0);
  const PatchList all = scene.find(options, Pose{}).patches;
  // A cell 40 m away has (lambda-free) sigma0 x area over R^4 of this size.
  const double sine = 10.0 / 40.0;
  const double area = options.waveform.range_bin_m() / std::sqrt(1.0 - sine * sine) * 40.0 * options.beam_rad;
  options.hidden_floor_m2 = scene::backscatter(*scene::clutter_called("grass"), sine, radar_carrier_hz).vv *
                            area / std::pow(40.0, 4);
  const PatchList seen = scene.find(options, Pose{}).patches;
  EXPECT_LT(seen.size(), all.size());
  // Nearer than the tube across 40 m nothing is missing, and beyond it nothing is left.
  const auto count = [](const PatchList& list, double from_m, double to_m) {
    size_t number = 0;
    for (size_t i = 0; i < list.size(); ++i)
      number += patch_range(list, i) > from_m && patch_range(list, i) < to_m;
    return number;
  };
  EXPECT_EQ(count(seen, 0.0, 35.0), count(all, 0.0, 35.0));
  EXPECT_GT(count(all, 50.0, 70.0), 20u);
  EXPECT_EQ(count(seen, 50.0, 70.0), 0u);
}

TEST(RadarClutter, FoliageSendsBackWithoutAWall) {
  TinyScene tiny;
  scene::Material leaves = rough_material("foliage");
  leaves.radio->foliage.emplace();
  const uint32_t material = tiny.material_as(leaves);
  tiny.object("crown", 0, material).box({20, -3, -3}, {26, 3, 3});
  RadioSurface volume;
  volume.foliage = true;
  EchoScene scene(tiny, {testing::conductor(), volume});
  EchoOptions options = still_options(20.0, -20.0, 20.0);
  options.diffuse_patch_m = 0.2;
  const EchoList list = scene.find(options, Pose{});
  EXPECT_TRUE(list.echoes.empty());
  EXPECT_GT(list.patches.size(), 50u);
}

TEST(RadarClutter, AnotherElementAtTheReceiverUsesItsOwnPattern) {
  // A bistatic radar with both ends nearly in one place receives the power of a monostatic one.
  const TinyScene tiny = floor_scene(rough_material("grass"));
  EchoScene scene(tiny);
  const EchoOptions options = still_options(20.0, -50.0, -10.0);
  const Pose beside{{0.0, 0.01, 0.0}, {1, 0, 0, 0}};
  const PatchList mono = scene.find(options, Pose{}).patches,
                  two = scene.find(options, Pose{}, beside).patches;
  ASSERT_EQ(mono.size(), two.size());
  EXPECT_NEAR(decibels(power_between(two, 10.0, 60.0)), decibels(power_between(mono, 10.0, 60.0)), 0.05);
}

TEST(RadarClutter, AirWeakensPatchesAndEchoesOverTheirWay) {
  TinyScene tiny = floor_scene(rough_material("grass"));
  tiny.object("plate").quad({40, -1, -1}, {40, -1, 1}, {40, 1, 1}, {40, 1, -1});
  EchoScene scene(tiny);
  EchoOptions options = still_options(20.0, -50.0, 5.0);
  const EchoList vacuum = scene.find(options, Pose{});
  options.air_db_per_km = 100.0;
  const EchoList air = scene.find(options, Pose{});
  ASSERT_EQ(vacuum.patches.size(), air.patches.size());
  ASSERT_EQ(vacuum.echoes.size(), air.echoes.size());
  ASSERT_GT(air.echoes.size(), 0u);
  const auto expect_loss = [](const Complex& weak, const Complex& strong, double delay_s, double error_db) {
    EXPECT_NEAR(decibels(std::norm(weak) / std::norm(strong)), -0.1 * speed_of_light * delay_s, error_db);
  };
  for (size_t i = 0; i < air.patches.size(); ++i)
    expect_loss(patch_amplitude(air.patches, i), patch_amplitude(vacuum.patches, i), air.patches.delay_s[i],
                1e-5);
  for (size_t i = 0; i < air.echoes.size(); ++i)
    expect_loss(air.echoes[i].amplitude, vacuum.echoes[i].amplitude, air.echoes[i].delay.coefficients[0],
                1e-6);
}

TEST(RadarClutter, BytesDoNotDependOnThreads) {
  const TinyScene tiny = floor_scene(rough_material("grass", -10.0));
  EchoScene scene(tiny);
  testing::expect_same_on_all_threads(scene, still_options(30.0, -60.0, -5.0));
}

}  // namespace
}  // namespace greatx::rf
