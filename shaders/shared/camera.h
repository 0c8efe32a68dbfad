// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The camera's shaders and renderer/ share these definitions: bindings, specialization constants, per-tick
// constants, lighting.
#ifndef GREATX_SHADERS_SHARED_CAMERA_H
#define GREATX_SHADERS_SHARED_CAMERA_H
#include "glsl.h"

GREATX_SHARED_BEGIN

// These bindings of set 0 stand beside the scene's own.
const uint lighting_binding = 4u;           // uniform: GpuLighting
const uint shadow_tiles_binding = 5u;       // storage: GpuShadowTiles, this tick's
const uint lights_binding = 6u;             // storage: words of lamps and their clusters, this tick's
const uint environment_binding = 7u;        // sampled: octahedral map of the sky, a roughness per mip level
const uint static_shadow_binding = 8u;      // sampled with comparison
const uint moving_shadow_binding = 9u;      // sampled with comparison
const uint visibility_binding = 10u;        // triangle + 1: storage image r32ui, or multisampled and sampled
const uint triangle_records_binding = 11u;  // storage: data that shading needs of each triangle
const uint material_records_binding = 15u;  // storage: data that shading needs of each material
// These are storage buffers, [pixels] (renderer/camera/picture.h).
const uint shade_color_binding = 12u;      // uvec2: four halves
const uint shade_seen_binding = 13u;       // uvec2: planar depth's bits, triangle + 1
const uint shade_luminance_binding = 14u;  // float, cd/m^2
const uint sky_view_binding = 16u;         // sampled: floor, then shares of the sky at three heights above it
const uint lens_binding = 17u;             // sampled: where the pinhole picture has the pixels' centres
// The pass that smooths edges has storage buffers as above.
const uint edges_seen_binding = 4u;
const uint edges_from_binding = 5u;
const uint edges_to_binding = 6u;
const uint edges_luminance_from_binding = 7u;
const uint edges_luminance_to_binding = 8u;
// shade and edges, of a camera with several views (renderer/camera/faces.h): storage, FacePixel; of one with
// thin lines: storage, the words of shaders/shared/lines.h, this tick's
const uint face_pixels_binding = 27u;
const uint horizon_binding = 28u;   // uniform: GpuHorizon (shaders/shared/horizon.h)
const uint panorama_binding = 29u;  // sampled: the sky's radiance with clouds, and what they let through
const uint marks_binding = 30u;     // uniform: GpuMarks (shaders/shared/marks.h)
const uint mark_map_binding = 31u;  // sampled: the share of the ground under markings
// Cascades (renderer/light/near_shadow.h): storage, GpuNearShadows; two maps, sampled with comparison.
const uint near_shadows_binding = 18u;
const uint fine_shadow_binding = 19u;
const uint middle_shadow_binding = 32u;
const uint stars_binding = 20u;  // storage: GpuStar [star_cells, star_cells]
// Weather and night (shaders/shared/weather.h).
const uint weather_binding = 24u;      // uniform: GpuWeather
const uint rain_cover_binding = 25u;   // sampled with comparison: what lies under the open sky
const uint lamp_shadow_binding = 26u;  // sampled with comparison: the lamps' tiles
// storage, words: uvec3 [pixels], halves: weight and roughness of a mirror, and the stored radiance that it
// shows so far (if spec_mirrors is set); then what pixels see of panes (if spec_panes is; pane_pixel_words)
const uint shade_mirror_binding = 23u;
const uint pane_passes_binding = 33u;  // what the panes of a sample let through: storage image, or sampled

