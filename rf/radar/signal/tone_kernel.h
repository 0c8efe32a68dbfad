// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the kernel of a non-uniform fast Fourier transform for tones that bend slightly. The kernel places
//   e^{j 2 pi p m/M + j phi x^2},  m = n - N/2, x = m/(N/2), n = 0 .. N-1
// on a grid of M >= 1.5 N frequencies, such that one transform of the grid and a division reproduce it. For
// each place between two grid frequencies the kernel has eight taps. They are the least-squares taps (J. A.
// Fessler, B. P. Sutton, "Nonuniform fast Fourier transforms using min-max interpolation", IEEE Trans. Signal
// Process. 51(2), 2003) for the scaling factors of a Kaiser-Bessel window (P. J. Beatty et al., IEEE Trans.
// Med. Imaging 24(6), 2005, eq. 4 and 5). The bend is a sum of a few kernels,
//   e^{j phi x^2} = e^{j phi/2} (J_0 + 2 sum_k j^k J_k(phi/2) T_2k(x))
// (Jacobi-Anger: M. Abramowitz, I. A. Stegun, 9.1.44-45), where kernel k represents T_2k.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace greatx::rf {

class ToneKernel {
 public:
  static constexpr int taps = 8;
  static constexpr int first_tap = -3;  ///< offset of the first tap from the grid frequency below the tone
  static constexpr int orders = 4;      ///< kernels: T_0, T_2, T_4, T_6
  /// Parts of the interval between two grid frequencies, with one parabola each.
  static constexpr int segments = 64;
  /// Largest bend for which the truncation error of the kernels is below 1e-6 of the tone, rad. Tones that
  /// bend more are summed sample by sample.
  static constexpr float largest_bend = 0.235f;

  explicit ToneKernel(uint32_t samples);

  uint32_t samples() const { return samples_; }
  uint32_t grid() const { return grid_; }  ///< M: 2^a or 3 2^a
  /// Returns the factor on sample n after the transform, [samples]. Sample n is output (n - N/2) mod M of the
  /// transform.
  const std::vector<float>& correction() const { return correction_; }
  /// Returns the number of kernels that a tone with the bend `bend` rad needs, or `orders` + 1 beyond
  /// largest_bend. The first kernel that is left out stays below 1e-6: 2 J_k(bend/2) <= 2 (bend/4)^k/k!.
  static int32_t orders_for(float bend) {
    const float size = bend < 0.0f ? -bend : bend;
    return 1 + (size >= 2e-6f) + (size >= 4e-3f) + (size >= 0.0577f) + (size > largest_bend);
  }
  /// Returns J_0(bend/2), 2 J_1, 2 J_2, 2 J_3 by their power series (A&S 9.1.10), for |bend| <= largest_bend.
  static std::array<float, orders> bessel(float bend) {
    const float q = 0.25f * bend, qq = q * q;
    return {1.0f - qq + 0.25f * qq * qq, 2.0f * q * (1.0f - 0.5f * qq + qq * qq / 12.0f),
            qq * (1.0f - qq / 3.0f), q * qq / 3.0f * (1.0f - 0.25f * qq)};
  }
  /// Returns the coefficients [segments][3][taps] of kernel `order`: a, b, c of tap = (a u + b) u + c, with u
  /// in [0, 1) within the segment.
  const float* table(int order) const { return table_.data() + size_t(order) * segments * 3 * taps; }

 private:
  uint32_t samples_, grid_;
  std::vector<float> correction_, table_;
};

}  // namespace greatx::rf
