// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Small repeating pictures, computed: the same for every seed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene::generator {

/// RGB8 rows, top first; tiles in both directions.
struct Picture {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;  ///< sRGB base colour
  /// glTF's metallic-roughness picture (G roughness, B metallic, linear); empty: the material's factors alone.
  std::vector<uint8_t> metallic_roughness;
};

/// The picture called `name` (MaterialSpec::texture); throws ContractError for an unknown name.
Picture make_texture(const std::string& name);

}  // namespace greatx::scene::generator
