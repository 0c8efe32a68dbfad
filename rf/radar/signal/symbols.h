// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the received signal of coded waveforms (OFDM, PMCW) from the echoes, and their lines from the signal.
//
// A slot sends the lines X_n at the frequencies f_n = (n - N/2) B/N. An echo of delay tau and rate tau'
// gives, as the conjugate of what is received (beat.h),
//   z(t) = conj(a) sqrt(P_t/N) sum_n conj(X_n) e^{j 2 pi [(f_c + f_n) tau - f_n t]} e^{j phi x},
//   x = (t - t_0)/(T/2),  phi = pi f_c tau' T,
// with tau at the middle t_0 of the N samples of the length T = N/B. The factor e^{j phi x} is the Doppler
// shift within the slot, which moves power from each line to all others: the intercarrier interference of
// OFDM, the code sidelobes of PMCW. It is the sum of the terms (j x)^k phi^k/k!, so that
//   z(t) = sum_k (j x)^k sum_n conj(X_n) H_k(n) e^{-j 2 pi f_n t},
// where H_k is the sum of the echoes, each with the weight phi^k/k!: a transform as for ramps, over lines
// instead of samples. The series ends where its terms stay below 1e-6.
//
// The receiver adds noise, converts, transforms z back, and multiplies line n by X_n. For OFDM, |X_n| = 1, so
// that this is the division by the symbols; for PMCW it is the periodic correlation with the code.
//
// The Doppler shift of the lines at the ends of the band differs from that at the carrier. That is left out
// within a slot: at most pi N |tau'|/2 rad.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "rf/config/radar_waveform.h"
#include "rf/radar/signal/echo.h"
#include "rf/radar/signal/fft.h"
#include "rf/radar/signal/receiver.h"

namespace greatx::rf {

/// Returns the weight phi^term/term! of an echo, times the response of the mean over a code's repetitions.
float symbol_weight(const RadarWaveform& waveform, double rate, uint32_t term);

/// Returns the power that an echo of a Doppler shift keeps on its own line: sinc^2 of the shift times T, in
/// its periodic form. 1 for waveforms that sweep.
double symbol_gain(const RadarWaveform& waveform, double doppler_hz);

class Symbols {
 public:
  /// Echoes whose Doppler shift exceeds the spacing of the lines are refused: |phi| <= pi.
  static constexpr double largest_phase = 3.14159265358979323846;

  /// Requires a coded waveform.
  explicit Symbols(const RadarWaveform& waveform);

  /// Returns the number of terms that the echoes of a frame take, at least one. Throws UserError, naming the
  /// radar, if an echo moves too fast.
  uint32_t terms(std::span<const EchoList> lists, const std::string& radar) const;

  /// Adds term `term` to the signal. `lines` and `signal` are cubes [receivers, loop, chirps, samples].
  void send(const RadarSeeds& seeds, uint32_t term, uint32_t threads,
            std::span<const std::complex<float>> lines, std::span<std::complex<float>> signal) const;
  /// Replaces the signal by its lines after division or correlation.
  void receive(const RadarSeeds& seeds, uint32_t threads, std::span<std::complex<float>> cube) const;

  /// Returns X_n of a slot, [samples], with the mean of |X_n|^2 equal to 1. OFDM draws QPSK symbols.
  std::vector<std::complex<float>> spectrum(const RadarSeeds& seeds, uint32_t slot) const;

 private:
  template <typename Work>
  void in_slots(const RadarSeeds& seeds, uint32_t threads, size_t samples, const Work& work) const;

  RadarWaveform waveform_;
  Fft to_signal_, to_lines_;
  std::vector<std::complex<float>> code_;  ///< X_n of the code
};

}  // namespace greatx::rf
