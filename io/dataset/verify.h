// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace greatx::io {

struct Problem {
  std::string file;  ///< relative to the data set's folder
  std::string what;
  std::string expected;
  std::string found;
  std::string str() const;
};

/// Checks a data set: every file of the manifest is there with its size and SHA-256, no others are; the index
/// agrees with the sensors' rates, with the frames and with the lengths of the stacks; floating-point arrays
/// hold no NaN or infinity where there must be none. Empty: all is well. An unfinished data set is one
/// problem. Throws UserError if the folder holds no data set.
std::vector<Problem> verify(const std::filesystem::path& folder, uint32_t threads = 0);

}  // namespace greatx::io
