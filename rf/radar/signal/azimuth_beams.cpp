// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/azimuth_beams.h"

#include <algorithm>
#include <cmath>

#include "core/phase.h"
#include "rf/radar/signal/lanes.h"

namespace greatx::rf {
namespace {

using Lane [[gnu::vector_size(32)]] = float;
using Stored [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;

/// Computes sum x[i] conj(y[i]) over `count` values, a multiple of 8, in a fixed order.
GREATX_LANES void conjugate_product(const float* x_re, const float* x_im, const float* y_re,
                                    const float* y_im, uint32_t count, float& re, float& im) {
  Lane sum_re{}, sum_im{};
  for (uint32_t i = 0; i < count; i += AzimuthBeams::lanes) {
    const Lane a = *reinterpret_cast<const Stored*>(x_re + i), b = *reinterpret_cast<const Stored*>(x_im + i);
    const Lane c = *reinterpret_cast<const Stored*>(y_re + i), d = *reinterpret_cast<const Stored*>(y_im + i);
    sum_re += a * c + b * d;
    sum_im += b * c - a * d;
  }
  re = ((sum_re[0] + sum_re[1]) + (sum_re[2] + sum_re[3])) +
       ((sum_re[4] + sum_re[5]) + (sum_re[6] + sum_re[7]));
  im = ((sum_im[0] + sum_im[1]) + (sum_im[2] + sum_im[3])) +
       ((sum_im[4] + sum_im[5]) + (sum_im[6] + sum_im[7]));
}

GREATX_LANES void add_scaled(float re, float im, const float* steering_re, const float* steering_im,
                             uint32_t count, float* out) {
  for (uint32_t i = 0; i < count; ++i) out[i] += re * steering_re[i] - im * steering_im[i];
}

/// Adds the values, turned by re + j im, to the sum.
GREATX_LANES void add_turned(float re, float im, const float* x_re, const float* x_im, uint32_t count,
                             float* sum_re, float* sum_im) {
  for (uint32_t i = 0; i < count; ++i) {
    sum_re[i] += re * x_re[i] - im * x_im[i];
    sum_im[i] += re * x_im[i] + im * x_re[i];
  }
}

}  // namespace

AzimuthBeams::AzimuthBeams(const std::vector<BeamPlace>& places, double wavelength_m,
                           const std::vector<double>& azimuths)
    : places_(places), azimuths_(azimuths.size()) {
  size_t pairs = 0;
  std::vector<size_t> sizes;
  for (const BeamPlace& place : places) {
    beams_ = std::max(beams_, place.beam + 1);
    sizes.resize(beams_, 0);
    pairs += sizes[place.beam]++;
  }
  const auto turns = [&](uint32_t place, size_t k) {
    const dvec3 u(std::cos(azimuths[k]), std::sin(azimuths[k]), 0.0);
    return -glm::dot(u, places[place].at_m) / wavelength_m;
  };
  const auto add_row = [&](const auto& turns_at) {
    const size_t row = steering_.size();
    steering_.resize(row + 2 * azimuths_);
    for (size_t k = 0; k < azimuths_; ++k) {
      const std::complex<double> phasor = unit_phasor(fraction_of_turn(turns_at(k)));
      steering_[row + k] = static_cast<float>(phasor.real());
      steering_[row + azimuths_ + k] = static_cast<float>(phasor.imag());
    }
  };
  const auto count = static_cast<uint32_t>(places.size());
  if (pairs * azimuths_ > most_entries) {
    steering_.reserve(places.size() * 2 * azimuths_);
    for (uint32_t a = 0; a < count; ++a) add_row([&](size_t k) { return -turns(a, k); });
    return;
  }
  steering_.reserve(pairs * 2 * azimuths_);
  for (uint32_t a = 0; a < count; ++a)
    for (uint32_t b = a + 1; b < count; ++b) {
      if (places[a].beam != places[b].beam) continue;
      pairs_.push_back({a, b});
      add_row([&](size_t k) { return turns(b, k) - turns(a, k); });
    }
}

void AzimuthBeams::add_powers(const float* re, const float* im, uint32_t count, float* out) const {
  if (pairs_.empty() && !steering_.empty())
    add_by_sums(re, im, count, out);
  else
    add_by_pairs(re, im, count, out);
}

void AzimuthBeams::add_by_pairs(const float* re, const float* im, uint32_t count, float* out) const {
  float sum = 0.0f, product_re, product_im;
  const auto product = [&](size_t a, size_t b) {
    conjugate_product(re + a * count, im + a * count, re + b * count, im + b * count, count, product_re,
                      product_im);
  };
  for (size_t v = 0; v < places_.size(); ++v) {
    product(v, v);
    sum += product_re;
  }
  for (size_t k = 0; k < azimuths_; ++k) out[k] += sum;
  for (size_t i = 0; i < pairs_.size(); ++i) {
    product(pairs_[i].a, pairs_[i].b);
    // The term is conj(w_a) w_b x_a conj(x_b), where w is the steering. The pair (b, a) gives its conjugate.
    add_scaled(2.0f * product_re, 2.0f * product_im, &steering_[2 * i * azimuths_],
               &steering_[(2 * i + 1) * azimuths_], static_cast<uint32_t>(azimuths_), out);
  }
}

void AzimuthBeams::add_by_sums(const float* re, const float* im, uint32_t count, float* out) const {
  std::vector<float> sum_re(count), sum_im(count);
  float power, nothing;
  for (size_t k = 0; k < azimuths_; ++k)
    for (uint32_t beam = 0; beam < beams_; ++beam) {
      std::fill(sum_re.begin(), sum_re.end(), 0.0f);
      std::fill(sum_im.begin(), sum_im.end(), 0.0f);
      for (size_t v = 0; v < places_.size(); ++v)
        if (places_[v].beam == beam)
          add_turned(steering_[2 * v * azimuths_ + k], steering_[(2 * v + 1) * azimuths_ + k], re + v * count,
                     im + v * count, count, sum_re.data(), sum_im.data());
      conjugate_product(sum_re.data(), sum_im.data(), sum_re.data(), sum_im.data(), count, power, nothing);
      out[k] += power;
    }
}

}  // namespace greatx::rf
