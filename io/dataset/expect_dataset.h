// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace greatx::io {

/// Throws UserError if `folder` is not the folder of a data set, and says what it is instead: nothing, a
/// file, the folder of a sequence, or that of a campaign, whose data sets lie below it.
void expect_dataset(const std::filesystem::path& folder);

}  // namespace greatx::io
