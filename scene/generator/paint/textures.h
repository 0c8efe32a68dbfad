// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes small repeating textures. They are the same for every seed.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace greatx::scene::generator {

/// RGB8 rows, top row first. The image tiles in both directions.
struct Raster {
  uint32_t width = 0, height = 0;
  std::vector<uint8_t> rgb;
  bool empty() const { return rgb.empty(); }
};

/// Number of evenings of one façade. On each evening different windows are lit.
inline constexpr int lit_pictures = 2;

/// Holds all texture maps of one surface. All but the first may be empty.
struct TextureMaps {
  Raster color;                          ///< sRGB base colour
  std::vector<uint8_t> alpha;            ///< of the base colour, [height * width]; empty: no holes
  Raster metallic_roughness;             ///< as in glTF: G roughness, B metallic, linear
  Raster normal;                         ///< as in glTF: tangent space, +y up
  std::array<Raster, lit_pictures> lit;  ///< sRGB, emitted light; a factor of MaterialSpec::emissive
};

/// Returns the maps of the texture called `name` (MaterialSpec::texture). Throws ContractError for an unknown
/// name.
TextureMaps make_texture(const std::string& name);

// These functions paint ground. ground_textures.cpp states the size of each texture.
TextureMaps asphalt();
TextureMaps country_road();
TextureMaps pavement();
TextureMaps road_paint();
TextureMaps grass();
TextureMaps pasture();
TextureMaps crop();

/// Paints 3 m x 3 m of leaves without holes: clumps of lit leaves in front of dark gaps.
TextureMaps leaves();

// These functions paint plants with holes between the leaves. Each quarter of a picture is another one.
/// Paints four sprays of leaves, each some 1.5 m wide.
TextureMaps leaf_sprays();
/// Paints four boughs with needles, each some 1.5 m long, from the lower edge of their quarters upwards.
TextureMaps needle_sprays();
// Those of autumn are pale, since the material colours them. In winter twigs stand in place of leaves.
TextureMaps leaves_pale();
TextureMaps leaf_sprays_pale();
/// Paints 3 m x 3 m of twigs with holes between them.
TextureMaps twigs();
/// Paints four sprays of twigs, each some 1.5 m wide, from the lower edge of their quarters upwards.
TextureMaps twig_sprays();
/// Paints four drifts of leaves on the ground, each some 2.4 m wide.
TextureMaps fallen_leaves();
/// Paints four tufts of grass, each some 0.8 m wide, which stand on the lower edges of their quarters.
TextureMaps grass_tufts();

// These functions paint what stands in streets. street_textures.cpp states the sizes.
/// Paints eight signs in the order of SignKind (objects/street_pieces.h), four beside each other, and their
/// grey backs below.
TextureMaps traffic_signs();
TextureMaps bicycles();
TextureMaps column_bills();
TextureMaps awning();
TextureMaps tree_grate();
TextureMaps mesh_fence();
/// Paints the foot of a wall, 3.2 m x 1.6 m: dirt that has splashed up.
TextureMaps plinth();

// These functions paint façades: two floors of 3.2 m and eight bays of 3.0 m (facade_bay_px pixels each). In
// each floor the lowest 0.85 m is plain wall, so that a parapet may end there.
inline constexpr int facade_bay_px = 128, facade_bays = 8, facade_floor_px = 128;

TextureMaps facade_brick();
TextureMaps facade_plaster();
TextureMaps facade_stone();
TextureMaps facade_concrete();
TextureMaps facade_ribbon();
TextureMaps facade_glass();
TextureMaps facade_metal();
TextureMaps facade_balcony();
/// Paints six shops of 6.0 m x 4.2 m, each with its name over the window.
TextureMaps shopfront();
/// Paints four bays of 4.0 m x 3.0 m of a farmhouse: whitewash and small windows.
TextureMaps farm_wall();
/// Paints an advertisement of 1.2 m x 1.8 m that is lit from behind by night.
TextureMaps poster();
/// Paints the front of a dormer, 1.5 m x 1.6 m.
TextureMaps dormer();

/// Paints the side of a car in shades of white: joints, handles and dirt of four doors in the upper half, of
/// two doors in the lower half. The corners are blank.
TextureMaps car_side();
// These functions paint wheels as seen from their side: the circle of the tyre touches the picture's edges.
TextureMaps wheel_alloy();
TextureMaps wheel_steel();
/// Paints a face from the chin to the brow, in shades of a white skin.
TextureMaps face();

}  // namespace greatx::scene::generator
