// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <complex>
#include <cstdint>
#include <memory>

namespace greatx::rf {

/// Discrete Fourier transform in fp32 (KISS FFT): out[k] = sum_n in[n] e^{-j 2 pi k n/size}, or e^{+j ...} backward; no factor.
/// The same input gives the same bits. transform() may run on many threads at once.
class Fft {
 public:
  enum class Direction { forward, backward };
  Fft(uint32_t size, Direction direction);
  ~Fft();
  Fft(Fft&&) noexcept;
  Fft& operator=(Fft&&) noexcept;

  uint32_t size() const { return size_; }
  /// in and out: [size], not the same.
  void transform(const std::complex<float>* in, std::complex<float>* out) const;

 private:
  struct Plan;
  uint32_t size_;
  std::unique_ptr<Plan> plan_;
};

}  // namespace greatx::rf
