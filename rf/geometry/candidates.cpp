// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/geometry/candidates.h"

#include <algorithm>
#include <numeric>

#include "core/error.h"

namespace greatx::rf {

bool sequence_less(std::span<const uint32_t> a, std::span<const uint32_t> b) {
  if (a.size() != b.size()) return a.size() < b.size();
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
}

void CandidateList::add(std::span<const uint32_t> sequence) {
  facets.insert(facets.end(), sequence.begin(), sequence.end());
  offsets.push_back(static_cast<uint32_t>(facets.size()));
}

bool CandidateList::is_canonical() const {
  for (size_t i = 1; i < size(); ++i)
    if (!sequence_less(sequence(i - 1), sequence(i))) return false;
  return true;
}

void CandidateList::make_canonical() {
  if (is_canonical()) return;
  GREATX_CHECK(windows.empty() && wedge_offsets.empty(),
               "{} windows, {} wedge lists would lose their sequence", windows.size(), wedge_offsets.size());
  std::vector<uint32_t> order(size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return sequence_less(sequence(a), sequence(b)); });
  const auto same = [&](uint32_t a, uint32_t b) { return std::ranges::equal(sequence(a), sequence(b)); };
  order.erase(std::unique(order.begin(), order.end(), same), order.end());
  CandidateList sorted;
  sorted.facets.reserve(facets.size());
  sorted.offsets.reserve(order.size() + 1);
  for (const uint32_t index : order) sorted.add(sequence(index));
  *this = std::move(sorted);
}

}  // namespace greatx::rf
