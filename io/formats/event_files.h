// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the events of one sensor and sequence in formats of other tools: DSEC's HDF5 and v2e's text.
#pragma once

#include <filesystem>
#include <functional>

#include "io/formats/npy.h"

namespace greatx::io {

/// Gives the events of a sequence, in order of time, piece by piece: t i64 ns, x u16, y u16, and p u8, which
/// is 1 for brighter.
class EventArrays {
 public:
  struct Piece {
    int64_t first = 0;  ///< index of the first event of the piece
    Array t, x, y, p;
    int64_t size() const { return t.shape[0]; }
  };
  virtual ~EventArrays() = default;
  virtual int64_t size() const = 0;
  /// Calls visit(piece) for each piece in order.
  virtual void for_each_piece(const std::function<void(const Piece&)>& visit) const = 0;
  /// Returns the file with the times, for messages.
  virtual const std::filesystem::path& file() const = 0;

 protected:
  EventArrays() = default;
  EventArrays(const EventArrays&) = default;
  EventArrays& operator=(const EventArrays&) = default;
};

/// Reads the events from .npy files.
class NpyEvents : public EventArrays {
 public:
  /// Throws UserError if a file does not hold an array of its type, or if the lengths differ.
  NpyEvents(const std::filesystem::path& t, const std::filesystem::path& x, const std::filesystem::path& y,
            const std::filesystem::path& p);
  int64_t size() const override { return t_.rows(); }
  void for_each_piece(const std::function<void(const Piece&)>& visit) const override;
  const std::filesystem::path& file() const override { return file_; }

 private:
  std::filesystem::path file_;
  NpyFile t_, x_, y_, p_;
};

/// Writes events in DSEC's layout (M. Gehrig et al., "DSEC", RA-L 2021): /events/t u32 microseconds, rounded
/// down, /events/x u16, /events/y u16, /events/p u8, /ms_to_idx u64, /t_offset i64 microseconds (0, because
/// times count from the sequence's first tick). ms_to_idx[m] is the index of the first event at or after m
/// milliseconds; the last entry is the number of events. The same events give the same bytes, because the
/// file holds no time of day and is not compressed. Throws WriteError, or UserError if a time does not fit
/// into 32 bits.
void write_hdf5_events(const std::filesystem::path& file, const EventArrays& events);

/// Writes a line that begins with '#', then one line "t x y p" per event. t is in seconds with nine decimals,
/// which is exact. Throws WriteError.
void write_text_events(const std::filesystem::path& file, const EventArrays& events);

}  // namespace greatx::io
