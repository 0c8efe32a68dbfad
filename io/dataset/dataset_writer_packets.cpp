// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A packet's journey: checked, queued, its files encoded and written by the workers, committed in order.
#include <chrono>

#include "core/hash.h"
#include "io/dataset/dataset_writer_state.h"
#include "io/dataset/journal.h"
#include "io/files/inside.h"
#include "io/formats/exr.h"
#include "io/formats/npy.h"
#include "io/formats/pcd.h"
#include "io/formats/ply.h"
#include "io/formats/png.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

Bytes encode_frame(const SensorSpec& sensor, const OutputSpec& output, const std::vector<Array>& arrays) {
  const std::vector<size_t> indices = arrays_of(sensor, output);
  const Array& first = arrays[indices[0]];
  switch (output.format) {
    case FileFormat::npy_frame:
      return encode_npy(first);
    case FileFormat::png:
      return encode_png(first);
    case FileFormat::png_depth24:
      return encode_png_depth24(first);
    case FileFormat::exr:
      return encode_exr(first);
    case FileFormat::kitti:
      return encode_kitti(first);
    case FileFormat::pcd:
    case FileFormat::ply: {
      std::vector<const Array*> columns;
      for (const size_t i : indices) columns.push_back(&arrays[i]);
      return output.format == FileFormat::ply ? encode_ply(output.arrays, columns)
                                              : encode_pcd(output.arrays, columns);
    }
    default:
      GREATX_CHECK(false, "{} is no format of frames", name_of(output.format));
  }
  return {};
}

void check_array(const SensorSpec& sensor, const ArraySpec& spec, const Array& array) {
  bool fits = array.dtype == spec.dtype && array.shape.size() == spec.shape.size();
  for (size_t i = 0; fits && i < spec.shape.size(); ++i)
    fits = array.shape[i] == spec.shape[i] || (i == 0 && spec.shape[0] < 0 && array.shape[0] >= 0);
  GREATX_CHECK(fits, "{}: {} is {} [{}], declared as {} [{}]", sensor.name, spec.name,
               numpy_name(array.dtype), fmt::join(array.shape, ", "), numpy_name(spec.dtype),
               fmt::join(spec.shape, ", "));
  GREATX_CHECK(array.bytes.size() == static_cast<size_t>(array.element_count()) * size_of(array.dtype),
               "{}: {} has {} bytes", sensor.name, spec.name, array.bytes.size());
}

}  // namespace

void DatasetWriter::State::check_packet(const Packet& packet) const {
  GREATX_CHECK(files_, "no sequence was begun");
  GREATX_CHECK(packet.tick > last_written_tick_, "tick {} after {}", packet.tick, last_written_tick_);
  int64_t last_sensor = -1;
  for (const Record& record : packet.records) {
    GREATX_CHECK(record.sensor < info_.sensors.size() && record.sensor > last_sensor, "sensor {} after {}",
                 record.sensor, last_sensor);
    last_sensor = record.sensor;
    const SensorSpec& sensor = info_.sensors[record.sensor];
    GREATX_CHECK(record.tick == packet.tick && record.time_ns == packet.time_ns && record.sample >= 0,
                 "{}: record of tick {} ({} ns) in the packet of tick {} ({} ns)", sensor.name, record.tick,
                 record.time_ns, packet.tick, packet.time_ns);
    GREATX_CHECK(record.arrays.size() == sensor.arrays.size(), "{}: {} arrays, declared {}", sensor.name,
                 record.arrays.size(), sensor.arrays.size());
    for (size_t i = 0; i < record.arrays.size(); ++i) check_array(sensor, sensor.arrays[i], record.arrays[i]);
  }
}

void DatasetWriter::State::write(Packet packet) {
  rethrow_error();
  check_packet(packet);
  last_written_tick_ = packet.tick;
  if (packet.records.empty()) return;
  auto pending = std::make_shared<Pending>();
  pending->packet = std::move(packet);
  const std::vector<Record>& records = pending->packet.records;
  for (size_t r = 0; r < records.size(); ++r) {
    const std::vector<OutputSpec>& outputs = info_.sensors[records[r].sensor].outputs;
    for (size_t o = 0; o < outputs.size(); ++o)
      if (is_frame(outputs[o].format)) pending->frames.push_back({r, o, 0, {}});
  }
  enqueue(pending);
}

