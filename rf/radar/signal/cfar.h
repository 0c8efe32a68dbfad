// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Detection at a constant false-alarm rate on a range-Doppler map of V virtual antennas' mean power: noise
// alone makes cells of Gamma(V)/V distribution.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/maps.h"
#include "rf/radar/signal/window.h"

namespace greatx::rf {

/// T such that noise exceeds T times the mean of `cells` independent cells with probability `false_alarm`;
/// `looks`: V. The root p = T/cells of  sum_{k<V} Gamma(V cells + k)/(Gamma(V cells) k!) p^k/(1+p)^{V cells +
/// k} = P_fa; for V = 1 T = cells (P_fa^{-1/cells} - 1)  (M. A. Richards, "Fundamentals of Radar Signal
/// Processing", 2nd ed., eq. 6.129, and for V > 1 the distribution of a ratio of two Gamma variates). `cells`
/// need not be whole.
double cell_averaging_factor(double cells, uint32_t looks, double false_alarm);

/// T such that noise exceeds T times the rank-th smallest of `cells` with that probability. V = 1: the root
/// of prod_{i<rank} (cells - i)/(cells - i + T) = P_fa (H. Rohling, IEEE Trans. Aerosp. Electron. Syst.
/// 19(4), 1983, eq. 35); V > 1: the mean of Gamma(V)'s tail over the order statistic's density, by
/// quadrature.
double ordered_statistic_factor(uint32_t cells, uint32_t rank, uint32_t looks, double false_alarm);

/// Mean over noise of the rank-th smallest of `cells`, by the mean of a cell.
double ordered_statistic_mean(uint32_t cells, uint32_t rank, uint32_t looks);

struct CfarPeak {
  uint32_t range = 0, velocity = 0;  ///< bins
  double power_w = 0.0;              ///< of the cell
  double noise_w = 0.0;              ///< mean power of noise about it
};

/// Cells above their threshold that no neighbour of the eight exceeds: one for each group. Training cells lie
/// around the guard cells on all sides. The Doppler axis is a circle; at the ends of the range axis the cells
/// that are there serve, with the factor of their number. Windows make neighbours' noise alike: n cells tell
/// as much as n_eff = n^2/sum_ij |rho_ij|^2 independent ones (a mean of the same variance), which cell
/// averaging counts with; the ordered statistic does with n_eff and a rank in proportion: it lets fewer
/// alarms pass then than asked (docs/radar.md).
class Cfar {
 public:
  /// `looks`: virtual antennas.
  Cfar(const RadarCfar& config, const Window& range_window, const Window& doppler_window, uint32_t looks);

  /// map: W [range, velocity]. In order of range, then velocity.
  std::vector<CfarPeak> peaks(std::span<const float> map, uint32_t threads) const;
  /// Of every cell of one range: the noise's mean power and what it is multiplied with for the threshold.
  struct Row {
    std::vector<double> noise_w;
    double factor;
  };
  Row row(std::span<const float> map, uint32_t range) const;

 private:
  struct Factor {
    double threshold;  ///< by the statistic
    double bias;       ///< statistic by mean noise
    uint32_t rank;     ///< 1 is the smallest; of ordered_statistic
  };
  Factor factor_for(uint32_t below, uint32_t above) const;

  RadarCfar config_;
  uint32_t ranges_, velocities_, looks_;
  std::vector<double> range_correlation_, doppler_correlation_;  ///< |rho|^2 by distance
  std::vector<double> quantiles_;                                ///< of a cell's noise; of ordered_statistic
  std::vector<Factor> factors_;                                  ///< [ranges]
};

}  // namespace greatx::rf
