// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/random_process.h"

#include <cmath>

#include "core/error.h"
#include "core/hash.h"
#include "core/units.h"
#include "shaders/shared/random.h"

namespace greatx::navigation {

namespace {

/// Sets these streams apart from RandomStream, whose last word is another.
constexpr uint32_t navigation_word = 0x6e617669u;

}  // namespace

StreamKey::StreamKey(uint64_t seed_, std::string_view name, uint32_t sequence_)
    : seed(seed_), stream(fnv1a32(name)), sequence(sequence_) {}

double NormalStream::at(uint64_t index) const {
  const uint64_t block = index / 2;
  const glm::uvec4 counter(static_cast<uint32_t>(block), key_.stream, key_.sequence,
                           navigation_word ^ static_cast<uint32_t>(block >> 32));
  const glm::uvec4 word = shared::philox4x32(
      counter, glm::uvec2(static_cast<uint32_t>(key_.seed), static_cast<uint32_t>(key_.seed >> 32)));
  const auto uniform = [](uint32_t low, uint32_t high) {
    const uint64_t bits = (static_cast<uint64_t>(high) << 32) | low;
    return static_cast<double>(bits >> 11) * 0x1.0p-53;
  };
  // 1 - u is in (0, 1], so that the logarithm is finite.
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(word.x, word.y)));
  const double angle = 2.0 * pi * uniform(word.z, word.w);
  return radius * (index % 2 == 0 ? std::cos(angle) : std::sin(angle));
}

GaussMarkov::GaussMarkov(const StreamKey& key, double sigma, double time_s, double step_s)
    : normal_(key),
      sigma_(sigma),
      keep_(std::exp(-step_s / time_s)),
      drive_(sigma * std::sqrt(-std::expm1(-2.0 * step_s / time_s))) {
  GREATX_CHECK(sigma >= 0.0 && time_s > 0.0 && step_s > 0.0, "sigma {}, time {} s, step {} s", sigma, time_s,
               step_s);
}

double GaussMarkov::at(int64_t sample) {
  GREATX_CHECK(sample >= 0, "sample {}", sample);
  if (sigma_ == 0.0) return 0.0;
  if (sample_ < 0 || sample < sample_) {
    sample_ = 0;
    value_ = sigma_ * normal_.at(0);
  }
  while (sample_ < sample) value_ = keep_ * value_ + drive_ * normal_.at(static_cast<uint64_t>(++sample_));
  return value_;
}

RandomWalk::RandomWalk(const StreamKey& key, double density, double step_s)
    : normal_(key), step_(density * std::sqrt(step_s)) {
  GREATX_CHECK(density >= 0.0 && step_s > 0.0, "density {}, step {} s", density, step_s);
}

double RandomWalk::at(int64_t sample) {
  GREATX_CHECK(sample >= 0, "sample {}", sample);
  if (step_ == 0.0) return 0.0;
  if (sample < sample_) {
    sample_ = 0;
    value_ = 0.0;
  }
  while (sample_ < sample) value_ += step_ * normal_.at(static_cast<uint64_t>(++sample_));
  return value_;
}

}  // namespace greatx::navigation
