// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/recovery.h"

#include <algorithm>
#include <set>

#include <spdlog/spdlog.h>

#include "io/dataset/sequence_files.h"
#include "io/files/inside.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

bool has_size(const fs::path& folder, const std::string& path, uint64_t size) {
  return size_inside(folder, path) == size;
}

/// Checks the lines of the journal in order. Throws UserError for a line that this run cannot have written.
class JournalChecker {
 public:
  JournalChecker(const fs::path& journal, const DatasetInfo& info, uint32_t first_sequence)
      : journal_(journal), info_(info), sequence_(first_sequence) {}

  void check(const JournalEntry& entry) {
    if (const auto* const end = std::get_if<JournalEnd>(&entry.entry)) {
      expect(entry, end->sequence == sequence_, "the end of sequence", sequence_, end->sequence);
      ++sequence_;
      next_tick_ = 0;
      return;
    }
    const auto& packet = std::get<JournalPacket>(entry.entry);
    expect(entry, packet.sequence == sequence_, "sequence", sequence_, packet.sequence);
    expect(entry, sequence_ < info_.sequences, "a sequence below", info_.sequences, sequence_);
    expect(entry, packet.tick >= next_tick_, "a tick from here on:", next_tick_, packet.tick);
    expect(entry, packet.tick < info_.ticks_per_sequence, "a tick below", info_.ticks_per_sequence,
           packet.tick);
    next_tick_ = packet.tick + 1;
    size_t frames = 0;
    for (const auto& record : packet.records) {
      expect(entry, record.sensor < info_.sensors.size(), "a sensor below", info_.sensors.size(),
             record.sensor);
      const std::vector<OutputSpec>& outputs = info_.sensors[record.sensor].outputs;
      frames += static_cast<size_t>(std::count_if(outputs.begin(), outputs.end(),
                                                  [](const OutputSpec& o) { return is_frame(o.format); }));
    }
    expect(entry, packet.frames.size() == frames, "as many files as its records have:", frames,
           packet.frames.size());
  }

 private:
  template <typename A, typename B>
  void expect(const JournalEntry& entry, bool good, const char* what, A expected, B found) const {
    if (!good)
      throw_user_error_at({journal_.string(), entry.line}, "expected {} {}, found {}", what, expected, found);
  }
  const fs::path journal_;
  const DatasetInfo& info_;
  uint32_t sequence_;
  int64_t next_tick_ = 0;
};

/// Calls visit(path, frame) for every per-frame file of the packet. Stops and returns false if `visit`
/// returns false.
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
    return has_size(folder, path, frame.size);
  });
}

}  // namespace

Recovered read_committed(const fs::path& folder, const DatasetInfo& info, uint32_t first_sequence) {
  Recovered recovered;
  recovered.first_sequence = first_sequence;
  if (!exists_inside(folder, journal_file)) return recovered;
  const fs::path journal = folder / journal_file;
  std::vector<JournalEntry> entries = parse_journal(read_text_file(journal), journal.string());
  JournalChecker checker(journal, info, first_sequence);
  for (const JournalEntry& entry : entries) checker.check(entry);
  // Packets before the last end of a sequence are not examined, because their sequences were complete.
  size_t closed_until = 0;
  for (size_t i = 0; i < entries.size(); ++i)
    if (std::holds_alternative<JournalEnd>(entries[i].entry)) closed_until = i + 1;
  uint32_t open_sequence = first_sequence;
  for (size_t i = 0; i < closed_until; ++i)
    open_sequence += std::holds_alternative<JournalEnd>(entries[i].entry);

  // The records in the stacks of the open sequence are counted by the sizes of the files. An interrupted end
  // of the sequence may have renamed the stacks already.
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
      if (!has_size(folder, file.path, file.size)) {
        throw_user_error(
            "{}: expected {} bytes, found another size or no file: this sequence was complete and cannot "
            "be resumed; generate the data set anew in another folder",
            (folder / file.path).string(), file.size);
      }
      keep.insert(file.path);
    }
  }
  const uint32_t open_sequence = recovered.open_sequence();
  if (open_sequence < info.sequences) {
    for (const std::string& path : SequenceFiles::stack_paths(info, open_sequence)) {
      const fs::path part = inside(folder, path + ".part");
      // The stack has its final name if the end of the sequence was interrupted.
      if (exists_inside(folder, path)) rename_file(folder / path, part);
      keep.insert(part_name(path).generic_string());
    }
  }
  std::vector<fs::path> remove;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string path = entry.path().lexically_relative(folder).generic_string();
    if (entry.is_directory() && !entry.is_symlink()) continue;
    inside(folder, path);  // throws unless the entry is a plain file
    if (path.starts_with("sequence_") && !keep.contains(path)) remove.push_back(entry.path());
  }
  for (const fs::path& file : remove) {
    spdlog::debug("resume: removes {}, which was not committed", file.string());
    fs::remove(file);
  }
}

}  // namespace greatx::io
