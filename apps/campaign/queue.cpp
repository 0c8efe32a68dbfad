// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/campaign/queue.h"

#include <algorithm>
#include <new>
#include <sys/mman.h>

#include "core/error.h"

namespace greatx::apps {
namespace {

/// The least number of units in a piece of a cell.
constexpr size_t least_piece = 4;

}  // namespace

WorkQueue::WorkQueue(std::vector<CampaignUnit> units, uint32_t takers) : units_(std::move(units)) {
  static_assert(std::atomic<uint32_t>::is_always_lock_free);
  GREATX_CHECK(takers > 0, "a queue without takers");
  void* const memory = ::mmap(nullptr, sizeof(std::atomic<uint32_t>), PROT_READ | PROT_WRITE,
                              MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  taken_ = new (memory) std::atomic<uint32_t>(0);
  if (takers == 1) {
    if (!units_.empty()) ends_.push_back(units_.size());
    return;
  }
  std::vector<size_t> cells;  // where they end
  for (size_t i = 0; i < units_.size(); ++i)
    if (i + 1 == units_.size() || units_[i + 1].cell != units_[i].cell) cells.push_back(i + 1);
  size_t begin = 0;
  for (size_t c = 0; c < cells.size(); ++c) {
    const size_t count = cells[c] - begin;
    const size_t most = c + takers < cells.size() ? 1 : size_t{4} * takers;
    const size_t pieces = std::clamp<size_t>(count / least_piece, 1, most);
    for (size_t piece = 1; piece <= pieces; ++piece) ends_.push_back(begin + piece * count / pieces);
    begin = cells[c];
  }
}

WorkQueue::~WorkQueue() { ::munmap(taken_, sizeof(std::atomic<uint32_t>)); }

std::span<const CampaignUnit> WorkQueue::take() const {
  const size_t range = taken_->fetch_add(1);
  if (range >= ends_.size()) return {};
  const size_t begin = range == 0 ? 0 : ends_[range - 1];
  return std::span(units_).subspan(begin, ends_[range] - begin);
}

}  // namespace greatx::apps