void DatasetWriter::State::enqueue(const std::shared_ptr<Pending>& pending) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failed_ || queue_.size() < options_.queue_packets; });
  stats_.blocked_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (failed_) {
    lock.unlock();
    rethrow_error();
  }
  pending->jobs_left = pending->frames.size() + 1;
  queue_.push_back(pending);
  lock.unlock();
  workers_->submit([this, pending] { run_job(pending, [&] { check_values(*pending); }); });
  for (Pending::Frame& frame : pending->frames)
    workers_->submit([this, pending, &frame] { run_job(pending, [&] { write_frame(*pending, frame); }); });
}

void DatasetWriter::State::run_job(const std::shared_ptr<Pending>& pending,
                                   const std::function<void()>& job) {
  std::exception_ptr error;
  if (!failed_) {
    try {
      job();
    } catch (...) {
      error = std::current_exception();
    }
  }
  std::unique_lock lock(mutex_);
  if (error && !pending->error) pending->error = error;
  --pending->jobs_left;
  commit_ready(lock);
  changed_.notify_all();
}

void DatasetWriter::State::check_values(const Pending& pending) const {
  for (const Record& record : pending.packet.records) {
    const SensorSpec& sensor = info_.sensors[record.sensor];
    for (size_t i = 0; i < record.arrays.size(); ++i) {
      const std::string bad = find_bad_value(sensor, sensor.arrays[i], record.arrays[i]);
      GREATX_CHECK(bad.empty(), "{}, tick {}, sample {}: {}", sensor.name, record.tick, record.sample, bad);
    }
  }
}

void DatasetWriter::State::write_frame(const Pending& pending, Pending::Frame& frame) const {
  const Record& record = pending.packet.records[frame.record];
  const SensorSpec& sensor = info_.sensors[record.sensor];
  const OutputSpec& output = sensor.outputs[frame.output];
  const fs::path path = inside(folder_, frame_path(next_sequence_, sensor, output, record.sample));
  Bytes bytes;
  try {
    bytes = encode_frame(sensor, output, record.arrays);
  } catch (const UserError& error) {
    throw_user_error("{}: {}", path.string(), error.what());
  }
  frame.size = bytes.size();
  frame.sha256 = sha256_hex(bytes);
  write_file_atomically(path, bytes);
}

/// Commits the packets at the head of the queue that are complete. Any worker may do it, one at a time. Packets before
/// one that failed are still committed, those behind it are not.
void DatasetWriter::State::commit_ready(std::unique_lock<std::mutex>& lock) {
  if (committing_) return;
  committing_ = true;
  while (!queue_.empty() && queue_.front()->jobs_left == 0) {
    const std::shared_ptr<Pending> pending = queue_.front();
    if (!failed_) {
      std::exception_ptr error = pending->error;
      if (!error) {
        lock.unlock();
        try {
          commit(*pending);
        } catch (...) {
          error = std::current_exception();
        }
        lock.lock();
      }
      if (error) {
        error_ = error;
        failed_ = true;
      } else {
        ++stats_.packets;
        stats_.records += static_cast<int64_t>(pending->packet.records.size());
      }
    }
    queue_.pop_front();
    changed_.notify_all();
  }
  committing_ = false;
  changed_.notify_all();
}

void DatasetWriter::State::commit(const Pending& pending) {
  const Packet& packet = pending.packet;
  JournalPacket line{next_sequence_, packet.tick, packet.time_ns, {}, {}};
  for (const Record& record : packet.records) {
    rows_.push_back(
        {packet.tick, packet.time_ns, record.sensor, record.sample, files_->records_of(record.sensor)});
    files_->append(record);
    ++manifest_.records_per_sensor[record.sensor];
    line.records.push_back({record.sensor, record.sample});
  }
  for (const Pending::Frame& frame : pending.frames) {
    const Record& record = packet.records[frame.record];
    manifest_.add_frame(
        {next_sequence_, record.sensor, static_cast<uint32_t>(frame.output), record.sample, frame.size},
        frame.sha256);
    line.frames.push_back({frame.size, frame.sha256});
  }
  append_journal(journal_line(line));
  ++manifest_.packets;
  next_tick_ = packet.tick + 1;
}

void DatasetWriter::State::append_journal(const std::string& line) {
  journal_.check_untouched(journal_bytes_);
  journal_.write_at(journal_bytes_, bytes_of(line));
  journal_bytes_ += line.size();
}

}  // namespace greatx::io