// Specialization constants of the shading pipeline: the wanted outputs, and one constant for each effect of
// the plan.
const uint spec_color = 0u;
const uint spec_ids = 1u;
const uint spec_sun = 2u;
const uint spec_sky = 3u;
const uint spec_static_shadows = 4u;
const uint spec_moving_shadows = 5u;
const uint spec_textures = 6u;
const uint spec_normal_maps = 7u;
const uint spec_emissive = 8u;
const uint spec_lights = 9u;
const uint spec_specular = 10u;
const uint spec_luminance = 11u;
const uint spec_haze = 12u;
const uint spec_night_sky = 13u;
const uint spec_ambient_occlusion = 14u;
const uint spec_distortion = 15u;
const uint spec_blend = 16u;
const uint spec_base_color_arrays = 17u;  // lib/textures.glsl
const uint spec_metallic_roughness_arrays = 18u;
const uint spec_normal_arrays = 19u;
const uint spec_emissive_arrays = 20u;
const uint spec_thin_lines = 21u;
// The records of triangles may be larger than the part of a buffer that a shader sees at once. Their address
// is then bound.
const uint spec_triangle_address = 22u;
// A camera with several views lists the pixels of each. Its depth may be the distance along the ray, and
// bands of rows may be of different instants (their rows; 0: they are not).
const uint spec_faces = 23u;
const uint spec_range = 24u;
const uint spec_band_rows = 25u;
const uint spec_clouds = 26u;
const uint spec_horizon = 27u;  // a HorizonKind (renderer/light/lighting.h)
const uint spec_markings = 28u;
const uint spec_pane_shadows = 29u;  // panes are in the maps of shadows (camera/shadow_pane.frag.glsl)
// Weather and night (shaders/shared/weather.h).
const uint spec_wet_surfaces = 32u;
const uint spec_snow_cover = 33u;
const uint spec_mirrors = 34u;  // what surfaces mirror is kept for MirrorPass
const uint spec_lamp_shadows = 35u;
const uint spec_lamp_halos = 36u;
// Effects of docs/global_light.md.
const uint spec_contact_occlusion = 37u;
const uint spec_bounced_light = 38u;
const uint spec_glass = 39u;
const uint spec_shadow_cascades = 40u;  // their number
const uint spec_beams = 41u;            // some lamp has a passing beam
const uint spec_panes = 42u;            // panes let light through (renderer/camera/panes.h)
const uint spec_switched_lamps = 43u;   // lamps switch (scene/description/lamps.h)
const uint spec_beam_shadows = 44u;     // spots that move cast shadows (renderer/light/beam_shadow.h)
const uint shade_spec_count = 45u;
// These constants belong to the shadow maps.
const uint shadow_spec_base_color_arrays = 0u;
const uint shadow_spec_masked = 1u;

/// A pixel looks at nine texels of the static or moving shadow map if its size in texels is below this.
const float shadow_near = 0.75f;
/// A surface rougher than this mirrors the sky's irradiance instead of the environment map.
const float environment_most_roughness = 0.6f;
/// The heights over the floor at which shares of the sky are known, m, beside 0.
const float sky_view_middle = 8.0f;
const float sky_view_top = 24.0f;

/// Clusters of lamps are tiles of the pinhole picture times slices of planar depth. The words are a header,
/// (first entry, count) of each cluster, the entries (quadruples of words where lamps begin), and the lamps.
const uint lamp_tile_pixels = 32u;
const uint lamp_slices = 20u;
const float lamp_slices_per_octave = 2.0f;
const float lamp_slice_of_1m = 1.0f;
const uint lamps_columns_word = 0u;
const uint lamps_rows_word = 1u;
const uint lamps_across_word = 2u;  // tiles across the picture, a float
const uint lamps_down_word = 3u;
const uint lamps_last_column_word = 4u;  // as floats
const uint lamps_last_row_word = 5u;
const uint lamps_header_words = 7u;
/// The word of the first of (first entry, count) of the lamps that may light the air before a tile's pixels,
/// row by row.
const uint lamps_halos_word = 6u;
/// A lamp is five quadruples of floats, and an entry counts the quadruples from the words' beginning. The
/// first holds the position from the eye (of a directional light: unit, towards it) and 1 / range^2
/// (directional: -1). The second holds the unit direction and the scale of the cone. The third holds the
/// intensity, cd (directional: lux), and the offset of the cone. The fourth belongs to its shadow: an axis
/// across its direction times the scale of its tile, and the middle of the tile in unsigned 16-bit fractions;
/// the axis is 0 if it casts none. Of a spot with a passing beam (shaders/shared/beam.h) it holds the
/// unit direction up across its axis, and lamp_of_beam; of another spot that moves and has a tile in this
/// picture, the same and lamp_of_cone. The fifth is that tile of a spot that moves: its middle, packed like
/// the other, its scale (uv over the tangents to the right and up), and the strength of the shadow, 0 without
/// a tile.
const uint lamp_record_quads = 5u;
const uint lamp_of_beam = 0xffffffffu;
const uint lamp_of_cone = 0xfffffffeu;
/// The tiles of spots that move, texels. Those of passing beams reach to these tangents right and left of the
/// axis, and up and down from their middle, which lies below the axis.
const uint beam_tile_width = 448u;
const uint beam_tile_height = 192u;
const float beam_tile_right = 0.7f;
const float beam_tile_up = 0.3f;
const float beam_tile_middle = -0.05f;
/// What is nearer to a lamp than this along its axis casts no shadow: its own housing.
const float lamp_shadow_near = 0.5f;
/// The most lamps whose light in the air a pixel adds up.
const uint most_halos = 24u;
/// Dielectrics rougher than this show no highlights of lamps.
const float lamp_most_roughness = 0.6f;

