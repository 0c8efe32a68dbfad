// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "core/budget.h"
#include "scene/gltf/gltf_file.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Decodes the images that materials use. Each image is decoded once for each combination of use (colour,
/// sRGB, or data, linear) and wrapping.
class TextureReader {
 public:
  TextureReader(const GltfFile& file, Model& model) : file_(file), model_(model) {}

  /// Returns the index into Model::textures of the file's texture `texture`, or -1 if `texture` is -1. `what`
  /// starts messages ("x.glb: material 'wall', base colour"). Throws UserError if an index is out of range,
  /// or the image is not PNG or JPEG or is too large. With GltfFile::keep_faults an image that cannot be read
  /// goes into Model::lost_pictures, and -1 is returned.
  int32_t read(int texture, bool srgb, const std::string& what);

 private:
  using Key = std::tuple<int, bool, bool, bool>;  // image, srgb, repeat u, repeat v
  bool repeats(int wrap, const std::string& what);
  int32_t decode(const Key& key, const std::string& what);

  const GltfFile& file_;
  Model& model_;
  std::map<Key, int32_t> done_;
  Spending memory_{budget::model_textures};
};

}  // namespace greatx::scene
