// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/fft.h"

#include <cmath>
#include <kiss_fft.h>
#include <kissfft.hh>
#include <numbers>
#include <vector>

#include "core/error.h"

/// Specializes the constructor of KISS FFT's template for four numbers side by side. The template's own
/// constructor computes the phases in the type of the numbers that it transforms. Here they are computed in
/// fp64 and rounded last. Only the radices 4, 2, 3 and 5 are allowed: for others the template keeps a buffer
/// that threads would share.
template <>
kissfft<greatx::rf::Four>::kissfft(const std::size_t nfft, const bool inverse)
    : _nfft(nfft), _inverse(inverse) {
  for (std::size_t i = 0; i < nfft; ++i) {
    const double phase = (inverse ? 2.0 : -2.0) * std::numbers::pi * double(i) / double(nfft);
    _twiddles.emplace_back(static_cast<float>(std::cos(phase)), static_cast<float>(std::sin(phase)));
  }
  std::size_t left = nfft;
  for (const std::size_t radix : {4u, 2u, 3u, 5u})
    while (left % radix == 0) {
      left /= radix;
      _stageRadix.push_back(radix);
      _stageRemainder.push_back(left);
    }
}

namespace greatx::rf {
namespace {

static_assert(sizeof(kiss_fft_cpx) == sizeof(std::complex<float>));

bool has_template_radices(uint32_t size) {
  for (const uint32_t radix : {2u, 3u, 5u})
    while (size % radix == 0) size /= radix;
  return size == 1;
}

/// Transforms `size` points by a convolution of at least 2 size - 1 points: with c_n = e^{-j pi n^2/size},
///   X_k = c_k sum_n (x_n c_n) conj(c_{k - n}).
class ChirpTransform {
 public:
  ChirpTransform(uint32_t size, bool backward)
      : points_(points_for(size)), forward_(points_, false), backward_(points_, true), chirp_(size) {
    std::vector<std::complex<Four>> kernel(points_), spectrum(points_);
    for (uint32_t n = 0; n < size; ++n) {
      // n^2 modulo 2 size keeps the phase exact.
      const double turns = double(uint64_t{n} * n % (2 * uint64_t{size})) / (2.0 * size);
      const double phase = (backward ? 2.0 : -2.0) * std::numbers::pi * turns;
      chirp_[n] = {static_cast<float>(std::cos(phase)), static_cast<float>(std::sin(phase))};
      const std::complex<Four> value(Four(chirp_[n].real()), Four(-chirp_[n].imag()));
      kernel[n] = value;
      if (n > 0) kernel[points_ - n] = value;
    }
    forward_.transform(kernel.data(), spectrum.data());
    const float scale = 1.0f / static_cast<float>(points_);
    for (const auto& value : spectrum)
      kernel_.emplace_back(scale * value.real().lane[0], scale * value.imag().lane[0]);
  }

  void transform(const std::complex<Four>* in, std::complex<Four>* out) const {
    std::vector<std::complex<Four>> a(points_), b(points_);
    for (size_t n = 0; n < chirp_.size(); ++n) a[n] = turned(in[n], chirp_[n]);
    forward_.transform(a.data(), b.data());
    for (uint32_t i = 0; i < points_; ++i) b[i] = turned(b[i], kernel_[i]);
    backward_.transform(b.data(), a.data());
    for (size_t k = 0; k < chirp_.size(); ++k) out[k] = turned(a[k], chirp_[k]);
  }

 private:
  static uint32_t points_for(uint32_t size) {
    uint32_t points = 2 * size - 1;
    while (!has_template_radices(points)) ++points;
    return points;
  }
  static std::complex<Four> turned(const std::complex<Four>& value, const std::complex<float>& by) {
    const Four re(by.real()), im(by.imag());
    return {value.real() * re - value.imag() * im, value.real() * im + value.imag() * re};
  }

  uint32_t points_;
  kissfft<Four> forward_, backward_;
  std::vector<std::complex<float>> chirp_, kernel_;
};

}  // namespace

struct Fft::Plan {
  /// Null for sizes with other factors; `chirp` transforms these, or `single`, one signal after the other.
  std::unique_ptr<const kissfft<Four>> four;
  std::unique_ptr<const ChirpTransform> chirp;
  kiss_fft_cfg single = nullptr;
  Plan(uint32_t size, bool backward, Others others) {
    if (size > 1 && has_template_radices(size)) {
      four = std::make_unique<const kissfft<Four>>(size, backward);
      return;
    }
    if (size > 1 && others == Others::chirp) {
      chirp = std::make_unique<const ChirpTransform>(size, backward);
      return;
    }
    single = kiss_fft_alloc(static_cast<int>(size), backward, nullptr, nullptr);
    GREATX_CHECK(single != nullptr, "a transform of {} points", size);
  }
  ~Plan() { kiss_fft_free(single); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;
};

Fft::Fft(uint32_t size, Direction direction, Others others)
    : size_(size), plan_(std::make_unique<Plan>(size, direction == Direction::backward, others)) {}
Fft::~Fft() = default;
Fft::Fft(Fft&&) noexcept = default;
Fft& Fft::operator=(Fft&&) noexcept = default;

void Fft::transform(const Value* in, Value* out) const {
  GREATX_CHECK(in != out, "a transform in place");
  if (plan_->four) return plan_->four->transform(in, out);
  if (plan_->chirp) return plan_->chirp->transform(in, out);
  std::vector<kiss_fft_cpx> one(size_), turned(size_);
  for (uint32_t lane = 0; lane < lanes; ++lane) {
    for (uint32_t n = 0; n < size_; ++n) one[n] = {in[n].real().lane[lane], in[n].imag().lane[lane]};
    kiss_fft(plan_->single, one.data(), turned.data());
    for (uint32_t n = 0; n < size_; ++n) {
      Four re = out[n].real(), im = out[n].imag();
      re.lane[lane] = turned[n].r, im.lane[lane] = turned[n].i;
      out[n] = {re, im};
    }
  }
}

namespace {

using Stored [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;

}  // namespace

void Fft::gather(const std::complex<float>* const rows[lanes], uint32_t count, Value* values) {
  const auto pair = [&](uint32_t row, uint32_t n) { return *reinterpret_cast<const Stored*>(rows[row] + n); };
  uint32_t n = 0;
  for (; n + 2 <= count; n += 2) {  // two numbers of each row are four floats
    Four a{pair(0, n)}, b{pair(1, n)}, c{pair(2, n)}, d{pair(3, n)};
    transpose(a, b, c, d);
    values[n] = {a, b}, values[n + 1] = {c, d};
  }
  if (n == count) return;
  Four re, im;
  for (uint32_t row = 0; row < lanes; ++row)
    re.lane[row] = rows[row][n].real(), im.lane[row] = rows[row][n].imag();
  values[n] = {re, im};
}

void Fft::scatter(const Value* values, uint32_t count, std::complex<float>* const rows[lanes]) {
  const auto put = [&](uint32_t row, uint32_t n, const Four& pair) {
    *reinterpret_cast<Stored*>(rows[row] + n) = pair.lane;
  };
  uint32_t n = 0;
  for (; n + 2 <= count; n += 2) {
    Four a = values[n].real(), b = values[n].imag(), c = values[n + 1].real(), d = values[n + 1].imag();
    transpose(a, b, c, d);
    put(0, n, a), put(1, n, b), put(2, n, c), put(3, n, d);
  }
  if (n == count) return;
  for (uint32_t row = 0; row < lanes; ++row)
    rows[row][n] = {values[n].real().lane[row], values[n].imag().lane[row]};
}

}  // namespace greatx::rf
