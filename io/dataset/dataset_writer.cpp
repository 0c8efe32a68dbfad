// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/dataset_writer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <sys/file.h>
#include <vector>

#include <spdlog/spdlog.h>

#include "core/hash.h"
#include "io/dataset/journal.h"
#include "io/dataset/manifest.h"
#include "io/dataset/recovery.h"
#include "io/dataset/sequence_exports.h"
#include "io/dataset/sequence_files.h"
#include "io/dataset/worker_pool.h"
#include "io/files/file.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"
#include "io/formats/exr.h"
#include "io/formats/npy.h"
#include "io/formats/pcd.h"
#include "io/formats/ply.h"
#include "io/formats/png.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

/// Level of libdeflate for EXR in small data sets.
constexpr int small_exr_level = 6;

Bytes encode_frame(const SensorSpec& sensor, const OutputSpec& output, const std::vector<Array>& arrays,
                   Compression compression) {
  const bool small = compression == Compression::small;
  const std::vector<size_t> indices = arrays_of(sensor, output);
  const Array& first = arrays[indices[0]];
  switch (output.format) {
    case FileFormat::npy_frame:
      return encode_npy(first);
    case FileFormat::png:
      // Pictures of ids are smaller by runs alone.
      return encode_png(first, small && first.shape.size() == 3 ? PngCoding::matched : PngCoding::fast);
    case FileFormat::png_depth24:
      return encode_png_depth24(first);
    case FileFormat::exr:
      return encode_exr(first, small ? small_exr_level : 0);
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

/// Holds a packet between write() and its commit.
struct QueuedPacket {
  Packet packet;
  struct Frame {
    size_t record, output;
    uint64_t size = 0;
    std::string sha256;
  };
  std::vector<Frame> frames;  ///< per record and per output of one file per frame
  struct Packing {
    size_t record, output;
  };
  std::vector<Packing> packings;  ///< per record and per output hdf5_records
  std::vector<PackedRecord> packed;
  // DatasetWriter::State::mutex_ guards the next two members.
  size_t jobs_left = 0;
  std::exception_ptr error;  ///< first exception of a job of this packet
};

/// Implements DatasetWriter. Public functions run in the caller's thread. The functions that process a packet
/// after enqueue() run in the workers.
class DatasetWriter::State {
 public:
  State(const std::filesystem::path& folder, DatasetInfo info, WriterOptions options);
  ~State();

  Position position() const { return {next_sequence_, next_tick_, finished_}; }
  void begin_sequence(uint32_t sequence);
  void flush();
  void end_sequence();
  void finish();
  WriterStats stats() const;
  void write(Packet packet);

 private:
  /// Throws UserError if a file is missing or has another size, because another process has deleted or
  /// changed it.
  void check_written(const std::string& path, uint64_t size) const;
  /// Checks the frames of the manifest from index `first` on by check_written().
  void check_frames(size_t first) const;
  void rethrow_error();
  [[noreturn]] void explain(const WriteError& error) const;

  void prepare_folder();
  void open_existing(const std::string& description);
  void open_journal(uint64_t bytes);
  void recover();

  void check_packet(const Packet& packet) const;
  void enqueue(const std::shared_ptr<QueuedPacket>& pending);
  void run_job(const std::shared_ptr<QueuedPacket>& pending, const std::function<void()>& job);
  void check_values(const QueuedPacket& pending) const;
  void write_frame(const QueuedPacket& pending, QueuedPacket::Frame& frame) const;
  void pack(QueuedPacket& pending, size_t packing) const;
  void commit_ready(std::unique_lock<std::mutex>& lock);
  void commit(const QueuedPacket& pending);
  void append_journal(const std::string& line);

  const std::filesystem::path folder_;
  const DatasetInfo info_;
  const std::string description_;
  const WriterOptions options_;

  // The next members are the state of the data set. Commits, which run one at a time, change them, and so
  // does the caller's thread while no packet is queued.
  File journal_;
  uint64_t journal_bytes_ = 0;
  Manifest manifest_;
  std::vector<IndexRow> rows_;  ///< index of the sequence that is open or will be opened next
  std::vector<int64_t> resumed_records_;
  std::optional<SequenceFiles> files_;
  uint32_t next_sequence_ = 0;
  int64_t next_tick_ = 0;
  bool finished_ = false;
  int64_t last_written_tick_ = -1;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::shared_ptr<QueuedPacket>> queue_;
  bool committing_ = false;
  std::atomic<bool> failed_ = false;
  std::exception_ptr error_;
  WriterStats stats_;
  std::optional<WorkerPool> workers_;  ///< last, so that the threads end before the members that they use
};

// The next functions open the folder of a new data set or of an unfinished one.

DatasetWriter::State::State(const fs::path& folder, DatasetInfo info, WriterOptions options)
    : folder_(folder), info_(std::move(info)), description_(dataset_json(info_)), options_(options) {
  check_sensors(info_.sensors);
  GREATX_CHECK(options.first_sequence < info_.sequences && options.queue_packets > 0,
               "{} sequences from {} on, queue of {}", info_.sequences, options.first_sequence,
               options.queue_packets);
  ignore_file_size_signal();
  manifest_.records_per_sensor.assign(info_.sensors.size(), 0);
  resumed_records_.assign(info_.sensors.size(), 0);
  try {
    prepare_folder();
  } catch (const fs::filesystem_error& error) {
    throw_user_error("{}: {}", error.path1().string(), error.code().message());
  }
  workers_.emplace(options.threads);
}

void DatasetWriter::State::prepare_folder() {
  create_folders(folder_);
  const fs::path description = folder_ / dataset_file;
  if (exists_inside(folder_, dataset_file)) {
    open_existing(read_text_file(description, JsonLimits{}.bytes));
  } else {
    for (const auto& entry : fs::directory_iterator(folder_)) {
      if (entry.path() == part_name(description)) continue;  // left by a run that was killed at its beginning
      throw_user_error(
          "{}: expected an empty folder or a data set, found a folder with other files ({}); choose another "
          "folder",
          folder_.string(), entry.path().filename().string());
    }
    write_file_atomically(description, description_);
  }
  if (finished_) return;
  write_file_atomically(inside(folder_, scenario_file), info_.scenario_text);
  if (!journal_.is_open()) open_journal(0);
  manifest_.files = {{dataset_file, description_.size(), sha256_hex(bytes_of(description_))},
                     {scenario_file, info_.scenario_text.size(), sha256_hex(bytes_of(info_.scenario_text))}};
  recover();
}

void DatasetWriter::State::open_existing(const std::string& stored) {
  const bool complete = exists_inside(folder_, manifest_file);
  if (!options_.resume) {
    if (complete)
      throw_user_error("{}: holds a finished data set, which is not overwritten; choose another folder",
                       folder_.string());
    throw_user_error("{}: holds an unfinished data set; --resume finishes it, or choose another folder",
                     folder_.string());
  }
  if (stored != description_) {
    const std::string differences =
        describe_differences(stored, description_, (folder_ / dataset_file).string());
    throw_user_error("{}: holds a data set of another run, which this one cannot resume:\n{}",
                     folder_.string(),
                     differences.empty() ? "  the text of dataset.json differs\n" : differences);
  }
  if (complete) {
    fs::remove(folder_ / journal_file);  // exists if the run was killed just after it wrote the manifest
    next_sequence_ = info_.sequences;
    finished_ = true;
  }
}

void DatasetWriter::State::open_journal(uint64_t bytes) {
  journal_ = File::open_for_writing(inside(folder_, journal_file));
  if (::flock(journal_.descriptor(), LOCK_EX | LOCK_NB) != 0)
    throw_user_error("{}: is being written by another process", folder_.string());
  journal_bytes_ = bytes;
}

void DatasetWriter::State::recover() {
  const Recovered recovered = read_committed(folder_, info_, options_.first_sequence);
  clear_uncommitted(folder_, info_, recovered);
  fs::remove(inside(folder_, std::string(manifest_file) + ".part"));
  journal_.truncate(recovered.journal_bytes);
  journal_bytes_ = recovered.journal_bytes;
  next_sequence_ = recovered.open_sequence();
  std::vector<int64_t> counts(info_.sensors.size());
  uint32_t sequence = options_.first_sequence;
  for (const JournalPacket& packet : recovered.packets) {
    if (packet.sequence != sequence) std::fill(counts.begin(), counts.end(), 0);
    sequence = packet.sequence;
    ++manifest_.packets;
    size_t frame = 0;
    for (const auto& record : packet.records) {
      ++manifest_.records_per_sensor[record.sensor];
      const SensorSpec& sensor = info_.sensors[record.sensor];
      for (uint32_t o = 0; o < sensor.outputs.size(); ++o) {
        if (!is_frame(sensor.outputs[o].format)) continue;
        const auto& file = packet.frames[frame++];
        manifest_.add_frame({sequence, record.sensor, o, record.sample, file.size}, file.sha256);
      }
      const int64_t row = counts[record.sensor]++;
      if (sequence == next_sequence_)
        rows_.push_back({packet.tick, packet.time_ns, record.sensor, record.sample, row});
    }
    if (sequence == next_sequence_) next_tick_ = packet.tick + 1;
  }
  if (!rows_.empty()) resumed_records_ = counts;
  for (const JournalEnd& closed : recovered.closed)
    manifest_.files.insert(manifest_.files.end(), closed.files.begin(), closed.files.end());
}

// The next functions process a packet: they check and queue it, encode and write its files in the workers,
// and commit it in order.

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
  auto pending = std::make_shared<QueuedPacket>();
  pending->packet = std::move(packet);
  const std::vector<Record>& records = pending->packet.records;
  for (size_t r = 0; r < records.size(); ++r) {
    const std::vector<OutputSpec>& outputs = info_.sensors[records[r].sensor].outputs;
    for (size_t o = 0; o < outputs.size(); ++o) {
      if (is_frame(outputs[o].format)) pending->frames.push_back({r, o, 0, {}});
      if (is_packed(outputs[o].format)) pending->packings.push_back({r, o});
    }
  }
  pending->packed.resize(pending->packings.size());
  enqueue(pending);
}

void DatasetWriter::State::enqueue(const std::shared_ptr<QueuedPacket>& pending) {
  const auto start = std::chrono::steady_clock::now();
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return failed_ || queue_.size() < options_.queue_packets; });
  stats_.blocked_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (failed_) {
    lock.unlock();
    rethrow_error();
  }
  pending->jobs_left = pending->frames.size() + pending->packings.size() + 1;
  queue_.push_back(pending);
  lock.unlock();
  workers_->submit([this, pending] { run_job(pending, [&] { check_values(*pending); }); });
  for (size_t i = 0; i < pending->packings.size(); ++i)
    workers_->submit([this, pending, i] { run_job(pending, [&] { pack(*pending, i); }); });
  for (QueuedPacket::Frame& frame : pending->frames)
    workers_->submit([this, pending, &frame] { run_job(pending, [&] { write_frame(*pending, frame); }); });
}

