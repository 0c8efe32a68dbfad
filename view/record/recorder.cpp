// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/record/recorder.h"

#include <algorithm>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "core/activity.h"
#include "core/error.h"
#include "io/video/frame_file.h"

namespace greatx::view {

namespace {

constexpr int64_t last_frame_ms = 100;  ///< if nobody says how long it is shown

}  // namespace

Recorder::Recorder(std::filesystem::path path, WhenFull when_full, size_t most_bytes)
    : path_(std::move(path)), when_full_(when_full), most_bytes_(most_bytes) {
  io::check_frame_file(path_);
  thread_ = std::thread([this] { work(); });
}

Recorder::~Recorder() {
  stop(0);
  thread_.join();
}

void Recorder::add(Array rgb, int64_t start_ms) {
  std::unique_lock lock(mutex_);
  const auto fits = [&] { return frames_.empty() || waiting_bytes_ + rgb.bytes.size() <= most_bytes_; };
  if (when_full_ == WhenFull::wait) changed_.wait(lock, [&] { return fits() || stopped_ || status_.done; });
  if (stopped_ || status_.done) return;
  GREATX_CHECK(start_ms > last_ms_, "a picture at {} ms after one at {} ms", start_ms, last_ms_);
  if (!fits()) {
    ++status_.left_out;
    return;
  }
  // The first picture that is recorded begins at 0, even if those before it were left out.
  last_ms_ = status_.taken == 0 ? 0 : start_ms;
  ++status_.taken;
  waiting_bytes_ += rgb.bytes.size();
  frames_.push_back({std::move(rgb), last_ms_});
  changed_.notify_all();
}

void Recorder::stop(int64_t end_ms) {
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  stopped_ = true;
  end_ms_ = std::max(end_ms, last_ms_ + 1);
  if (end_ms <= last_ms_) end_ms_ = last_ms_ + last_frame_ms;
  changed_.notify_all();
}

RecorderStatus Recorder::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

void Recorder::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return status_.done; });
}

bool Recorder::take(Frame& frame) {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopped_ || !frames_.empty(); });
  if (frames_.empty()) return false;
  frame = std::move(frames_.front());
  frames_.pop_front();
  waiting_bytes_ -= frame.rgb.bytes.size();
  changed_.notify_all();
  return true;
}

void Recorder::work() {
  std::string error;
  try {
    write_frames();
  } catch (const std::bad_alloc&) {
    error = out_of_memory();
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  const std::lock_guard lock(mutex_);
  status_.done = true;
  status_.error = std::move(error);
  frames_.clear();
  changed_.notify_all();
}

void Recorder::write_frames() {
  std::unique_ptr<io::FrameFile> file;
  std::vector<int64_t> shape;
  int64_t end_ms = 0;
  for (Frame frame; take(frame);) {
    if (file == nullptr) {
      shape = frame.rgb.shape;
      file = io::open_frame_file(path_, static_cast<int>(shape.at(1)), static_cast<int>(shape.at(0)));
    } else if (frame.rgb.shape != shape && !file->takes_any_size()) {
      const std::lock_guard lock(mutex_);
      status_.note = "the window's size has changed, so the recording has ended";
      end_ms = frame.start_ms;
      break;
    }
    file->add(frame.rgb, frame.start_ms);
    const std::lock_guard lock(mutex_);
    ++status_.written;
    status_.bytes = file->bytes();
  }
  if (file == nullptr) throw_user_error("{}: nothing was recorded", path_.string());
  if (end_ms == 0) {
    const std::lock_guard lock(mutex_);
    end_ms = end_ms_;
  }
  file->finish(end_ms);
  const std::lock_guard lock(mutex_);
  status_.bytes = file->bytes();
}

}  // namespace greatx::view
