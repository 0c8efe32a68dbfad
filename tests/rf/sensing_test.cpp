// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests of OFDM sensing with tones made by hand.
#include <cmath>
#include <cstring>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "tests/rf/sensing_points.h"

namespace greatx::rf {
namespace {

using ::testing::HasSubstr;
using namespace test;

TEST(OfdmSensing, APointIsWhereItIs) {
  const SensingArrays one;
  const OfdmSensing sensing("csi", noisy(), waveform, one);
  for (const auto& [range, velocity] :
       {std::pair{100.0, 12.0}, {33.3, -7.7}, {512.25, 15.0}, {250.0, -19.0}}) {
    const Point point{range, velocity, 1e-9};
    const SensingFrame frame = frame_of(sensing, one, std::span(&point, 1));
    ASSERT_EQ(frame.detections.size(), 1u) << range;
    const SensingDetection& d = frame.detections[0];
    EXPECT_NEAR(d.range_m, range, 0.01 * waveform.range_bin_m());
    EXPECT_NEAR(d.velocity_m_s, velocity, 0.01 * waveform.velocity_bin_m_s());
    EXPECT_NEAR(d.power_w / (2.0 * 1e-9), 1.0, 0.01);
    EXPECT_EQ(d.instance, 1u);
    EXPECT_NEAR(d.position_m.x, range, 0.01 * waveform.range_bin_m());
  }
}

TEST(OfdmSensing, TheRatioOfACellIsThatOfTheFormula) {
  const SensingArrays eight{{dvec3(0.0)}, std::vector<dvec3>(8, dvec3(0.0)), 1, 1, false};
  const OfdmSensing sensing("csi", noisy(), waveform, eight);
  // In the middle of a cell, and so weak that the sidelobes do not count as noise.
  const double gain = 100.0 / sensing.cell_snr(1.0);
  const Point point{100.0 * waveform.range_bin_m(), 10.0 * waveform.velocity_bin_m_s(), gain};
  const SensingFrame frame = frame_of(sensing, eight, std::span(&point, 1));
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_NEAR(10.0 * std::log10(frame.detections[0].snr), 20.0, 1.0);
  EXPECT_NEAR(frame.detections[0].range_m, point.range_m, 0.1 * waveform.range_bin_m());
  EXPECT_NEAR(frame.detections[0].velocity_m_s, point.velocity_m_s, 0.1 * waveform.velocity_bin_m_s());
}

TEST(OfdmSensing, NoiseHasItsPower) {
  const SensingArrays four{{dvec3(0.0)}, std::vector<dvec3>(4, dvec3(0.0)), 1, 1, false};
  SensingConfig config = noisy(6.0);
  config.remove_static = false;
  const OfdmSensing sensing("csi", config, waveform, four);
  const SensingFrame frame = frame_of(sensing, four, {});
  double mean = 0.0;
  for (const float power : frame.range_doppler) mean += power;
  mean /= double(frame.range_doppler.size());
  const double expected = 1.380649e-23 * 290.0 * waveform.bandwidth_hz() * std::pow(10.0, 0.6) * 1.5 * 1.5 /
                          (waveform.subcarriers * double(waveform.symbols));
  EXPECT_NEAR(mean / expected, 1.0, 0.02);
  EXPECT_LE(frame.detections.size(), 1u);  // 24576 cells at 1e-6
}

TEST(OfdmSensing, TheStaticMeanTakesWhatStandsStill) {
  const SensingArrays one;
  const std::vector<Point> points{{60.0, 0.0, 1e-4, 0}, {120.0, 9.0, 1e-11, 3}};
  const auto instances = [&](bool remove) {
    SensingConfig config = noisy();
    config.remove_static = remove;
    const SensingFrame frame = frame_of(OfdmSensing("csi", config, waveform, one), one, points);
    std::vector<std::pair<long, uint32_t>> found;
    for (const SensingDetection& d : frame.detections) found.emplace_back(std::lround(d.range_m), d.instance);
    return found;
  };
  EXPECT_THAT(instances(true), ::testing::ElementsAre(std::pair(120l, 3u)));
  EXPECT_THAT(instances(false), ::testing::Contains(std::pair(60l, 0u)));
}

/// The notch at rest is no lack of noise: there are no more false alarms beside it than elsewhere.
TEST(OfdmSensing, FalseAlarmsAreAsRareBesideTheNotch) {
  const SensingArrays many{{dvec3(0.0)}, std::vector<dvec3>(16, dvec3(0.0)), 1, 1, false};
  for (const RadarWindow window : {RadarWindow::hann, RadarWindow::rectangular, RadarWindow::taylor}) {
    SensingConfig config = noisy();
    config.doppler_window = window;
    config.cfar.false_alarm = 1e-4;
    const OfdmSensing sensing("csi", config, waveform, many);
    const std::vector<std::complex<float>> silence(16 * size_t{waveform.subcarriers} * waveform.symbols);
    size_t near = 0, all = 0;
    constexpr int bursts = 12;
    for (uint32_t burst = 0; burst < bursts; ++burst)
      for (const SensingDetection& d :
           sensing.process({silence, {}, {7, 21, burst}, {}, dvec3(0.0)}).detections) {
        ++all;
        near += std::abs(doppler_turns(d.velocity_bin, waveform.symbols)) <= 6;
      }
    // 24576 cells each; a cell of three that exceed the threshold side by side is one detection.
    EXPECT_LT(all, 24576 * bursts * 1e-4 * 1.3);
    EXPECT_GT(all, 24576 * bursts * 1e-4 * 0.2);
    EXPECT_LT(double(near), std::max(8.0, 2.0 * double(all) * 13.0 / 64.0));
  }
}

TEST(OfdmSensing, LeakageIsAToneAtItsDelay) {
  const SensingArrays one;
  SensingConfig config = noisy();
  config.leakage_db = -60.0;
  config.leakage_delay_s = 40e-9;
  config.remove_static = false;
  const SensingFrame frame = frame_of(OfdmSensing("csi", config, waveform, one), one, {});
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_NEAR(frame.detections[0].range_m, 0.5 * speed_of_light * 40e-9, 0.02);
  EXPECT_NEAR(frame.detections[0].power_w, 2e-6, 2e-8);
  EXPECT_NEAR(frame.detections[0].velocity_m_s, 0.0, 0.01);
  EXPECT_EQ(frame.detections[0].instance, 0u);
  config.remove_static = true;
  EXPECT_TRUE(frame_of(OfdmSensing("csi", config, waveform, one), one, {}).detections.empty());
}

TEST(OfdmSensing, TheConverterAddsNoiseOfItsStepsAndSaturates) {
  const SensingArrays one;
  const std::vector<Point> points{{100.0, 5.0, 1e-6, 1}};
  SensingConfig config = quiet();
  config.remove_static = false;
  config.adc = AnalogToDigital{8, -10.0};
  const SensingFrame coarse = frame_of(OfdmSensing("csi", config, waveform, one), one, points);
  EXPECT_EQ(coarse.saturated_samples, 0u);
  // I and Q have noise of step^2/12 each, with 2^8 steps over twice the full scale.
  const double step = std::sqrt(1e-3 * std::pow(10.0, -1.0)) / 128.0;
  std::vector<float> map = coarse.range_doppler;
  std::nth_element(map.begin(), map.begin() + map.size() / 2, map.end());
  const double mean = map[map.size() / 2] / std::log(2.0);  // of an exponential distribution
  const double expected = step * step / 6.0 * 1.5 * 1.5 / (waveform.subcarriers * double(waveform.symbols));
  EXPECT_NEAR(10.0 * std::log10(mean / expected), 0.0, 0.5);
  config.adc->full_scale_dbm = -60.0;
  EXPECT_GT(frame_of(OfdmSensing("csi", config, waveform, one), one, points).saturated_samples, 1000u);
}

TEST(OfdmSensing, AnArrayFindsTheDirection) {
  SensingArrays panel;
  panel.receive_m.clear();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      panel.receive_m.push_back(0.5 * waveform.wavelength_m() * dvec3(0.0, column - 1.5, row - 1.5));
  for (const bool monostatic : {true, false}) {
    panel.monostatic = monostatic;
    const double azimuth = 0.4, elevation = -0.25;
    const Point point{80.0,
                      6.0,
                      1e-10,
                      2,
                      {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
                       std::sin(elevation)}};
    const SensingFrame frame =
        frame_of(OfdmSensing("csi", noisy(), waveform, panel), panel, std::span(&point, 1));
    ASSERT_EQ(frame.detections.size(), 1u);
    EXPECT_NEAR(frame.detections[0].azimuth, azimuth, 2e-3);
    EXPECT_NEAR(frame.detections[0].elevation, elevation, 2e-3);
    EXPECT_LT(glm::distance(frame.detections[0].position_m, 80.0 * point.direction), 0.25);
  }
}

TEST(OfdmSensing, ADetectionBelongsToTheTargetWithThePower) {
  const SensingArrays one;
  const std::vector<Point> points{{100.0, 8.0, 1e-10, 4}, {140.0, -8.0, 4e-11, 9}};
  const SensingFrame frame = frame_of(OfdmSensing("csi", noisy(), waveform, one), one, points);
  ASSERT_EQ(frame.detections.size(), 2u);
  EXPECT_EQ(frame.detections[0].instance, 4u);
  EXPECT_EQ(frame.detections[1].instance, 9u);
}

/// Ranges and velocities beyond the waveform's spans come back from the other side.
TEST(OfdmSensing, SpansWrap) {
  const SensingArrays one;
  const OfdmSensing sensing("csi", noisy(), waveform, one);
  const Point point{waveform.range_span_m() + 70.0, waveform.velocity_span_m_s() + 3.0, 1e-9};
  const SensingFrame frame = frame_of(sensing, one, std::span(&point, 1));
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_NEAR(frame.detections[0].range_m, 70.0, 0.05);
  EXPECT_NEAR(frame.detections[0].velocity_m_s, 3.0, 0.05);
}

TEST(OfdmSensing, ThreadsChangeNoByte) {
  const SensingArrays two{{dvec3(0.0)}, {dvec3(0, -0.003, 0), dvec3(0, 0.003, 0)}, 1, 1, true};
  SensingConfig config = noisy();
  config.adc = AnalogToDigital{10, -40.0};
  config.leakage_db = -70.0;
  config.range_azimuth = true;
  const OfdmSensing sensing("csi", config, waveform, two);
  const std::vector<Point> points{{100.0, 8.0, 1e-10, 4}, {140.0, -8.0, 4e-11, 9}};
  const SensingFrame a = frame_of(sensing, two, points, 1), b = frame_of(sensing, two, points, 3);
  ASSERT_EQ(a.range_doppler.size(), b.range_doppler.size());
  EXPECT_EQ(std::memcmp(a.range_doppler.data(), b.range_doppler.data(), a.range_doppler.size() * 4), 0);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  EXPECT_EQ(a.detections[0].range_m, b.detections[0].range_m);
  ASSERT_EQ(a.range_azimuth.size(), waveform.subcarriers * size_t{181});
  EXPECT_EQ(std::memcmp(a.range_azimuth.data(), b.range_azimuth.data(), a.range_azimuth.size() * 4), 0);
}

TEST(OfdmSensing, BadInputIsRefused) {
  const auto message = [](const SensingConfig& config, const SensingWaveform& w,
                          const SensingArrays& arrays) {
    try {
      const OfdmSensing sensing("csi", config, w, arrays);
    } catch (const UserError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  SensingWaveform few = waveform;
  few.symbols = 8;
  EXPECT_THAT(message(quiet(), few, {}), HasSubstr("time_samples"));
  few = waveform;
  few.subcarriers = 8;
  EXPECT_THAT(message(quiet(), few, {}), HasSubstr("subcarriers"));
  SensingArrays many;
  many.receive_m.assign(64, dvec3(0.0));
  many.transmit_m.assign(64, dvec3(0.0));
  EXPECT_THAT(message(quiet(), waveform, many), HasSubstr("found 4096"));
  SensingConfig beams = quiet();
  beams.range_azimuth = true;
  EXPECT_THAT(message(beams, waveform, {}),
              HasSubstr("channel 'csi': sensing.outputs: range_azimuth: expected elements that measure an "
                        "azimuth, at least 0.05 wavelengths apart along y, found 0"));
  SensingArrays column;
  column.receive_m = {dvec3(0, 0, 0), dvec3(0, 0, 0.01)};
  EXPECT_THAT(message(beams, waveform, column), HasSubstr("range_azimuth"));
  // Two ends: the elements of the transmitter measure no angle of arrival.
  SensingArrays apart;
  apart.transmit_m = {dvec3(0, 0, 0), dvec3(0, 0.01, 0)};
  EXPECT_EQ(message(beams, waveform, apart), "");
  apart.monostatic = false;
  EXPECT_THAT(message(beams, waveform, apart), HasSubstr("range_azimuth"));
}

}  // namespace
}  // namespace greatx::rf
