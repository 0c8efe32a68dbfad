// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Small repeating pictures, computed: the same for every seed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene::generator {

/// RGB8 rows, top first; tiles in both directions.
struct Raster {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
  bool empty() const { return rgb.empty(); }
};

/// Evenings of one façade: other windows are lit.
inline constexpr int lit_pictures = 2;

/// All texture maps of one surface; all but the first may be empty.
struct TextureMaps {
  Raster color;                          ///< sRGB base colour
  Raster metallic_roughness;             ///< glTF's: G roughness, B metallic, linear
  Raster normal;                         ///< glTF's: tangent space, +y up
  std::array<Raster, lit_pictures> lit;  ///< sRGB, what glows: times MaterialSpec::emissive
};

/// The maps of the texture called `name` (MaterialSpec::texture); throws ContractError for an unknown name.
TextureMaps make_texture(const std::string& name);

// Ground: its sizes stand where it is painted.
TextureMaps asphalt();
TextureMaps country_road();
TextureMaps pavement();
TextureMaps grass();
TextureMaps pasture();
TextureMaps crop();

// Façades: two floors of 3.2 m and eight bays of 3.0 m (facade_bay_px each). In each floor the lowest 0.85 m
// is plain wall, so that a parapet may end there.
inline constexpr int facade_bay_px = 128, facade_bays = 8, facade_floor_px = 128;

TextureMaps facade_brick();
TextureMaps facade_plaster();
TextureMaps facade_stone();
TextureMaps facade_concrete();
TextureMaps facade_ribbon();
TextureMaps facade_glass();
TextureMaps facade_metal();
TextureMaps facade_balcony();
/// Four shops of 6.0 m x 4.2 m.
TextureMaps shopfront();
/// Four bays of 4.0 m x 3.0 m of a farmhouse: whitewash and small windows.
TextureMaps farm_wall();
/// An advertisement, 1.2 m x 1.8 m, lit from behind by night.
TextureMaps poster();
/// A dormer's front, 1.5 m x 1.6 m.
TextureMaps dormer();

}  // namespace greatx::scene::generator