/// A triangle's record has these quadruples of words. Corners are in the body's frame, in fp32 unless said
/// otherwise:
///   0  first corner; body << 16 | material
///   1  edge to the second corner; normal at the first
///   2  edge to the third corner; normal at the second
///   3  texture coordinates at the first corner, then their change to the second
///   4  ... and to the third; normal at the third; bits (shared/marks.h), 1 where the normal map is mirrored
///   5  tangents at the three corners; 1 where its material has an alpha mask, and above this bit the number
///      of its switched lamp's factor (lib/scene.glsl)
/// Normals and tangents are octahedral in two 16-bit words: 5e-5 rad.
const uint triangle_record_quads = 6u;
/// A material's record has these quadruples, low half first:
///   0  base colour in halves: red, green; blue, other place of its roughness (roughness_in_...; 0: nowhere);
///      metallic, roughness as fractions of 65535; base-colour texture
///   1  emission in floats; emissive texture
///   2  scale of the normal map; normal texture, metallic-roughness texture; what a pane lets
///      through beside its reflection, in three fractions of 1023 from the lowest bits
/// A texture is stored as its reference (scene/device/texture_layers.h) + 1, or 0 if there is none.
const uint material_record_quads = 3u;
const uint roughness_in_texture = 1u;   ///< metallic-roughness texture
const uint roughness_in_alpha = 2u;     ///< alpha of the base-colour texture
const uint roughness_of_pane = 3u;      ///< nowhere; the material is a pane, and so it is from here on
const uint roughness_of_lit_pane = 4u;  ///< one that glows as far as cameras do not look through it

const uint shade_group_width = 8u;
const uint shade_group_height = 8u;

/// Mip levels of the environment map: level l is blurred for roughness l / (levels - 1).
const uint environment_size = 256u;
const uint environment_levels = 6u;

/// The edge of the octahedral map of stars. A cell has at most one star.
const uint star_cells = 128u;

/// The radiance over 1 cd/m^2 that an emissive factor of 1.0 stands for.
const float emissive_nits = 1000.0f;

/// Bits of CameraConstants::first.
const uint camera_first_part = 1u;
const uint camera_sees_panes = 2u;  ///< PanePixels of this view are valid
const uint camera_sees_lines = 4u;  ///< the view has words of thin lines

/// Holds what a pixel sees of panes, in five words. The first is the triangle + 1 of the nearest pane before
/// its centre (0: no pane; pane_beside: only before other samples); those of all pixels stand together. The
/// others are its planar depth, then six halves: the stored radiance that the panes add, and the share of the
/// light behind that they let through.
const uint pane_pixel_words = 5u;
const uint pane_beside = 0x80000000u;

/// Holds the push constants of the visibility and shading pipelines. Positions are taken relative to the eye
/// before anything is rounded: eye_high + eye_low is the eye in local coordinates to twice the precision of a
/// float.
struct CameraConstants {
  vec3 eye_high;
  vec3 eye_low;
  vec3 clip_x;  ///< clip.x = dot(clip_x, p - eye)
  vec3 clip_y;
  vec3 forward;  ///< clip.w = planar depth = dot(forward, p - eye)
  vec3 ray_x;    ///< p - eye = depth (ray_0 + ray_x x + ray_y y) at pixel coordinates x, y (centres at +0.5)
  vec3 ray_y;
  vec3 ray_0;
  vec3 light_eye;  ///< the eye in the sun's frame (GpuLighting::light_x, light_y, sun_direction)
  float near_m;
  float exposure;  ///< stored value = exposure times radiance in cd/m^2
  float weight;    ///< fraction of the exposure time of this part; 1: the whole
  uint first;      ///< bits: camera_first_part, camera_sees_panes, camera_sees_lines
  uint size;       ///< size of the picture: width | height << 16
};

/// Holds the push constants of the visibility pass for one moving body: a point p of the body has the clip
/// coordinates dot(clip_x, (p, 1)), dot(clip_y, (p, 1)) and the planar depth dot(forward, (p, 1)).
struct BodyView {
  vec4 clip_x;
  vec4 clip_y;
  vec4 forward;
  float near_m;
};

/// Holds a pixel that looks through a view: column | row << 16 of the picture (all ones: no pixel), and the
/// places in the view, in its pixels, where its ray and those of its right and lower neighbours pass.
struct FacePixel {
  uint at;
  vec2 place;
  vec2 right;
  vec2 down;
};

