// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a receiver adds to the beat signal. Every draw is a function of (seed, stream, sequence, what it is
// for).
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"

namespace greatx::rf {

/// Of one frame.
struct RadarSeeds {
  uint64_t seed = 0;      ///< the scenario's
  uint32_t stream = 0;    ///< the sensor's
  uint32_t sequence = 0;  ///< the frame's number
};

/// Which draws of a frame: the fourth word of the counter.
enum class RadarDraw : uint32_t { thermal = 0x72640000u, walk = 0x73000000u, bridge = 0x74000000u };

/// Complex normal numbers of variance 1 (1/2 in each part): out[i] is draw `first` + i of (seeds, purpose +
/// part). Box and Muller's transform of Philox words, whose radius ends at 5.9 of a part's standard
/// deviations. `first` is even.
void complex_normals(const RadarSeeds& seeds, RadarDraw purpose, uint32_t part, uint32_t first,
                     std::span<std::complex<float>> out);

/// k T_0 f_s F, W: noise power of a complex sample, as a power at the receiver's port.
double noise_power_w(double sample_rate_hz, double noise_figure_db);

/// What noise hides: the cross-section of a body 1 m from both ends whose echo, all of a frame's samples and
/// antennas added up in phase, is a hundredth of the mean power that noise then has. Elements of these gains;
/// in a distance it grows with the square of each end's. 0 without noise. m^2.
double hidden_section_m2(const RadarSignalConfig& config, double transmit_gain, double receive_gain);

/// Adds noise of `power_w` to each sample. Any number of threads, the same bytes.
void add_noise(const RadarSeeds& seeds, double power_w, uint32_t threads,
               std::span<std::complex<float>> cube);

/// Rounds I and Q to the middle of their step; what lies beyond full scale ends there. Returns how many
/// samples did.
uint64_t digitize(const AnalogToDigital& adc, uint32_t threads, std::span<std::complex<float>> cube);

/// The oscillator's phase over a frame. Its echo comes back tau later, so the beat signal has phi(t) - phi(t
/// - tau): what changes slowly cancels, the nearer the target the more (range correlation: M. C. Budge, M. P.
/// Burt, "Range correlation effects in radars", Record of the 1993 IEEE National Radar Conference). A pole's
/// phase is an Ornstein-Uhlenbeck process, drawn exactly at the samples' times and, between them, from its
/// distribution given both neighbours. Echoes share the phase of the nearest of delays that grow by a quarter
/// each: their noise is that of a delay within 12 %, so its power within 0.5 dB. From one ramp to the next
/// the phase is drawn afresh: right where interval_s is many times 1/(2 pi f_p).
class PhaseWalk {
 public:
  PhaseWalk(const PhaseNoise& noise, const RadarWaveform& waveform, const RadarSeeds& seeds);

  static uint32_t node_of(double delay_s);
  static double node_delay_s(uint32_t node);
  /// Standard deviation of the phase, rad: sqrt(pi f_p L_0).
  double deviation() const { return deviation_; }

  /// The phase over one ramp.
  class Ramp {
   public:
    /// turns[n] = (phi(t_n) - phi(t_n - delay of `node`))/2 pi, [samples].
    void differences(uint32_t node, std::span<float> turns);

   private:
    friend class PhaseWalk;
    Ramp(const PhaseWalk& walk, uint32_t slot) : walk_(walk), slot_(slot) {}
    void extend(size_t count);
    const PhaseWalk& walk_;
    uint32_t slot_;
    std::vector<float> backwards_;  ///< phase/deviation at the last sample, one sample before, ...
  };
  Ramp ramp(uint32_t slot) const { return {*this, slot}; }

 private:
  RadarSeeds seeds_;
  double deviation_, pole_rad_s_, sample_s_;
  uint32_t samples_;
};

}  // namespace greatx::rf
