// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Models the receiver's thermal noise, digitization and phase noise in the beat signal. Every random draw is
// a function of (seed, stream, sequence, purpose).
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"

namespace greatx::rf {

/// Holds the seeds of one frame.
struct RadarSeeds {
  uint64_t seed = 0;      ///< seed of the scenario
  uint32_t stream = 0;    ///< number of the sensor's stream
  uint32_t sequence = 0;  ///< number of the frame
};

/// Selects the purpose of a draw: the fourth word of the counter.
enum class RadarDraw : uint32_t {
  thermal = 0x72640000u,
  walk = 0x73000000u,
  bridge = 0x74000000u,
  symbols = 0x75000000u
};

/// Fills `out` with complex normal numbers of variance 1 (1/2 in each part). out[i] is draw `first` + i of
/// (seeds, purpose + part). The numbers are the Box-Muller transform of Philox words. Their radius ends at
/// 5.9 standard deviations of a part. `first` must be even.
void complex_normals(const RadarSeeds& seeds, RadarDraw purpose, uint32_t part, uint32_t first,
                     std::span<std::complex<float>> out);

/// Returns k T_0 B F, W: the noise power of a complex sample, as a power at the port of the receiver.
double noise_power_w(double bandwidth_hz, double noise_figure_db);

/// Returns the ratio of received to transmitted power below which noise hides an echo: its power is a
/// hundredth of the mean power of the noise when all samples and antennas of a frame are added up in phase.
/// Returns 0 without noise.
double hidden_ratio(const RadarSignalConfig& config);
/// Returns the radar cross-section, m^2, below which noise hides an echo, for a body 1 m away from both ends
/// and elements with the given gains. All samples and antennas of a frame are added up in phase; the echo of
/// this body is then a hundredth of the mean power of the noise. The cross-section grows with the square of
/// the distance to each end. Returns 0 without noise.
double hidden_section_m2(const RadarSignalConfig& config, double transmit_gain, double receive_gain);

/// Adds noise of `power_w` to each sample. The bytes do not depend on the number of threads.
void add_noise(const RadarSeeds& seeds, double power_w, uint32_t threads,
               std::span<std::complex<float>> cube);

/// Rounds I and Q to the middle of their quantization steps and clips them at full scale. Returns the number
/// of clipped samples.
uint64_t digitize(const AnalogToDigital& adc, uint32_t threads, std::span<std::complex<float>> cube);

/// Models the phase of the oscillator over a frame.
///
/// The echo returns tau later, so that the beat signal contains phi(t) - phi(t - tau). Slow changes cancel,
/// and they cancel the better the nearer the target is (range correlation: M. C. Budge, M. P. Burt, "Range
/// correlation effects in radars", Record of the 1993 IEEE National Radar Conference).
///
/// The phase of a pole is an Ornstein-Uhlenbeck process. It is drawn exactly at the times of the samples.
/// Between samples it is drawn from its distribution conditioned on both neighbours. Echoes share the phase
/// of the nearest node of a series of delays that grow by a quarter. The delay is then right within 12 %, and
/// the power of the noise within 0.5 dB. Each ramp draws a new phase. This is valid if interval_s is many
/// times 1/(2 pi f_p).
class PhaseWalk {
 public:
  PhaseWalk(const PhaseNoise& noise, const RadarWaveform& waveform, const RadarSeeds& seeds);

  /// Returns the index of the node nearest to a delay, on a logarithmic scale.
  static uint32_t node_of(double delay_s);
  static double node_delay_s(uint32_t node);
  /// Returns the standard deviation of the phase, rad: sqrt(pi f_p L_0).
  double deviation() const { return deviation_; }

  /// Draws the phase over one ramp.
  class Ramp {
   public:
    /// Sets turns[n] = (phi(t_n) - phi(t_n - delay of `node`))/2 pi, [samples].
    void differences(uint32_t node, std::span<float> turns);

   private:
    friend class PhaseWalk;
    Ramp(const PhaseWalk& walk, uint32_t slot) : walk_(walk), slot_(slot) {}
    void extend(size_t count);
    const PhaseWalk& walk_;
    uint32_t slot_;
    std::vector<float> backwards_;  ///< phase/deviation at the last sample, one sample before it, ...
  };
  Ramp ramp(uint32_t slot) const { return {*this, slot}; }

 private:
  RadarSeeds seeds_;
  double deviation_, pole_rad_s_, sample_s_;
  uint32_t samples_;
};

}  // namespace greatx::rf
