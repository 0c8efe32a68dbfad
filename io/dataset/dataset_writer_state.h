// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What is behind DatasetWriter, shared by its three sources and nobody else.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "io/dataset/dataset_writer.h"
#include "io/dataset/manifest.h"
#include "io/dataset/sequence_files.h"
#include "io/dataset/worker_pool.h"
#include "io/files/file.h"

namespace greatx::io {

/// One packet between write() and its commit.
struct Pending {
  Packet packet;
  struct Frame {
    size_t record, output;
    uint64_t size = 0;
    std::string sha256;
  };
  std::vector<Frame> frames;  ///< per record, per output that is one file a frame
  size_t jobs_left = 0;       ///< guarded by DatasetWriter::State::mutex_, as is the next
  std::exception_ptr error;   ///< the first that one of its jobs threw
};

/// See DatasetWriter. Its functions run in the caller's thread, those of a packet after enqueue() in the workers.
class DatasetWriter::State {
 public:
  State(const std::filesystem::path& folder, DatasetInfo info, WriterOptions options);
  ~State();

  // dataset_writer.cpp: sequences, closing, errors
  Position position() const { return {next_sequence_, next_tick_, finished_}; }
  void begin_sequence(uint32_t sequence);
  void flush();
  void end_sequence();
  void finish();
  WriterStats stats() const;

  // dataset_writer_packets.cpp: a packet's way to its commit
  void write(Packet packet);

 private:
  /// Throw UserError for a file of the data set, the frames from `first` on, that are not there as they were written: somebody
  /// else deleted or changed them meanwhile.
  void check_written(const std::string& path, uint64_t size) const;
  void check_frames(size_t first) const;
  void rethrow_error();
  [[noreturn]] void explain(const WriteError& error) const;

  // dataset_writer_open.cpp: the folder, new or resumed; the constructor is there as well
  void prepare_folder();
  void open_existing(const std::string& description);
  void open_journal(uint64_t bytes);
  void recover();

  // dataset_writer_packets.cpp
  void check_packet(const Packet& packet) const;
  void enqueue(const std::shared_ptr<Pending>& pending);
  void run_job(const std::shared_ptr<Pending>& pending, const std::function<void()>& job);
  void check_values(const Pending& pending) const;
  void write_frame(const Pending& pending, Pending::Frame& frame) const;
  void commit_ready(std::unique_lock<std::mutex>& lock);
  void commit(const Pending& pending);
  void append_journal(const std::string& line);

  const std::filesystem::path folder_;
  const DatasetInfo info_;
  const std::string description_;
  const WriterOptions options_;

  // Where the data set stands; changed by commits, which are one at a time, and by the caller between drains.
  File journal_;
  uint64_t journal_bytes_ = 0;
  Manifest manifest_;
  std::vector<IndexRow> rows_;  ///< of the sequence that is open or about to be
  std::vector<int64_t> resumed_records_;
  std::optional<SequenceFiles> files_;
  uint32_t next_sequence_ = 0;
  int64_t next_tick_ = 0;
  bool finished_ = false;
  int64_t last_written_tick_ = -1;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<Pending>> queue_;
  bool committing_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
  WriterStats stats_;
  std::optional<WorkerPool> workers_;  ///< last, so that its threads end before what they use
};

}  // namespace greatx::io
