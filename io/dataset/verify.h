// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks a data set against its manifest and its own description.
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

/// Checks a data set and returns its problems. Every file of the manifest must exist with its size and
/// SHA-256, and no other file may exist. The index must agree with the sensors' rates, with the frames and
/// with the lengths of the stacks. Floating-point arrays must pass find_bad_value(). An unfinished data set
/// is one problem. `threads`: 0 stands for the number of processors. Throws UserError if the folder holds no
/// data set.
std::vector<Problem> verify(const std::filesystem::path& folder, uint32_t threads = 0);

}  // namespace greatx::io
