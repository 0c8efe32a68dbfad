// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "scene/files/asset_folder.h"

namespace greatx::scene {

/// Holds a parsed glTF 2.0 file whose buffers are in memory. Indices and ranges in the file are not checked
/// yet.
struct GltfFile {
  std::string name;          ///< for messages
  tinygltf::Model model;     ///< images hold their encoded bytes (PNG, JPEG)
  nlohmann::json json;       ///< the same document, with extensions and extras in full
  bool keep_faults = false;  ///< LoadOptions::keep_faults
  /// With keep_faults: the images whose files cannot be read, and the messages of the errors.
  std::map<size_t, std::string> lost_images;

  /// Returns the JSON object of element `index` of the top-level list `list`.
  const nlohmann::json& element(const char* list, size_t index) const { return json.at(list).at(index); }
};

/// Parses .gltf or .glb from `bytes`. External files come from `folder` alone; tinygltf itself opens no file.
/// Throws UserError, which starts with `name`, if the file is not glTF 2.0 or is truncated, if a URI is not
/// allowed, or if a required extension is not supported. With `keep_faults`, images whose files cannot be
/// read are listed instead.
GltfFile parse_gltf(const std::string& name, std::span<const unsigned char> bytes, AssetFolder& folder,
                    bool keep_faults = false);

}  // namespace greatx::scene
