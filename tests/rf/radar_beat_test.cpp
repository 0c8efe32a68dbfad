// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <fstream>

#include <gtest/gtest.h>

#include "core/error.h"
#include "core/random.h"
#include "tests/rf/radar_support.h"
#include "tests/support/temporary_folder.h"

namespace greatx::rf {
namespace {

using testing::cube_of;
using testing::direct_cube;
using testing::point_echo;
using testing::set_row;
using testing::small_radar;
using testing::whole_frame;

/// Returns the largest difference of a sample relative to the sum of all amplitudes.
double fault_of(const RadarSignalConfig& config, const EchoList& list) {
  const auto fast = cube_of(config, list);
  const auto slow = direct_cube(config, list);
  double sum = 0.0, largest = 0.0;
  for (const Echo& echo : list.echoes) sum += std::abs(echo.amplitude) * std::sqrt(config.transmit_power_w);
  for (size_t i = 0; i < fast.size(); ++i)
    largest = std::max(largest, std::abs(std::complex<double>(fast[i]) - slow[i]));
  return largest / sum;
}

std::vector<Echo> random_echoes(const RadarSignalConfig& config, int count, double fastest, uint64_t seed) {
  RandomStream random(seed, 1);
  std::vector<Echo> echoes;
  for (int i = 0; i < count; ++i) {
    Echo echo = testing::random_echo(config, fastest, random);
    echo.arrival = Direction{random.uniform(-1.5, 1.5), 0.1, 0.0}.unit();
    echo.delay.coefficients[2] = random.uniform(-10.0, 10.0) / speed_of_light;  // 10 m/s^2
    echo.delay.coefficients[3] = random.uniform(-50.0, 50.0) / speed_of_light;
    echoes.push_back(echo);
  }
  return echoes;
}

TEST(RadarBeat, FastSumEqualsTheDirectOne) {
  for (const double fastest : {0.0, 5.0, 60.0, 300.0})
    for (const uint32_t samples : {16u, 37u, 43u, 128u, 250u}) {
      RadarSignalConfig config = small_radar();
      config.waveform.samples = samples;
      config.waveform.sample_rate_hz = samples / 42e-6;
      config.waveform.slots = 8;
      config.waveform.slope_hz_per_s = 20e12;
      config.processing.detections = false;
      ASSERT_FALSE(check(config));
      for (const uint64_t seed : {1u, 2u})
        EXPECT_LT(fault_of(config, whole_frame(config, random_echoes(config, 20, fastest, seed))), 1e-5)
            << fastest << " m/s, " << samples << " samples";
      EXPECT_LT(fault_of(config, whole_frame(config, random_echoes(config, 1, fastest, 3))), 1e-5);
    }
}

TEST(RadarBeat, FastSumOfALargeArrayAndAWideBandEqualsTheDirectOne) {
  RadarSignalConfig config = small_radar();
  config.waveform.slope_hz_per_s = 100e12;  // 4.3 GHz
  config.waveform.slots = 64;  // by then the change of the ranges times the leads of the elements matters
  set_row(config, 4, 4);
  for (auto& p : config.arrays.transmit_m) p += dvec3(0.05, 0.3, 0.1);
  EXPECT_LT(fault_of(config, whole_frame(config, random_echoes(config, 30, 60.0, 4))), 1e-5);
}

TEST(RadarBeat, RotorTablesOfHardBendsEqualTheDirectSum) {
  RadarSignalConfig config = small_radar();
  EchoList list = whole_frame(config, random_echoes(config, 5, 10.0, 5));
  for (int blade = 0; blade < 6; ++blade) {
    Echo echo = list.echoes[0];
    echo.delay = {};
    echo.delay.table = blade;
    list.echoes.push_back(echo);
    const double omega = 2 * pi * (60 + 60 * blade);  // tip speeds from 9 to 340 m/s
    for (uint32_t s = 0; s < list.slots; ++s) {
      const double angle = omega * s * config.waveform.interval_s + blade;
      list.tables.push_back({2 / speed_of_light * (30 + 0.15 * std::cos(angle)),
                             -2 / speed_of_light * 0.15 * omega * std::sin(angle)});
    }
  }
  // The fast sum leaves out the cubic term of the delay within a chirp: at most 2 pi f_c tau''' (N/2 f_s)^3/6
  // rad of that echo.
  const double jerk = 2 / speed_of_light * 0.15 * std::pow(2 * pi * 360, 3),
               half = 0.5 * config.waveform.sampled_s();
  double sum = 0.0;
  for (const Echo& echo : list.echoes) sum += std::abs(echo.amplitude);
  const double bound = 2 * pi * config.waveform.carrier_hz * jerk * std::pow(half, 3) / 6;
  EXPECT_LT(fault_of(config, list), 1e-5 + bound * 6 * std::abs(list.echoes[0].amplitude) / sum);
  EXPECT_LT(bound, 0.01);
  RadarCube cube(config.arrays.receive_m.size() * config.waveform.slots * config.waveform.samples);
  const BeatReport report = BeatSynthesizer(config).add(list, {}, nullptr, 0, cube);
  EXPECT_EQ(report.tones, list.echoes.size() * list.slots);
  EXPECT_GT(report.bent_tones, 0u);
}

TEST(RadarBeat, ListsOfParts) {
  const RadarSignalConfig config = small_radar();
  const EchoList whole = whole_frame(config, random_echoes(config, 9, 20.0, 6));
  EchoList first = whole, second = whole;
  first.slots = 23;
  second.first_slot = 23;
  second.slots = config.waveform.slots - 23;
  RadarCube parts(cube_of(config, whole).size());
  const BeatSynthesizer synthesizer(config);
  synthesizer.add(first, {}, nullptr, 0, parts);
  synthesizer.add(second, {}, nullptr, 0, parts);
  const auto expected = cube_of(config, whole);
  for (size_t i = 0; i < parts.size(); ++i) EXPECT_LT(std::abs(parts[i] - expected[i]), 1e-5f * 9);
}

TEST(RadarBeatHardCase, N63_ThreadsGiveTheSameBytes) {
  RadarSignalConfig config = small_radar();
  config.receiver.noise_figure_db = 10.0;
  config.receiver.phase_noise = PhaseNoise{};
  config.receiver.adc = AnalogToDigital{};
  const std::vector<EchoList> lists{whole_frame(config, random_echoes(config, 300, 60.0, 7))};
  const std::vector<RadarAttitude> attitudes(1);
  const RadarProcessor processor("front", config, testing::isotropic, testing::isotropic);
  const RadarFrame one = processor.process({lists, attitudes, {}, {1, 2, 3}}, 1);
  for (const uint32_t threads : {2u, 16u}) {
    const RadarFrame many = processor.process({lists, attitudes, {}, {1, 2, 3}}, threads);
    EXPECT_EQ(std::memcmp(one.cube.data(), many.cube.data(), one.cube.size() * sizeof one.cube[0]), 0);
    EXPECT_EQ(one.range_doppler, many.range_doppler);
    EXPECT_EQ(one.range_azimuth, many.range_azimuth);
    ASSERT_EQ(one.detections.size(), many.detections.size());
    for (size_t i = 0; i < one.detections.size(); ++i) {
      EXPECT_EQ(one.detections[i].rcs_m2, many.detections[i].rcs_m2);
      EXPECT_EQ(one.detections[i].azimuth, many.detections[i].azimuth);
    }
  }
}

TEST(RadarBeatHardCase, N64_NoEchoesGiveZeros) {
  const RadarSignalConfig config = small_radar();
  for (const auto& lists : {std::vector<EchoList>{}, std::vector<EchoList>{whole_frame(config, {})}}) {
    const RadarFrame frame = testing::frame_of(config, lists);
    EXPECT_EQ(frame.cube, RadarCube(2 * 64 * 64));
    EXPECT_EQ(frame.range_doppler, std::vector<float>(64 * 32));
    EXPECT_EQ(frame.range_azimuth, std::vector<float>(64 * 181));
    EXPECT_TRUE(frame.detections.empty());
    EXPECT_EQ(frame.report.echoes, 0u);
  }
}

/// Returns the phase between two samples of virtual antenna (0, 0) in turns.
double turns_between(const std::complex<double>& to, const std::complex<double>& from) {
  return std::arg(to * std::conj(from)) / (2 * pi);
}

TEST(RadarBeat, HasTheSquaredDelaysTerm) {
  // Two frames have the slopes S and 2 S. At the sample at which the ramp passes f_c, their phases differ
  // only by S tau^2/2.
  RadarSignalConfig config = small_radar();
  config.waveform.slope_hz_per_s = 20e12;
  const EchoList list = whole_frame(config, {point_echo(config, 100.0, 0.0)});
  const auto plain = direct_cube(config, list);
  const auto plain_fast = cube_of(config, list);
  config.waveform.slope_hz_per_s *= 2.0;
  const auto steep = direct_cube(config, list);
  const auto steep_fast = cube_of(config, list);
  const double tau = 200.0 / speed_of_light, expected = -0.5 * 20e12 * tau * tau;
  EXPECT_NEAR(2 * pi * expected, -27.96, 0.01);  // rad
  const uint32_t n = config.waveform.middle_sample();
  EXPECT_NEAR(turns_between(steep[n], plain[n]), expected - std::nearbyint(expected), 1e-9);
  EXPECT_NEAR(turns_between(steep_fast[n], plain_fast[n]), expected - std::nearbyint(expected), 1e-5);
}

TEST(RadarBeat, RangeMigratesAndChirpsMove) {
  // During 64 slots of 60 us, a velocity of 40 m/s is 0.15 m, about one range bin. The tone at the end of the
  // frame is that of the range there.
  RadarSignalConfig config = small_radar();
  config.waveform.slope_hz_per_s = 20e12;
  set_row(config, 1, 1);
  const EchoList list = whole_frame(config, {point_echo(config, 20.0, 40.0)});
  const auto cube = cube_of(config, list);
  const RadarWaveform& w = config.waveform;
  for (const uint32_t slot : {0u, 31u, 63u}) {
    const double range = 20.0 + 40.0 * (w.slot_middle_s(slot) - w.frame_middle_s());
    const double tau = 2 * range / speed_of_light, rate = 80.0 / speed_of_light;
    const double tone_hz = w.slope_hz_per_s * tau * (1 - rate) + w.carrier_hz * rate;
    const size_t middle = slot * w.samples + w.middle_sample();
    double turns = 0.0;
    for (int n = -15; n < 15; ++n) turns += turns_between(cube[middle + n + 1], cube[middle + n]);
    // Each phase step is accurate to 1e-5 of a turn. The curvature within the chirp is even about its middle.
    EXPECT_NEAR(turns / 30, std::remainder(tone_hz / w.sample_rate_hz, 1.0), 2e-6) << slot;
    const double phase = (w.carrier_hz - 0.5 * w.slope_hz_per_s * tau) * tau;
    EXPECT_NEAR(std::remainder(std::arg(cube[middle]) / (2 * pi) - phase, 1.0), 0.0, 1e-5);
  }
}

template <typename Value>
void write(const std::filesystem::path& file, const std::vector<Value>& values) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

TEST(RadarBeat, AnIndependentModelInNumPyAgreesSampleBySample) {
  // The points fly straight past turned arrays. The script knows positions, not echoes.
  RadarSignalConfig config = small_radar();
  set_row(config, 2, 3);
  config.arrays.transmit_m[1].z = 0.004;
  const RadarWaveform& w = config.waveform;
  const dquat orientation = orientation_from_yaw_pitch_roll(0.3, -0.1, 0.05);
  RandomStream random(8, 1);
  EchoList list = whole_frame(config, {});
  std::vector<double> points;  // position and velocity at the start of the frame, amplitude and phase
  for (int i = 0; i < 12; ++i) {
    const dvec3 p = orientation * (random.uniform(20, 120) *
                                   Direction{random.uniform(-1, 1), random.uniform(-0.4, 0.4), 0}.unit());
    const dvec3 v(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-5, 5));
    const double amplitude = random.uniform(0.2, 1.0), phase = random.uniform(-3, 3);
    points.insert(points.end(), {p.x, p.y, p.z, v.x, v.y, v.z, amplitude, phase});
    Echo echo;
    echo.amplitude = std::polar(amplitude, phase);
    const double mid = w.frame_middle_s();
    const dvec3 at = p + v * mid;
    const double range = glm::length(at), along = glm::dot(v, at) / range;
    const double across = (glm::dot(v, v) - along * along) / range;  // second derivative of the range
    echo.delay.mid_s = mid;
    echo.delay.coefficients = {2 * range / speed_of_light, 2 * along / speed_of_light,
                               across / speed_of_light, -across * along / range / speed_of_light};
    echo.departure = echo.arrival = at / range;
    list.echoes.push_back(echo);
  }
  RadarCube cube(3 * w.slots * w.samples);
  BeatSynthesizer(config).add(list, {orientation, orientation}, nullptr, 0, cube);
  const test::TemporaryFolder folder;
  write(folder.path() / "cube.bin", cube);
  write(folder.path() / "points.bin", points);
  std::vector<double> elements, radar{w.carrier_hz,
                                      w.slope_hz_per_s,
                                      w.sample_rate_hz,
                                      w.adc_start_s,
                                      w.interval_s,
                                      double(w.samples),
                                      double(w.slots),
                                      2,
                                      3,
                                      config.transmit_power_w};
  for (const auto* positions : {&config.arrays.transmit_m, &config.arrays.receive_m})
    for (const dvec3& p : *positions) {
      const dvec3 world = orientation * p;
      elements.insert(elements.end(), {world.x, world.y, world.z});
    }
  write(folder.path() / "elements.bin", elements);
  write(folder.path() / "radar.bin", radar);
  EXPECT_EQ(
      std::system(
          fmt::format("'{}' '{}' '{}'", GREATX_PYTHON, GREATX_RADAR_POINTS, folder.path().string()).c_str()),
      0);
}

}  // namespace
}  // namespace greatx::rf
