// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/budget.h"

namespace greatx::scene {

/// The folder of one glTF file: what its URIs may name, and nothing else.
class AssetFolder {
 public:
  /// `asset` is the glTF file; an empty path stands for an asset in memory, which may name no external file
  /// at all. `files`: what all of them may come to.
  explicit AssetFolder(const std::filesystem::path& asset, const Budget& files = budget::model_externals);

  /// The bytes of the file that `uri` (RFC 3986, percent-encoded, relative) names. Throws UserError, starting
  /// with `what` ("x.gltf: buffer 0"), if the URI is absolute, has a scheme, a ".." or a backslash (also
  /// percent-encoded), if the file lies outside the folder through a symbolic link, is no regular file, or
  /// cannot be read; or if this and all read before are too much.
  std::vector<unsigned char> read(const std::string& uri, const std::string& what);

 private:
  std::filesystem::path folder_;  ///< canonical
  bool in_memory_ = false;
  Budget files_;
  Spending read_;
};

/// Percent-decodes; throws UserError starting with `what` on a broken escape or a NUL.
std::string decode_uri(const std::string& uri, const std::string& what);

/// The whole file. Throws UserError starting with `what` if it is no regular file, cannot be read, or is too
/// large.
std::vector<unsigned char> read_regular_file(const std::filesystem::path& file, const std::string& what,
                                             const Budget& budget);

}  // namespace greatx::scene
