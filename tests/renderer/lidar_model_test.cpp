// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks scan patterns, footprints, receivers and returns on the host against closed forms.
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "renderer/lidar/pane.h"
#include "renderer/lidar/scan/footprint.h"
#include "renderer/lidar/scan/receiver.h"
#include "renderer/lidar/scan/returns.h"
#include "renderer/lidar/scan/scan_pattern.h"

namespace greatx::render {
namespace {

using testing::ElementsAre;

// ------------------------------------------------------------------------------------------------ patterns

double azimuth_of(const dvec3& d) { return std::atan2(d.y, d.x); }
double elevation_of(const dvec3& d) { return std::atan2(d.z, std::hypot(d.x, d.y)); }

TEST(ScanPattern, RasterGoesLineByLineAndEveryShotHasItsTime) {
  RasterScan scan{4, 3, radians(10.0), radians(-20.0), radians(-5.0), radians(5.0), true, 0.06};
  const ScanPattern pattern = scan_pattern(scan);
  ASSERT_EQ(pattern.size(), 12u);
  ASSERT_EQ(pattern.times_s.size(), 12u);
  for (uint32_t i = 0; i < 12; ++i) {
    const uint32_t row = i / 4, column = row == 1 ? 3 - i % 4 : i % 4;
    EXPECT_NEAR(azimuth_of(pattern.directions[i]), radians(10.0 - 10.0 * column), 1e-15);
    EXPECT_NEAR(elevation_of(pattern.directions[i]), radians(-5.0 + 5.0 * row), 1e-15);
    EXPECT_NEAR(glm::length(pattern.directions[i]), 1.0, 1e-15);
    EXPECT_EQ(pattern.rings[i], row);
    EXPECT_DOUBLE_EQ(pattern.times_s[pattern.instants[i]], i * 0.005);
  }
  scan.alternate = false;
  EXPECT_NEAR(azimuth_of(scan_pattern(scan).directions[4]), radians(10.0), 1e-15);
  scan.sweep_s = 0.0;
  EXPECT_THAT(scan_pattern(scan).times_s, ElementsAre(0.0));
}

TEST(ScanPattern, RosetteOfEqualPrismsIsALineAndOfUnequalOnesStaysInItsRing) {
  // Equal deflections at opposite rates cancel along one axis: d (cos, sin)(wt) + d (cos, -sin)(wt) = (2 d
  // cos wt, 0).
  RosetteScan scan{1000, {radians(8.0), radians(8.0)}, {50.0, -50.0}, {0.0, 0.0}, 0.1};
  for (uint32_t i = 0; const dvec3& d : scan_pattern(scan).directions) {
    const double t = i++ * 1e-4, v = radians(16.0) * std::cos(2.0 * pi * 50.0 * t);
    EXPECT_NEAR(d.x, std::cos(v), 1e-12);
    EXPECT_NEAR(d.y, std::sin(v), 1e-12);
    EXPECT_NEAR(d.z, 0.0, 1e-12);
  }
  // In general the angle off the axis is |v|, with |v|^2 = d1^2 + d2^2 + 2 d1 d2 cos(angle between).
  scan = {5000, {radians(11.0), radians(7.0)}, {121.0, -77.0}, {0.3, 1.1}, 0.1};
  const ScanPattern pattern = scan_pattern(scan, 1234.5);
  double least = 10.0, most = 0.0;
  for (uint32_t i = 0; i < 5000; ++i) {
    const double t = 1234.5 + i * 2e-5, off = std::acos(pattern.directions[i].x);
    const double between = 2.0 * pi * (121.0 + 77.0) * t + 0.3 - 1.1;
    const double expected = std::sqrt(std::pow(radians(11.0), 2) + std::pow(radians(7.0), 2) +
                                      2.0 * radians(11.0) * radians(7.0) * std::cos(between));
    EXPECT_NEAR(off, expected, 1e-8);
    least = std::min(least, off);
    most = std::max(most, off);
  }
  EXPECT_NEAR(least, radians(4.0), 1e-4);
  EXPECT_NEAR(most, radians(18.0), 1e-4);
  // The pattern continues where the previous sweep ended.
  EXPECT_NE(scan_pattern(scan, 0.1).directions[7], scan_pattern(scan, 0.0).directions[7]);
  EXPECT_FALSE(repeats(scan));
}

TEST(ScanPattern, TableKeepsItsOrderAndSharesTimes) {
  const ShotTable table{{{0.0, 0.1, 0.2, 3}, {0.0, 0.3, -0.2, 5}, {0.01, -1.0, 0.0, 3}}, "t.csv", ""};
  const ScanPattern pattern = scan_pattern(table);
  EXPECT_THAT(pattern.times_s, ElementsAre(0.0, 0.01));
  EXPECT_THAT(pattern.instants, ElementsAre(0, 0, 1));
  EXPECT_THAT(pattern.rings, ElementsAre(3, 5, 3));
  EXPECT_NEAR(azimuth_of(pattern.directions[1]), 0.3, 1e-15);
  EXPECT_NEAR(elevation_of(pattern.directions[1]), -0.2, 1e-15);
  EXPECT_EQ(duration_s(table), 0.01);
  EXPECT_THROW(scan_pattern(ShotTable{}), ContractError);
  EXPECT_THROW(scan_pattern(ShotTable{{{0.1, 0, 0, 0}, {0.0, 0, 0, 0}}, "", ""}), ContractError);
}

// ----------------------------------------------------------------------------------------------- footprint

TEST(Footprint, WeightsAreTheRingsEnergyAndMomentsTheBeams) {
  for (const uint32_t rings : {1u, 2u, 3u, 8u}) {
    const double divergence = 0.003, w = 0.5 * divergence;
    const std::vector<SubRay> rays = sub_rays(divergence, rings);
    ASSERT_EQ(rays.size(), 1 + 3 * rings * (rings + 1));
    double sum = 0.0, moment = 0.0;
    dvec2 mean(0.0);
    for (const SubRay& ray : rays) {
      sum += ray.weight;
      mean += double{ray.weight} * dvec2(ray.offset);
      moment += ray.weight * glm::dot(dvec2(ray.offset), dvec2(ray.offset));
    }
    EXPECT_NEAR(sum, 1.0, 1e-6);
    EXPECT_NEAR(glm::length(mean), 0.0, 1e-6 * w);
    EXPECT_NEAR(moment, 0.5 * w * w, 1e-6 * w * w);  // second moment of exp(-2 r^2/w^2)
    // The weight of the disc of radius w / (2 n) is 1 - exp(-2 / (2 n)^2).
    EXPECT_NEAR(rays[0].weight, 1.0 - std::exp(-0.5 / (rings * rings)), 1e-7);
    // A ray of ring 1 has a sixth of exp(-2 r1^2/w^2) - exp(-2 r2^2/w^2).
    if (rings > 1) {
      const double r1 = 0.5 / rings, r2 = 1.5 / rings;
      EXPECT_NEAR(rays[1].weight, (std::exp(-2 * r1 * r1) - std::exp(-2 * r2 * r2)) / 6.0, 1e-7);
    }
  }
  EXPECT_EQ(sub_rays(0.0, 0).size(), 1u);
  EXPECT_THROW(sub_rays(0.0, 2), ContractError);
}

// --------------------------------------------------------------------------------------------------- glass

TEST(Pane, ReflectanceByFresnelAndStokes) {
  // One face at normal incidence reflects ((n-1)/(n+1))^2 = 0.04 for n = 1.5, a pane 2 r / (1 + r) = 1/13.
  EXPECT_NEAR(shared::pane_reflectance(1.0f, 1.5f, 1.0f), 1.0 / 13.0, 1e-7);
  EXPECT_NEAR(shared::pane_reflectance(1.0f, 1.5f, 2.0f), 4 * 0.04 / (1 + 3 * 0.04), 1e-7);
  EXPECT_NEAR(shared::pane_reflectance(0.5f, 1.0f, 1.0f), 0.0, 1e-7);   // glass with the index of air
  EXPECT_NEAR(shared::pane_reflectance(1e-6f, 1.5f, 1.0f), 1.0, 1e-4);  // grazing incidence
  // At Brewster's angle one polarization passes; one face reflects ((n^2-1)/(n^2+1))^2 of the other
  // polarization.
  const double n = 1.5, s = std::pow((n * n - 1) / (n * n + 1), 2);
  EXPECT_NEAR(shared::pane_reflectance(static_cast<float>(1.0 / std::hypot(1.0, n)), 1.5f, 1.0f),
              0.5 * 2 * s / (1 + s), 1e-6);
  EXPECT_NEAR(glass_index(905.0), 1.5152, 1e-4);
  EXPECT_NEAR(glass_index(1550.0), 1.5070, 1e-4);
}

TEST(Pane, OfAMaterialByWhatTheFileOrRadioSays) {
  scene::Material wall;
  EXPECT_FALSE(pane_of(wall, 905));
  scene::Material blend;
  blend.pbr.transmission = 0.7f;
  ASSERT_TRUE(pane_of(blend, 905));
  EXPECT_EQ(pane_of(blend, 905)->sheets, 1.0f);
  EXPECT_EQ(pane_of(blend, 905)->clearness, 0.7f);

  const auto layer = [](const char* name, double thickness) {
    return scene::RadioLayer{*scene::itu_medium(name), thickness};
  };
  scene::Material glazing;
  glazing.reflectance_1550nm = 0.02f;
  glazing.radio.emplace().layers = {layer("glass", 0.006), layer("vacuum", 0.016), layer("glass", 0.006)};
  ASSERT_TRUE(pane_of(glazing, 905));
  EXPECT_EQ(pane_of(glazing, 905)->sheets, 2.0f);
  EXPECT_EQ(pane_of(glazing, 905)->scattering, 0.0f);
  EXPECT_EQ(pane_of(glazing, 1550)->scattering, 0.02f);
  glazing.pbr.base_color_texture = 0;  // the material has a picture of a facade
  EXPECT_FALSE(pane_of(glazing, 905));
  glazing.pbr.base_color_texture = -1;
  glazing.radio->layers[1] = layer("concrete", 0.1);
  EXPECT_FALSE(pane_of(glazing, 905));
  glazing.radio->layers = {layer("glass", 0.0)};  // a half-space of glass
  EXPECT_FALSE(pane_of(glazing, 905));
}

// ------------------------------------------------------------------------------------------------ receiver

TEST(Receiver, RangeEquationAndRating) {
  Receiver receiver;
  receiver.aperture_diameter_m = 0.02;
  receiver.system_efficiency = 0.8;
  receiver.extinction_per_m = 2e-3;
  // P_t rho cos(theta) D^2 eta / (4 R^2) exp(-2 alpha R)
  EXPECT_DOUBLE_EQ(received_power(receiver, 50.0, 0.3), 0.3 * 4e-4 * 0.8 / (4 * 2500.0) * std::exp(-0.2));
  const Receiver::Detection rating = rated(receiver, 100.0, 0.1, 0.9, 5.0);
  const double clear_power = 0.1 * 4e-4 * 0.8 / 4e4;
  EXPECT_NEAR(normal_cdf(clear_power / rating.noise_equivalent_power - 5.0), 0.9, 1e-12);
  for (const double p : {1e-9, 0.02, 0.5, 0.9, 1.0 - 1e-9})
    EXPECT_NEAR(normal_cdf(normal_quantile(p)), p, 1e-15 + 1e-12 * p);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-12);
}

TEST(Receiver, DrawsAreNormalAndOfTheirCounterAlone) {
  const ShotNoise noise(1234567890123ull, 77, 3, 1ll << 33);
  constexpr uint32_t count = 100'000;
  double sum = 0.0, squares = 0.0, tails = 0.0;
  for (uint32_t shot = 0; shot < count; ++shot) {
    const double n = noise.normal(shot, ShotNoise::Purpose::range, 2);
    sum += n;
    squares += n * n;
    tails += std::abs(n) > 1.959963984540054;
  }
  EXPECT_NEAR(sum / count, 0.0, 4.0 / std::sqrt(count));
  EXPECT_NEAR(squares / count, 1.0, 4.0 * std::sqrt(2.0 / count));
  EXPECT_NEAR(tails / count, 0.05, 4.0 * std::sqrt(0.05 * 0.95 / count));
  EXPECT_EQ(noise.normal(5, ShotNoise::Purpose::range, 2),
            ShotNoise(1234567890123ull, 77, 3, 1ll << 33).normal(5, ShotNoise::Purpose::range, 2));
  const double here = noise.normal(5, ShotNoise::Purpose::range, 2);
  EXPECT_NE(here, noise.normal(6, ShotNoise::Purpose::range, 2));
  EXPECT_NE(here, noise.normal(5, ShotNoise::Purpose::range, 1));
  EXPECT_NE(here, noise.normal(5, ShotNoise::Purpose::detection, 2));
  EXPECT_NE(here, ShotNoise(1234567890123ull, 77, 3, 0).normal(5, ShotNoise::Purpose::range, 2));
  EXPECT_NE(here, ShotNoise(1234567890123ull, 77, 4, 1ll << 33).normal(5, ShotNoise::Purpose::range, 2));
  EXPECT_NE(here, ShotNoise(1234567890123ull, 78, 3, 1ll << 33).normal(5, ShotNoise::Purpose::range, 2));
}

// ------------------------------------------------------------------------------------------------- returns

TEST(Pulses, EchoesTheReceiverCannotTellApartAreOne) {
  const Receiver receiver;
  std::vector<WeightedEcho> echoes{{10.5, 0.2, 1.0, 1.0, 4, 1},
                                   {10.0, 0.3, 0.5, 1.0, 2, 1},
                                   {10.2, 0.1, 0.5, 1.0, 3, 1},
                                   {20.0, 0.4, 0.8, 1.0, 7, 2}};
  const std::vector<Pulse> pulses = pulses_of(echoes, receiver, 0.35);
  ASSERT_EQ(pulses.size(), 2u);  // 10.0, 10.2 and 10.5 follow each other within the resolution
  const auto power = [&](double r, double weight, double intensity) {
    return weight * received_power(receiver, r, intensity);
  };
  const double a = power(10.0, 0.3, 0.5), b = power(10.2, 0.1, 0.5), c = power(10.5, 0.2, 1.0);
  EXPECT_NEAR(pulses[0].range_m, (10.0 * a + 10.2 * b + 10.5 * c) / (a + b + c), 1e-12);
  EXPECT_NEAR(pulses[0].power, a + b + c, 1e-18);
  EXPECT_NEAR(pulses[0].intensity, 0.15 + 0.05 + 0.2, 1e-15);
  EXPECT_NEAR(pulses[0].share, 0.6, 1e-15);
  EXPECT_EQ(pulses[0].instance, 4u);
  EXPECT_EQ(pulses[1].range_m, 20.0);
  EXPECT_EQ(pulses[1].instance, 7u);
}

/// Holds the echoes of one shot along x, with one sub-ray each.
struct OneShot {
  ScanPattern pattern = scan_pattern(ShotTable{{{0.0, 0.0, 0.0, 0}}, "", ""});
  std::vector<shared::LidarEcho> echoes;
  ReturnModel model;
  void add(float range, float weight, float intensity, uint32_t instance) {
    echoes.push_back({range, intensity, 1.0f, instance, 1});
    model.weights.push_back(weight);
  }
  LidarScan scan(const ShotNoise& noise = {}) const {
    return make_scan(pattern, {echoes, 1, static_cast<uint32_t>(echoes.size()), 1}, model, noise);
  }
};

TEST(Returns, Modes) {
  OneShot shot;
  shot.add(10.0f, 0.1f, 0.2f, 1);  // weak and near
  shot.add(20.0f, 0.6f, 0.9f, 2);  // the strongest
  shot.add(30.0f, 0.2f, 0.9f, 3);
  shot.add(40.0f, 0.1f, 0.05f, 4);  // the last
  const auto instances = [&](ReturnMode mode, uint32_t most = 15) {
    shot.model.choice.mode = mode;
    shot.model.choice.most = most;
    const LidarScan scan = shot.scan();
    for (size_t i = 0; i < scan.size(); ++i) {
      EXPECT_EQ(scan.return_count[i], 4);
      EXPECT_EQ(scan.return_number[i], scan.instance[i]);
    }
    return scan.instance;
  };
  EXPECT_THAT(instances(ReturnMode::strongest), ElementsAre(2));
  EXPECT_THAT(instances(ReturnMode::last), ElementsAre(4));
  EXPECT_THAT(instances(ReturnMode::dual), ElementsAre(2, 4));
  EXPECT_THAT(instances(ReturnMode::all), ElementsAre(1, 2, 3, 4));
  EXPECT_THAT(instances(ReturnMode::all, 3), ElementsAre(1, 2, 3));
  shot.echoes[3].intensity = 20.0f;  // the last is the strongest: the second strongest goes with it
  EXPECT_THAT(instances(ReturnMode::dual), ElementsAre(2, 4));
  shot.echoes[2].intensity = 15.0f;
  EXPECT_THAT(instances(ReturnMode::dual), ElementsAre(3, 4));
}

TEST(Returns, DetectionHasItsProbabilityAndRangeNoiseItsDeviation) {
  constexpr uint32_t count = 20'000;
  ShotTable table;
  table.shots.assign(count, {0.0, 0.0, 0.0, 0});
  const ScanPattern pattern = scan_pattern(table);
  const std::vector<shared::LidarEcho> echoes(count, {50.0f, 0.1f, 1.0f, 1, 1});
  ReturnModel model;
  model.weights = {1.0f};
  model.receiver.detection = rated(model.receiver, 50.0, 0.1, 0.7, 5.0);
  model.receiver.range_std_m = 0.02;
  model.receiver.rise_m = 0.3;
  const ShotNoise noise(9, 1, 0, 0);
  const LidarScan scan = make_scan(pattern, {echoes, count, 1, 1}, model, noise);
  EXPECT_NEAR(static_cast<double>(scan.size()) / count, 0.7, 4.0 * std::sqrt(0.7 * 0.3 / count));
  const double snr = 5.0 + normal_quantile(0.7), deviation = std::hypot(0.02, 0.3 / snr);
  double sum = 0.0, squares = 0.0;
  for (const float range : scan.range_m) {
    sum += range - 50.0;
    squares += (range - 50.0) * (range - 50.0);
  }
  const auto n = static_cast<double>(scan.size());
  EXPECT_NEAR(sum / n, 0.0, 4.0 * deviation / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n), deviation, 4.0 * deviation / std::sqrt(2.0 * n));
  // The points lie at their ranges.
  for (size_t i = 0; i < scan.size(); ++i) ASSERT_FLOAT_EQ(scan.points[i].x, scan.range_m[i]);
  // A second call gives the same ranges.
  EXPECT_EQ(make_scan(pattern, {echoes, count, 1, 1}, model, noise).range_m, scan.range_m);
}

