// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes how a channel senses with the symbols of its own multicarrier waveform (docs/sensing.md). Plain
// data.
#pragma once

#include <cstdint>
#include <optional>

#include "rf/config/radar_config.h"

namespace greatx::rf {

struct SensingConfig {
  /// Power of each transmit port over the whole band, W. The ports are orthogonal: each is received without
  /// the others.
  double power_w = 1.0;
  /// F. Without it there is no noise.
  std::optional<double> noise_figure_db;
  std::optional<AnalogToDigital> adc;
  /// Self-interference: power that each receive port takes from each transmit port without the scene, dB of
  /// the transmitted power. Without it there is none.
  std::optional<double> leakage_db;
  double leakage_delay_s = 0.0;
  /// Removes the mean over the symbols (weighted by their window) at every subcarrier, and with it everything
  /// that stands still.
  bool remove_static = true;
  RadarWindow range_window = RadarWindow::hann, doppler_window = RadarWindow::hann;
  RadarCfar cfar;
  uint32_t azimuths = 181;               ///< azimuths of the range-azimuth map
  double azimuth_limit = radians(90.0);  ///< they go from -limit to +limit in equal steps, rad
  bool range_doppler = true, range_azimuth = false, detections = true;
};

}  // namespace greatx::rf
