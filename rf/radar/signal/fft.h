// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstdint>
#include <memory>

#include "rf/radar/signal/lanes.h"

namespace greatx::rf {

/// Computes discrete Fourier transforms of four signals side by side in fp32 (KISS FFT): out[k] = sum_n in[n]
/// e^{-j 2 pi k n/size} forward, or with e^{+j ...} backward, without a factor. The same input gives the same
/// bits in any lane. transform() may run on many threads at once.
class Fft {
 public:
  /// One value of each of the four signals.
  using Value = std::complex<Four>;
  static constexpr uint32_t lanes = 4;

  enum class Direction { forward, backward };
  /// How a size with other factors than 2, 3 and 5 is transformed: by its own factors, one signal after the
  /// other, or as a convolution with a chirp, four signals side by side (L. I. Bluestein, IEEE Trans. Audio
  /// Electroacoust. 18(4), 1970), which is faster where a factor is large.
  enum class Others { factors, chirp };
  Fft(uint32_t size, Direction direction, Others others = Others::factors);
  ~Fft();
  Fft(Fft&&) noexcept;
  Fft& operator=(Fft&&) noexcept;

  uint32_t size() const { return size_; }
  /// `in` and `out` are [size] and must not be the same.
  void transform(const Value* in, Value* out) const;

  /// Convert between four rows of `count` numbers and `count` values.
  static void gather(const std::complex<float>* const rows[lanes], uint32_t count, Value* values);
  static void scatter(const Value* values, uint32_t count, std::complex<float>* const rows[lanes]);

 private:
  struct Plan;
  uint32_t size_;
  std::unique_ptr<Plan> plan_;
};

}  // namespace greatx::rf
