// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the packets that an unfinished data set holds completely, and removes the rest before a run
// continues.
#pragma once

#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

struct Recovered {
  std::vector<JournalPacket> packets;  ///< committed and complete, in order
  uint32_t first_sequence = 0;         ///< of the folder
  std::vector<JournalEnd> closed;      ///< sequences from the first one on
  uint64_t journal_bytes = 0;          ///< the journal must be cut to this size
  uint32_t open_sequence() const { return first_sequence + static_cast<uint32_t>(closed.size()); }
};

/// Reads the journal. Accepts a packet of the open sequence only if its frame files exist with their sizes
/// and the stacks hold its rows; drops all packets from the first one on that fails this test. Accepts the
/// packets of closed sequences without a test. Changes nothing on disk. Throws UserError if the journal does
/// not fit `info`. The folder holds the sequences from `first_sequence` on.
Recovered read_committed(const std::filesystem::path& folder, const DatasetInfo& info,
                         uint32_t first_sequence = 0);
/// Removes the files of sequences that were not committed, and renames the stacks of the open sequence back
/// to `.part`. Throws UserError if a file of a closed sequence is missing or has another size, because
/// resuming cannot restore this file.
void clear_uncommitted(const std::filesystem::path& folder, const DatasetInfo& info,
                       const Recovered& recovered);

}  // namespace greatx::io
