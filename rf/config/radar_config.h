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

namespace greatx::rf {

/// Describes a train of equal linear ramps (frequency-modulated continuous wave). One transmitter sends at a
/// time.
///
/// Slot s is the s-th ramp of a frame. Transmitter s % transmitters sends it as its own chirp s /
/// transmitters (TDM). A frame begins at the start of the first ramp. Sample n of slot s is taken at
///   t = s interval_s + adc_start_s + n / sample_rate_hz.
/// The ramp passes `carrier_hz` at sample samples/2 (rounded down), the middle of the samples. This frequency
/// is f_c in every formula and gives every wavelength.
struct RadarWaveform {
  double carrier_hz = 77e9;
  double slope_hz_per_s = 20e12;  ///< S
  double chirp_s = 50e-6;         ///< duration of a ramp
  double interval_s = 60e-6;      ///< T_c, from the start of one ramp to the start of the next
  double adc_start_s = 5e-6;      ///< from the start of a ramp to its first sample
  double sample_rate_hz = 6e6;    ///< rate of complex samples (I and Q)
  uint32_t samples = 256;         ///< N, samples of a chirp
  uint32_t slots = 512;           ///< ramps of a frame, of all transmitters
  uint32_t transmitters = 4;

  double wavelength_m() const { return speed_of_light / carrier_hz; }
  uint32_t chirps() const { return slots / transmitters; }              ///< M, of each transmitter
  uint32_t middle_sample() const { return samples / 2; }                ///< where the ramp passes carrier_hz
  double sampled_s() const { return samples / sample_rate_hz; }         ///< N/f_s
  double bandwidth_hz() const { return slope_hz_per_s * sampled_s(); }  ///< B, of the sampled part
  /// Returns c/2B: the distance of two ranges whose tones differ by one turn over the samples.
  double range_bin_m() const { return speed_of_light / (2.0 * bandwidth_hz()); }
  /// Returns N c/2B = f_s c/2S, which is R_max because samples are complex. Ranges are known up to multiples
  /// of it.
  double range_span_m() const { return samples * range_bin_m(); }
  /// Returns the time T from one chirp of a transmitter to its next.
  double repetition_s() const { return transmitters * interval_s; }
  /// Returns lambda/(2 M T), T = repetition_s().
  double velocity_bin_m_s() const { return wavelength_m() / (2.0 * chirps() * repetition_s()); }
  /// Returns lambda/(2 T). Velocities are known up to multiples of it. Outputs lie in [-v_max, v_max) with
  /// v_max half of it.
  double velocity_span_m_s() const { return wavelength_m() / (2.0 * repetition_s()); }
  double slot_start_s(uint32_t slot) const { return slot * interval_s; }
  /// Returns the time of the sample at which the ramp of `slot` passes carrier_hz.
  double slot_middle_s(uint32_t slot) const {
    return slot_start_s(slot) + adc_start_s + middle_sample() / sample_rate_hz;
  }
  /// Returns the time halfway between the first and the last slot's middle, to which a detection's range
  /// refers.
  double frame_middle_s() const { return 0.5 * (slot_middle_s(0) + slot_middle_s(slots - 1)); }
};

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

/// Describes a receiver. An imperfection is on if its member has a value.
struct RadarReceiver {
  /// F. Every complex sample has the noise power k T_0 f_s F, T_0 = 290 K (IEEE).
  std::optional<double> noise_figure_db;
  std::optional<PhaseNoise> phase_noise;
  std::optional<AnalogToDigital> adc;
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
  double transmit_power_w = 0.0158489319246111;  ///< 12 dBm, of the one transmitter that sends
  /// Transmitter and receiver are at different places, and angles are those of arrival.
  bool bistatic = false;
  RadarReceiver receiver;
  RadarProcessing processing;
};

/// Describes a fault of a configuration; the scenario's parser adds the location.
struct RadarFault {
  std::string field;    ///< member of RadarSignalConfig, such as "waveform.chirp_s"
  std::string message;  ///< the expected value and the found value
};

/// Returns the first fault, if there is one. All derived figures of a configuration without fault are finite
/// and positive.
std::optional<RadarFault> check(const RadarSignalConfig& config);

}  // namespace greatx::rf
