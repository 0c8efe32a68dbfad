// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Resolves paths of files in a data set. The paths that a data set states are not trusted: a path must stay
// below the data set's folder, must not contain a symbolic link, and must lead to a plain file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace greatx::io {

/// Checks whether `relative` can be a path below a folder. Its parts, which single '/' separate, must not be
/// empty, "." or "..", and must not contain control characters or backslashes. Returns an empty string if the
/// path is good, and otherwise a description of the expected path.
std::string fault_of_path(const std::string& relative);

/// Returns folder/relative. Throws UserError if fault_of_path() rejects the path, if a part of it is a
/// symbolic link, if a parent is not a folder, or if it names something other than a plain file. The file
/// need not exist. `folder` itself may be a link, because the user named it.
std::filesystem::path inside(const std::filesystem::path& folder, const std::string& relative);

/// Returns the size of the file folder/relative, bytes, or nullopt if it does not exist. Throws UserError
/// like inside().
std::optional<uint64_t> size_inside(const std::filesystem::path& folder, const std::string& relative);
inline bool exists_inside(const std::filesystem::path& folder, const std::string& relative) {
  return size_inside(folder, relative).has_value();
}

/// Creates the folder folder/relative and its parents. Except `folder` itself, none of them may be a symbolic
/// link. Throws WriteError or UserError.
void create_folders_inside(const std::filesystem::path& folder, const std::string& relative);

}  // namespace greatx::io
