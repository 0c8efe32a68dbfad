// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/run/schedule.h"

#include <algorithm>

namespace greatx::sim {

void Schedule::add(std::optional<Rational> rate_hz) {
  if (rate_hz)
    times_.emplace_back(SampleTimes(tick_rate_hz_, *rate_hz));
  else
    times_.emplace_back();
}

std::vector<Due> Schedule::due(int64_t tick, int64_t before) const {
  std::vector<Due> all;
  bool any = false;
  for (uint32_t sensor = 0; sensor < times_.size(); ++sensor) {
    const int64_t sample = times_[sensor] ? times_[sensor]->sample_at(tick) : before;
    if (sample < 0) continue;
    all.push_back({sensor, sample});
    any |= times_[sensor].has_value();
  }
  if (!any) all.clear();
  return all;
}

int64_t Schedule::next(int64_t tick, int64_t end) const {
  int64_t first = end;
  for (const std::optional<SampleTimes>& times : times_)
    if (times) first = std::min(first, times->tick_of(times->first_at_or_after(tick)));
  return first;
}

int64_t Schedule::previous(int64_t tick) const {
  int64_t last = -1;
  for (const std::optional<SampleTimes>& times : times_) {
    if (!times) continue;
    if (const int64_t sample = times->first_at_or_after(tick); sample > 0)
      last = std::max(last, times->tick_of(sample - 1));
  }
  return last;
}

int64_t Schedule::last_of(uint32_t sensor, int64_t tick) const {
  const std::optional<SampleTimes>& times = times_.at(sensor);
  if (!times) return previous(tick + 1);
  const int64_t sample = times->first_at_or_after(tick + 1);
  return sample > 0 ? times->tick_of(sample - 1) : -1;
}

}  // namespace greatx::sim
