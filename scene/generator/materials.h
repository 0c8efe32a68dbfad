// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every material that the generator uses, optics and radio side by side (docs/generator.md lists them).
#pragma once

#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene::generator {

struct MaterialSpec {
  std::string name;
  std::string texture;  ///< a name of textures.h; empty: none
  dvec2 tile_m{1.0};    ///< metres that one repetition of the texture covers
  int bays = 0;         ///< window bays in one repetition; 0: not a façade
  vec3 color{1.0f};     ///< linear base colour, times the texture
  float roughness = 0.9f;
  float metallic = 0.0f;
  vec3 emissive{0.0f};  ///< 1.0 stands for 1000 cd/m^2
  std::string radio;    ///< JSON of GREATX_radio_material (docs/materials.md)
};

const std::vector<MaterialSpec>& material_library();

/// Index into material_library(); throws ContractError for an unknown name.
int material(const std::string& name);

}  // namespace greatx::scene::generator
