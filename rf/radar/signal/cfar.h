// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Detects targets at a constant false-alarm rate on a range-Doppler map. The map is the mean power of V
// virtual antennas, so that a cell with noise alone follows a Gamma(V)/V distribution.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/config/radar_config.h"
#include "rf/radar/signal/maps.h"
#include "rf/radar/signal/window.h"

namespace greatx::rf {

/// Returns the factor T such that noise exceeds T times the mean of `cells` independent cells with the
/// probability P_fa = `false_alarm`. `looks` is V. p = T/cells is the root of
///   sum_{k<V} Gamma(V cells + k)/(Gamma(V cells) k!) p^k/(1+p)^{V cells + k} = P_fa.
/// For V = 1 this is T = cells (P_fa^{-1/cells} - 1) (M. A. Richards, "Fundamentals of Radar Signal
/// Processing", 2nd ed., eq. 6.129). For V > 1 it is the distribution of a ratio of two Gamma variates.
/// `cells` need not be a whole number.
double cell_averaging_factor(double cells, uint32_t looks, double false_alarm);

/// Returns the factor T such that noise exceeds T times the rank-th smallest of `cells` with the probability
/// P_fa = `false_alarm`. The tail of Gamma(V) is averaged over the density of the order statistic by
/// quadrature. For V = 1, T is the root of prod_{i<rank} (cells - i)/(cells - i + T) = P_fa (H. Rohling, IEEE
/// Trans. Aerosp. Electron. Syst. 19(4), 1983, eq. 35).
double ordered_statistic_factor(uint32_t cells, uint32_t rank, uint32_t looks, double false_alarm);

/// Returns the expected value of the rank-th smallest of `cells` noise cells, divided by the mean of a cell.
double ordered_statistic_mean(uint32_t cells, uint32_t rank, uint32_t looks);

struct CfarPeak {
  uint32_t range = 0, velocity = 0;  ///< bins
  double power_w = 0.0;              ///< power of the cell
  double noise_w = 0.0;              ///< mean noise power around the cell
};

/// Finds the cells above their threshold that none of their eight neighbours exceeds, so that each group of
/// cells gives one peak. The training cells surround the guard cells on all sides. The Doppler axis is
/// circular. At the ends of the range axis only the existing training cells are used, with the factor for
/// their number.
///
/// The windows correlate the noise of neighbouring cells: the mean of n cells has the variance of n_eff =
/// n^2/sum_ij |rho_ij|^2 independent cells. Cell averaging uses n_eff. The ordered statistic uses n_eff and a
/// proportional rank; its false-alarm rate is then lower than requested (docs/radar.md).
class Cfar {
 public:
  /// `looks` is the number of virtual antennas. `rise` is the mean of the map's cells where there is noise
  /// alone, relative to the mean power of the noise (noise_rise() of a folded map).
  Cfar(const RadarCfar& config, const Window& range_window, const Window& doppler_window, uint32_t looks,
       double rise = 1.0);

  /// Returns the peaks in the order of range, then velocity. `map` is W [range, velocity].
  std::vector<CfarPeak> peaks(std::span<const float> map, uint32_t threads) const;
  /// Holds the mean noise power of every cell of one range, and the factor on it that gives the threshold.
  struct Row {
    std::vector<double> noise_w;
    double factor;
  };
  Row row(std::span<const float> map, uint32_t range) const;

 private:
  struct Factor {
    double threshold;  ///< factor on the statistic
    double bias;       ///< ratio of the statistic to the mean noise
    uint32_t rank;     ///< rank in the ordered statistic; 1 is the smallest
  };
  Factor factor_for(uint32_t below, uint32_t above) const;

  RadarCfar config_;
  uint32_t ranges_, velocities_, looks_;
  double rise_;
  std::vector<double> range_correlation_, doppler_correlation_;  ///< |rho|^2 by distance in bins
  std::vector<double> quantiles_;  ///< quantiles of a noise cell, for the ordered statistic
  std::vector<Factor> factors_;    ///< [ranges]
};

}  // namespace greatx::rf
