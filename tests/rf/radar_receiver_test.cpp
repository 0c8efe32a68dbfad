// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "rf/radar/signal/lanes.h"
#include "rf/radar/signal/receiver.h"
#include "shaders/shared/random.h"
#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

/// Bound of a two-sided test at a significance of 1e-5, standard deviations.
constexpr double z_bound = 4.42;

TEST(RadarReceiver, FunctionsOfLanes) {
  double cosine_fault = 0.0, log_fault = 0.0;
  for (int i = -4000; i <= 4000; ++i) {
    const float turns = static_cast<float>(i) / 1777.0f;
    float cosine, sine;
    cos_sin_of_turns(turns, cosine, sine);
    cosine_fault = std::max({cosine_fault, std::abs(cosine - std::cos(2 * pi * turns)),
                             std::abs(sine - std::sin(2 * pi * turns))});
    const float value = std::exp2(static_cast<float>(i) / 40.0f);
    log_fault = std::max(log_fault, std::abs(natural_log(value) - std::log(double(value))) /
                                        std::max(1.0, std::abs(std::log(double(value)))));
  }
  EXPECT_LT(cosine_fault, 2.4e-7);
  EXPECT_LT(log_fault, 2.4e-7);
  EXPECT_NEAR(natural_log(0x1p-25f), std::log(0x1p-25), 1e-5);
}

TEST(RadarReceiver, DrawsArePhiloxByThatName) {
  std::vector<std::complex<float>> draws(300);
  const RadarSeeds seeds{0x0123456789abcdefull, 5, 9};
  complex_normals(seeds, RadarDraw::thermal, 3, 1000, draws);
  for (const size_t i : {0u, 1u, 128u, 299u}) {
    const glm::uvec4 words = shared::philox4x32(
        glm::uvec4(static_cast<uint32_t>(500 + i / 2), 5, 9, static_cast<uint32_t>(RadarDraw::thermal) + 3),
        glm::uvec2(0x89abcdefu, 0x01234567u));
    const uint32_t radius = i % 2 ? words.z : words.x, angle = i % 2 ? words.w : words.y;
    const double r = std::sqrt(-std::log(((radius >> 8) + 0.5) * 0x1p-24)),
                 a = 2 * pi * (angle >> 8) * 0x1p-24;
    EXPECT_NEAR(draws[i].real(), r * std::cos(a), 2e-6);
    EXPECT_NEAR(draws[i].imag(), r * std::sin(a), 2e-6);
  }
  std::vector<std::complex<float>> later(100);
  complex_normals(seeds, RadarDraw::thermal, 3, 1200, later);
  EXPECT_EQ(later[7], draws[207]);
}

TEST(RadarReceiver, HiddenEchoIsAHundredthOfTheNoiseOfAWholeFrame) {
  RadarSignalConfig config;
  config.waveform.samples = 256;
  config.waveform.transmitters = 4;
  config.waveform.slots = 512;
  config.arrays.transmit_m.assign(4, dvec3(0.0));
  config.arrays.receive_m.assign(3, dvec3(0.0));
  config.transmit_power_w = 0.02;
  config.receiver.noise_figure_db = 9.0;
  const double section = hidden_section_m2(config, 5.0, 2.0), r = 40.0,
               lambda = config.waveform.wavelength_m();
  // The radar equation for a body of this cross-section times r^4 at each antenna. The amplitudes of all
  // samples add up.
  const double each = 0.02 * 5.0 * 2.0 * lambda * lambda * section * std::pow(r, 4) /
                      (std::pow(4.0 * pi, 3) * std::pow(r, 4));
  const double samples = 256.0 * 512.0 * 3.0;
  const double noise = noise_power_w(config.waveform.sample_rate_hz, 9.0);
  EXPECT_NEAR(each * samples * samples / (noise * samples), 0.01, 1e-12);
  config.receiver.noise_figure_db.reset();
  EXPECT_EQ(hidden_section_m2(config, 5.0, 2.0), 0.0);
}

TEST(RadarReceiver, NoisePowerIsThermal) {
  // k T_0 = -173.975 dBm/Hz; with 10 MHz and 12 dB the noise power is -91.975 dBm.
  const double power = noise_power_w(10e6, 12.0);
  EXPECT_NEAR(testing::dbm_of(power), -91.975, 1e-3);
  RadarCube cube(1 << 18);
  add_noise({7, 1, 2}, power, 0, cube);
  double sum = 0.0, squares = 0.0;
  std::complex<double> mean = 0.0, skew = 0.0, neighbours = 0.0;
  for (size_t i = 0; i < cube.size(); ++i) {
    const std::complex<double> z = std::complex<double>(cube[i]) / std::sqrt(power);
    sum += std::norm(z);
    squares += std::norm(z) * std::norm(z);
    mean += z;
    skew += z * z;
    if (i) neighbours += z * std::conj(std::complex<double>(cube[i - 1])) / std::sqrt(power);
  }
  const double n = double(cube.size());
  EXPECT_LT(std::abs(sum / n - 1.0) * std::sqrt(n), z_bound);             // |z|^2 is exponential
  EXPECT_LT(std::abs(squares / n - 2.0) * std::sqrt(n / 20.0), z_bound);  // variance of |z|^4: 24 - 4
  for (const auto& value : {mean, skew / std::sqrt(2.0), neighbours}) {
    EXPECT_LT(std::abs(value.real()) / std::sqrt(n / 2), z_bound);
    EXPECT_LT(std::abs(value.imag()) / std::sqrt(n / 2), z_bound);
  }
  RadarCube other(cube.size());
  add_noise({7, 1, 3}, power, 0, other);
  EXPECT_NE(other[0], cube[0]);
}

