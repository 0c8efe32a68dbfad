// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests the waveforms of radars against direct sums and closed forms.
#include <cmath>

#include <gtest/gtest.h>

#include "core/error.h"
#include "rf/radar/signal/delay.h"
#include "rf/radar/signal/symbols.h"
#include "tests/rf/radar_waveforms.h"

namespace greatx::rf {
namespace {

using testing::all_radars;
using testing::coded_direct;
using testing::dbm_of;
using testing::frame_of;
using testing::NamedRadar;
using testing::point_echo;
using testing::radar_of;
using testing::strongest;
using testing::whole_frame;

/// Returns the cube of a radar that has no noise.
RadarCube cube_of_frame(const RadarSignalConfig& config, const EchoList& list) {
  RadarSignalConfig quiet = config;
  quiet.processing.range_doppler = quiet.processing.range_azimuth = quiet.processing.detections = false;
  return frame_of(quiet, {list}).cube;
}

/// Echoes within the span and the cyclic prefix of all waveforms, some of which turn too fast for a cubic.
EchoList some_echoes(const RadarSignalConfig& config, double fastest) {
  RandomStream random(7, 8);
  EchoList list = whole_frame(config, {});
  for (int i = 0; i < 6; ++i) {
    Echo echo = point_echo(config, random.uniform(2.0, 42.0), random.uniform(-fastest, fastest),
                           random.uniform(-1.2, 1.2));
    echo.amplitude = std::polar(random.uniform(0.1, 1.0), random.uniform(-pi, pi));
    echo.delay.coefficients[2] = random.uniform(-1e-6, 1e-6);
    list.echoes.push_back(echo);
  }
  Echo turning = list.echoes[0];
  turning.delay.table = 0;
  for (uint32_t s = 0; s < list.slots; ++s) {
    const double t = config.waveform.slot_start_s(s), angle = 2.0 * pi * 60.0 * t;
    list.tables.push_back({2.0 * (30.0 + 0.1 * std::sin(angle)) / speed_of_light,
                           2.0 * 0.1 * 2.0 * pi * 60.0 * std::cos(angle) / speed_of_light});
  }
  list.echoes.push_back(turning);
  return list;
}

TEST(RadarWaveforms, CubesAreThoseOfTheDirectSum) {
  for (const auto& [name, config] : all_radars(8)) {
    const EchoList list = some_echoes(config, 60.0);
    const RadarCube cube = cube_of_frame(config, list);
    const auto direct =
        config.waveform.coded() ? coded_direct(config, list, {1, 2, 3}) : testing::direct_cube(config, list);
    ASSERT_EQ(cube.size(), direct.size()) << name;
    double sum = 0.0, worst = 0.0;
    for (const Echo& echo : list.echoes) sum += std::abs(echo.amplitude);
    const double together = config.waveform.bands() > 1 ? 2.0 : 1.0;
    sum *= std::sqrt(config.transmit_power_w) * together;
    for (size_t i = 0; i < cube.size(); ++i)
      worst = std::max(worst, std::abs(std::complex<double>(cube[i]) - direct[i]));
    // Coded waveforms leave out that the ends of the band have another Doppler shift: pi N |tau'|/2 rad, and
    // the lines of a code differ from 1.
    // Those that sweep leave out the cubic part of the delay within a sweep: 2 pi f_c |tau'''| (N/2f_s)^3/6,
    // of the echo that turns.
    const double third = 2.0 * 0.1 * std::pow(2.0 * pi * 60.0, 3) / speed_of_light;
    const double left_out = config.waveform.coded()
                                ? 2.0 * pi * config.waveform.samples * 2.0 * 60.0 / speed_of_light
                                : 2.0 * pi * config.waveform.carrier_hz * third *
                                      std::pow(0.5 * config.waveform.sampled_s(), 3) / 6.0 *
                                      std::abs(list.echoes.back().amplitude) *
                                      std::sqrt(config.transmit_power_w) * together / sum;
    EXPECT_LT(worst / sum, 1e-5 + left_out) << name;
    EXPECT_GT(worst / sum, 0.0) << name;
  }
}

/// Returns a target whose range and Doppler are in the middle of no bin.
Echo target(const RadarSignalConfig& config, double range_m, double share_of_v_max, double azimuth) {
  return point_echo(config, range_m, share_of_v_max * 0.5 * config.waveform.velocity_span_m_s(), azimuth);
}

double power_of(const RadarSignalConfig& config, const Echo& echo) {
  return config.transmit_power_w * std::norm(echo.amplitude);
}

TEST(RadarWaveforms, OneTargetHasItsRangeVelocityAngleAndPower) {
  // An m-sequence lacks its middle line, which costs 2/N of the amplitude with a Hann window.
  for (const auto& [name, config] : all_radars(32, 2047))
    for (const double of_band : {0.0, 0.413, -0.77}) {
      // Doppler shifts within a code change its sidelobes: take up to a fiftieth of the spacing of its lines.
      const double fastest = config.waveform.modulation == RadarModulation::pmcw
                                 ? 0.04 * config.waveform.repetition_s() / config.waveform.sampled_s()
                                 : 1.0;
      const double share = of_band * std::min(1.0, fastest);
      const Echo echo = target(config, 31.7, share, 0.25);
      const RadarFrame frame = frame_of(config, {whole_frame(config, {echo})});
      ASSERT_GE(frame.detections.size(), 1u) << name;
      const RadarDetection& found = strongest(frame);
      const RadarWaveform& w = config.waveform;
      EXPECT_NEAR(found.range_m, 31.7, 0.01 * w.range_bin_m()) << name << " " << share;
      EXPECT_NEAR(found.velocity_m_s, share * 0.5 * w.velocity_span_m_s(), 0.01 * w.velocity_bin_m_s())
          << name << " " << share;
      EXPECT_NEAR(found.azimuth, 0.25, 0.002) << name << " " << share;
      EXPECT_NEAR(dbm_of(found.power_w), dbm_of(power_of(config, echo)), 0.01) << name << " " << share;
      EXPECT_NEAR(decibels(found.rcs_m2), 0.0, 0.02) << name;
      EXPECT_EQ(found.instance, 1u) << name;
    }
}

TEST(RadarWaveforms, TwoTargetsAreTold) {
  for (const auto& [name, config] : all_radars(32, 1023)) {
    const RadarWaveform& w = config.waveform;
    Echo near = target(config, 12.0, 0.3, 0.1), far = target(config, 36.0, -0.45, -0.3);
    far.amplitude *= 6.0;
    far.instance = 2;
    const RadarFrame frame = frame_of(config, {whole_frame(config, {near, far})});
    for (const auto& [echo, range, share] : {std::tuple{near, 12.0, 0.3}, std::tuple{far, 36.0, -0.45}}) {
      const auto power_near = [&, range = range](const RadarDetection& d) {
        return std::abs(d.range_m - range) < 1.0 ? d.power_w : 0.0;
      };
      const auto found =
          std::max_element(frame.detections.begin(), frame.detections.end(),
                           [&](const auto& a, const auto& b) { return power_near(a) < power_near(b); });
      ASSERT_NE(found, frame.detections.end()) << name;
      // Sidelobes of the other target's code, and the code's lack of a line, move each a little.
      const bool code = w.modulation == RadarModulation::pmcw;
      EXPECT_NEAR(found->range_m, range, (code ? 0.02 : 0.01) * w.range_bin_m()) << name;
      EXPECT_NEAR(found->velocity_m_s, share * 0.5 * w.velocity_span_m_s(),
                  (code ? 0.02 : 0.01) * w.velocity_bin_m_s())
          << name;
      EXPECT_NEAR(dbm_of(found->power_w), dbm_of(power_of(config, echo)), code ? 0.2 : 0.01) << name;
      EXPECT_EQ(found->instance, echo.instance) << name;
    }
  }
}

TEST(RadarWaveforms, APlacedToneHasItsPowerInItsBin) {
  // All waveforms: rectangular windows, a target at rest in the middle of a range bin.
  for (auto [name, config] : all_radars(16)) {
    const RadarWaveform& w = config.waveform;
    if (w.modulation == RadarModulation::pmcw && w.code == RadarCode::apas) continue;
    config.processing.range_window = config.processing.doppler_window = RadarWindow::rectangular;
    const Echo echo = target(config, 10.0 * w.range_bin_m(), 0.0, 0.0);
    const RadarFrame frame = frame_of(config, {whole_frame(config, {echo})});
    EXPECT_EQ(testing::peak_of(frame.range_doppler), 10u * w.chirps() + w.chirps() / 2) << name;
    EXPECT_NEAR(dbm_of(frame.range_doppler[10u * w.chirps() + w.chirps() / 2]),
                dbm_of(power_of(config, echo)), 0.01)
        << name;
  }
}

TEST(RadarWaveforms, InterferenceBetweenCarriersIsThatOfTheory) {
  // A Doppler shift of e spacings leaves D^2 = (sin(pi e)/(N sin(pi e/N)))^2 of the power on each line; the
  // rest, 1 - D^2, is on the others (P. H. Moose, IEEE Trans. Commun. 42(10), 1994).
  RadarSignalConfig config = radar_of(testing::small_symbols(), 1, 1, 256);
  const RadarWaveform& w = config.waveform;
  for (const double e : {0.02, 0.1, 0.3, 0.8}) {
    const double rate = e / (w.sampled_s() * w.carrier_hz);
    Echo echo = point_echo(config, 20.0, 0.5 * speed_of_light * rate);
    echo.amplitude = 1.0;
    const RadarCube cube = cube_of_frame(config, whole_frame(config, {echo}));
    const RadarCube expected = testing::cube_of(config, whole_frame(config, {echo}));  // term 0 alone
    const double keeps = symbol_gain(w, e / w.sampled_s());
    EXPECT_NEAR(keeps, std::pow(std::sin(pi * e) / (64 * std::sin(pi * e / 64)), 2), 1e-12);
    double useful = 0.0, rest = 0.0;
    const double mean = std::sqrt(keeps);
    for (size_t i = 0; i < cube.size(); ++i) {
      // The phase of the whole symbol is that at its middle.
      const std::complex<double> on_line = mean * std::complex<double>(expected[i]);
      useful += std::norm(on_line);
      rest += std::norm(std::complex<double>(cube[i]) - on_line);
    }
    useful /= double(cube.size()) * config.transmit_power_w;
    rest /= double(cube.size()) * config.transmit_power_w;
    EXPECT_NEAR(useful, keeps, 1e-4);
    // 16,384 lines: their mean power is known to some per cent. The middle of the samples is half a sample
    // late, which turns the lines by pi e/N.
    EXPECT_NEAR(decibels(rest), decibels(1.0 - keeps), 0.2) << e;
  }
}

TEST(RadarWaveforms, EchoesBeyondThePrefixInterfereAsTheDirectSumSays) {
  for (const auto& [name, config] : all_radars(6)) {
    const RadarWaveform& w = config.waveform;
    if (!w.coded()) continue;
    EchoList list = whole_frame(config, {});
    // From just beyond the prefix to more than a symbol beyond it.
    for (const double beyond : {0.02, 0.3, 0.9, 1.7}) {
      const double delay_s = w.latest_delay_s() + beyond * w.sampled_s();
      Echo echo = point_echo(config, 0.5 * speed_of_light * delay_s, 20.0 * (beyond - 0.7), 0.4);
      echo.amplitude = std::polar(1.0, 7.0 * beyond);
      list.echoes.push_back(echo);
    }
    const RadarCube cube = cube_of_frame(config, list);
    const auto direct = coded_direct(config, list, {1, 2, 3});
    double worst = 0.0, power = 0.0;
    for (size_t i = 0; i < cube.size(); ++i) {
      worst = std::max(worst, std::abs(std::complex<double>(cube[i]) - direct[i]));
      power += std::norm(direct[i]) / double(cube.size());
    }
    EXPECT_LT(worst / std::sqrt(power), 1e-3) << name;
  }
}

TEST(RadarWaveforms, AnEchoBeyondThePrefixLosesWhatTheoryLoses) {
  // A share d of a symbol that belongs to the symbol before leaves (1 - d)^2 of the power on the lines, and
  // 1 - (1 - d)^2 is interference: d from the symbol before, d (1 - d) between the lines.
  RadarSignalConfig config = radar_of(testing::small_symbols(), 1, 1, 256);
  config.waveform.interval_s = config.waveform.chirp_s;  // no silence between symbols
  const RadarWaveform& w = config.waveform;
  for (const double d : {0.125, 0.5}) {
    Echo echo = point_echo(config, 0.5 * speed_of_light * (w.latest_delay_s() + d * w.sampled_s()), 0.0);
    echo.amplitude = 1.0;
    const RadarCube cube = cube_of_frame(config, whole_frame(config, {echo}));
    const RadarCube full = testing::cube_of(config, whole_frame(config, {echo}));
    std::complex<double> useful = 0.0;
    double all = 0.0;
    for (size_t i = w.samples; i < cube.size(); ++i) {  // there is no symbol before the first
      useful += std::complex<double>(cube[i]) * std::conj(std::complex<double>(full[i]));
      all += std::norm(std::complex<double>(cube[i]));
    }
    const double unit = double(cube.size() - w.samples) * config.transmit_power_w;
    EXPECT_NEAR(std::norm(useful / unit), (1 - d) * (1 - d), 0.03) << d;
    EXPECT_NEAR(all / unit, 1.0, 0.03) << d;
  }
}

TEST(RadarWaveforms, PatchesBeyondThePrefixAreWrongByTwiceTheShare) {
  RadarSignalConfig config = radar_of(testing::small_symbols(), 1, 1, 256);
  config.waveform.interval_s = config.waveform.chirp_s;
  const RadarWaveform& w = config.waveform;
  for (const int samples : {4, 13}) {
    const double d = samples / 64.0, beyond_s = (samples - 0.5) / w.sample_rate_hz;
    EchoList echo = whole_frame(config, {}), patch = echo;
    Echo one = point_echo(config, 0.5 * speed_of_light * (w.latest_delay_s() + beyond_s), 0.0);
    one.amplitude = 1.0;
    echo.echoes.push_back(one);
    PatchList& list = patch.patches;
    list.re = {1.0f}, list.im = {0.0f}, list.departure = {vec3(one.departure)}, list.instance = {1};
    list.delay_s = {one.delay.coefficients[0]}, list.rate = {0.0};
    const RadarCube exact = cube_of_frame(config, echo), wrong = cube_of_frame(config, patch);
    double power = 0.0;
    for (size_t i = w.samples; i < exact.size(); ++i)
      power += std::norm(std::complex<double>(exact[i]) - std::complex<double>(wrong[i]));
    EXPECT_NEAR(power / (double(exact.size() - w.samples) * config.transmit_power_w) / (2.0 * d), 1.0, 0.06)
        << d;
  }
}

TEST(RadarWaveforms, StepsAreNearlyTheMeanOfTheirIntegration) {
  // The fewest steps, integrated all the time, at v_max: the loss is (pi/2N)^2/6.
  const RadarSignalConfig config =
      radar_of(waveform_of(SteppedFrequency{77e9, 5e6, 1e-6, 0.0, 16, 0.0}), 1, 1, 8);
  const RadarWaveform& w = config.waveform;
  Echo echo = point_echo(config, 12.0, 0.5 * w.velocity_span_m_s());
  echo.amplitude = 1.0;
  const EchoList list = whole_frame(config, {echo});
  const RadarCube cube = cube_of_frame(config, list);
  double worst = 0.0;
  for (uint32_t slot = 0; slot < w.slots; ++slot)
    for (uint32_t n = 0; n < w.samples; ++n) {
      const double frequency = w.carrier_hz + (double(n) - w.middle_sample()) * 5e6;
      std::complex<double> mean = 0.0;
      constexpr int parts = 200;
      for (int i = 0; i < parts; ++i) {
        const double t = w.slot_start_s(slot) + (n + (i + 0.5) / parts) * 1e-6;
        const double delay_s = delay_at(list, echo.delay, w.interval_s, t).delay_s;
        mean += std::polar(1.0 / parts, 2.0 * pi * std::remainder(frequency * delay_s, 1.0));
      }
      const std::complex<double> sample(cube[size_t{slot} * w.samples + n]);
      worst = std::max(worst, std::abs(sample / std::sqrt(config.transmit_power_w) - mean));
    }
  EXPECT_LT(worst, 1.02 * std::pow(pi / 32.0, 2) / 6.0 + 2e-5);
  EXPECT_GT(worst, 0.9 * std::pow(pi / 32.0, 2) / 6.0);
}

TEST(RadarWaveforms, TooFastAnEchoIsRefused) {
  RadarSignalConfig config = radar_of(testing::small_symbols(), 1, 1, 16);
  const Echo echo = point_echo(config, 20.0, 0.51 * 1.1 / config.waveform.sampled_s() * 299792458.0 / 77e9);
  EXPECT_THROW(frame_of(config, {whole_frame(config, {echo})}), UserError);
}

TEST(RadarWaveforms, SteppedNoiseFollowsItsIntegration) {
  RadarSignalConfig config = radar_of(testing::small_steps(), 1, 1, 256);
  config.receiver.noise_figure_db = 10.0;
  const RadarCube cube = cube_of_frame(config, whole_frame(config, {}));
  double mean = 0.0;
  for (const auto& sample : cube) mean += std::norm(std::complex<double>(sample)) / double(cube.size());
  EXPECT_NEAR(decibels(mean), decibels(noise_power_w(1.0 / 0.5e-6, 10.0)), 0.15);
}

TEST(RadarWaveforms, BytesDoNotDependOnThreads) {
  for (auto [name, config] : all_radars(16)) {
    config.receiver.noise_figure_db = 10.0;
    if (config.waveform.averages == 1) config.receiver.adc.emplace();
    const EchoList list = some_echoes(config, 60.0);
    const std::vector<EchoList> lists{list};
    const std::vector<RadarAttitude> attitudes(1);
    const RadarProcessor processor("front", config, testing::isotropic, testing::isotropic);
    const RadarFrame one = processor.process({lists, attitudes, {}, {1, 2, 3}}, 1);
    const RadarFrame many = processor.process({lists, attitudes, {}, {1, 2, 3}}, 5);
    EXPECT_EQ(one.cube, many.cube) << name;
    EXPECT_EQ(one.range_doppler, many.range_doppler) << name;
    EXPECT_EQ(one.range_azimuth, many.range_azimuth) << name;
  }
}

TEST(RadarWaveforms, PatchesAreTheSumOfTheirEchoes) {
  for (const auto& [name, config] : all_radars(16)) {
    RandomStream random(3, 4);
    EchoList echoes = whole_frame(config, {}), patches = echoes;
    PatchList& list = patches.patches;
    double sum = 0.0;
    for (int i = 0; i < 40; ++i) {
      Echo echo =
          point_echo(config, random.uniform(2.0, 42.0), random.uniform(-0.2, 0.2), random.uniform(-0.5, 0.5));
      echo.amplitude = std::polar(random.uniform(0.1, 1.0), random.uniform(-pi, pi));
      // The range of a patch is the same for all antennas: leave the leads at the carrier alone.
      const PatchBlock block = patch_block(config.waveform, 0, config.waveform.slots, 1, 0);
      echo.delay.mid_s = block.middle_s;
      list.re.push_back(static_cast<float>(echo.amplitude.real()));
      list.im.push_back(static_cast<float>(echo.amplitude.imag()));
      list.departure.push_back(vec3(echo.departure));
      list.instance.push_back(1);
      list.delay_s.push_back(echo.delay.coefficients[0]);
      list.rate.push_back(echo.delay.coefficients[1]);
      sum += std::abs(echo.amplitude);
      echoes.echoes.push_back(echo);
    }
    const RadarCube a = cube_of_frame(config, echoes), b = cube_of_frame(config, patches);
    double worst = 0.0;
    for (size_t i = 0; i < a.size(); ++i) worst = std::max<double>(worst, std::abs(a[i] - b[i]));
    sum *= std::sqrt(config.transmit_power_w) * (config.waveform.bands() > 1 ? 2.0 : 1.0);
    EXPECT_LT(worst / sum, 5e-3) << name;
  }
}

}  // namespace
}  // namespace greatx::rf
