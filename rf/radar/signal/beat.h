// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// From echoes to the beat signal. With phi(t) = 2 pi (f_c u + S u^2/2) the phase sent u after the ramp passes
// f_c, the mixer gives what is sent times the conjugate of what is received, so an echo of delay tau is
//   s(t) = conj(a) sqrt(P_t) e^{j[phi(t) - phi(t - tau)]} = conj(a) sqrt(P_t) e^{j 2 pi [f_c tau + S tau u -
// S tau^2/2]}, tau = tau(t) at every sample (A. G. Stove, "Linear FMCW radar techniques", IEE Proc. F 139(5),
// 1992, with the term in tau^2 kept). An echo that comes closer turns the phase backwards from chirp to
// chirp. In the far field the delay between elements at d_tx and d_rx is tau - (departure . d_tx + arrival .
// d_rx)/c, in the tone as in its phase.
#pragma once

#include <complex>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/config/radar_config.h"
#include "rf/radar/signal/echo.h"

namespace greatx::rf {

/// world_from_array of both arrays while a list's slots are sent.
struct RadarAttitude {
  dquat transmitter{1.0, 0.0, 0.0, 0.0}, receiver{1.0, 0.0, 0.0, 0.0};
};

/// Beat signal [receivers, transmitters, chirps, samples] as sqrt(W): |s|^2 is the power at the receiver's
/// port.
using RadarCube = std::vector<std::complex<float>>;

/// What the oscillator adds to each echo's phase; receiver.h makes it.
class PhaseWalk;

struct BeatReport {
  uint64_t tones = 0;       ///< echoes summed, times slots
  uint64_t bent_tones = 0;  ///< of those, added sample by sample for they bend too much within a chirp
};

/// Adds echoes to cubes by a non-uniform fast Fourier transform for each slot and receiver. Each sample is
/// good to 1e-5 of the sum of the echoes' amplitudes.
class BeatSynthesizer {
 public:
  explicit BeatSynthesizer(const RadarSignalConfig& config);
  ~BeatSynthesizer();

  /// Adds the echoes of `list` to `cube`, over the list's slots. `walk`: null, or the oscillator's phase
  /// noise. threads: 0, all there are; the bytes are the same. What check_echoes() refuses is a broken
  /// contract here.
  BeatReport add(const EchoList& list, const RadarAttitude& attitude, const PhaseWalk* walk, uint32_t threads,
                 std::span<std::complex<float>> cube) const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

/// departure . d_tx/c of each transmitter, arrival . d_rx/c of each receiver: by how much the delay between
/// two elements is shorter than that between the origins, seconds.
std::vector<double> transmitter_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                      const Echo& echo);
std::vector<double> receiver_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                   const Echo& echo);

}  // namespace greatx::rf
