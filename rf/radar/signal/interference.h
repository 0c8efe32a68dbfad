// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds to the beat signal of a radar with ramps what other radars with ramps send towards it.
//
// The receiver mixes the ramp of another radar with its own, so that the difference of both frequencies
// sweeps through the band of the receiver. What is within the band of its samples is a burst: a linear chirp
// of the slope S - S_i that lasts f_s/|S - S_i| (G. M. Brooker, "Mutual interference of millimeter-wave radar
// systems", IEEE Trans. Electromagn. Compat. 49(1), 2007). Ramps of equal slopes give a tone as long as they
// overlap. Let phi_i be the phase of the other ramp; a sample at t is
//   conj(a) sqrt(P_i) e^{j [phi(t) - phi_i(t - tau) + psi]}   while |f(t) - f_i(t - tau)| < f_s/2.
// The filter before the converter is thus ideal for the signals of others. The phase psi between both
// oscillators is drawn for each frame of the other radar.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/beat.h"
#include "rf/radar/signal/receiver.h"

namespace greatx::rf {

/// Describes one frame of another radar, as it arrives during some slots of this one.
struct Interferer {
  uint32_t radar = 0;                     ///< number of the other radar
  RadarWaveform waveform;                 ///< ramps
  RadarArrays arrays;                     ///< of the other radar, whose transmitters count
  dquat orientation{1.0, 0.0, 0.0, 0.0};  ///< world_from_array of its transmitters
  double power_w = 0.0;                   ///< of each transmitter while it sends
  /// Ratio of the field at the receiver's port to that at the transmitter's port, as Echo::amplitude.
  std::complex<double> amplitude;
  dvec3 departure{0.0}, arrival{0.0};             ///< as those of Echo
  double delay_s = 0.0, rate = 0.0, mid_s = 0.0;  ///< delay_s + rate (t - mid_s)
  double start_s = 0.0;                           ///< start of its frame after that of this radar's frame
  double phase_turns = 0.0;
  uint32_t first_slot = 0, slots = 0;  ///< slots of this radar
};

struct InterferenceReport {
  uint64_t samples = 0;   ///< samples of all receivers within bursts
  double energy_w_s = 0;  ///< sum of their powers over f_s, mean over the receivers
};

/// Adds an interferer to the cube [receivers, loop, chirps, samples] of ramps. The bytes do not depend on the
/// number of threads.
InterferenceReport add_interference(const RadarSignalConfig& config, const Interferer& interferer,
                                    const RadarAttitude& attitude, uint32_t threads,
                                    std::span<std::complex<float>> cube);

}  // namespace greatx::rf
