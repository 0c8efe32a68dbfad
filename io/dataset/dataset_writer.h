// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Packets to files. write() checks the packet and hands it to worker threads, which encode, hash and write
// its pictures and clouds; packets are then committed in their order: stacks are appended, and last a line
// goes into the journal. So a killed run leaves whole packets, and `resume` cuts away what is beyond the last
// one.
//
//   DatasetWriter writer(folder, info, {.resume = true});
//   for (auto [sequence, tick, finished] = writer.resume_position(); sequence < info.sequences; ++sequence,
// tick = 0) {
//     writer.begin_sequence(sequence);
//     ... writer.write(packet) from `tick` on ...
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
  uint32_t threads =
      0;                ///< workers; 0: as many as the machine has processors. The bytes do not depend on it.
  bool resume = false;  ///< go on with an unfinished data set
  uint32_t queue_packets = 8;  ///< write() blocks while so many packets are on their way
};

struct WriterStats {
  int64_t packets = 0, records = 0;  ///< committed by this object
  int64_t files = 0;                 ///< of the whole data set, once finished
  uint64_t bytes = 0;                ///< likewise
  double blocked_s = 0.0;            ///< time that write() waited for the workers
};

class DatasetWriter : public RecordSink {
 public:
  /// Makes the folder, or opens it if `resume`. Throws UserError if it cannot be written, holds other files,
  /// holds a finished data set (without `resume`), is in use by another process, or holds a different run;
  /// the message then lists what differs.
  DatasetWriter(const std::filesystem::path& folder, DatasetInfo info, WriterOptions options = {});
  /// Commits what was written so far; the data set stays unfinished and can be resumed unless finish() was
  /// called.
  ~DatasetWriter() override;

  struct Position {
    uint32_t sequence = 0;  ///< to begin with; == DatasetInfo::sequences: only finish() is left
    int64_t next_tick = 0;  ///< the first tick of it whose packet is not yet in the data set
    bool finished = false;  ///< the data set is complete, there is nothing to do
  };
  Position resume_position() const;

  /// In order, from resume_position().sequence on.
  void begin_sequence(uint32_t sequence);
  /// Throws what went wrong with this packet or one before it. A full disk is a UserError that says how to go
  /// on.
  void write(Packet packet) override;
  /// Waits for all packets, closes the stacks, writes the index.
  void end_sequence();
  /// Writes the manifest: from then on the data set is complete. Does nothing if it was.
  void finish();
  /// Waits until everything written so far is committed.
  void flush();

  WriterStats stats() const;

 private:
  class State;
  std::unique_ptr<State> state_;
};

}  // namespace greatx::io
