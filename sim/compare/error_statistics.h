// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace greatx::sim {

/// Collects relative errors: their number, the largest, and quantiles, in constant memory.
class ErrorStatistics {
 public:
  void add(double error) {
    ++count_;
    max_ = std::max(max_, error);
    ++buckets_[bucket_of(error)];
  }
  void add(const ErrorStatistics& other) {
    count_ += other.count_;
    max_ = std::max(max_, other.max_);
    for (size_t i = 0; i < buckets_.size(); ++i) buckets_[i] += other.buckets_[i];
  }
  uint64_t count() const { return count_; }
  double max() const { return max_; }
  /// Returns an upper bound of the `share` quantile, at most 26 % above it (ten buckets a decade); 0 if no
  /// error was added.
  double quantile(double share) const {
    const double wanted = share * static_cast<double>(count_);
    uint64_t below = 0;
    for (size_t i = 0; i < buckets_.size(); ++i) {
      below += buckets_[i];
      if (buckets_[i] > 0 && static_cast<double>(below) >= wanted) return std::min(max_, upper_end(i));
    }
    return max_;
  }

 private:
  static constexpr int per_decade = 10, lowest_decade = -18, decades = 20;
  static size_t bucket_of(double error) {
    if (!(error > 0.0)) return 0;
    const double position = (std::log10(error) - lowest_decade) * per_decade;
    return static_cast<size_t>(
        std::clamp(std::ceil(position), 0.0, static_cast<double>(per_decade * decades)));
  }
  static double upper_end(size_t bucket) {
    return std::pow(10.0, lowest_decade + static_cast<double>(bucket) / per_decade);
  }

  uint64_t count_ = 0;
  double max_ = 0.0;
  std::array<uint64_t, per_decade * decades + 1> buckets_{};
};

}  // namespace greatx::sim
