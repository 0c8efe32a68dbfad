// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/dataset_writer.h"

#include <algorithm>

#include <spdlog/spdlog.h>

#include "core/hash.h"
#include "io/dataset/dataset_writer_state.h"
#include "io/dataset/journal.h"
#include "io/dataset/sequence_exports.h"
#include "io/files/inside.h"

namespace greatx::io {

namespace fs = std::filesystem;

void DatasetWriter::State::begin_sequence(uint32_t sequence) {
  GREATX_CHECK(!finished_ && !files_ && sequence == next_sequence_ && sequence < info_.sequences,
               "sequence {} of {}, next is {}", sequence, info_.sequences, next_sequence_);
  try {
    files_.emplace(folder_, info_, sequence, resumed_records_);
  } catch (const WriteError& error) {
    explain(error);
  }
  last_written_tick_ = next_tick_ - 1;
}

void DatasetWriter::State::flush() {
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return queue_.empty() && !committing_; });
  }
  rethrow_error();
}

void DatasetWriter::State::end_sequence() {
  GREATX_CHECK(files_, "no sequence was begun");
  flush();
  try {
    std::vector<FileEntry> entries(files_->file_count());
    workers_->for_each(entries.size(), [&](size_t i) { entries[i] = files_->seal(i); });
    const std::vector<FileEntry> exports = export_sequence(folder_, info_, next_sequence_);
    entries.insert(entries.end(), exports.begin(), exports.end());
    files_->publish();
    for (const FileEntry& file : exports) rename_file(part_name(folder_ / file.path), folder_ / file.path);
    const Bytes npy = index_npy(rows_);
    const std::string csv = index_csv(info_, rows_);
    write_file_atomically(inside(folder_, index_path(next_sequence_, "npy")), npy);
    write_file_atomically(inside(folder_, index_path(next_sequence_, "csv")), csv);
    entries.push_back({index_path(next_sequence_, "npy"), npy.size(), sha256_hex(npy)});
    entries.push_back({index_path(next_sequence_, "csv"), csv.size(), sha256_hex(bytes_of(csv))});
    // The frames of this sequence are the last ones.
    size_t first = manifest_.frames.size();
    while (first > 0 && manifest_.frames[first - 1].sequence == next_sequence_) --first;
    check_frames(first);
    append_journal(journal_line(JournalEnd{next_sequence_, entries}));
    manifest_.files.insert(manifest_.files.end(), entries.begin(), entries.end());
  } catch (const WriteError& error) {
    explain(error);
  }
  files_.reset();
  rows_.clear();
  std::fill(resumed_records_.begin(), resumed_records_.end(), 0);
  ++next_sequence_;
  next_tick_ = 0;
}

void DatasetWriter::State::finish() {
  if (finished_) return;
  GREATX_CHECK(!files_ && next_sequence_ == info_.sequences, "sequence {} of {}", next_sequence_,
               info_.sequences);
  try {
    for (const FileEntry& file : manifest_.files) check_written(file.path, file.size);
    check_frames(0);
    const auto [files, bytes] = write_manifest(folder_, info_, manifest_);
    stats_.files = files;
    stats_.bytes = bytes;
  } catch (const WriteError& error) {
    explain(error);
  }
  std::error_code ignored;  // one that stays is reported by verify and removed by --resume
  fs::remove(folder_ / journal_file, ignored);
  journal_ = File();
  finished_ = true;
}

void DatasetWriter::State::check_written(const std::string& path, uint64_t size) const {
  const std::optional<uint64_t> found = size_inside(folder_, path);
  if (!found)
    throw_user_error("{}: was deleted while the data set was being written", (folder_ / path).string());
  if (*found != size)
    throw_user_error("{}: expected {} bytes, found {}: it was changed while the data set was being written",
                     (folder_ / path).string(), size, *found);
}

void DatasetWriter::State::check_frames(size_t first) const {
  for (size_t i = first; i < manifest_.frames.size(); ++i) {
    const Manifest::Frame& frame = manifest_.frames[i];
    const SensorSpec& sensor = info_.sensors[frame.sensor];
    check_written(frame_path(frame.sequence, sensor, sensor.outputs[frame.output], frame.sample), frame.size);
  }
}

WriterStats DatasetWriter::State::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

void DatasetWriter::State::rethrow_error() {
  std::exception_ptr error;
  {
    std::unique_lock lock(mutex_);
    if (!error_) return;
    changed_.wait(lock, [this] { return !committing_; });  // so that the count of whole packets stands still
    error = error_;
  }
  try {
    std::rethrow_exception(error);
  } catch (const WriteError& write_error) {
    explain(write_error);
  }
}

void DatasetWriter::State::explain(const WriteError& error) const {
  throw_user_error(
      "{}. {} holds {} whole packets; when there is room, the same command with --resume finishes it",
      error.what(), folder_.string(), manifest_.packets);
}

DatasetWriter::State::~State() {
  // Workers finish what was handed over; an error that nobody asked for must not get lost.
  workers_.reset();
  if (error_ && !finished_) spdlog::debug("{}: closed after an error, unfinished", folder_.string());
}

DatasetWriter::DatasetWriter(const fs::path& folder, DatasetInfo info, WriterOptions options)
    : state_(std::make_unique<State>(folder, std::move(info), options)) {}
DatasetWriter::~DatasetWriter() = default;
DatasetWriter::Position DatasetWriter::resume_position() const { return state_->position(); }
void DatasetWriter::begin_sequence(uint32_t sequence) { state_->begin_sequence(sequence); }
void DatasetWriter::write(Packet packet) { state_->write(std::move(packet)); }
void DatasetWriter::end_sequence() { state_->end_sequence(); }
void DatasetWriter::finish() { state_->finish(); }
void DatasetWriter::flush() { state_->flush(); }
WriterStats DatasetWriter::stats() const { return state_->stats(); }

}  // namespace greatx::io
