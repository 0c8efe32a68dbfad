// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What benchmarks measure with.
#pragma once

#include <algorithm>
#include <chrono>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/record.h"

namespace greatx::apps {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}
inline double milliseconds_since(Clock::time_point begin) { return 1e3 * seconds_since(begin); }

/// Takes packets and keeps none.
struct Discard : RecordSink {
  void write(Packet) override {}
};

/// Count, least, median and largest of samples.
inline nlohmann::json distribution(std::vector<double> samples) {
  if (samples.empty()) return {{"count", 0}};
  std::sort(samples.begin(), samples.end());
  return {{"count", samples.size()},
          {"min", samples.front()},
          {"median", samples[samples.size() / 2]},
          {"max", samples.back()}};
}

}  // namespace greatx::apps
