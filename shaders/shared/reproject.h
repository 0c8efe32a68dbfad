// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines what an event camera keeps of a rendered picture, and how a pixel at an instant between two
// pictures finds the point that it sees in them (docs/events.md, "Reconstructed instants").
//
// All vectors of three are homogeneous pixel coordinates of one picture: (u z, v z, z) for a point at planar
// depth z that projects to (u, v). A surface is a plane q with dot(q, point) = 1, so 1 / z = dot(q, (u, v,
// 1)). The sky is the plane 0.
#ifndef GREATX_SHADERS_SHARED_REPROJECT_H
#define GREATX_SHADERS_SHARED_REPROJECT_H
#include "glsl.h"

GREATX_SHARED_BEGIN

// Bindings of the pass that makes cells, beside the scene's and the surfaces'.
const uint cells_seen_binding = 4u;       // storage: uvec2: planar depth's bits, triangle + 1
const uint cells_luminance_binding = 5u;  // storage: float, cd/m^2, before edges are smoothed
const uint cells_to_binding = 6u;         // storage: u64vec2 [2 * pixels]: PictureCell
const uint cells_ids_binding = 7u;        // storage: uvec2 [triangles + 1]: instance + 1, ...

const uint cells_spec_outlines = 0u;  // specialization constant: outlines are known

/// A picture's tiles are squares of that many pixels.
const uint cell_tile = 8u;
/// Returns the number of tiles along a side of that many pixels.
GREATX_FUNCTION uint tiles_along(uint pixels) { return (pixels + cell_tile - 1u) / cell_tile; }

/// Holds what one pixel of a picture saw. It is loaded and stored as four numbers of 64 bits.
///   words 0 to 2  plane of the surface that its centre sees
///   word 3        luminance without smoothed edges, cd/m^2
///   words 4, 5    luminance of the neighbours to the right, left; below, above: the upper halves of floats
///   word 6        a byte for each of these neighbours, lowest first: how far the outline between the two is
///                 from the centre, in 126ths of a pixel, or cell_no_edge; cell_occluder is added if the
///                 neighbour lies before a gap in depth
///   word 7        body << 16 | (instance + 1)
const uint cell_quads = 2u;
const uint cell_no_edge = 127u;
const uint cell_occluder = 128u;

/// Takes the pixel (x, y) of a camera at an instant into the homogeneous coordinates of a picture: a point at
/// planar depth z of that instant is o + z (r0 + rx x + ry y). Everything is seen from the body on which the
/// point lies.
struct PixelPath {
  vec3 r0;
  vec3 rx;
  vec3 ry;
  vec3 o;
};

/// Describes the interval between two pictures, `from` and `to`. It is followed by the paths of bodies:
/// PixelPath [2 pictures][grid + 1 instants][bodies].
struct ReprojectInterval {
  uint64_t cells[2];  ///< address of PictureCell [pixels] of each picture
  /// Addresses of vec4 [tiles]. The first holds the least and the largest luminance in both pictures, the
  /// second the number of instants, and the bits of the least and the largest signal on the pixels' way.
  uint64_t tiles[2];
  uint64_t paths;      ///< address of PixelPath, as above
  uint grid;           ///< even instants of the interval at which pixels may look
  uint bodies;         ///< number of bodies with the world, body 0
  uint exact_world;    ///< whether the world's paths are read from `paths`, too, and not from `world`
  float most_px;       ///< wanted motion from one instant of a pixel to its next
  float sharpness;     ///< outlines: 1 over the width in pixels of what a pixel takes in
  uint replay;         ///< whether the pass writes the events in order of the pixels, after an overflow
  PixelPath world[8];  ///< by picture: coefficients of 1, t, t^2, t^3; t from 0 to 1 in the interval
};

GREATX_SHARED_END

#ifdef __cplusplus
static_assert(sizeof(greatx::shared::PixelPath) == 48);
static_assert(sizeof(greatx::shared::ReprojectInterval) == 64 + 8 * 48);
#endif
#endif