/// Holds the lighting, which is set at construction: key light (sun or moon), sky, haze, the static shadow
/// map. Radiometric units are photometric: lux and cd/m^2 per linear Rec. 709 channel, such that 0.2126 R +
/// 0.7152 G + 0.0722 B is the illuminance or luminance.
struct GpuLighting {
  vec3 sun_direction;         ///< unit, to the key light, local frame; also the third axis of its frame
  float sun_cos_radius;       ///< cosine of the angular radius of the disc
  vec3 sun_illuminance;       ///< on a surface facing the sun
  float static_texel_m;       ///< edge of a texel of the static shadow map
  vec3 sun_disc;              ///< radiance of the disc; 0 if the key light is the moon
  float environment_scale;    ///< radiance = texel of the environment map times this
  vec3 light_x;               ///< the sun's frame: unit, right-handed with light_y and sun_direction
  float static_depth_offset;  ///< depth = z static_depth_scale + static_depth_offset
  vec3 light_y;
  float static_depth_scale;
  vec2 static_uv_scale;  ///< uv = xy static_uv_scale + static_uv_offset
  vec2 static_uv_offset;
  float static_map_size;  ///< texels along an edge
  float moving_map_size;
  float pad1;
  float pad2;
  /// Radiance of endless haze: haze_ambient + haze_directed (1 + g^2 - 2 g cos)^-1.5, with the cosine of the
  /// angle from the key light.
  vec3 haze_ambient;
  float haze_extinction;  ///< 1/m
  vec3 haze_directed;
  float haze_asymmetry;  ///< g
  vec3 moon_direction;   ///< unit
  float moon_radius;     ///< rad
  vec3 moon_bright;      ///< unit, across moon_direction: from the disc's middle to its bright limb
  float moon_cos_phase;
  vec3 moon_disc;  ///< radiance of its bright part
  float pad3;
  vec4 sky_view_uv;      ///< scale and offset of local x, y
  float sky_view_floor;  ///< local z from which heights are counted
  float sky_view_step;   ///< m along the normal at which a point is looked up
  vec3 bounce;           ///< radiance of the objects that hide the sky
  float pad4;
  vec4 irradiance[9];  ///< spherical harmonics of the sky's irradiance / pi (rgb), real basis, order 2
};

/// Holds one cell of the map of stars.
struct GpuStar {
  uint place;  ///< octahedral coordinates within the cell, 16 bits each
  uint light;  ///< halves: illuminance / 1e-6 lux, 0 where there is none; warmth from 0 (blue) to 1
};

/// Holds the header before the tiles: their common bounds in the sun's x, y, and a grid over these bounds.
/// Behind it stands a word for each cell, row by row: its number of tiles, and above shadow_cell_bits the
/// quadruple of words (from the beginning) where they stand, two quadruples each.
struct ShadowTilesHeader {
  vec2 min;
  vec2 max;
  float cells_per_m;
  float columns;
  float rows;
  float pad;
};
const uint shadow_cell_bits = 10u;
const uint shadow_cell_most = 1023u;  // tiles of a cell

/// Holds the shadow of one moving body: a square of the sun's frame around it, and the place of that square
/// in the atlas.
struct GpuShadowTile {
  vec3 center;  ///< centre of the body's bounding sphere, in the sun's frame
  float radius;
  vec2 uv_center;   ///< centre of the tile
  float uv_radius;  ///< half of its edge, without the margin
  float texel_m;
};

/// Holds a camera's cascades, finest first (renderer/light/near_shadow.h). A point that is r from `center`
/// along x or y, whichever is more, has the weight (reach - r) fade, from 0 to 1.
struct GpuNearShadows {
  vec2 center;  ///< in the sun's x, y
  vec2 reach;   ///< m
  vec2 fade;    ///< 1/m
  vec2 texel_m;
  vec2 uv_scale;  ///< uv = xy uv_scale, modulo 1
};

/// Holds the push constants of the pass that draws a part of a moving body into the atlas. It takes points to
/// clip coordinates: (dot(row, vec4(p, 1)), 1).
struct GpuShadowPart {
  vec4 row0;
  vec4 row1;
  vec4 row2;
};

/// Holds the push constants of the passes that draw casters of shadows: clip = (dot(row, vec4(p, 1))).
struct CasterConstants {
  vec4 rows[4];
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::CameraConstants) == 128);
// A group of FacePixels begins where every device lets a binding begin.
static_assert(sizeof(greatx::shared::FacePixel) * greatx::shared::shade_group_width *
                  greatx::shared::shade_group_height % 256 ==
              0);
static_assert(sizeof(greatx::shared::GpuLighting) == 112 + 80 + 40 + 144);
static_assert(sizeof(greatx::shared::ShadowTilesHeader) == 32);
static_assert(sizeof(greatx::shared::GpuShadowTile) == 32);
#endif
#endif
