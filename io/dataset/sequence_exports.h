// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the files of a sequence in the formats of other tools. The files are made from the npy stacks when
// these are complete. They therefore need no journal, and an interrupted run makes them from the same arrays
// as an uninterrupted one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "io/dataset/journal.h"

namespace greatx::io {

/// Writes every export of the sequence as PATH.part. The stacks must be sealed and still have their names
/// PATH.part. Returns the exports with their final paths. Throws WriteError or UserError.
std::vector<FileEntry> export_sequence(const std::filesystem::path& folder, const DatasetInfo& info,
                                       uint32_t sequence);

}  // namespace greatx::io
