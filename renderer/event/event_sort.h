// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts events in order of (t, y, x, p). The GPU writes the events of each step row by row, so a stable sort
// by time is enough. One pass deals the events out to parts of the interval, and a radix sort puts each part
// in order while it lies in the nearest cache.
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
  /// Calls take(part) for spans of events that follow each other in order.
  template <typename Take>
  void sort(std::span<const Event> events, uint32_t interval_ns, const Take& take) {
    const auto bits = static_cast<uint32_t>(std::bit_width(interval_ns | 1u)),
               wanted = static_cast<uint32_t>(std::bit_width(events.size() / part_events));
    const uint32_t part_bits = std::min({wanted, bits - 1, most_digit_bits}), left = bits - part_bits;
    deal_out(events, left, size_t{1} << part_bits);
    for (size_t part = 0, first = 0; part < size_t{1} << part_bits; ++part) {
      const size_t count = ends_[part] - first;
      if (count > 0) take(std::span<const Event>(sort_part(dealt_.data() + first, count, left), count));
      first += count;
    }
  }

 private:
  static constexpr size_t part_events = 1024;
  static constexpr uint32_t most_digit_bits = 10;  ///< counters and a part stay in the nearest cache

  static Event* room(std::vector<Event>& memory, size_t count) {
    if (memory.size() < count) memory.resize(count);
    return memory.data();
  }

  /// Writes the events to dealt_, part by part. ends_ then holds the end of each part.
  void deal_out(std::span<const Event> events, uint32_t shift, size_t parts) {
    ends_.assign(parts, 0);
    uint32_t* const at = ends_.data();
    for (const Event& event : events) ++at[event.t_ns >> shift];
    uint32_t sum = 0;
    for (size_t part = 0; part < parts; ++part) sum += std::exchange(at[part], sum);
    Event* const to = room(dealt_, events.size());
    for (const Event& event : events) to[at[event.t_ns >> shift]++] = event;
  }

  /// Sorts by the lowest `bits` of the time, in equal digits. Returns the place of the sorted events.
  const Event* sort_part(Event* events, size_t count, uint32_t bits) {
    const uint32_t passes = (bits + most_digit_bits - 1) / most_digit_bits,
                   digit = (bits + passes - 1) / passes, mask = (1u << digit) - 1;
    Event *from = events, *to = room(scratch_, count);
    digits_.assign(size_t{passes} << digit, 0);
    uint32_t* const digits = digits_.data();
    for (size_t i = 0; i < count; ++i)
      for (uint32_t pass = 0; pass < passes; ++pass)
        ++digits[(pass << digit) + (events[i].t_ns >> pass * digit & mask)];
    for (uint32_t pass = 0; pass < passes; ++pass) {
      uint32_t* const place = digits + (size_t{pass} << digit);
      uint32_t sum = 0;
      for (uint32_t i = 0; i <= mask; ++i) sum += std::exchange(place[i], sum);
      for (size_t i = 0; i < count; ++i) to[place[from[i].t_ns >> pass * digit & mask]++] = from[i];
      std::swap(from, to);
    }
    // Two events of a pixel in the same nanosecond, of which one is noise, are ordered by polarity.
    for (size_t i = 1; i < count; ++i)
      for (size_t j = i; j > 0 && from[j] < from[j - 1]; --j) std::swap(from[j], from[j - 1]);
    return from;
  }

  std::vector<Event> dealt_, scratch_;
  std::vector<uint32_t> ends_, digits_;
};

}  // namespace greatx::render
