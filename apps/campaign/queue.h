// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Hands the units of a run to the processes that share it.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "apps/campaign/store.h"

namespace greatx::apps {

/// Units in ranges. Each range goes to one taker: the processes that are forked after this is made share what
/// is taken. To begin a cell costs as much as some ticks, so a range is a whole cell; but the last cells, one
/// for each taker, are split, so that all takers end at about the same time.
class WorkQueue {
 public:
  /// `takers`: the number of processes, from 1 on. A single one gets everything as one range.
  WorkQueue(std::vector<CampaignUnit> units, uint32_t takers);
  ~WorkQueue();
  WorkQueue(const WorkQueue&) = delete;
  WorkQueue& operator=(const WorkQueue&) = delete;
  /// Takes the next range; an empty one: nothing is left.
  std::span<const CampaignUnit> take() const;
  const std::vector<CampaignUnit>& units() const { return units_; }
  size_t ranges() const { return ends_.size(); }

 private:
  std::vector<CampaignUnit> units_;
  std::vector<size_t> ends_;                ///< of the ranges in units_
  std::atomic<uint32_t>* taken_ = nullptr;  ///< in memory that forked processes share
};

}  // namespace greatx::apps
