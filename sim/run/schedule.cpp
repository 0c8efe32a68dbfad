// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/schedule.h"

#include <algorithm>

namespace greatx::sim {

std::vector<Due> Schedule::due(int64_t tick) const {
  std::vector<Due> all;
  for (uint32_t sensor = 0; sensor < times_.size(); ++sensor)
    if (const int64_t sample = times_[sensor].sample_at(tick); sample >= 0) all.push_back({sensor, sample});
  return all;
}

int64_t Schedule::next(int64_t tick, int64_t end) const {
  int64_t first = end;
  for (const SampleTimes& times : times_)
    first = std::min(first, times.tick_of(times.first_at_or_after(tick)));
  return first;
}

int64_t Schedule::previous(int64_t tick) const {
  int64_t last = -1;
  for (const SampleTimes& times : times_)
    if (const int64_t sample = times.first_at_or_after(tick); sample > 0)
      last = std::max(last, times.tick_of(sample - 1));
  return last;
}

}  // namespace greatx::sim
