// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/mesh/materials.h"

#include "core/error.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

namespace {

// Radio properties. Media are those of ITU-R P.2040-4, Table 3, by name where the table has them.
// Scattering coefficients are plausible values for the effective-roughness model (lowest for smooth glass
// and metal, highest for rough ground), not measurements of these surfaces.
const char* const concrete_wall =
    R"({"itu":"concrete","thickness_m":0.25,"scattering_coefficient":0.2,"cross_polarization":0.1})";
const char* const concrete_ground =
    R"({"itu":"concrete","scattering_coefficient":0.2,"cross_polarization":0.1,"clutter":"concrete"})";
const char* const brick_wall = R"({"itu":"brick","extrapolate":true,"thickness_m":0.3,)"
                               R"("scattering_coefficient":0.3,"cross_polarization":0.1})";
// Double glazing, outer pane first.
const char* const glazing = R"({"layers":[{"itu":"glass","thickness_m":0.006},)"
                            R"({"relative_permittivity":1.0,"conductivity":0.0,"thickness_m":0.016},)"
                            R"({"itu":"glass","thickness_m":0.006}],"scattering_coefficient":0.05})";
const char* const pane = R"({"itu":"glass","thickness_m":0.005})";
const char* const sheet_metal = R"({"itu":"metal","thickness_m":0.002,"scattering_coefficient":0.1})";
const char* const asphalt_ground =
    R"({"itu":"asphalt_concrete","extrapolate":true,"scattering_coefficient":0.2,"clutter":"asphalt"})";
// The table's row for soil ends at 10 GHz. Its formula is extrapolated above 10 GHz, and the file says so.
#define GREATX_GROUND(clutter)                                                                              \
  R"({"itu":"medium_dry_ground","extrapolate":true,"scattering_coefficient":0.4,"cross_polarization":0.2,)" \
  R"("clutter":")" clutter R"("})"
const char* const soil = GREATX_GROUND("soil");
const char* const lawn = GREATX_GROUND("grass");
const char* const corn = GREATX_GROUND("tall_grass");
#undef GREATX_GROUND
const char* const timber = R"({"itu":"wood","thickness_m":0.05,"scattering_coefficient":0.2})";
const char* const trunk = R"({"itu":"wood","thickness_m":0.25,"scattering_coefficient":0.3})";
// A volume: its faces do not reflect, and the loss grows with the depth.
const char* const canopy = R"({"foliage":"weissberger","clutter":"foliage"})";
// Radio does not see these sheets (scene/material/lossless.h): single leaves around a crown, whose inside
// holds the leaves that attenuate, and pictures of tubes and wires that are much thinner than their sheet
// is high.
const char* const unseen = R"({"foliage":{"attenuation_db_per_m":0}})";
const char* const cloth = R"({"relative_permittivity":1.8,"conductivity":0.002,"thickness_m":0.001})";
// Surfaces of bodies. A facet of a mesh stands for a curved piece that is many wavelengths across, and lies
// up to a centimetre off it. What a flat facet would send into one direction goes into all directions about
// which the normals of the piece turn: such a piece scatters nearly all, in a directive lobe. Normals that
// turn by s (rms, about each axis) make alpha_R = 1/(2 s^2). The normals by which the meshes are shaded turn
// by 4.5 degrees on car bodies and panes, by 7 degrees on lamps, and by 10 degrees on people
// (docs/radar_bodies.md). Waves that are long beside the distance between facet and piece (rms, `deviation`)
// see the flat facet.
#define GREATX_CURVED(exponent, deviation)                                               \
  R"("scattering_coefficient":0.99,"pattern":"directive","pattern_exponent":)" #exponent \
  R"(,"deviation_m":)" #deviation
const char* const body_metal = R"({"itu":"metal","thickness_m":0.002,)" GREATX_CURVED(80, 0.003) "}";
const char* const body_pane = R"({"itu":"glass","thickness_m":0.005,)" GREATX_CURVED(80, 0.003) "}";
// Bumpers, grilles and lamps: a plastic skin before steel beams, radiators and metallized reflectors.
const char* const body_cover =
    R"({"layers":[{"relative_permittivity":2.8,"conductivity":0.003,"thickness_m":0.003},)"
    R"({"relative_permittivity":1.0,"conductivity":0.0,"thickness_m":0.06},)"
    R"({"itu":"metal","thickness_m":0.002}],)" GREATX_CURVED(33, 0.0025) "}";
// Engines and wheels: fins, pipes, spokes and bolts turn every way within a facet.
const char* const castings =
    R"({"itu":"metal","thickness_m":0.002,"scattering_coefficient":0.99,"deviation_m":0.01})";
// Treads have blocks and grooves.
const char* const rubber = R"({"relative_permittivity":3.0,"conductivity":0.02,"thickness_m":0.02,)"
                           R"("scattering_coefficient":0.99,"deviation_m":0.005})";
const char* const plastic = R"({"relative_permittivity":2.8,"conductivity":0.003,"thickness_m":0.003})";
// Dry skin by the four Cole-Cole terms of S. Gabriel, R. W. Lau and C. Gabriel, "The dielectric properties of
// biological tissues: III", Phys. Med. Biol. 41 (1996). The rows are fitted to it within 1.1 % of the
// permittivity and 4.2 % of the conductivity (docs/materials.md). As a half-space it lets nothing pass.
const char* const tissue =
    R"({"rows":[{"a":41.21,"b":-0.1273,"c":0.9174,"d":0.3268,"min_hz":4e8,"max_hz":1.5e9},)"
    R"({"a":40.61,"b":-0.07451,"c":0.75,"d":0.7917,"min_hz":1.5e9,"max_hz":4e9},)"
    R"({"a":44.48,"b":-0.138,"c":0.3689,"d":1.322,"min_hz":4e9,"max_hz":8e9},)"
    R"({"a":68.1,"b":-0.3417,"c":0.3192,"d":1.398,"min_hz":8e9,"max_hz":1.4e10},)"
    R"({"a":153.0,"b":-0.6488,"c":0.6504,"d":1.129,"min_hz":1.4e10,"max_hz":2.2e10},)"
    R"({"a":345.6,"b":-0.9136,"c":2.099,"d":0.7501,"min_hz":2.2e10,"max_hz":3.4e10},)"
    R"({"a":438.3,"b":-0.9822,"c":6.69,"d":0.4207,"min_hz":3.4e10,"max_hz":5.2e10},)"
    R"({"a":237.0,"b":-0.8273,"c":14.78,"d":0.2194,"min_hz":5.2e10,"max_hz":7.6e10},)"
    R"({"a":94.09,"b":-0.6134,"c":22.23,"d":0.1246,"min_hz":7.6e10,"max_hz":1e11}],)"
    R"("extrapolate":true,"cross_polarization":0.1,)" GREATX_CURVED(14, 0.002) "}";
#undef GREATX_CURVED
// Woven or coated cloth.
const char* const fabric = R"({"relative_permittivity":2.8,"conductivity":0.003,"thickness_m":0.001})";
const char* const radome = R"({"relative_permittivity":3.5,"conductivity":0.005,"thickness_m":0.003})";
// Carbon fibre composite conducts well enough to reflect like metal.
const char* const carbon_fibre =
    R"({"relative_permittivity":1.0,"conductivity":10000.0,"thickness_m":0.003})";
// Fresh water near 20 C at a few GHz. Unlike Debye's model, the values do not depend on frequency.
const char* const fresh_water = R"({"relative_permittivity":75.0,"conductivity":2.5,"clutter":"water"})";
const char* const clay_tiles = R"({"itu":"brick","extrapolate":true,"thickness_m":0.03,)"
                               R"("scattering_coefficient":0.3,"cross_polarization":0.1})";

std::vector<MaterialSpec> make_library() {
  const dvec2 facade(3.0 * facade_bays, 6.4);
  // Luminance of a white texel of TextureMaps::lit, in units of 1000 cd/m^2. A warm lit pane has 0.6 of the
  // luminance of a white one (docs/generator.md).
  const vec3 home_light(0.05f), office_light(0.05f), shop_light(0.12f);
  return {
      // name, texture, tile, bays, colour, roughness, metallic, emissive, radio
      {"asphalt", "asphalt", dvec2(16.0, 32.0), 0, vec3(1.0f), 0.95f, 0.0f, vec3(0), asphalt_ground},
      {"asphalt_lot", "asphalt", dvec2(16.0, 32.0), 0, vec3(0.96f), 0.95f, 0.0f, vec3(0), asphalt_ground},
      {"country_road", "country_road", dvec2(6.0, 24.0), 0, vec3(1.0f), 0.95f, 0.0f, vec3(0), asphalt_ground},
      {"road_marking", "road_paint", dvec2(4.0), 0, vec3(1.0f), 0.7f, 0.0f, vec3(0), asphalt_ground},
      {"pavement", "pavement", dvec2(9.6), 0, vec3(1.0f), 0.9f, 0.0f, vec3(0), concrete_ground},
      {"kerb", "kerb", dvec2(2.0), 0, vec3(1.0f), 0.85f, 0.0f, vec3(0), concrete_ground},
      {"paving", "pavement", dvec2(19.2), 0, vec3(0.86f, 0.78f, 0.68f), 0.9f, 0.0f, vec3(0), concrete_ground},
      {"subsoil", "", dvec2(2.0), 0, vec3(0.12f, 0.09f, 0.06f), 1.0f, 0.0f, vec3(0), soil},
      {"grass", "grass", dvec2(14.0), 0, vec3(1.0f), 1.0f, 0.0f, vec3(0), lawn},
      {"meadow", "pasture", dvec2(40.0), 0, vec3(1.0f), 1.0f, 0.0f, vec3(0), lawn},
      {"wheat", "crop", dvec2(48.0), 0, vec3(0.62f, 0.46f, 0.18f), 1.0f, 0.0f, vec3(0), corn},
      {"wheat_pale", "crop", dvec2(48.0), 0, vec3(0.70f, 0.58f, 0.30f), 1.0f, 0.0f, vec3(0), corn},
      {"crop", "crop", dvec2(48.0), 0, vec3(0.16f, 0.27f, 0.06f), 1.0f, 0.0f, vec3(0), corn},
      {"crop_dark", "crop", dvec2(48.0), 0, vec3(0.10f, 0.20f, 0.05f), 1.0f, 0.0f, vec3(0), corn},
      {"crop_young", "crop", dvec2(48.0), 0, vec3(0.26f, 0.33f, 0.10f), 1.0f, 0.0f, vec3(0), lawn},
      {"ploughed_soil", "crop", dvec2(48.0), 0, vec3(0.24f, 0.15f, 0.09f), 1.0f, 0.0f, vec3(0), soil, -1,
       true},
      {"stubble", "crop", dvec2(48.0), 0, vec3(0.52f, 0.43f, 0.24f), 1.0f, 0.0f, vec3(0), lawn},
      {"rapeseed", "crop", dvec2(48.0), 0, vec3(0.66f, 0.56f, 0.07f), 1.0f, 0.0f, vec3(0), corn},
      {"verge", "grass", dvec2(11.0), 0, vec3(0.9f, 0.85f, 0.7f), 1.0f, 0.0f, vec3(0), lawn},
      {"water", "", dvec2(4.0), 0, vec3(0.03f, 0.07f, 0.08f), 0.06f, 0.0f, vec3(0), fresh_water},

      {"facade_brick_red", "facade_brick", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, home_light,
       brick_wall, 0},
      {"facade_brick_yellow", "facade_brick", facade, facade_bays, vec3(1.0f, 0.98f, 0.72f), 1.0f, 1.0f,
       home_light, brick_wall, 1},
      {"facade_brick_brown", "facade_brick", facade, facade_bays, vec3(0.6f, 0.66f, 0.7f), 1.0f, 1.0f,
       home_light, brick_wall, 1},
      {"facade_plaster_cream", "facade_plaster", facade, facade_bays, vec3(1.0f, 0.93f, 0.78f), 1.0f, 1.0f,
       home_light, brick_wall, 0},
      {"facade_plaster_white", "facade_plaster", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, home_light,
       brick_wall, 1},
      {"facade_plaster_ochre", "facade_plaster", facade, facade_bays, vec3(1.0f, 0.72f, 0.42f), 1.0f, 1.0f,
       home_light, brick_wall, 0},
      {"facade_plaster_rose", "facade_plaster", facade, facade_bays, vec3(0.92f, 0.66f, 0.56f), 1.0f, 1.0f,
       home_light, brick_wall, 1},
      {"facade_stone_light", "facade_stone", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, home_light,
       concrete_wall, 0},
      {"facade_stone_grey", "facade_stone", facade, facade_bays, vec3(0.78f, 0.8f, 0.82f), 1.0f, 1.0f,
       home_light, concrete_wall, 1},
      {"facade_balcony_white", "facade_balcony", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, home_light,
       concrete_wall, 0},
      {"facade_balcony_sand", "facade_balcony", facade, facade_bays, vec3(0.9f, 0.78f, 0.6f), 1.0f, 1.0f,
       home_light, concrete_wall, 1},
      {"facade_concrete_grey", "facade_concrete", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, home_light,
       concrete_wall, 1},
      {"facade_concrete_light", "facade_ribbon", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, office_light,
       concrete_wall, 0},
      {"facade_glass_blue", "facade_glass", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, office_light,
       glazing, 0},
      {"facade_glass_green", "facade_glass", facade, facade_bays, vec3(0.8f, 1.0f, 0.82f), 1.0f, 1.0f,
       office_light, glazing, 1},
      {"facade_metal_silver", "facade_metal", facade, facade_bays, vec3(1.0f), 1.0f, 1.0f, office_light,
       sheet_metal, 1},
      {"facade_metal_dark", "facade_metal", facade, facade_bays, vec3(0.42f, 0.46f, 0.52f), 1.0f, 1.0f,
       office_light, sheet_metal, 0},
      {"shopfront", "shopfront", dvec2(36.0, 4.2), 6, vec3(1.0f), 1.0f, 1.0f, shop_light, glazing, 0},
      {"shopfront_late", "shopfront", dvec2(36.0, 4.2), 6, vec3(0.94f, 0.96f, 1.0f), 1.0f, 1.0f, shop_light,
       glazing, 1},
      {"dormer", "dormer", dvec2(1.5, 1.6), 1, vec3(1.0f), 1.0f, 1.0f, home_light, timber, 0},
      {"dormer_dark", "dormer", dvec2(1.5, 1.6), 1, vec3(1.0f), 1.0f, 1.0f, vec3(0), timber},
      {"blind_brick", "brick", dvec2(2.56), 0, vec3(1.0f), 0.95f, 0.0f, vec3(0), brick_wall},
      {"blind_plaster", "concrete", dvec2(3.2), 0, vec3(0.9f, 0.84f, 0.72f), 0.95f, 0.0f, vec3(0),
       brick_wall},
      {"concrete", "concrete", dvec2(3.2), 0, vec3(1.0f), 0.9f, 0.0f, vec3(0), concrete_wall},
      {"roof_gravel", "roof", dvec2(18.0), 0, vec3(0.8f), 1.0f, 0.0f, vec3(0), concrete_wall},
      {"roof_dark", "roof", dvec2(18.0), 0, vec3(0.36f), 0.95f, 0.0f, vec3(0), concrete_wall},
      {"roof_equipment", "corrugated", dvec2(1.6), 0, vec3(0.62f, 0.64f, 0.66f), 0.6f, 0.4f, vec3(0),
       sheet_metal},
      {"roof_tiles", "roof_tiles", dvec2(2.4), 0, vec3(1.0f), 0.9f, 0.0f, vec3(0), clay_tiles},
      {"roof_tiles_old", "roof_tiles", dvec2(2.4), 0, vec3(0.62f, 0.6f, 0.58f), 0.95f, 0.0f, vec3(0),
       clay_tiles},
      {"farm_tiles", "roof_tiles", dvec2(2.4), 0, vec3(1.0f), 0.9f, 0.0f, vec3(0), clay_tiles, -1, true},
      {"roof_slate", "slate", dvec2(3.2), 0, vec3(1.0f), 0.7f, 0.0f, vec3(0), clay_tiles},
      {"roof_zinc", "corrugated", dvec2(4.8), 0, vec3(0.42f, 0.46f, 0.5f), 0.5f, 0.4f, vec3(0), sheet_metal},
      {"skylight", "", dvec2(1.0), 0, vec3(0.1f, 0.13f, 0.15f), 0.1f, 0.0f, vec3(0), pane},
      {"solar_panel", "solar", dvec2(1.6, 1.0), 0, vec3(1.0f), 0.2f, 0.0f, vec3(0), pane},
      {"roof_sheet", "corrugated", dvec2(1.6), 0, vec3(0.5f, 0.52f, 0.55f), 0.55f, 0.5f, vec3(0),
       sheet_metal},
      {"barn_boards", "boards", dvec2(2.0), 0, vec3(0.5f, 0.1f, 0.07f), 0.9f, 0.0f, vec3(0), timber},
      {"barn_boards_brown", "boards", dvec2(2.0), 0, vec3(0.42f, 0.28f, 0.17f), 0.9f, 0.0f, vec3(0), timber},
      {"door_boards", "boards", dvec2(1.5), 0, vec3(0.75f, 0.72f, 0.66f), 0.8f, 0.0f, vec3(0), timber},
      {"farm_plaster", "farm_wall", dvec2(16.0, 3.0), 4, vec3(1.0f), 1.0f, 1.0f, home_light, brick_wall, 0},
      {"straw", "crop", dvec2(8.0), 0, vec3(0.7f, 0.54f, 0.24f), 1.0f, 0.0f, vec3(0), timber},
      {"wire", "", dvec2(1.0), 0, vec3(0.03f), 0.6f, 0.0f, vec3(0), unseen},
      {"insulator", "", dvec2(1.0), 0, vec3(0.3f, 0.17f, 0.1f), 0.4f, 0.0f, vec3(0), unseen},
      {"wood_pole", "bark", dvec2(1.0), 0, vec3(0.9f), 0.95f, 0.0f, vec3(0), trunk},

      {"bark", "bark", dvec2(1.0), 0, vec3(0.8f), 1.0f, 0.0f, vec3(0), trunk},
      {"bark_plane", "bark_plane", dvec2(1.6), 0, vec3(1.0f), 1.0f, 0.0f, vec3(0), trunk},
      {"bark_birch", "bark_birch", dvec2(0.8), 0, vec3(1.0f), 1.0f, 0.0f, vec3(0), trunk},
      // Leaves fill a crown, and sprays stand around it.
      {"leaves_green", "leaves", dvec2(3.0), 0, vec3(0.72f, 0.81f, 0.76f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_green", "leaf_sprays", dvec2(3.0), 0, vec3(0.8f, 0.9f, 0.84f), 1.0f, 0.0f, vec3(0), unseen},
      {"leaves_dark", "leaves", dvec2(3.0), 0, vec3(0.54f, 0.67f, 0.56f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_dark", "leaf_sprays", dvec2(3.0), 0, vec3(0.6f, 0.74f, 0.62f), 1.0f, 0.0f, vec3(0), unseen},
      {"leaves_light", "leaves", dvec2(3.0), 0, vec3(0.9f, 0.9f, 0.56f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_light", "leaf_sprays", dvec2(3.0), 0, vec3(1.0f, 1.0f, 0.62f), 1.0f, 0.0f, vec3(0), unseen},
      {"leaves_olive", "leaves", dvec2(3.0), 0, vec3(0.76f, 0.79f, 0.59f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_olive", "leaf_sprays", dvec2(3.0), 0, vec3(0.84f, 0.88f, 0.66f), 1.0f, 0.0f, vec3(0), unseen},
      {"leaves_copper", "leaves", dvec2(3.0), 0, vec3(0.65f, 0.27f, 0.34f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_copper", "leaf_sprays", dvec2(3.0), 0, vec3(0.72f, 0.3f, 0.38f), 1.0f, 0.0f, vec3(0), unseen},
      {"leaves_birch", "leaves", dvec2(3.0), 0, vec3(0.9f, 0.88f, 0.45f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_birch", "leaf_sprays", dvec2(3.0), 0, vec3(1.0f, 0.98f, 0.5f), 1.0f, 0.0f, vec3(0), unseen},
      // Leaves on the ground, and the boughs of bare crowns, whose volume for radio is that of the twigs.
      {"fallen_yellow", "fallen_leaves", dvec2(3.0), 0, vec3(0.66f, 0.44f, 0.08f), 1.0f, 0.0f, vec3(0),
       unseen},
      {"fallen_red", "fallen_leaves", dvec2(3.0), 0, vec3(0.5f, 0.17f, 0.05f), 1.0f, 0.0f, vec3(0), unseen},
      {"fallen_brown", "fallen_leaves", dvec2(3.0), 0, vec3(0.36f, 0.21f, 0.09f), 1.0f, 0.0f, vec3(0),
       unseen},
      {"boughs", "bark", dvec2(1.0), 0, vec3(0.62f), 1.0f, 0.0f, vec3(0), unseen},
      {"needles", "leaves", dvec2(3.0), 0, vec3(0.34f, 0.5f, 0.46f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_needles", "needle_sprays", dvec2(3.0), 0, vec3(0.6f, 0.8f, 0.86f), 1.0f, 0.0f, vec3(0),
       unseen},
      {"needles_pine", "leaves", dvec2(3.0), 0, vec3(0.5f, 0.6f, 0.5f), 1.0f, 0.0f, vec3(0), canopy},
      {"sprays_pine", "needle_sprays", dvec2(3.0), 0, vec3(0.8f, 0.9f, 0.8f), 1.0f, 0.0f, vec3(0), unseen},
      {"grass_tuft", "grass_tufts", dvec2(1.6), 0, vec3(1.0f), 1.0f, 0.0f, vec3(0), unseen},
      {"sprays_hedge", "leaf_sprays", dvec2(3.0), 0, vec3(0.62f, 0.76f, 0.6f), 1.0f, 0.0f, vec3(0), unseen},
      {"hedge", "leaves", dvec2(2.0), 0, vec3(0.7f, 0.8f, 0.62f), 1.0f, 0.0f, vec3(0), canopy},

      {"painted_metal", "", dvec2(1.0), 0, vec3(0.1f, 0.12f, 0.13f), 0.45f, 0.0f, vec3(0), sheet_metal},
      {"galvanised_metal", "", dvec2(1.0), 0, vec3(0.55f, 0.57f, 0.58f), 0.5f, 0.7f, vec3(0), sheet_metal},
      // docs/generator.md states the luminances of the lamps.
      {"lamp_glass", "", dvec2(1.0), 0, vec3(0.9f), 0.3f, 0.0f, lamp_color_4000k * 14.0f, pane},
      {"lamp_glass_warm", "", dvec2(1.0), 0, vec3(0.9f), 0.3f, 0.0f, lamp_color_3000k * 14.0f, pane},
      // 3600 lm leave 0.36 m^2 evenly: 3200 cd/m^2.
      {"panel_glass", "", dvec2(1.0), 0, vec3(0.9f), 0.4f, 0.0f, lamp_color_4000k * 3.2f, plastic},
      {"signal_housing", "", dvec2(1.0), 0, vec3(0.03f, 0.035f, 0.03f), 0.6f, 0.0f, vec3(0), plastic},
      // Lenses of 200 mm shine with some 250 cd: 8000 cd/m^2 (EN 12368 asks for 200 cd at least). They are
      // dark glass before a black housing, and no obstacle to radio beside it.
      {"switched_red", "", dvec2(1.0), 0, vec3(0.09f, 0.006f, 0.006f), 0.3f, 0.0f, vec3(37.6f, 0.0f, 0.0f),
       unseen},
      {"switched_amber", "", dvec2(1.0), 0, vec3(0.09f, 0.045f, 0.006f), 0.3f, 0.0f, vec3(17.8f, 5.9f, 0.0f),
       unseen},
      {"switched_green", "", dvec2(1.0), 0, vec3(0.006f, 0.07f, 0.05f), 0.3f, 0.0f, vec3(0.0f, 11.0f, 2.0f),
       unseen},
      // Direction indicators give 50 to 500 cd (UN Regulation 6) from some 0.01 m^2.
      {"switched_left", "", dvec2(1.0), 0, vec3(0.5f, 0.2f, 0.02f), 0.25f, 0.0f, vec3(22.0f, 7.3f, 0.0f),
       unseen},
      {"switched_right", "", dvec2(1.0), 0, vec3(0.5f, 0.2f, 0.02f), 0.25f, 0.0f, vec3(22.0f, 7.3f, 0.0f),
       unseen},
      {"sign_blue", "", dvec2(1.0), 0, vec3(0.02f, 0.09f, 0.42f), 0.5f, 0.0f, vec3(0), sheet_metal},
      {"neon_red", "", dvec2(1.0), 0, vec3(0.55f, 0.06f, 0.08f), 0.4f, 0.0f, vec3(0.45f, 0.03f, 0.06f),
       plastic},
      {"neon_blue", "", dvec2(1.0), 0, vec3(0.07f, 0.2f, 0.6f), 0.4f, 0.0f, vec3(0.05f, 0.16f, 0.5f),
       plastic},
      {"neon_green", "", dvec2(1.0), 0, vec3(0.06f, 0.42f, 0.2f), 0.4f, 0.0f, vec3(0.025f, 0.2f, 0.08f),
       plastic},
      {"neon_amber", "", dvec2(1.0), 0, vec3(0.7f, 0.4f, 0.08f), 0.4f, 0.0f, vec3(0.3f, 0.15f, 0.03f),
       plastic},
      {"poster", "poster", dvec2(1.2, 1.8), 0, vec3(1.0f), 0.3f, 0.0f, vec3(0.2f), plastic, 0},
      // Panes of 5 mm, with some dust on them: a wall of glass has one on each side.
      {"shelter_glass", "", dvec2(1.0), 0, vec3(0.9f, 0.95f, 0.93f), 0.08f, 0.0f, vec3(0), pane, -1, false,
       0.97f},
      {"traffic_signs", "traffic_signs", dvec2(1.0), 0, vec3(1.0f), 0.5f, 0.0f, vec3(0), sheet_metal},
      {"bicycle", "bicycles", dvec2(1.0), 0, vec3(1.0f), 0.4f, 0.0f, vec3(0), unseen},
      // Tubes of 5 cm.
      {"scaffold_tube", "", dvec2(1.0), 0, vec3(0.5f, 0.51f, 0.52f), 0.5f, 0.6f, vec3(0), unseen},
      {"mesh_fence", "mesh_fence", dvec2(0.3), 0, vec3(1.0f), 0.5f, 0.0f, vec3(0), unseen},
      {"column_bills", "column_bills", dvec2(3.6, 2.5), 0, vec3(1.0f), 0.7f, 0.0f, vec3(0), concrete_wall},
      {"column_green", "", dvec2(1.0), 0, vec3(0.03f, 0.1f, 0.06f), 0.5f, 0.0f, vec3(0), sheet_metal},
      {"post_yellow", "", dvec2(1.0), 0, vec3(0.78f, 0.5f, 0.03f), 0.45f, 0.0f, vec3(0), sheet_metal},
      {"hydrant_red", "", dvec2(1.0), 0, vec3(0.5f, 0.03f, 0.02f), 0.5f, 0.0f, vec3(0), sheet_metal},
      {"cabinet_grey", "cabinet", dvec2(1.2, 1.3), 0, vec3(0.74f, 0.78f, 0.75f), 0.6f, 0.0f, vec3(0),
       plastic},
      {"chair", "", dvec2(1.0), 0, vec3(0.34f, 0.2f, 0.1f), 0.7f, 0.0f, vec3(0), timber},
      {"tree_grate", "tree_grate", dvec2(1.5), 0, vec3(1.0f), 0.9f, 0.0f, vec3(0), soil},
      {"awning_red", "awning", dvec2(0.6, 2.0), 0, vec3(0.8f, 0.24f, 0.18f), 0.9f, 0.0f, vec3(0), cloth},
      {"awning_green", "awning", dvec2(0.6, 2.0), 0, vec3(0.22f, 0.5f, 0.3f), 0.9f, 0.0f, vec3(0), cloth},
      {"awning_blue", "awning", dvec2(0.6, 2.0), 0, vec3(0.24f, 0.36f, 0.62f), 0.9f, 0.0f, vec3(0), cloth},
      {"awning_sand", "awning", dvec2(0.6, 2.0), 0, vec3(0.86f, 0.74f, 0.52f), 0.9f, 0.0f, vec3(0), cloth},
      {"parapet_white", "concrete", dvec2(3.2), 0, vec3(1.0f), 0.8f, 0.0f, vec3(0), concrete_wall},
      {"parapet_dark", "", dvec2(1.0), 0, vec3(0.07f, 0.075f, 0.08f), 0.6f, 0.0f, vec3(0), sheet_metal},
      {"parapet_glass", "", dvec2(1.0), 0, vec3(0.82f, 0.91f, 0.89f), 0.1f, 0.0f, vec3(0), pane, -1, false,
       0.95f},
      {"door_dark", "boards", dvec2(1.5), 0, vec3(0.16f, 0.12f, 0.09f), 0.7f, 0.0f, vec3(0), timber},
      {"downpipe", "", dvec2(1.0), 0, vec3(0.34f, 0.36f, 0.37f), 0.5f, 0.3f, vec3(0), sheet_metal},
      {"plinth_grey", "plinth", dvec2(3.2, 1.6), 0, vec3(0.72f), 0.95f, 0.0f, vec3(0), concrete_wall},
      {"plinth_brown", "plinth", dvec2(3.2, 1.6), 0, vec3(0.56f, 0.48f, 0.42f), 0.95f, 0.0f, vec3(0),
       concrete_wall},
      {"bench_wood", "boards", dvec2(1.0), 0, vec3(0.45f, 0.28f, 0.14f), 0.8f, 0.0f, vec3(0), timber},
      {"radome", "", dvec2(1.0), 0, vec3(0.8f), 0.5f, 0.0f, vec3(0), radome},
      {"aviation_light", "", dvec2(1.0), 0, vec3(0.6f, 0.02f, 0.02f), 0.3f, 0.0f, vec3(1.0f, 0.02f, 0.02f),
       plastic},

      {"car_paint_white", "car_side", dvec2(1.0), 0, vec3(0.78f), 0.28f, 0.0f, vec3(0), body_metal},
      {"car_paint_silver", "car_side", dvec2(1.0), 0, vec3(0.5f, 0.51f, 0.53f), 0.3f, 0.5f, vec3(0),
       body_metal},
      {"car_paint_red", "car_side", dvec2(1.0), 0, vec3(0.5f, 0.025f, 0.03f), 0.25f, 0.0f, vec3(0),
       body_metal},
      {"car_paint_blue", "car_side", dvec2(1.0), 0, vec3(0.03f, 0.1f, 0.32f), 0.28f, 0.3f, vec3(0),
       body_metal},
      {"car_paint_grey", "car_side", dvec2(1.0), 0, vec3(0.16f, 0.17f, 0.18f), 0.3f, 0.4f, vec3(0),
       body_metal},
      {"car_paint_green", "car_side", dvec2(1.0), 0, vec3(0.04f, 0.14f, 0.09f), 0.28f, 0.2f, vec3(0),
       body_metal},
      {"car_paint_sand", "car_side", dvec2(1.0), 0, vec3(0.52f, 0.43f, 0.3f), 0.3f, 0.4f, vec3(0),
       body_metal},
      {"car_paint_yellow", "car_side", dvec2(1.0), 0, vec3(0.7f, 0.46f, 0.03f), 0.28f, 0.0f, vec3(0),
       body_metal},
      {"car_paint_black", "car_side", dvec2(1.0), 0, vec3(0.012f), 0.25f, 0.0f, vec3(0), body_metal},
      {"car_paint_navy", "car_side", dvec2(1.0), 0, vec3(0.014f, 0.028f, 0.08f), 0.28f, 0.3f, vec3(0),
       body_metal},
      {"car_paint_bronze", "car_side", dvec2(1.0), 0, vec3(0.2f, 0.115f, 0.065f), 0.3f, 0.4f, vec3(0),
       body_metal},
      {"car_paint_orange", "car_side", dvec2(1.0), 0, vec3(0.6f, 0.15f, 0.02f), 0.28f, 0.0f, vec3(0),
       body_metal},
      {"car_paint_ivory", "car_side", dvec2(1.0), 0, vec3(0.76f, 0.66f, 0.36f), 0.3f, 0.0f, vec3(0),
       body_metal},
      {"engine_metal", "", dvec2(1.0), 0, vec3(0.55f, 0.57f, 0.58f), 0.5f, 0.7f, vec3(0), castings},
      {"car_trim", "", dvec2(1.0), 0, vec3(0.012f), 0.2f, 0.0f, vec3(0), body_metal},
      {"soft_top", "", dvec2(1.0), 0, vec3(0.022f, 0.02f, 0.02f), 0.95f, 0.0f, vec3(0), fabric},
      {"tarpaulin", "", dvec2(1.0), 0, vec3(0.06f, 0.16f, 0.34f), 0.55f, 0.0f, vec3(0), fabric},
      {"truck_box", "", dvec2(1.0), 0, vec3(0.72f, 0.73f, 0.74f), 0.45f, 0.0f, vec3(0), body_metal},
      {"chassis", "", dvec2(1.0), 0, vec3(0.025f), 0.7f, 0.0f, vec3(0), body_metal},
      {"chrome", "", dvec2(1.0), 0, vec3(0.6f, 0.61f, 0.62f), 0.15f, 1.0f, vec3(0), body_metal},
      {"lamp_cover", "", dvec2(1.0), 0, vec3(0.2f, 0.21f, 0.22f), 0.12f, 0.0f, vec3(0), body_cover},
      {"taxi_sign", "", dvec2(1.0), 0, vec3(0.8f, 0.62f, 0.08f), 0.4f, 0.0f, vec3(0.3f, 0.21f, 0.03f),
       plastic},
      {"blue_beacon", "", dvec2(1.0), 0, vec3(0.02f, 0.06f, 0.55f), 0.2f, 0.0f, vec3(0), plastic},
      {"destination", "", dvec2(1.0), 0, vec3(0.05f, 0.03f, 0.01f), 0.4f, 0.0f, vec3(0.35f, 0.16f, 0.015f),
       plastic},
      {"lit_window", "", dvec2(1.0), 0, vec3(0.035f, 0.042f, 0.045f), 0.08f, 0.0f, lamp_color_4000k * 0.012f,
       body_pane},
      {"wheel_alloy", "wheel_alloy", dvec2(1.0), 0, vec3(1.0f), 0.45f, 0.0f, vec3(0), castings},
      {"wheel_steel", "wheel_steel", dvec2(1.0), 0, vec3(1.0f), 0.55f, 0.0f, vec3(0), castings},
      // With both reflections a pane lets through 72 % along its normal (UN Regulation 43: 70 % at least).
      {"car_glass", "", dvec2(1.0), 0, vec3(0.79f, 0.83f, 0.80f), 0.06f, 0.0f, vec3(0), body_pane, -1, false,
       0.95f},
      // Windows behind which nothing is modelled.
      {"car_glass_dark", "", dvec2(1.0), 0, vec3(0.025f, 0.035f, 0.04f), 0.08f, 0.0f, vec3(0), body_pane},
      // Windows of buses, which glow where no camera looks through them (renderer/surface/pane_color.h), and
      // what stands behind. A saloon with 100 to 150 lux: its surfaces glow with the light that they reflect.
      {"lit_pane_bus", "", dvec2(1.0), 0, vec3(0.79f, 0.83f, 0.80f), 0.06f, 0.0f, lamp_color_4000k * 0.04f,
       body_pane, -1, false, 0.95f},
      {"bus_ceiling", "", dvec2(1.0), 0, vec3(0.3f, 0.3f, 0.29f), 0.8f, 0.0f, lamp_color_4000k * 0.12f,
       unseen},
      {"bus_floor", "", dvec2(1.0), 0, vec3(0.05f, 0.05f, 0.055f), 0.9f, 0.0f, lamp_color_4000k * 0.004f,
       unseen},
      {"bus_seat", "", dvec2(1.0), 0, vec3(0.03f, 0.05f, 0.12f), 0.9f, 0.0f, vec3(0.0016f, 0.0024f, 0.004f),
       unseen},
      {"bus_pole", "", dvec2(1.0), 0, vec3(0.55f, 0.40f, 0.03f), 0.4f, 0.0f, vec3(0.03f, 0.021f, 0.002f),
       unseen},
      {"cabin", "", dvec2(1.0), 0, vec3(0.022f, 0.022f, 0.024f), 0.9f, 0.0f, vec3(0), unseen},
      {"seat", "", dvec2(1.0), 0, vec3(0.038f, 0.036f, 0.035f), 0.9f, 0.0f, vec3(0), unseen},
      {"tyre", "", dvec2(1.0), 0, vec3(0.015f), 0.9f, 0.0f, vec3(0), rubber},
      {"wheel_rim", "", dvec2(1.0), 0, vec3(0.45f), 0.35f, 0.8f, vec3(0), body_metal},
      {"bumper", "", dvec2(1.0), 0, vec3(0.03f), 0.7f, 0.0f, vec3(0), body_cover},
      {"headlight", "", dvec2(1.0), 0, vec3(0.5f, 0.52f, 0.55f), 0.15f, 0.0f, head_lamp_color * 20.0f,
       body_cover},
      {"headlight_off", "", dvec2(1.0), 0, vec3(0.5f, 0.52f, 0.55f), 0.15f, 0.0f, vec3(0), body_cover},
      // 60 to 260 cd of a stop lamp (UN Regulation 7) leave some 0.025 m^2; tail lamps shine with a ninth.
      {"switched_stop", "", dvec2(1.0), 0, vec3(0.45f, 0.01f, 0.01f), 0.2f, 0.0f, vec3(20.7f, 0.0f, 0.0f),
       body_cover},
      {"tail_light", "", dvec2(1.0), 0, vec3(0.45f, 0.01f, 0.01f), 0.2f, 0.0f, vec3(2.3f, 0.004f, 0.003f),
       body_cover},
      {"tail_light_off", "", dvec2(1.0), 0, vec3(0.4f, 0.01f, 0.01f), 0.2f, 0.0f, vec3(0), body_cover},
      {"number_plate", "", dvec2(1.0), 0, vec3(0.7f), 0.5f, 0.0f, vec3(0), body_metal},

      // People. Clothes are thin and nearly transparent to radio, so that they have the skin's medium.
      {"skin_light", "", dvec2(1.0), 0, vec3(0.56f, 0.33f, 0.24f), 0.6f, 0.0f, vec3(0), tissue},
      {"skin_tan", "", dvec2(1.0), 0, vec3(0.42f, 0.23f, 0.14f), 0.6f, 0.0f, vec3(0), tissue},
      {"skin_brown", "", dvec2(1.0), 0, vec3(0.21f, 0.105f, 0.06f), 0.6f, 0.0f, vec3(0), tissue},
      {"skin_dark", "", dvec2(1.0), 0, vec3(0.085f, 0.045f, 0.03f), 0.6f, 0.0f, vec3(0), tissue},
      {"face_light", "face", dvec2(1.0), 0, vec3(0.56f, 0.33f, 0.24f), 0.6f, 0.0f, vec3(0), tissue},
      {"face_tan", "face", dvec2(1.0), 0, vec3(0.42f, 0.23f, 0.14f), 0.6f, 0.0f, vec3(0), tissue},
      {"face_brown", "face", dvec2(1.0), 0, vec3(0.21f, 0.105f, 0.06f), 0.6f, 0.0f, vec3(0), tissue},
      {"face_dark", "face", dvec2(1.0), 0, vec3(0.085f, 0.045f, 0.03f), 0.6f, 0.0f, vec3(0), tissue},
      {"hair_black", "", dvec2(1.0), 0, vec3(0.01f, 0.009f, 0.008f), 0.7f, 0.0f, vec3(0), tissue},
      {"hair_brown", "", dvec2(1.0), 0, vec3(0.05f, 0.027f, 0.015f), 0.7f, 0.0f, vec3(0), tissue},
      {"hair_blond", "", dvec2(1.0), 0, vec3(0.36f, 0.23f, 0.09f), 0.7f, 0.0f, vec3(0), tissue},
      {"hair_auburn", "", dvec2(1.0), 0, vec3(0.11f, 0.035f, 0.014f), 0.7f, 0.0f, vec3(0), tissue},
      {"hair_grey", "", dvec2(1.0), 0, vec3(0.28f), 0.8f, 0.0f, vec3(0), tissue},
      {"hair_white", "", dvec2(1.0), 0, vec3(0.58f), 0.8f, 0.0f, vec3(0), tissue},
      {"helmet", "", dvec2(1.0), 0, vec3(0.6f, 0.61f, 0.62f), 0.3f, 0.0f, vec3(0), plastic},
      {"cloth_navy", "", dvec2(1.0), 0, vec3(0.012f, 0.02f, 0.055f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_black", "", dvec2(1.0), 0, vec3(0.012f, 0.012f, 0.013f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_grey", "", dvec2(1.0), 0, vec3(0.14f, 0.145f, 0.15f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_red", "", dvec2(1.0), 0, vec3(0.32f, 0.02f, 0.025f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_green", "", dvec2(1.0), 0, vec3(0.05f, 0.1f, 0.05f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_beige", "", dvec2(1.0), 0, vec3(0.42f, 0.34f, 0.23f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_white", "", dvec2(1.0), 0, vec3(0.66f, 0.66f, 0.64f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_blue", "", dvec2(1.0), 0, vec3(0.045f, 0.12f, 0.3f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_brown", "", dvec2(1.0), 0, vec3(0.1f, 0.055f, 0.03f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_mustard", "", dvec2(1.0), 0, vec3(0.42f, 0.24f, 0.03f), 0.9f, 0.0f, vec3(0), tissue},
      {"cloth_denim", "", dvec2(1.0), 0, vec3(0.04f, 0.065f, 0.125f), 0.9f, 0.0f, vec3(0), tissue},

      {"navigation_red", "", dvec2(1.0), 0, vec3(0.6f, 0.02f, 0.02f), 0.3f, 0.0f, vec3(8.0f, 0.01f, 0.01f),
       plastic},
      {"navigation_green", "", dvec2(1.0), 0, vec3(0.02f, 0.5f, 0.2f), 0.3f, 0.0f, vec3(0.01f, 2.6f, 0.7f),
       plastic},
      {"uav_shell", "", dvec2(1.0), 0, vec3(0.75f, 0.76f, 0.77f), 0.4f, 0.0f, vec3(0), plastic},
      {"uav_dark", "", dvec2(1.0), 0, vec3(0.03f), 0.5f, 0.0f, vec3(0), plastic},
      {"carbon_fibre", "", dvec2(1.0), 0, vec3(0.02f, 0.02f, 0.022f), 0.35f, 0.0f, vec3(0), carbon_fibre},
      {"motor_metal", "", dvec2(1.0), 0, vec3(0.35f), 0.4f, 0.9f, vec3(0), sheet_metal},
      {"camera_glass", "", dvec2(1.0), 0, vec3(0.01f, 0.01f, 0.02f), 0.05f, 0.0f, vec3(0), pane},
      {"uav_accent", "", dvec2(1.0), 0, vec3(0.75f, 0.16f, 0.02f), 0.45f, 0.0f, vec3(0), plastic},
  };
}

}  // namespace

const std::vector<MaterialSpec>& material_library() {
  static const std::vector<MaterialSpec> library = make_library();
  return library;
}

int material(const std::string& name) {
  const std::vector<MaterialSpec>& library = material_library();
  for (size_t i = 0; i < library.size(); ++i)
    if (library[i].name == name) return static_cast<int>(i);
  GREATX_CHECK(false, "no material called \"{}\"", name);
}

}  // namespace greatx::scene::generator
