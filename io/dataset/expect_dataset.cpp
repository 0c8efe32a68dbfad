// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/expect_dataset.h"

#include "core/error.h"
#include "io/dataset/dataset_format.h"
#include "io/files/inside.h"

namespace greatx::io {

void expect_dataset(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const std::string name = folder.string();
  if (!fs::exists(folder, ignored)) throw_user_error("{}: expected a data set, found no such folder", name);
  if (!fs::is_directory(folder, ignored))
    throw_user_error("{}: expected the folder of a data set, found a file", name);
  if (exists_inside(folder, dataset_file)) return;
  std::string hint;
  const fs::path above = fs::absolute(folder, ignored).lexically_normal().parent_path();
  if (fs::exists(folder / "cells.json", ignored))
    hint = "; it is the folder of a campaign, whose data sets lie in folders below it";
  else if (fs::exists(above / dataset_file, ignored))
    hint = "; the folder above it is a data set";
  throw_user_error("{}: expected a data set, found no {}{}", name, dataset_file, hint);
}

}  // namespace greatx::io
