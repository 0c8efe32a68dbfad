// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The channel as a discrete-time filter at a bandwidth: what an equaliser or a link simulator in baseband
// reads.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "rf/channel/frequency_response.h"
#include "rf/geometry/path.h"

namespace greatx::rf {

/// Samples of 1/bandwidth about the carrier: tap l stands for the absolute delay l / bandwidth_hz.
struct TapGrid {
  double carrier_hz = 3.5e9;
  double bandwidth_hz = 20e6;
  int32_t first = 0;   ///< number of the first tap; may be negative: a path's sinc begins before its delay
  uint32_t taps = 64;  ///< above 0
  uint32_t time_samples = 1;
  double time_spacing_s = 1e-3;
};

/// What a window of taps leaves out. An ideal low-pass has no end: also a window that holds all delays leaves
/// some 1/(pi^2 L) of a path's power out, L taps from its edge.
struct TapCoverage {
  /// sum_i p_i (1 - sum_l sinc^2(l - B tau_i)) / sum_i p_i, of path_powers(); in [0, 1]. 0 if no path has
  /// power.
  double power_outside = 0.0;
  uint32_t paths_outside =
      0;  ///< paths of any power whose delay is not in [first - 1/2, first + taps - 1/2) / B
};

/// h[l](t) = sum_i a_i e^{j 2 pi nu_i t} sinc(l - B tau_i), a_i as in ImpulseResponse, sinc(x) = sin(pi
/// x)/(pi x); complex64 [rx_ant, tx_ant, time, tap], C order, t = m * time_spacing (D. Tse, P. Viswanath,
/// Fundamentals of Wireless Communication, 2005, eq. 2.35). Nothing is normalised: delays are absolute and
/// the sum over all l of |h[l]|^2 of one path is its power.
///
/// Fractional delays are exact: B tau is formed as the sum of two doubles and the sine is taken of its
/// fraction alone, so that a delay of a whole number of samples has one tap that is not 0. Sums and their
/// order are those of frequency_response(). Transfers are the carrier's (no dispersion).
///
/// And the frequency response: H(f) = sum over all l of h[l] e^{-j 2 pi f l/B} for |f| < B/2. Hence with an
/// odd number N of subcarriers at B/N, the inverse DFT of frequency_response() is sum_q h[l + q N], the taps
/// folded to N; with an even N one subcarrier lies on -B/2, where the sinc's spectrum ends, and is there in
/// full in place of one half at either edge.
std::vector<std::complex<float>> channel_taps(std::span<const Path> paths, const ArrayPose& transmitter,
                                              const ArrayPose& receiver, const TapGrid& grid);
/// The same before it is rounded.
std::vector<Complex> channel_taps_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                       const ArrayPose& receiver, const TapGrid& grid);
/// Into memory of the caller's, [rx_ant * tx_ant * time * tap]; the same bits. Thread-safe, as all of this
/// file.
void channel_taps_into(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                       const TapGrid& grid, std::span<std::complex<float>> out);

/// `powers` [paths], of path_powers(). Any order of the paths gives the same bits.
TapCoverage tap_coverage(std::span<const Path> paths, std::span<const double> powers, const TapGrid& grid);

}  // namespace greatx::rf
