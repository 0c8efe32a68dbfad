// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the beat signal from the echoes. Let phi(t) = 2 pi (f_c u + S u^2/2) be the transmitted phase at
// the time u after the ramp passes f_c. The mixer multiplies the transmitted signal by the conjugate of the
// received one, so that an echo of delay tau is
//   s(t) = conj(a) sqrt(P_t) e^{j[phi(t) - phi(t - tau)]}
//        = conj(a) sqrt(P_t) e^{j 2 pi [f_c tau + S tau u - S tau^2/2]}
// with tau = tau(t) at every sample (A. G. Stove, "Linear FMCW radar techniques", IEE Proc. F 139(5), 1992,
// with the term in tau^2 kept). Other waveforms have the same form (rf/config/radar_waveform.h). The phase of
// an echo that comes closer turns backwards from chirp to chirp.
// In the far field the delay between elements at d_tx and d_rx is tau - (departure . d_tx + arrival .
// d_rx)/c. This delay enters the frequency of the tone as well as its phase.
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

/// Holds world_from_array of both arrays during the slots of a list.
struct RadarAttitude {
  dquat transmitter{1.0, 0.0, 0.0, 0.0}, receiver{1.0, 0.0, 0.0, 0.0};
};

/// The beat signal [receivers, transmitters, chirps, samples] in sqrt(W). |s|^2 is the power at the port of
/// the receiver.
using RadarCube = std::vector<std::complex<float>>;

/// Holds the phase that the oscillator adds to each echo; defined in receiver.h.
class PhaseWalk;

struct BeatReport {
  uint64_t tones = 0;       ///< number of echoes summed, times slots
  uint64_t bent_tones = 0;  ///< those that bend too much within a chirp and are summed sample by sample
};

/// Adds echoes to cubes by a non-uniform fast Fourier transform per slot and receiver. The error of each
/// sample is at most 1e-5 of the sum of the echoes' amplitudes.
class BeatSynthesizer {
 public:
  explicit BeatSynthesizer(const RadarSignalConfig& config);
  ~BeatSynthesizer();

  /// Adds the echoes of `list` to `cube` over the slots of the list. `walk` is null or the phase noise of the
  /// oscillator. `threads`: 0 uses all there are; the bytes do not depend on it. Requires echoes that
  /// check_echoes() accepts.
  /// `term` selects the term of a coded waveform (SymbolSynthesizer); waveforms that sweep have one.
  BeatReport add(const EchoList& list, const RadarAttitude& attitude, const PhaseWalk* walk, uint32_t threads,
                 std::span<std::complex<float>> cube, uint32_t term = 0) const;

 private:
  struct Shared;
  std::unique_ptr<Shared> shared_;
};

/// Returns direction . d/c of each element of an array with this orientation, seconds.
std::vector<double> element_leads(const std::vector<dvec3>& elements, const dquat& orientation,
                                  const dvec3& direction);
/// Return departure . d_tx/c of each transmitter and arrival . d_rx/c of each receiver, seconds. The delay
/// between two elements is shorter than that between the origins by the sum of both leads.
std::vector<double> transmitter_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                      const Echo& echo);
std::vector<double> receiver_leads(const RadarArrays& arrays, const RadarAttitude& attitude,
                                   const Echo& echo);

}  // namespace greatx::rf
