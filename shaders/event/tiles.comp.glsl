#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the least and the largest luminance of each tile of both pictures.
#include "event/tile.glsl"

void main() {
  begin_looks();
  uint tile, across;
  uvec2 first;
  if (!has_tile(tile, first, across)) return;
  float least = 1e30, largest = 0.0;
  for (uint i = 0u; i < cell_tile * cell_tile; ++i) {
    uvec2 at = min(first + uvec2(i % cell_tile, i / cell_tile), uvec2(model.width, model.height) - 1u);
    uint pixel = at.y * model.width + at.x;
    for (uint picture = 0u; picture < 2u; ++picture) {
      CellList list = CellList(between.cells[picture]);
      float luminance = uintBitsToFloat(unpack32(list.v[cell_quads * pixel].y).y);
      least = min(least, luminance);
      largest = max(largest, luminance);
    }
  }
  TileList(between.tiles[0]).v[tile] = vec4(least, largest, 0.0, 0.0);
}
