// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the sums of errors have in common. Inside of sim/tradeoff/error.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sim/tradeoff/error/error_sum.h"

namespace greatx::sim {

/// Keeps samples for quantiles in bounded memory. Beyond `most` it keeps every second one, then every fourth
/// one, and so on, in the order in which they came. The rank of a quantile of n kept samples is then
/// uncertain by about 1/sqrt(n): 0.1 % for a million.
class Samples {
 public:
  void add(double value) {
    if (seen_++ % stride_ != 0) return;
    values_.push_back(static_cast<float>(value));
    if (values_.size() < most) return;
    for (size_t i = 0; i < most / 2; ++i) values_[i] = values_[2 * i];
    values_.resize(most / 2);
    stride_ *= 2;
  }
  bool empty() const { return values_.empty(); }
  double quantile(double share) const {
    std::vector<float> values = values_;
    const auto place = values.begin() + static_cast<std::ptrdiff_t>(share * double(values.size() - 1) + 0.5);
    std::nth_element(values.begin(), place, values.end());
    return static_cast<double>(*place);
  }

 private:
  static constexpr size_t most = size_t{1} << 20;
  uint64_t seen_ = 0, stride_ = 1;
  std::vector<float> values_;
};

/// Returns the array of a name; null if the sensor does not deliver it.
const Array* array_of(const SensorSpec& spec, const Record& record, std::string_view name);

/// The same array of both records.
struct ArrayPair {
  const Array *reference = nullptr, *got = nullptr;
  /// Whether both are there, of one type and of one shape.
  explicit operator bool() const {
    return reference != nullptr && got != nullptr && reference->dtype == got->dtype &&
           reference->shape == got->shape;
  }
};

std::unique_ptr<ErrorSum> make_csi_error();
std::unique_ptr<ErrorSum> make_camera_error();
std::unique_ptr<ErrorSum> make_event_error();
std::unique_ptr<ErrorSum> make_lidar_error();
std::unique_ptr<ErrorSum> make_radar_error();
std::unique_ptr<ErrorSum> make_map_error();

}  // namespace greatx::sim
