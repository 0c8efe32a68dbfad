// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes packets to files. write() checks a packet and hands it to worker threads, which encode, hash and
// write its pictures and clouds. Packets are then committed in their order: their rows are appended to the
// stacks, and last a line goes into the journal. A run that was killed therefore leaves complete packets, and
// `resume` removes whatever lies behind the last one.
//
//   DatasetWriter writer(folder, info, {.resume = true});
//   auto [sequence, tick, finished] = writer.resume_position();
//   for (; sequence < info.sequences; ++sequence, tick = 0) {
//     writer.begin_sequence(sequence);
//     ... writer.write(packet) for the ticks from `tick` on ...
//     writer.end_sequence();
//   }
//   writer.finish();
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "core/record.h"
#include "io/dataset/dataset_format.h"

namespace greatx::io {

struct WriterOptions {
  /// Number of workers; 0 stands for the number of processors. The bytes do not depend on it.
  uint32_t threads = 0;
  bool resume = false;         ///< continue an unfinished data set
  uint32_t queue_packets = 8;  ///< write() blocks while so many packets wait for their commit
  /// The first sequence that the folder gets; those before it are elsewhere (io/dataset/part.h). Such a data
  /// set cannot be finished.
  uint32_t first_sequence = 0;
};

struct WriterStats {
  int64_t packets = 0, records = 0;  ///< committed by this object
  int64_t files = 0;                 ///< files of the whole data set; set by finish()
  uint64_t bytes = 0;                ///< bytes of the whole data set; set by finish()
  double blocked_s = 0.0;            ///< time that write() waited for the workers
};

/// Writes a data set, in order of sequences and ticks.
class DatasetWriter : public RecordSink {
 public:
  /// Creates the folder, or opens an existing data set if `resume` is set. Throws UserError if the folder
  /// cannot be written, holds other files, is in use by another process, or holds a data set without
  /// `resume`. With `resume`, throws UserError if the folder holds a different run; the message lists the
  /// differences.
  DatasetWriter(const std::filesystem::path& folder, DatasetInfo info, WriterOptions options = {});
  /// Commits the packets written so far. Unless finish() was called, the data set stays unfinished and can be
  /// resumed.
  ~DatasetWriter() override;

  struct Position {
    /// Sequence to begin next. If it equals DatasetInfo::sequences, only finish() remains to be called.
    uint32_t sequence = 0;
    int64_t next_tick = 0;  ///< first tick of this sequence whose packet is not yet in the data set
    bool finished = false;  ///< true if the data set is complete
  };
  Position resume_position() const;

  /// Begins a sequence. Sequences must be begun in order, from resume_position().sequence on.
  void begin_sequence(uint32_t sequence);
  /// Checks and queues the packet. Throws the error of this packet or of an earlier one. If the disk is full,
  /// this is a UserError that tells how to continue.
  void write(Packet packet) override;
  /// Waits for all packets, closes the stacks, and writes the exports and the index.
  void end_sequence();
  /// Writes the manifest, which completes the data set. Does nothing if the data set was complete.
  void finish();
  /// Waits until all packets written so far are committed. Throws their first error.
  void flush();

  WriterStats stats() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace greatx::io
