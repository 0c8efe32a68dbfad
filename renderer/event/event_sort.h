// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts events in order of (t, y, x, p). The GPU writes the events of each step row by row, so a stable sort
// by time is enough. A radix sort takes one pass over them for each 13 bits of the interval.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace greatx::render {

/// Describes an event as the GPU writes it.
struct ListedEvent {
  uint32_t t_ns;
  uint32_t place;  ///< row << 15 | column << 1 | p
  friend bool operator<(const ListedEvent& a, const ListedEvent& b) {
    return a.t_ns != b.t_ns ? a.t_ns < b.t_ns : a.place < b.place;
  }
};
struct ListedEventOfInstance : ListedEvent {
  uint32_t instance;
};

/// Sorts events and keeps its memory from one interval to the next.
template <typename Event>
class EventSorter {
 public:
  /// Events of one time must be in order of their pixels beforehand. No event is later than interval_ns.
  void sort(std::span<const Event> events, uint32_t interval_ns) {
    const auto bits = static_cast<uint32_t>(std::bit_width(interval_ns | 1u));
    const uint32_t passes = (bits + most_digit_bits - 1) / most_digit_bits,
                   digit = (bits + passes - 1) / passes;
    const uint32_t mask = (1u << digit) - 1;
    places_.assign(size_t{passes} << digit, 0);
    for (const Event& event : events)
      for (uint32_t pass = 0; pass < passes; ++pass)
        ++places_[(pass << digit) + (event.t_ns >> pass * digit & mask)];
    std::span<const Event> from = events;
    for (uint32_t pass = 0; pass < passes; ++pass) {
      uint32_t* const place = &places_[pass << digit];
      uint32_t sum = 0;
      for (uint32_t i = 0; i <= mask; ++i) sum += std::exchange(place[i], sum);
      scratch_.resize(events.size());
      for (const Event& event : from) scratch_[place[event.t_ns >> pass * digit & mask]++] = event;
      sorted_.swap(scratch_);
      from = sorted_;
    }
    // Two events of a pixel in the same nanosecond, of which one is noise, are ordered by polarity.
    for (size_t i = 1; i < sorted_.size(); ++i)
      for (size_t j = i; j > 0 && sorted_[j] < sorted_[j - 1]; --j) std::swap(sorted_[j], sorted_[j - 1]);
  }
  const std::vector<Event>& sorted() const { return sorted_; }

 private:
  static constexpr uint32_t most_digit_bits = 13;  ///< counters of a pass stay in the nearest cache
  std::vector<Event> sorted_, scratch_;
  std::vector<uint32_t> places_;
};

}  // namespace greatx::render
