// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/budget.h"

namespace greatx::scene {

/// Reads files from the folder of one glTF file. The URIs of the file may name files in this folder and no
/// others.
class AssetFolder {
 public:
  /// `asset` is the glTF file. An empty path stands for an asset in memory, which may name no external file.
  /// `files` limits the total size of the files.
  explicit AssetFolder(const std::filesystem::path& asset, const Budget& files = budget::model_externals);

  /// Returns the bytes of the file that `uri` (RFC 3986, percent-encoded, relative) names. Throws UserError,
  /// which starts with `what` ("x.gltf: buffer 0"),
  /// - if the URI is absolute, or has a scheme, a ".." or a backslash (also percent-encoded);
  /// - if the file lies outside the folder through a symbolic link, is not a regular file, or cannot be read;
  /// - if this file and all files read before exceed the budget.
  std::vector<unsigned char> read(const std::string& uri, const std::string& what);

 private:
  std::filesystem::path folder_;  ///< canonical
  bool in_memory_ = false;
  Budget files_;
  Spending read_;
};

/// Decodes percent escapes. Throws UserError, which starts with `what`, for an invalid escape or a NUL.
std::string decode_uri(const std::string& uri, const std::string& what);

/// Returns the bytes of the whole file. Throws UserError, which starts with `what`, if it is not a regular
/// file, cannot be read, or is too large.
std::vector<unsigned char> read_regular_file(const std::filesystem::path& file, const std::string& what,
                                             const Budget& budget);

}  // namespace greatx::scene
