// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What an unfinished data set holds for certain, and how the rest of it is cleared away before a run goes on.
#pragma once

#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

struct Recovered {
  std::vector<JournalPacket> packets;  ///< committed, whole, in order
  std::vector<JournalEnd> closed;      ///< sequences 0 .. closed.size()-1
  uint64_t journal_bytes = 0;          ///< the journal beyond that is to be dropped
};

/// Reads the journal and believes a packet only if its files are there with their size. Changes nothing on
/// disk.
Recovered read_committed(const std::filesystem::path& folder, const DatasetInfo& info);
/// Removes files of packets that were not committed, gives the open sequence's stacks their `.part` names
/// back. Throws UserError if a closed sequence lacks a file, because that cannot be mended by going on.
void clear_uncommitted(const std::filesystem::path& folder, const DatasetInfo& info,
                       const Recovered& recovered);

}  // namespace greatx::io
