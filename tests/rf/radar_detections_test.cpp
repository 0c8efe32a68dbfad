// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/rf/radar_support.h"

namespace greatx::rf {
namespace {

using testing::frame_of;
using testing::point_echo;
using testing::set_row;
using testing::small_radar;
using testing::whole_frame;

/// Returns a radar with so little noise that the noise only fills the map.
RadarSignalConfig quiet_radar() {
  RadarSignalConfig config = small_radar();
  config.receiver.noise_figure_db = 0.0;
  config.transmit_power_w = 1e3;
  return config;
}

TEST(RadarDetections, AzimuthOfMovingTargetsByTheWholeTdmArray) {
  RadarSignalConfig config = quiet_radar();
  set_row(config, 2, 4);
  for (const double azimuth : {-50.0, -8.0, 0.0, 25.0})
    for (const double velocity : {-7.3, 0.0, 4.4}) {
      const auto frame =
          frame_of(config, {whole_frame(config, {point_echo(config, 25.0, velocity, radians(azimuth))})});
      ASSERT_EQ(frame.detections.size(), 1u);
      const RadarDetection& d = frame.detections[0];
      EXPECT_NEAR(degrees(d.azimuth), azimuth, 0.05);
      EXPECT_EQ(d.elevation, 0.0);
      EXPECT_NEAR(d.velocity_m_s, velocity, 0.01);
      EXPECT_NEAR(d.range_m, 25.0, 0.005);
      EXPECT_NEAR(d.rcs_m2, 1.0, 0.003);
      EXPECT_NEAR(glm::length(d.position_m - 25.0 * Direction{radians(azimuth), 0, 0}.unit()), 0.0, 0.05);
      EXPECT_EQ(d.instance, 1u);
    }
}

TEST(RadarDetections, ElevationByATransmitterAboveAnother) {
  RadarSignalConfig config = quiet_radar();
  set_row(config, 2, 4);
  const double half = 0.5 * config.waveform.wavelength_m();
  config.arrays.transmit_m = {{0, 0, 0}, {0, 0, half}};
  const auto frame =
      frame_of(config, {whole_frame(config, {point_echo(config, 25.0, 6.0, radians(15), radians(-12))})});
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_NEAR(degrees(frame.detections[0].azimuth), 15.0, 0.05);
  EXPECT_NEAR(degrees(frame.detections[0].elevation), -12.0, 0.05);
}

TEST(RadarDetections, OneAntennaTellsNoDirection) {
  RadarSignalConfig config = quiet_radar();
  set_row(config, 1, 1);
  const auto frame =
      frame_of(config, {whole_frame(config, {point_echo(config, 25.0, 6.0, radians(15), radians(-12))})});
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_EQ(frame.detections[0].azimuth, 0.0);
  EXPECT_EQ(frame.detections[0].elevation, 0.0);
}

TEST(RadarDetections, TurnedArraysSeeTheirOwnFrame) {
  const RadarSignalConfig config = quiet_radar();
  const std::vector<EchoList> lists{whole_frame(config, {point_echo(config, 25.0, 0.0, radians(30.0))})};
  const dquat turned = orientation_from_yaw_pitch_roll(radians(20.0), 0, 0);
  const std::vector<RadarAttitude> attitudes{{turned, turned}};
  const auto gain = [](const dvec3& u) { return u.x > 0 ? u.x * u.x : 0.0; };  // cos^2
  const auto frame = RadarProcessor("front", config, gain, gain).process({lists, attitudes, {}, {1, 2, 3}});
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_NEAR(degrees(frame.detections[0].azimuth), 10.0, 0.05);
  // The echo is that of isotropic elements. So the cross-section is overestimated by the loss of both
  // elements.
  EXPECT_NEAR(frame.detections[0].rcs_m2 * std::pow(std::cos(radians(10.0)), 4), 1.0, 0.003);
}

TEST(RadarDetections, TwoTargetsAreResolvedAndNamed) {
  RadarSignalConfig config = quiet_radar();
  // The strong target is among the training cells of the weak one. The mean of these cells would hide the
  // weak target, their order statistic does not.
  config.processing.cfar.kind = RadarCfar::Kind::ordered_statistic;
  const double bin = config.waveform.range_bin_m();
  std::vector<Echo> echoes{point_echo(config, 25 * bin, 0.0), point_echo(config, 25 * bin + 3 * bin, 0.0),
                           point_echo(config, 25 * bin, 5.0)};
  for (uint32_t i = 0; i < 3; ++i) echoes[i].instance = 11 + i;
  echoes[1].amplitude *= 0.3;
  echoes[2].delay.coefficients[0] -= 2 / speed_of_light * config.waveform.carrier_hz /
                                     config.waveform.slope_hz_per_s * 5.0;  // the same range bin
  const auto frame = frame_of(config, {whole_frame(config, echoes)});
  ASSERT_EQ(frame.detections.size(), 3u);
  EXPECT_EQ(frame.detections[0].instance, 11u);
  EXPECT_EQ(frame.detections[1].instance, 13u);
  EXPECT_EQ(frame.detections[2].instance, 12u);
  EXPECT_NEAR(frame.detections[2].range_m - frame.detections[0].range_m, 3 * bin, 0.05 * bin);
}

TEST(RadarDetections, WhatNoEchoExplainsHasNoInstance) {
  RadarSignalConfig config = quiet_radar();
  config.processing.cfar.false_alarm = 0.02;
  const auto frame = frame_of(config, {});
  ASSERT_GT(frame.detections.size(), 3u);
  for (const RadarDetection& d : frame.detections) EXPECT_EQ(d.instance, 0u);
  // An echo far below the noise is not assigned to detections of noise.
  Echo weak = point_echo(
      config, frame.detections[0].range_m + config.waveform.carrier_hz / config.waveform.slope_hz_per_s * 0,
      0.0);
  weak.amplitude = 1e-13;
  for (const RadarDetection& d : frame_of(config, {whole_frame(config, {weak})}).detections)
    EXPECT_EQ(d.instance, 0u);
}

TEST(RadarDetections, SidelobesOfAStrongTargetAreNotDetections) {
  RadarSignalConfig config = quiet_radar();
  config.processing.range_window = config.processing.doppler_window = RadarWindow::rectangular;
  config.processing.cfar.train_range = 3;
  const auto frame = frame_of(config, {whole_frame(config, {point_echo(config, 25.04, 3.3)})});
  EXPECT_EQ(frame.detections.size(), 1u);
  EXPECT_GT(frame.report.sidelobes, 0u);
}

TEST(RadarDetections, BistaticPlacesTheTargetOnTheEllipsoid) {
  RadarSignalConfig config = quiet_radar();
  set_row(config, 1, 8);
  config.bistatic = true;
  const dvec3 baseline(0, 12, 0), target(30, 5, 0);
  const double out = glm::length(target - baseline), back = glm::length(target), way = out + back;
  Echo echo = point_echo(config, 0.5 * way, 0.0);
  echo.amplitude =
      config.waveform.wavelength_m() * std::sqrt(2.0 / std::pow(4 * pi, 3)) / (out * back);  // 2 m^2
  echo.departure = (target - baseline) / out;
  echo.arrival = target / back;
  const std::vector<EchoList> lists{whole_frame(config, {echo})};
  const std::vector<RadarAttitude> attitudes(1);
  const auto frame = RadarProcessor("pair", config, testing::isotropic, testing::isotropic)
                         .process({lists, attitudes, baseline, {1, 2, 3}});
  ASSERT_EQ(frame.detections.size(), 1u);
  const RadarDetection& d = frame.detections[0];
  EXPECT_NEAR(d.range_m, 0.5 * way, 0.01);
  EXPECT_NEAR(glm::length(d.position_m - target), 0.0, 0.05);
  EXPECT_NEAR(d.rcs_m2, 2.0, 0.02);
}

TEST(RadarDetections, EchoesByTablesNameTheirDopplerBins) {
  RadarSignalConfig config = quiet_radar();
  set_row(config, 1, 1);
  EchoList list = whole_frame(config, {});
  Echo echo = point_echo(config, 25.0, 0.0);
  echo.delay = {};
  echo.delay.table = 0;
  echo.instance = 9;
  list.echoes.push_back(echo);
  for (uint32_t s = 0; s < list.slots; ++s) {
    const double angle = 2 * pi * 500 * s * config.waveform.interval_s;
    list.tables.push_back({2 / speed_of_light * (25 + 0.003 * std::sin(angle)),
                           2 / speed_of_light * 0.003 * 2 * pi * 500 * std::cos(angle)});
  }
  const auto frame = frame_of(config, {list});
  ASSERT_GE(frame.detections.size(), 2u);
  for (const RadarDetection& d : frame.detections) EXPECT_EQ(d.instance, 9u);
}

}  // namespace
}  // namespace greatx::rf
