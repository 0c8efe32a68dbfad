// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes windows that are sums of cosines about their middle, w[n] = sum_m c_m cos(2 pi m (n - N/2)/N), and
// their figures. The response has a closed form. F. J. Harris, "On the use of windows for harmonic analysis
// with the discrete Fourier transform", Proc. IEEE 66(1), 1978.
#pragma once

#include <complex>
#include <cstdint>
#include <vector>

#include "rf/config/radar_config.h"

namespace greatx::rf {

class Window {
 public:
  /// Makes a window of a kind: rectangular, Hann, Hamming (0.54, 0.46), Blackman (0.42, 0.5, 0.08), or Taylor
  /// with nbar = 4 and sidelobes of -35 dB (T. T. Taylor, IRE Trans. Antennas Propag. 3(1), 1955;
  /// coefficients as in Carrara, Goodman, Majewski, "Spotlight Synthetic Aperture Radar", 1995, appendix D).
  /// The windows have the periodic (DFT-even) form.
  Window(RadarWindow kind, uint32_t size);

  uint32_t size() const { return static_cast<uint32_t>(values_.size()); }
  const std::vector<float>& values() const { return values_; }
  /// Returns the mean of w: the amplitude of a tone at the centre of a bin, before normalization (Harris,
  /// III.B).
  double coherent_gain() const { return gain_; }
  /// Returns the equivalent noise bandwidth N sum w^2/(sum w)^2, bins (Harris, eq. 11).
  double noise_bandwidth() const { return bandwidth_; }
  /// Returns 1/|response(1/2)|^2: the loss of a tone halfway between two bins, as a power ratio (Harris, eq.
  /// 17).
  double scalloping_loss() const { return 1.0 / power(0.5); }
  /// Returns sum_n w[n] e^{j 2 pi bins (n - N/2)/N}/sum w: the response in a bin to a tone `bins` above this
  /// bin. The phase counts from sample N/2.
  std::complex<double> response(double bins) const;
  double power(double bins) const { return std::norm(response(bins)); }
  /// Returns |correlation| of white noise in two bins that are `bins` apart.
  double noise_correlation(uint32_t bins) const;
  /// Returns the offset of a tone from the bin of its peak, in [-1/2, 1/2] bins. The arguments are the powers
  /// in the bin of the peak and in the bins before and after it. The ratio of the peak to its larger
  /// neighbour is solved for exactly: the error for one tone without noise is below 1e-8 bins.
  double peak_offset(double before, double peak, double after) const;

 private:
  /// Returns the power in the neighbouring bin on the side of the tone, divided by that in the bin of the
  /// peak. The ratio rises from offset 0 to 1 at offset 1/2.
  double neighbour_ratio(double offset) const;

  std::vector<double> coefficients_;
  std::vector<double> ratios_;  ///< ratios at the offsets 0 .. 1/2
  std::vector<float> values_;
  double gain_ = 1.0, bandwidth_ = 1.0;
};

}  // namespace greatx::rf
