// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "core/budget.h"

namespace greatx {

/// A file that a person gave, to be read whole: regular (neither folder nor pipe, which would hang) and within its
/// budget, both known before anything is allocated.
class InputFile {
 public:
  /// Throws UserError "`what`: ...": no such file, none that is regular, cannot be read, too large.
  InputFile(const std::filesystem::path& file, const std::string& what, const Budget& budget);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  size_t size() const { return size_; }
  /// All of it. Throws UserError if it has become shorter.
  void read(std::span<std::byte> bytes) const;
  std::string text() const;

 private:
  std::string name_, what_;
  int descriptor_ = -1;
  size_t size_ = 0;
};

}  // namespace greatx