void DatasetWriter::State::run_job(const std::shared_ptr<QueuedPacket>& pending,
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

void DatasetWriter::State::check_values(const QueuedPacket& pending) const {
  for (const Record& record : pending.packet.records) {
    const SensorSpec& sensor = info_.sensors[record.sensor];
    for (size_t i = 0; i < record.arrays.size(); ++i) {
      const std::string bad = find_bad_value(sensor, sensor.arrays[i], record.arrays[i]);
      GREATX_CHECK(bad.empty(), "{}, tick {}, sample {}: {}", sensor.name, record.tick, record.sample, bad);
    }
  }
}

void DatasetWriter::State::write_frame(const QueuedPacket& pending, QueuedPacket::Frame& frame) const {
  const Record& record = pending.packet.records[frame.record];
  const SensorSpec& sensor = info_.sensors[record.sensor];
  const OutputSpec& output = sensor.outputs[frame.output];
  const fs::path path = inside(folder_, frame_path(next_sequence_, sensor, output, record.sample));
  Bytes bytes;
  try {
    bytes = encode_frame(sensor, output, record.arrays, info_.compression);
  } catch (const UserError& error) {
    throw_user_error("{}: {}", path.string(), error.what());
  }
  frame.size = bytes.size();
  frame.sha256 = sha256_hex(bytes);
  write_file_atomically(path, bytes);
}

void DatasetWriter::State::pack(QueuedPacket& pending, size_t packing) const {
  const QueuedPacket::Packing& place = pending.packings[packing];
  const Record& record = pending.packet.records[place.record];
  const SensorSpec& sensor = info_.sensors[record.sensor];
  try {
    pending.packed[packing] =
        pack_record(sensor, sensor.outputs[place.output], record.arrays, info_.compression);
  } catch (const UserError& error) {
    throw_user_error("{}, tick {}: {}", sensor.name, record.tick, error.what());
  }
}

/// Commits the complete packets at the head of the queue. Any worker may call this, but only one at a time
/// commits. Packets before a failed one are still committed, later ones are not.
void DatasetWriter::State::commit_ready(std::unique_lock<std::mutex>& lock) {
  if (committing_) return;
  committing_ = true;
  while (!queue_.empty() && queue_.front()->jobs_left == 0) {
    const std::shared_ptr<QueuedPacket> pending = queue_.front();
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

void DatasetWriter::State::commit(const QueuedPacket& pending) {
  const Packet& packet = pending.packet;
  JournalPacket line{next_sequence_, packet.tick, packet.time_ns, {}, {}};
  size_t packing = 0;
  for (size_t r = 0; r < packet.records.size(); ++r) {
    const Record& record = packet.records[r];
    rows_.push_back(
        {packet.tick, packet.time_ns, record.sensor, record.sample, files_->records_of(record.sensor)});
    const size_t first = packing;
    while (packing < pending.packings.size() && pending.packings[packing].record == r) ++packing;
    files_->append(record, std::span(pending.packed).subspan(first, packing - first));
    ++manifest_.records_per_sensor[record.sensor];
    line.records.push_back({record.sensor, record.sample});
  }
  for (const QueuedPacket::Frame& frame : pending.frames) {
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

// The next functions begin and end sequences, and finish the data set.

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
    std::vector<std::vector<FileEntry>> sealed(files_->file_count());
    workers_->for_each(sealed.size(), [&](size_t i) { sealed[i] = files_->seal(i); });
    std::vector<FileEntry> entries;
    for (const std::vector<FileEntry>& files : sealed)
      entries.insert(entries.end(), files.begin(), files.end());
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
    // The frames of this sequence are the last ones in the manifest.
    size_t first = manifest_.frames.size();
    while (first > 0 && manifest_.frames[first - 1].sequence == next_sequence_) --first;
    check_frames(first);
    append_journal(journal_line(JournalEnd{next_sequence_, entries}));
    files_->remove_streams();
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
  GREATX_CHECK(!files_ && next_sequence_ == info_.sequences && options_.first_sequence == 0,
               "sequence {} of {}, from {} on", next_sequence_, info_.sequences, options_.first_sequence);
  try {
    for (const FileEntry& file : manifest_.files) check_written(file.path, file.size);
    check_frames(0);
    const auto [files, bytes] = write_manifest(folder_, info_, manifest_);
    stats_.files = files;
    stats_.bytes = bytes;
  } catch (const WriteError& error) {
    explain(error);
  }
  std::error_code ignored;  // `verify` reports a journal that remains, and --resume removes it
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

// The next functions report errors and statistics to the caller.

WriterStats DatasetWriter::State::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

void DatasetWriter::State::rethrow_error() {
  std::exception_ptr error;
  {
    std::unique_lock lock(mutex_);
    if (!error_) return;
    // explain() states the number of complete packets, so wait until it no longer changes.
    changed_.wait(lock, [this] { return !committing_; });
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
  // The workers finish all queued packets. Errors are logged, because possibly no call has thrown them.
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
