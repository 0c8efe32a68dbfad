// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/part.h"

#include <system_error>

#include <fmt/format.h>

#include "io/dataset/dataset_writer.h"
#include "io/dataset/journal.h"
#include "io/files/inside.h"
#include "io/files/untrusted_json.h"

namespace greatx::io {

namespace fs = std::filesystem;

namespace {

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// Throws UserError unless the part is complete and of the same run.
void check_part(const Assembly& assembly, uint32_t sequence) {
  const fs::path folder = assembly.part(sequence);
  if (!part_state(folder, sequence).complete)
    throw_user_error("{}: expected sequence {}, complete; found it {}", folder.string(), sequence,
                     is_there(folder) ? "unfinished" : "missing");
  const std::string wanted = dataset_json(assembly.part_info(sequence + 1));
  const fs::path description = folder / dataset_file;
  const std::string stored = read_text_file(description, JsonLimits{}.bytes);
  if (stored == wanted) return;
  const std::string differences = describe_differences(stored, wanted, description.string());
  throw_user_error("{}: is a part of another run:\n{}", folder.string(),
                   differences.empty() ? "  the text of dataset.json differs\n" : differences);
}

}  // namespace

void move_folder(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error) return;
  const fs::path half = part_name(to);
  fs::remove_all(half);
  fs::copy(from, half, fs::copy_options::recursive);
  fs::rename(half, to);
  fs::remove_all(from);
}

PartState part_state(const fs::path& folder, uint32_t sequence) {
  PartState state;
  const fs::path journal = folder / journal_file;
  if (!is_there(journal)) return state;
  for (const JournalEntry& entry : parse_journal(read_text_file(journal), journal.string())) {
    const auto* const end = std::get_if<JournalEnd>(&entry.entry);
    const auto* const packet = std::get_if<JournalPacket>(&entry.entry);
    const uint32_t found = end ? end->sequence : packet->sequence;
    if (found != sequence)
      throw_user_error_at({journal.string(), entry.line}, "expected sequence {}, found {}", sequence, found);
    state.begun = true;
    if (end)
      state.complete = true;
    else
      state.next_tick = packet->tick + 1;
  }
  return state;
}

fs::path kept_journal(const fs::path& journals, uint32_t sequence) {
  return journals / fmt::format("{}.txt", sequence_folder(sequence));
}

void assemble(const Assembly& assembly) {
  const DatasetInfo& info = assembly.info;
  const std::string description = dataset_json(info);
  const fs::path described = assembly.folder / dataset_file;
  const bool same = is_there(described) && read_text_file(described, JsonLimits{}.bytes) == description;
  if (same && is_there(assembly.folder / manifest_file)) return;
  for (uint32_t s = 0; s < info.sequences; ++s)
    if (!is_there(kept_journal(assembly.journals, s))) check_part(assembly, s);

  create_folders(assembly.folder);
  create_folders(assembly.journals);
  std::string journal;
  for (uint32_t s = 0; s < info.sequences; ++s) {
    const fs::path kept = kept_journal(assembly.journals, s);
    if (!is_there(kept)) write_file_atomically(kept, read_text_file(assembly.part(s) / journal_file));
    journal += read_text_file(kept);
  }
  // From here on the data set is unfinished, until finish() has checked all files.
  fs::remove(assembly.folder / manifest_file);
  write_file_atomically(described, description);
  write_file_atomically(assembly.folder / scenario_file, info.scenario_text);
  for (uint32_t s = 0; s < info.sequences; ++s) {
    const fs::path from = assembly.part(s) / sequence_folder(s), to = assembly.folder / sequence_folder(s);
    if (is_there(from) && !is_there(to)) move_folder(from, to);
  }
  write_file_atomically(assembly.folder / journal_file, journal);
  DatasetWriter writer(assembly.folder, info, {.threads = 1, .resume = true});
  const DatasetWriter::Position position = writer.resume_position();
  GREATX_CHECK(position.sequence == info.sequences, "{} of {} sequences", position.sequence, info.sequences);
  writer.finish();
  for (uint32_t s = 0; s < info.sequences; ++s) fs::remove_all(assembly.part(s));
}

}  // namespace greatx::io
