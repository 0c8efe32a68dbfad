// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The way to a file of a data set. What a data set says of itself is not believed: its paths stay below its
// folder, nothing on the way is a symbolic link, and what is opened is a plain file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace greatx::io {

/// Empty if `relative` can be a path below a folder: parts that are neither empty nor "." or "..", between
/// single '/', without control characters and backslashes; else what was expected.
std::string fault_of_path(const std::string& relative);

/// folder/relative. Throws UserError if the path leads out of the folder, goes over a symbolic link or
/// through something that is no folder, or names something that is there and no plain file. `folder` itself,
/// which the user named, may be a link.
std::filesystem::path inside(const std::filesystem::path& folder, const std::string& relative);

/// The size of that file; empty if there is none.
std::optional<uint64_t> size_inside(const std::filesystem::path& folder, const std::string& relative);
inline bool exists_inside(const std::filesystem::path& folder, const std::string& relative) {
  return size_inside(folder, relative).has_value();
}

/// Makes the folders of folder/relative, all but `folder` itself not by way of links. Throws WriteError or
/// UserError.
void create_folders_inside(const std::filesystem::path& folder, const std::string& relative);

}  // namespace greatx::io
