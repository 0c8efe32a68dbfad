// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Opening the folder: a new one, or one to go on with.
#include <algorithm>
#include <sys/file.h>

#include "core/hash.h"
#include "io/dataset/dataset_writer_state.h"
#include "io/dataset/journal.h"
#include "io/dataset/recovery.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

namespace fs = std::filesystem;

DatasetWriter::State::State(const fs::path& folder, DatasetInfo info, WriterOptions options)
    : folder_(folder), info_(std::move(info)), description_(dataset_json(info_)), options_(options) {
  check_sensors(info_.sensors);
  GREATX_CHECK(info_.sequences > 0 && options.queue_packets > 0, "{} sequences, queue of {}", info_.sequences,
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
      if (entry.path() == part_name(description)) continue;  // killed before anything else was written
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
    fs::remove(folder_ / journal_file);  // if the run was killed between the manifest and this
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
  const Recovered recovered = read_committed(folder_, info_);
  clear_uncommitted(folder_, info_, recovered);
  fs::remove(inside(folder_, std::string(manifest_file) + ".part"));
  journal_.truncate(recovered.journal_bytes);
  journal_bytes_ = recovered.journal_bytes;
  next_sequence_ = static_cast<uint32_t>(recovered.closed.size());
  std::vector<int64_t> counts(info_.sensors.size());
  uint32_t sequence = 0;
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

}  // namespace greatx::io
