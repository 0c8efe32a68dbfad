// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/dataset/expect_dataset.h"

#include <algorithm>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "io/dataset/dataset_format.h"
#include "io/files/inside.h"

namespace greatx::io {
namespace {

/// Returns words that name the first data sets of a campaign.
std::string cells_of(const std::filesystem::path& campaign) {
  constexpr size_t most_named = 5;
  std::error_code failure;
  std::vector<std::string> cells;
  for (const auto& entry : std::filesystem::directory_iterator(campaign / "data", failure))
    cells.push_back(entry.path().string());
  if (cells.empty()) return ", of which no cell is merged";
  std::ranges::sort(cells);
  const size_t named = std::min(cells.size(), most_named);
  return fmt::format(": name one of its {} data sets, {}{}", cells.size(),
                     fmt::join(std::span(cells).first(named), ", "), cells.size() > named ? ", ..." : "");
}

}  // namespace

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
    hint = fmt::format("; it is a campaign{}", cells_of(folder));
  else if (fs::exists(above / dataset_file, ignored))
    hint = "; the folder above it is a data set";
  throw_user_error("{}: expected a data set, found no {}{}", name, dataset_file, hint);
}

}  // namespace greatx::io
