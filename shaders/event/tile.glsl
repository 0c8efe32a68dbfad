// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Passes with one invocation for each tile of the pictures (shared/reproject.h).
#ifndef GREATX_EVENT_TILE_GLSL
#define GREATX_EVENT_TILE_GLSL
#include "event/pixels.glsl"
#include "event/look.glsl"
#include "lib/linear.glsl"

layout(local_size_x = event_group_size) in;

/// Returns whether the invocation has a tile: its number, its first pixel, and the tiles in a row.
bool has_tile(out uint tile, out uvec2 first, out uint across) {
  across = tiles_along(model.width);
  tile = linear_invocation;
  first = cell_tile * uvec2(tile % across, tile / across);
  return tile < across * tiles_along(model.height);
}
#endif
