// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/campaign/store.h"

namespace greatx::apps {

/// Moves the complete parts of other folders of the same campaign into this one. Throws UserError, before
/// anything is moved, if a folder is not of this campaign, or if two folders hold the same part: shards
/// overlapped.
void gather_parts(const OpenCampaign& open, const std::vector<std::filesystem::path>& folders);

/// Makes the data set of a cell from its parts. Returns false if it has it already. Throws UserError as
/// io::assemble() does.
bool merge_cell(const OpenCampaign& open, size_t cell);

/// Writes splits.csv: cell, sequence, split.
void write_splits(const OpenCampaign& open);

}  // namespace greatx::apps
