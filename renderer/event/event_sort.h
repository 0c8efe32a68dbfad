// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts events in order of (t, y, x, p). The GPU writes each step's events row by row, so a stable sort by time alone is
// enough; a radix sort takes one pass over them for each 11 bits of the interval.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace greatx::render {

/// As the GPU writes it.
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

/// Sorts; `scratch` is room to work in. Events of one time must be in order of their pixels beforehand.
template <typename Event>
void sort_events(std::vector<Event>& events, std::vector<Event>& scratch, uint32_t interval_ns) {
  constexpr uint32_t digit_bits = 11;
  const uint32_t bits = static_cast<uint32_t>(std::bit_width(interval_ns));
  scratch.resize(events.size());
  std::array<uint32_t, (1u << digit_bits)> place;
  for (uint32_t shift = 0; shift < bits; shift += digit_bits) {
    const auto digit = [&](const Event& event) { return event.t_ns >> shift & ((1u << digit_bits) - 1); };
    place.fill(0);
    for (const Event& event : events) ++place[digit(event)];
    uint32_t sum = 0;
    for (uint32_t& p : place) sum += std::exchange(p, sum);
    for (const Event& event : events) scratch[place[digit(event)]++] = event;
    events.swap(scratch);
  }
  // A pixel's events of the same nanosecond, one by noise: by polarity.
  for (size_t i = 1; i < events.size(); ++i)
    for (size_t j = i; j > 0 && events[j] < events[j - 1]; --j) std::swap(events[j], events[j - 1]);
}

}  // namespace greatx::render
