// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a radar: its waveform, its elements, its receiver and the processing of its signal
// (docs/radar.md). Plain data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "core/vec.h"
#include "rf/config/radar_waveform.h"

namespace greatx::rf {

/// Holds the positions of the elements' phase centres, metres, in the frame of their array: x forward, y
/// left, z up.
struct RadarArrays {
  std::vector<dvec3> transmit_m{dvec3(0.0)};  ///< [transmitters]
  std::vector<dvec3> receive_m{dvec3(0.0)};   ///< [receivers]
};

/// Describes the phase noise of the one oscillator that makes the ramp and mixes the echo. It is a stationary
/// Gaussian phase with the spectrum L(f) = L_0/(1 + (f/f_p)^2), dBc/Hz on each side: the pole of IEEE
/// 802.11-09/0296r16, "TGad Evaluation Methodology", 4.4. That model has L_0 = -90 dBc/Hz and f_p = 1 MHz.
/// Its zero at 100 MHz is left out, because it is far beyond a radar's samples.
struct PhaseNoise {
  double level_dbc_hz = -90.0;  ///< L_0
  double pole_hz = 1e6;         ///< f_p
};

/// Describes a converter with equal steps for I and Q.
struct AnalogToDigital {
  uint32_t bits = 12;  ///< of I and of Q, sign included
  /// Power at the receiver's port of a complex tone that just fills I and Q.
  double full_scale_dbm = -30;
};

/// Describes what each receiver takes from each transmitter without the scene. It is an echo at rest whose
/// delay and phase are the same for all pairs of elements.
struct RadarLeakage {
  double level_db = -40.0;  ///< relative to the power of the transmitter
  double length_m = 0.0;    ///< the whole way, at the speed of light
};

/// Describes a receiver. An imperfection is on if its member has a value.
struct RadarReceiver {
  /// F. Every complex sample has the noise power k T_0 B_n F, T_0 = 290 K (IEEE), with the bandwidth B_n =
  /// RadarWaveform::noise_bandwidth_hz(): the sample rate f_s for ramps.
  std::optional<double> noise_figure_db;
  std::optional<PhaseNoise> phase_noise;
  std::optional<AnalogToDigital> adc;
  std::optional<RadarLeakage> leakage;
};

enum class RadarWindow : uint32_t { rectangular, hann, hamming, blackman, taylor };

/// Describes constant false-alarm rate detection on the range-Doppler map.
struct RadarCfar {
  enum class Kind : uint32_t { cell_averaging, ordered_statistic };
  Kind kind = Kind::cell_averaging;
  double false_alarm = 1e-6;                    ///< probability per cell
  uint32_t guard_range = 2, guard_doppler = 2;  ///< guard cells on each side; the noise estimate skips them
  uint32_t train_range = 6, train_doppler = 4;  ///< training cells on each side, beyond the guard cells
  double rank = 0.75;  ///< rank of ordered_statistic, as a share of the training cells
};

struct RadarProcessing {
  RadarWindow range_window = RadarWindow::hann, doppler_window = RadarWindow::hann;
  uint32_t azimuths = 181;  ///< azimuths of the range-azimuth map
  /// The map's azimuths go from -limit to +limit in equal steps, rad.
  double azimuth_limit = radians(90.0);
  RadarCfar cfar;
  /// Outputs that are kept. Detections do not need the maps to be kept.
  bool range_doppler = true, range_azimuth = true, detections = true;
};

/// Holds all properties of a radar that its signal depends on.
struct RadarSignalConfig {
  RadarWaveform waveform;
  RadarArrays arrays;
  double transmit_power_w = 0.0158489319246111;  ///< 12 dBm, of each transmitter while it sends
  /// Transmitter and receiver are at different places, and angles are those of arrival.
  bool bistatic = false;
  RadarReceiver receiver;
  RadarProcessing processing;
};

/// Describes a fault of a configuration; the scenario's parser adds the location.
struct RadarFault {
  /// Member of RadarSignalConfig, such as "waveform.chirp_s", or of the scenario that it follows from.
  std::string field;
  std::string message;  ///< the expected value and the found value
};

/// Returns the first fault, if there is one. All derived figures of a configuration without fault are finite
/// and positive.
std::optional<RadarFault> check(const RadarSignalConfig& config);

}  // namespace greatx::rf
