// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Windows that are sums of cosines about their middle, w[n] = sum_m c_m cos(2 pi m (n - N/2)/N): all figures
// in closed form. F. J. Harris, "On the use of windows for harmonic analysis with the discrete Fourier
// transform", Proc. IEEE 66(1), 1978.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "rf/config/radar_config.h"

namespace greatx::rf {

class Window {
 public:
  /// Hann, Hamming (0.54, 0.46), Blackman (0.42, 0.5, 0.08), or Taylor's with nbar = 4 and sidelobes of -35
  /// dB (T. T. Taylor, IRE Trans. Antennas Propag. 3(1), 1955; coefficients as in Carrara, Goodman, Majewski,
  /// "Spotlight Synthetic Aperture Radar", 1995, appendix D), in the periodic (DFT-even) form.
  Window(RadarWindow kind, uint32_t size);

  uint32_t size() const { return static_cast<uint32_t>(values_.size()); }
  const std::vector<float>& values() const { return values_; }
  /// Mean of w: amplitude of a tone at a bin's centre, before the division by it (Harris, III.B).
  double coherent_gain() const { return gain_; }
  /// Equivalent noise bandwidth N sum w^2/(sum w)^2, bins (Harris, eq. 11).
  double noise_bandwidth() const { return bandwidth_; }
  /// 1/|response(1/2)|^2: what a tone halfway between two bins loses, as a power ratio (Harris, eq. 17).
  double scalloping_loss() const { return 1.0 / power(0.5); }
  /// sum_n w[n] e^{j 2 pi bins (n - N/2)/N}/sum w: what a tone `bins` above a bin leaves there, phase counted
  /// from sample N/2.
  std::complex<double> response(double bins) const;
  double power(double bins) const { return std::norm(response(bins)); }
  /// |correlation| of white noise in two bins that lie `bins` apart.
  double noise_correlation(uint32_t bins) const;
  /// The offset in [-1/2, 1/2] from a peak's bin of the tone whose powers there and in the bins before and
  /// after are these: the ratio of peak and larger neighbour, solved for exactly. One tone without noise is
  /// found to 1e-8 bins.
  double peak_offset(double before, double peak, double after) const;

 private:
  /// Power of the neighbour on a tone's side by that of the peak's bin, rising from offset 0 to 1 at 1/2.
  double neighbour_ratio(double offset) const;

  std::vector<double> coefficients_;
  std::vector<double> ratios_;  ///< of offsets 0 .. 1/2
  std::vector<float> values_;
  double gain_ = 1.0, bandwidth_ = 1.0;
};

}  // namespace greatx::rf
