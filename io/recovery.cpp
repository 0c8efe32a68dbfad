// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/recovery.h"

#include <set>

#include <spdlog/spdlog.h>

#include "io/sequence_files.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

bool has_size(const fs::path& file, uint64_t size) {
  std::error_code error;
  return fs::file_size(file, error) == size && !error;
}

/// Calls visit(path, frame) for every per-frame file of the packet; stops when it returns false.
template <typename Visit>
bool for_each_frame(const DatasetInfo& info, const JournalPacket& packet, Visit visit) {
  size_t next = 0;
  for (const auto& record : packet.records) {
    const SensorSpec& sensor = info.sensors.at(record.sensor);
    for (const OutputSpec& output : sensor.outputs) {
      if (!is_frame(output.format)) continue;
      const std::string path = frame_path(packet.sequence, sensor, output, record.sample);
      if (!visit(path, packet.frames.at(next++))) return false;
    }
  }
  return true;
}

bool frames_are_there(const fs::path& folder, const DatasetInfo& info, const JournalPacket& packet) {
  return for_each_frame(info, packet, [&](const std::string& path, const JournalPacket::FrameFile& frame) {
    return has_size(folder / path, frame.size);
  });
}

}  // namespace

Recovered read_committed(const fs::path& folder, const DatasetInfo& info) {
  Recovered recovered;
  if (!fs::exists(folder / journal_file)) return recovered;
  std::vector<JournalEntry> entries = parse_journal(read_text_file(folder / journal_file));
  size_t closed_until = 0;  // packets before the last "end" are not examined: their sequence was complete
  for (size_t i = 0; i < entries.size(); ++i)
    if (std::holds_alternative<JournalEnd>(entries[i].entry)) closed_until = i + 1;
  uint32_t open_sequence = 0;
  for (size_t i = 0; i < closed_until; ++i)
    open_sequence += std::holds_alternative<JournalEnd>(entries[i].entry);

  // The stacks of the open sequence, which a cut-short end may have renamed already, are counted by size.
  std::vector<int64_t> whole, used(info.sensors.size());
  if (open_sequence < info.sequences) {
    whole = SequenceFiles::whole_records(folder, info, open_sequence);
  }
  for (size_t i = 0; i < entries.size(); ++i) {
    if (auto* const end = std::get_if<JournalEnd>(&entries[i].entry)) {
      recovered.closed.push_back(std::move(*end));
    } else {
      auto& packet = std::get<JournalPacket>(entries[i].entry);
      if (i >= closed_until) {
        bool good = packet.sequence == open_sequence && frames_are_there(folder, info, packet);
        for (const auto& record : packet.records)
          good = good && used.at(record.sensor)++ < whole.at(record.sensor);
        if (!good) break;
      }
      recovered.packets.push_back(std::move(packet));
    }
    recovered.journal_bytes = entries[i].end;
  }
  return recovered;
}

void clear_uncommitted(const fs::path& folder, const DatasetInfo& info, const Recovered& recovered) {
  std::set<std::string> keep;
  for (const JournalPacket& packet : recovered.packets) {
    for_each_frame(info, packet, [&](const std::string& path, const JournalPacket::FrameFile&) {
      keep.insert(path);
      return true;
    });
  }
  for (const JournalEnd& closed : recovered.closed) {
    for (const FileEntry& file : closed.files) {
      if (!has_size(folder / file.path, file.size)) {
        throw_user_error(
            "{}: expected {} bytes, found another size or no file: this sequence was complete and cannot "
            "be resumed; generate the data set anew in another folder",
            (folder / file.path).string(), file.size);
      }
      keep.insert(file.path);
    }
  }
  const auto open_sequence = static_cast<uint32_t>(recovered.closed.size());
  if (open_sequence < info.sequences) {
    for (const std::string& path : SequenceFiles::stack_paths(info, open_sequence)) {
      const fs::path final = folder / path, part = part_name(final);
      if (fs::exists(final)) rename_file(final, part);  // closing the sequence was cut short
      keep.insert(part_name(path).generic_string());
    }
  }
  std::vector<fs::path> remove;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    const std::string path = fs::relative(entry.path(), folder).generic_string();
    if (path.starts_with("sequence_") && !keep.contains(path)) remove.push_back(entry.path());
  }
  for (const fs::path& file : remove) {
    spdlog::debug("resume: removes {}, which was not committed", file.string());
    fs::remove(file);
  }
}

}  // namespace greatx::io
