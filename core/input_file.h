// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/budget.h"

namespace greatx {

/// Reads a file that a person gave, whole. It is a regular file (not a folder, and not a pipe, which would
/// hang) and within its budget. Both are checked before anything is allocated.
class InputFile {
 public:
  /// Throws UserError "`what`: ..." if the file does not exist, is not regular, cannot be read or is too
  /// large.
  InputFile(const std::filesystem::path& file, const std::string& what, const Budget& budget);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  size_t size() const { return size_; }
  /// Reads the whole file. Throws UserError if the file has become shorter.
  void read(std::span<std::byte> bytes) const;
  std::string text() const;

 private:
  std::string name_, what_;
  int descriptor_ = -1;
  size_t size_ = 0;
};

}  // namespace greatx
