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

/// All pictures of one surface; all but the first may be empty.
struct Picture {
  Raster color;                          ///< sRGB base colour
  Raster metallic_roughness;             ///< glTF's: G roughness, B metallic, linear
  Raster normal;                         ///< glTF's: tangent space, +y up
  std::array<Raster, lit_pictures> lit;  ///< sRGB, what glows: times MaterialSpec::emissive
};

/// The picture called `name` (MaterialSpec::texture); throws ContractError for an unknown name.
Picture make_texture(const std::string& name);

// Ground: its sizes stand where it is painted.
Picture asphalt();
Picture country_road();
Picture pavement();
Picture grass();
Picture pasture();
Picture crop();

// Façades: two floors of 3.2 m and eight bays of 3.0 m (facade_bay_px each). In each floor the lowest 0.85 m is plain
// wall, so that a parapet may end there.
inline constexpr int facade_bay_px = 128, facade_bays = 8, facade_floor_px = 128;

Picture facade_brick();
Picture facade_plaster();
Picture facade_stone();
Picture facade_concrete();
Picture facade_ribbon();
Picture facade_glass();
Picture facade_metal();
Picture facade_balcony();
/// Four shops of 6.0 m x 4.2 m.
Picture shopfront();
/// Four bays of 4.0 m x 3.0 m of a farmhouse: whitewash and small windows.
Picture farm_wall();
/// An advertisement, 1.2 m x 1.8 m, lit from behind by night.
Picture poster();
/// A dormer's front, 1.5 m x 1.6 m.
Picture dormer();

}  // namespace greatx::scene::generator