TEST(RadarReceiver, PhaseNoiseCancelsByRange) {
  // The variance of phi(t) - phi(t - tau) for one pole is 2 sigma^2 (1 - e^{-2 pi f_p tau}).
  RadarWaveform w;
  w.samples = 256;
  w.slots = 256;
  const PhaseNoise noise{-80.0, 0.2e6};
  const PhaseWalk walk(noise, w, {3, 4, 5});
  EXPECT_NEAR(walk.deviation(), std::sqrt(pi * 0.2e6 * 1e-8), 1e-12);
  double nearest = 0.0;
  for (const double range : {1.0, 10.0, 100.0, 1000.0}) {
    const uint32_t node = PhaseWalk::node_of(2 * range / speed_of_light);
    const double tau = PhaseWalk::node_delay_s(node);
    EXPECT_LT(std::abs(std::log(tau * speed_of_light / (2 * range))), 0.5 * std::log(1.25) + 1e-9);
    double sum = 0.0;
    std::vector<double> of_slots;
    for (uint32_t slot = 0; slot < w.slots; ++slot) {
      std::vector<float> turns(w.samples);
      walk.ramp(slot).differences(node, turns);
      double square = 0.0;
      for (const float t : turns) square += std::pow(2 * pi * t, 2);
      of_slots.push_back(square / w.samples);
      sum += of_slots.back();
    }
    const double mean = sum / w.slots;
    double spread = 0.0;
    for (const double value : of_slots) spread += (value - mean) * (value - mean);
    // Slots are independent, which gives the deviation of their mean.
    const double deviation = std::sqrt(spread / (w.slots - 1) / w.slots);
    const double expected = 2 * std::pow(walk.deviation(), 2) * (1 - std::exp(-2 * pi * 0.2e6 * tau));
    EXPECT_LT(std::abs(mean - expected) / deviation, z_bound) << range;
    EXPECT_GT(mean, nearest);
    nearest = mean;
  }
}

TEST(RadarReceiver, PhaseNoiseTurnsEachEchoAsItsRangeSays) {
  RadarSignalConfig config = testing::small_radar();
  testing::set_row(config, 1, 1);
  config.receiver.phase_noise = PhaseNoise{-70.0, 1e6};
  const std::vector<EchoList> lists{testing::whole_frame(config, {testing::point_echo(config, 40.0, 3.0)})};
  const RadarFrame frame = testing::frame_of(config, lists, {1, 2, 3});
  const auto clean = testing::direct_cube(config, lists[0]);
  const PhaseWalk walk(*config.receiver.phase_noise, config.waveform, {1, 2, 3});
  for (const uint32_t slot : {0u, 17u, 63u}) {
    std::vector<float> turns(config.waveform.samples);
    walk.ramp(slot).differences(PhaseWalk::node_of(80.0 / speed_of_light), turns);
    for (uint32_t n = 0; n < config.waveform.samples; ++n) {
      const size_t i = slot * config.waveform.samples + n;
      const std::complex<double> ratio = std::complex<double>(frame.cube[i]) / clean[i];
      EXPECT_NEAR(std::abs(ratio), 1.0, 1e-4);
      EXPECT_NEAR(std::remainder(std::arg(ratio) - 2 * pi * turns[n], 2 * pi), 0.0, 1e-4);
    }
  }
}

TEST(RadarReceiver, ConverterRoundsToTheMiddleAndCountsWhatIsBeyond) {
  const AnalogToDigital adc{4, 30.0};  // full scale 1 sqrt(W), steps of 1/8
  RadarCube cube{{0.01f, -0.01f}, {0.5f, -0.99f}, {1.2f, 0.0f}, {0.0f, -3.0f}};
  EXPECT_EQ(digitize(adc, 1, cube), 2u);
  EXPECT_EQ(cube[0], std::complex<float>(0.0625f, -0.0625f));
  EXPECT_EQ(cube[1], std::complex<float>(0.5625f, -0.9375f));
  EXPECT_EQ(cube[2], std::complex<float>(0.9375f, 0.0625f));
  EXPECT_EQ(cube[3], std::complex<float>(0.0625f, -0.9375f));
  // The noise of each part is step^2/12: 6.02 dB per bit.
  RadarCube tone(1 << 16);
  for (size_t i = 0; i < tone.size(); ++i)
    tone[i] = std::polar(0.99f, static_cast<float>(std::fmod(double(i) * 0.7548776662466927, 1.0) * 2 * pi));
  const RadarCube before = tone;
  EXPECT_EQ(digitize({10, 30.0}, 0, tone), 0u);
  double noise = 0.0;
  for (size_t i = 0; i < tone.size(); ++i)
    noise += std::norm(std::complex<double>(tone[i]) - std::complex<double>(before[i]));
  EXPECT_NEAR(noise / double(tone.size()) / (2 * std::pow(1 / 512.0, 2) / 12), 1.0, 0.02);
}

}  // namespace
}  // namespace greatx::rf
