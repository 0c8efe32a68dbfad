// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Turns the fields of a link's paths into what was measured, with the slopes by every variable of a fit.
//
//   fields ─► PathTerms: amplitudes per path and pair of ports, delays ─► Signal over subcarriers ─► FitRows
//                                                                      └► powers of paths ─────────► FitRows
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/vec.h"
#include "sim/fit/links.h"
#include "sim/fit/transfer_slopes.h"

namespace greatx::sim {

/// For each path and pair of ports, the factors of the entries of Path::transfer in the amplitude:
/// (lambda/4 pi) C_R^H T C_T = sum_e w_e T_e.
struct FitWeights {
  size_t pairs = 1;
  std::vector<FitTransfer> of;  ///< [paths, pairs]
};
/// `yaw` turns both ends about the world's z, rad. Where powers of paths add, one element at each end gives
/// the mean over the array; a cir or cfr has the pair of ports of its set.
FitWeights weights_of(const FitLink& link, const FitSet& set, double carrier_hz, double transmitter_yaw,
                      double receiver_yaw);

/// Holds the amplitudes of the paths, without the phase of their delay, and the delays, with their slopes by
/// the columns of a link.
struct PathTerms {
  struct AmplitudeSlope {
    uint32_t column = 0, path = 0;
    std::vector<rf::Complex> of;  ///< [pairs]
  };
  struct DelaySlope {
    uint32_t column = 0;
    std::vector<double> of;  ///< [paths], s per unit
  };
  size_t pairs = 1, columns = 0;
  std::vector<rf::Complex> amplitudes;  ///< [paths, pairs]
  std::vector<double> delays_s;         ///< [paths]
  std::vector<AmplitudeSlope> amplitude_slopes;
  std::vector<DelaySlope> delay_slopes;
};

/// Values of a function of frequency or time, and their slopes.
struct Signal {
  std::vector<rf::Complex> value;                ///< [pairs, samples]
  std::vector<std::vector<rf::Complex>> slopes;  ///< [columns]
};

/// Real values and their slopes.
struct FitRows {
  Eigen::VectorXd value;   ///< [rows]
  Eigen::MatrixXd slopes;  ///< [rows, columns]
};

/// Returns the frequency response, H = sum of a e^{-j 2 pi (f_c + f) tau}, at the subcarriers of the band.
Signal response_of(const PathTerms& terms, const FitBand& band, double carrier_hz, bool slopes);
/// Returns the taps of the response's band: the inverse DFT over the subcarriers, [pairs, taps]. Tap l has
/// the delay l/(subcarriers * spacing), modulo subcarriers.
Signal taps_of(const Signal& response, const FitBand& band, size_t pairs);
/// Returns the response of which all taps, without a window, are those of taps_of().
std::vector<rf::Complex> response_of_taps(std::span<const rf::Complex> taps);
/// Returns the power of each path, the mean over the pairs of ports.
FitRows powers_of(const PathTerms& terms, bool slopes);
/// Returns the mean over the pairs of |value|^2, [samples].
FitRows powers_of(const Signal& signal, size_t pairs);
/// Returns the sum of the rows as one row.
FitRows sum_of(const FitRows& powers);
/// Returns the mean of the rows as one row.
FitRows mean_of(const FitRows& powers);
/// Returns the rms delay spread of powers at delays, ns. `delay_slopes` are those of PathTerms. A spread of 0
/// has no slope and gets 0.
FitRows delay_spread_of(const FitRows& powers, std::span<const double> delays_s,
                        std::span<const PathTerms::DelaySlope> delay_slopes);
/// Returns 10 log10(scale * power + floor), dB, with the slope by the scale in dB in column `scale_column`
/// (none if negative).
FitRows levels_of(const FitRows& powers, double scale_db, std::span<const double> floors, int scale_column);

}  // namespace greatx::sim
