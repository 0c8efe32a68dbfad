// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Puts a data set together from parts. A part is a folder with one sequence of the data set, which a
// DatasetWriter with WriterOptions::first_sequence has written: dataset.json, scenario.yaml, the folder of
// the sequence, and the journal, whose last line is the end of the sequence. Parts come from any process, in
// any order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "io/dataset/dataset_format.h"

namespace greatx::io {

struct PartState {
  bool begun = false, complete = false;
  int64_t next_tick = 0;  ///< of a part that is not complete
};
/// Reads the state of a part from its journal. Throws UserError if the journal is not one of this sequence.
PartState part_state(const std::filesystem::path& folder, uint32_t sequence);

/// Moves a folder, also to another file system. What is at `to` is whole or not there at any moment.
void move_folder(const std::filesystem::path& from, const std::filesystem::path& to);

struct Assembly {
  std::filesystem::path folder;    ///< of the data set
  std::filesystem::path journals;  ///< keeps the journal of each sequence, so that more can be added later
  DatasetInfo info;                ///< of the whole data set
  /// The description of a run of `count` sequences, as the last part of these says it.
  std::function<DatasetInfo(uint32_t count)> part_info;
  std::function<std::filesystem::path(uint32_t sequence)>
      part;  ///< its folder; it may be gone if it was moved
};

/// Returns the file that keeps the journal of a sequence.
std::filesystem::path kept_journal(const std::filesystem::path& journals, uint32_t sequence);

/// Moves the sequences of all parts into the data set and finishes it. A data set of fewer sequences grows,
/// and its sequences keep their bytes. The result has the bytes of a single run. It may be interrupted at any
/// moment and called again. Throws UserError if a part is missing, not complete, or of another run (program,
/// device, scenario), before anything is moved.
void assemble(const Assembly& assembly);

}  // namespace greatx::io
