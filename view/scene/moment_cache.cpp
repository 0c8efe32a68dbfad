// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/scene/moment_cache.h"

namespace greatx::view {

MomentCache::MomentCache(std::shared_ptr<const sim::Experiment> experiment)
    : experiment_(std::move(experiment)), clock_(experiment_->scenario.tick_rate_hz) {}

const sim::Moment& MomentCache::at(uint32_t sequence, int64_t tick) {
  if (courses_ && sequence == sequence_ && tick == tick_) return moment_;
  if (!courses_ || sequence != sequence_)
    courses_.emplace(sim::make_courses(experiment_->scenario, *experiment_->world, sequence));
  moment_ = sim::moment_at(*experiment_->world, *courses_, clock_, tick);
  sequence_ = sequence;
  tick_ = tick;
  return moment_;
}

}  // namespace greatx::view
