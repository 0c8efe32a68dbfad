// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the channel as a discrete-time filter at a bandwidth, as an equaliser or a baseband link simulator
// reads it.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Describes samples at intervals of 1/bandwidth about the carrier: tap l has the absolute delay l /
/// bandwidth_hz.
struct TapGrid {
  double carrier_hz = 3.5e9;
  double bandwidth_hz = 20e6;
  /// Number of the first tap. It may be negative, because a path's sinc begins before its delay.
  int32_t first = 0;
  uint32_t taps = 64;  ///< above 0
  uint32_t time_samples = 1;
  double time_spacing_s = 1e-3;
};

/// Describes the power and paths outside a window of taps. An ideal low-pass has no end: even a window that
/// holds all delays leaves out about 1/(pi^2 L) of the power of a path that is L taps from the window's edge.
struct TapCoverage {
  /// sum_i p_i (1 - sum_l sinc^2(l - B tau_i)) / sum_i p_i, with p_i of path_powers(); in [0, 1]. 0 if no
  /// path has power.
  double power_outside = 0.0;
  /// Number of paths of any power whose delay is not in [first - 1/2, first + taps - 1/2) / B.
  uint32_t paths_outside = 0;
};

/// Writes the taps h[l](t) = sum_i a_i e^{j 2 pi nu_i t} sinc(l - B tau_i) with a_i as in ImpulseResponse
/// and sinc(x) = sin(pi x)/(pi x), as complex64 [rx_ant, tx_ant, time, tap] in C order, t = m * time_spacing
/// (D. Tse, P. Viswanath, Fundamentals of Wireless Communication, 2005, eq. 2.35), into the caller's memory,
/// [rx_ant * tx_ant * time * tap]. Nothing is normalised: delays are absolute, and the sum of |h[l]|^2 of one
/// path over all l is its power. Thread-safe, like everything in this file.
///
/// Fractional delays are exact. B tau is formed as the sum of two doubles, and only its fraction enters the
/// sine. Hence a delay of a whole number of samples gives exactly one tap that is not 0. The order of the
/// sums is that of frequency_response(). Transfers are the carrier's (no dispersion). With
/// ArrayPose::beam_squint tau is the delay of the pair of elements.
///
/// The taps give the frequency response: H(f) = sum over all l of h[l] e^{-j 2 pi f l/B} for |f| < B/2. With
/// an odd number N of subcarriers at spacing B/N, the inverse DFT of frequency_response() is therefore sum_q
/// h[l + q N], the taps folded to N. With an even N one subcarrier lies at -B/2, where the spectrum of the
/// sinc ends. The response has its full value there, and the taps give one half at either edge.
void channel_taps_into(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                       const TapGrid& grid, std::span<std::complex<float>> out, uint32_t threads = 1);
/// Returns the same taps before they are rounded.
std::vector<Complex> channel_taps_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                       const ArrayPose& receiver, const TapGrid& grid);

/// Returns the coverage of the window. `powers` is [paths], from path_powers(). Any order of the paths gives
/// the same bits.
TapCoverage tap_coverage(std::span<const Path> paths, std::span<const double> powers, const TapGrid& grid);

}  // namespace greatx::rf