TEST(Returns, FogAnswersNearByAndAsOftenAsItsPowerSays) {
  constexpr uint32_t count = 20'000;
  ShotTable table;
  table.shots.assign(count, {0.0, 0.0, 0.0, 0});
  const ScanPattern pattern = scan_pattern(table);
  const std::vector<shared::LidarEcho> nothing(count, {INFINITY, 0.0f, 0.0f, 0, 0});
  ReturnModel model;
  model.weights = {1.0f};
  model.choice.resolution_m = 0.5;
  model.min_range_m = 1.0;
  model.receiver.extinction_per_m = 0.03;
  model.receiver.backscatter_per_m_sr = 0.03 / lidar_ratio_sr;
  model.receiver.detection = rated(model.receiver, 100.0, 0.1, 0.9, 5.0);
  const LidarScan scan = make_scan(pattern, {nothing, count, 1, 1}, model, ShotNoise(9, 1, 0, 0));
  // In the first gates the signal is certain: all returns come from there.
  const double first = received_power(model.receiver, 1.5, pi * model.receiver.backscatter_per_m_sr * 0.5) /
                       model.receiver.detection->noise_equivalent_power;
  ASSERT_GT(first, 15.0);
  ASSERT_EQ(scan.size(), count);
  for (size_t i = 0; i < scan.size(); ++i) {
    ASSERT_GE(scan.range_m[i], 1.0f);
    ASSERT_LE(scan.range_m[i], 1.5f);
    ASSERT_EQ(scan.instance[i], 0u);
  }
  // In thin fog, the share of shots with a return is 1 - prod(1 - P_k), where P_k is the mean over each gate.
  model.receiver.backscatter_per_m_sr /= 250.0;
  const LidarScan thin = make_scan(pattern, {nothing, count, 1, 1}, model, ShotNoise(9, 1, 0, 0));
  double silent = 1.0;
  for (int k = 0; k < 238; ++k) {
    double p = 0.0;
    for (int j = 0; j < 1000; ++j) {
      const double r = 1.0 + 0.5 * k + 0.5 * (j + 0.5) / 1000;
      p += normal_cdf(received_power(model.receiver, r, pi * model.receiver.backscatter_per_m_sr * 0.5) /
                          model.receiver.detection->noise_equivalent_power -
                      5.0) /
           1000;
    }
    silent *= 1.0 - p;
  }
  EXPECT_GT(silent, 0.1);
  EXPECT_LT(silent, 0.9);
  EXPECT_NEAR(1.0 - static_cast<double>(thin.size()) / count, silent,
              4.0 * std::sqrt(silent * (1 - silent) / count));
  // A wall at 1.2 m hides the fog behind it.
  const std::vector<shared::LidarEcho> near(count, {1.2f, 0.5f, 1.0f, 1, 1});
  for (const uint32_t instance :
       make_scan(pattern, {near, count, 1, 1}, model, ShotNoise(9, 1, 0, 0)).instance)
    ASSERT_EQ(instance, 1u);
}

}  // namespace
}  // namespace greatx::render
