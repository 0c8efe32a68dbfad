// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records pictures into a file on a thread of its own, so that encoding does not hold up the window.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "core/record.h"

namespace greatx::view {

struct RecorderStatus {
  int64_t taken = 0, written = 0;  ///< pictures
  int64_t left_out = 0;            ///< because the encoder was too slow
  uint64_t bytes = 0;              ///< of the file so far; of a WebP only at its end
  bool done = false;               ///< the file is complete, or has failed
  std::string error;               ///< why it has failed; empty: it has not
  std::string note;                ///< why it ended early, although it is complete
};

class Recorder {
 public:
  /// What add() does while too many pictures wait for the encoder.
  enum class WhenFull : uint8_t {
    wait,      ///< every picture is recorded: for scripts
    leave_out  ///< the picture is left out and counted: for a window with a person before it
  };
  /// The bytes of the pictures that may wait. One picture may always wait.
  static constexpr size_t most_waiting_bytes = size_t{192} << 20;

  /// Throws UserError if the file cannot be recorded to (io::check_frame_file()).
  Recorder(std::filesystem::path path, WhenFull when_full, size_t most_bytes = most_waiting_bytes);
  /// Completes the file, which may take a while.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Takes a picture, u8 [height, width, 3], that is shown from `start_ms` on; starts increase, and the first
  /// one is 0. A picture of another size ends the file, unless it is a folder.
  void add(Array rgb, int64_t start_ms);
  /// Ends the recording. Returns at once; the thread writes the rest.
  void stop(int64_t end_ms);
  RecorderStatus status() const;
  /// Waits until the file is complete or has failed, after stop().
  void wait();
  const std::filesystem::path& path() const { return path_; }

 private:
  struct Frame {
    Array rgb;
    int64_t start_ms = 0;
  };
  void work();
  void write_frames();
  /// Waits for a frame. Returns false when none comes any more.
  bool take(Frame& frame);

  std::filesystem::path path_;
  WhenFull when_full_;
  size_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Frame> frames_;
  size_t waiting_bytes_ = 0;
  int64_t last_ms_ = -1, end_ms_ = 0;
  bool stopped_ = false;
  RecorderStatus status_;
  std::thread thread_;
};

}  // namespace greatx::view
