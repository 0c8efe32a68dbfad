#version 460
#extension GL_GOOGLE_include_directive : require
// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds for each tile of pixels how far its surfaces move over the pictures, and so the number of instants,
// and the least and the largest signal anywhere on their way.
#include "event/tile.glsl"

struct Box {
  vec2 least, most;
  float way;
};

/// Adds the way of a pixel's surface over a picture to the box.
void add_way(inout Box box, uint picture, Instant at, uvec2 pixel) {
  vec2 x = vec2(pixel) + 0.5;
  Patch of = patch_of(cell_at(picture, pixel.y * model.width + pixel.x));
  vec2 there = spot_of(ray_of(picture, ray_curve(picture, x), at, of.body, x), of.plane).place;
  box.least = min(box.least, min(there, x));
  box.most = max(box.most, max(there, x));
  box.way = max(box.way, length(there - x));
}

void main() {
  begin_looks();
  uint tile, across;
  uvec2 first;
  if (!has_tile(tile, first, across)) return;
  Box box = Box(vec2(1e30), vec2(-1e30), 0.0);
  const uint apart = 2u;  // every second pixel of every second row stands for its neighbours
  const uint along = cell_tile / apart;
  for (uint i = 0u; i < along * along; ++i) {
    uvec2 pixel = min(first + apart * uvec2(i % along, i / along), uvec2(model.width, model.height) - 1u);
    add_way(box, 0u, Instant(between.grid, 1.0), pixel);
    add_way(box, 1u, Instant(0u, 0.0), pixel);
  }
  const float margin = 4.0;  // pixels: the neighbours, and what a pixel takes in around its place
  vec2 size = vec2(float(model.width), float(model.height)) - 1.0;
  uvec2 begin = uvec2(clamp(box.least - margin, vec2(0.0), size)) / cell_tile,
        end = uvec2(clamp(box.most + margin, vec2(0.0), size)) / cell_tile;
  float least = 1e30, largest = 0.0;
  for (uint y = begin.y; y <= end.y; ++y)
    for (uint x = begin.x; x <= end.x; ++x) {
      vec2 range = TileList(between.tiles[0]).v[y * across + x].xy;
      least = min(least, range.x);
      largest = max(largest, range.y);
    }
  float instants = clamp(ceil(box.way / between.most_px), 1.0, float(between.grid));
  TileList(between.tiles[1]).v[tile] = vec4(instants, 0.0, intBitsToFloat(event_signal(least, model.dark)),
                                            intBitsToFloat(event_signal(largest, model.dark)));
}
