// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lists every material that the generator uses, with its optical and radio properties (docs/generator.md
// describes them).
#pragma once

#include <string>
#include <vector>

#include "core/vec.h"

namespace greatx::scene::generator {

/// Linear Rec. 709 colours of Planckian radiators (3000, 4000 and 5500 K; Kim et al., US patent 7024034).
/// Each has luminance 1 (0.2126 R + 0.7152 G + 0.0722 B), so that a factor in candela is the intensity of the
/// lamp.
inline const vec3 lamp_color_3000k{1.767f, 0.846f, 0.273f}, lamp_color_4000k{1.414f, 0.924f, 0.534f},
    head_lamp_color{1.143f, 0.971f, 0.863f};

struct MaterialSpec {
  std::string name;
  std::string texture;  ///< a name known to make_texture; empty: none
  dvec2 tile_m{1.0};    ///< size of one repetition of the texture, metres
  int bays = 0;         ///< window bays in one repetition; 0: not a façade
  vec3 color{1.0f};     ///< linear base colour, multiplied by the texture
  float roughness = 0.9f;
  float metallic = 0.0f;
  vec3 emissive{0.0f};  ///< 1.0 stands for 1000 cd/m^2; multiplied by TextureMaps::lit[lit]
  std::string radio;    ///< JSON of GREATX_radio_material (docs/materials.md)
  int lit = -1;         ///< index into TextureMaps::lit; -1: `emissive` alone
  bool relief = false;  ///< whether to use the texture's normal map
  float transmission =
      0.0f;  ///< KHR_materials_transmission: light that a pane lets through, tinted by `color`
};

const std::vector<MaterialSpec>& material_library();

/// Returns the index into material_library(). Throws ContractError for an unknown name.
int material(const std::string& name);

}  // namespace greatx::scene::generator
