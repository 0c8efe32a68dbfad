// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Recognises a file that a person gave in place of another: a Blender file or a point cloud in place of a
// glTF file, a scene in place of a scenario. A message then says which format it is and how it becomes
// something that greatx reads.
//
//   first bytes, name ─► recognised_format() ─► {"an OBJ file", "…"} ─► "FILE: expected glTF 2.0, found an …"
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace greatx::scene {

struct KnownFormat {
  std::string name;  ///< with its article: "a Blender file"
  std::string way;   ///< how greatx can use it, a sentence without its full stop
  bool is_gltf = false, is_scenario = false, is_mitsuba = false;
};

/// Returns the format of a file by its content, and by its extension where the content says nothing. `bytes`
/// is the file, or its first 4096 bytes. The result is empty if the format is not known.
std::optional<KnownFormat> recognised_format(const std::filesystem::path& file,
                                             std::span<const unsigned char> bytes);

/// Returns words for a file whose format is not known: which files can become a scene.
KnownFormat unknown_format();

/// Returns the first 4096 bytes of a file, or fewer; none if it cannot be read.
std::vector<unsigned char> first_bytes(const std::filesystem::path& file);

/// Returns "FILE: expected `expected`, found a Blender file; ...".
std::string wrong_format(const std::filesystem::path& file, const KnownFormat& found,
                         const std::string& expected);

}  // namespace greatx::scene
