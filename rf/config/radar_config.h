// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a radar is: its waveform, its elements, its receiver and what is made of the signal. Plain data;
// docs/radar.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/units.h"
#include "core/vec.h"

namespace greatx::rf {

/// A train of equal linear ramps (frequency-modulated continuous wave), one transmitter at a time.
///
/// Slot s is the s-th ramp of a frame; transmitter s % transmitters sends it, as chirp s / transmitters of
/// its own (TDM). A frame begins at the start of the first ramp. Sample n of slot s is taken at
///   t = s interval_s + adc_start_s + n / sample_rate_hz,
/// and the ramp passes `carrier_hz` at sample samples/2 (rounded down), the middle of what is sampled: f_c of
/// every formula, and of every wavelength.
struct RadarWaveform {
  double carrier_hz = 77e9;
  double slope_hz_per_s = 20e12;  ///< S
  double chirp_s = 50e-6;         ///< how long a ramp lasts
  double interval_s = 60e-6;      ///< T_c, from one ramp's start to the next one's
  double adc_start_s = 5e-6;      ///< from a ramp's start to its first sample
  double sample_rate_hz = 6e6;    ///< complex samples (I and Q)
  uint32_t samples = 256;         ///< N, of a chirp
  uint32_t slots = 512;           ///< ramps of a frame, of all transmitters
  uint32_t transmitters = 4;

  double wavelength_m() const { return speed_of_light / carrier_hz; }
  uint32_t chirps() const { return slots / transmitters; }              ///< M, of each transmitter
  uint32_t middle_sample() const { return samples / 2; }                ///< where the ramp passes carrier_hz
  double sampled_s() const { return samples / sample_rate_hz; }         ///< N/f_s
  double bandwidth_hz() const { return slope_hz_per_s * sampled_s(); }  ///< B, of what is sampled
  /// c/2B: distance of two ranges whose tones differ by one turn over the samples.
  double range_bin_m() const { return speed_of_light / (2.0 * bandwidth_hz()); }
  /// N c/2B = f_s c/2S: ranges are known up to multiples of it. R_max, for samples are complex.
  double range_span_m() const { return samples * range_bin_m(); }
  /// Time from one chirp of a transmitter to its next.
  double repetition_s() const { return transmitters * interval_s; }
  /// lambda/(2 M T), T = repetition_s().
  double velocity_bin_m_s() const { return wavelength_m() / (2.0 * chirps() * repetition_s()); }
  /// lambda/(2 T): velocities are known up to multiples of it; what is shown lies in [-v_max, v_max), v_max
  /// half of it.
  double velocity_span_m_s() const { return wavelength_m() / (2.0 * repetition_s()); }
  double slot_start_s(uint32_t slot) const { return slot * interval_s; }
  /// Time of the sample at which slot's ramp passes carrier_hz.
  double slot_middle_s(uint32_t slot) const {
    return slot_start_s(slot) + adc_start_s + middle_sample() / sample_rate_hz;
  }
  /// Time halfway through the slots' middles: what a detection's range refers to.
  double frame_middle_s() const { return 0.5 * (slot_middle_s(0) + slot_middle_s(slots - 1)); }
};

/// Positions of the elements' phase centres, metres, in the frame of their array: x forward, y left, z up.
struct RadarArrays {
  std::vector<dvec3> transmit_m{dvec3(0.0)};  ///< [transmitters]
  std::vector<dvec3> receive_m{dvec3(0.0)};   ///< [receivers]
};

/// Phase noise of the one oscillator that makes the ramp and mixes the echo: a stationary Gaussian phase
/// whose spectrum is L(f) = L_0/(1 + (f/f_p)^2), dBc/Hz on each side: the pole of IEEE 802.11-09/0296r16,
/// "TGad Evaluation Methodology", 4.4 (there L_0 = -90 dBc/Hz, f_p = 1 MHz, and a zero at 100 MHz, far beyond
/// a radar's samples, which is left out).
struct PhaseNoise {
  double level_dbc_hz = -90.0;  ///< L_0
  double pole_hz = 1e6;         ///< f_p
};

/// Equal steps for I and Q alike.
struct AnalogToDigital {
  uint32_t bits = 12;           ///< of I and of Q, sign included
  double full_scale_dbm = -30;  ///< power at the receiver's port of a complex tone that just fills both
};

/// Each imperfection is off unless it is there.
struct RadarReceiver {
  std::optional<double>
      noise_figure_db;  ///< F; noise power k T_0 f_s F of every complex sample, T_0 = 290 K (IEEE)
  std::optional<PhaseNoise> phase_noise;
  std::optional<AnalogToDigital> adc;
};

enum class RadarWindow : uint32_t { rectangular, hann, hamming, blackman, taylor };

/// Constant false-alarm rate detection on the range-Doppler map.
struct RadarCfar {
  enum class Kind : uint32_t { cell_averaging, ordered_statistic };
  Kind kind = Kind::cell_averaging;
  double false_alarm = 1e-6;                    ///< probability per cell
  uint32_t guard_range = 2, guard_doppler = 2;  ///< cells on each side that tell nothing of the noise
  uint32_t train_range = 6, train_doppler = 4;  ///< cells on each side, beyond those, that do
  double rank = 0.75;  ///< of ordered_statistic: which one, as a share of the training cells
};

struct RadarProcessing {
  RadarWindow range_window = RadarWindow::hann, doppler_window = RadarWindow::hann;
  uint32_t azimuths = 181;               ///< of the range-azimuth map
  double azimuth_limit = radians(90.0);  ///< rad: the map's azimuths go from -limit to +limit in equal steps
  RadarCfar cfar;
  /// What is made; a detection needs neither map to be kept.
  bool range_doppler = true, range_azimuth = true, detections = true;
};

/// All that the signal needs to know of a radar.
struct RadarSignalConfig {
  RadarWaveform waveform;
  RadarArrays arrays;
  double transmit_power_w = 0.0158489319246111;  ///< 12 dBm, of the one transmitter that sends
  bool bistatic = false;  ///< transmitter and receiver at different places: angles are those of arrival
  RadarReceiver receiver;
  RadarProcessing processing;
};

/// What is wrong with a configuration: for the scenario's parser to say where.
struct RadarFault {
  std::string field;    ///< member of RadarSignalConfig, such as "waveform.chirp_s"
  std::string message;  ///< what was expected and what was found
};

/// The first fault, if there is one. What passes has all derived figures finite and positive.
std::optional<RadarFault> check(const RadarSignalConfig& config);

}  // namespace greatx::rf
