// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Files of a sequence in other tools' formats, made from its npy stacks once those are whole: so they need no
// journal, and a run that was interrupted makes them from the same arrays as one that was not.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

/// Writes every export of the sequence as PATH.part from stacks that are sealed and still called PATH.part.
/// Throws WriteError or UserError.
std::vector<FileEntry> export_sequence(const std::filesystem::path& folder, const DatasetInfo& info,
                                       uint32_t sequence);

}  // namespace greatx::io
