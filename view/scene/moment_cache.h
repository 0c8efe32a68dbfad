// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "sim/experiment/experiment.h"
#include "sim/scenario/clock.h"
#include "sim/world/moment.h"

namespace greatx::view {

/// Computes where everything is at a tick, and keeps the answer for the next time.
class MomentCache {
 public:
  explicit MomentCache(std::shared_ptr<const sim::Experiment> experiment);
  /// Returns the moment, which is valid until the next call.
  const sim::Moment& at(uint32_t sequence, int64_t tick);
  const sim::Experiment& experiment() const { return *experiment_; }

 private:
  std::shared_ptr<const sim::Experiment> experiment_;
  sim::Clock clock_;
  std::optional<sim::Courses> courses_;
  sim::Moment moment_;
  uint32_t sequence_ = 0;
  int64_t tick_ = 0;
};

}  // namespace greatx::view
