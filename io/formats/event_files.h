// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Events of one sensor and sequence as other tools read them: DSEC's HDF5, v2e's text.
#pragma once

#include <algorithm>
#include <filesystem>
#include <utility>

#include "io/formats/npy.h"

namespace greatx::io {

/// A sequence's events in order of time, read from .npy files piece by piece: t i64 ns, x u16, y u16, p u8
/// (1: brighter).
class EventArrays {
 public:
  /// Throws UserError if a file is no array of its type or they differ in length.
  EventArrays(const std::filesystem::path& t, const std::filesystem::path& x, const std::filesystem::path& y,
              const std::filesystem::path& p);
  int64_t size() const { return t_.rows(); }

  struct Piece {
    int64_t first = 0;  ///< index of its first event
    Array t, x, y, p;
    int64_t size() const { return t.shape[0]; }
  };
  /// Calls visit(piece) for one piece after the other.
  template <typename Visit>
  void for_each_piece(Visit&& visit) const {
    constexpr int64_t piece = 1 << 20;
    for (int64_t first = 0; first < size(); first += piece) {
      const int64_t last = std::min(first + piece, size());
      visit(Piece{first, t_.read_rows(first, last), x_.read_rows(first, last), y_.read_rows(first, last),
                  p_.read_rows(first, last)});
    }
  }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  NpyFile t_, x_, y_, p_;
};

/// DSEC's layout (M. Gehrig et al., "DSEC", RA-L 2021): /events/t u32 microseconds, rounded down, /events/x
/// u16, /events/y u16, /events/p u8, /ms_to_idx u64, /t_offset i64 microseconds (0: times count from the
/// sequence's first tick). ms_to_idx[ms] is the first event with t >= 1000 ms; its last entry is the number
/// of events. The same events give the same bytes: no times of day, no compression. Throws WriteError, or
/// UserError if a time is beyond 32 bits.
void write_hdf5_events(const std::filesystem::path& file, const EventArrays& events);

/// A line beginning with '#', then "t x y p" for each event: t in seconds with nine decimals, exact. Throws
/// WriteError.
void write_text_events(const std::filesystem::path& file, const EventArrays& events);

}  // namespace greatx::io
