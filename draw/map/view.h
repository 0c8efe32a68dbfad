// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places the camera for a radio map: straight above the scene. The code needs no device.
#pragma once

#include <cstdint>

#include "draw/paths/view.h"
#include "sim/channel/radio_map.h"

namespace greatx::apps {

/// Describes a picture that shows exactly the rectangle of a grid, with north at the top.
struct MapPixels {
  uint32_t width = 0, height = 0;
  dvec2 min_m{0.0}, max_m{0.0};  ///< corners of the rectangle, world

  /// Returns the column and row of a world position, with fractions. Pixel (i, j) covers i to i + 1 and j to
  /// j + 1.
  dvec2 at(const dvec2& world) const {
    return (dvec2(world.x, max_m.y) - dvec2(min_m.x, world.y)) / (max_m - min_m) * dvec2(width, height);
  }
};
/// Returns the pixels for a grid. Every cell has the same whole number of pixels, and the longer side has at
/// most `side` pixels. If the longer side has more than `side` cells, it has exactly `side` pixels.
MapPixels map_pixels(const sim::MapGrid& grid, uint32_t side);

/// Returns a pinhole camera above the middle of the rectangle. Points at the height `level_m` (world z)
/// appear exactly at their x, y. The camera is so high that points from `low_m` to `high_m` are shifted by at
/// most `most_shift_m`. The height above `level_m` is at most 100 km, where fp32 resolves depth to 6 mm; at
/// this limit the shift may be larger.
PictureView top_view(const MapPixels& pixels, const dvec3& origin, double level_m, double low_m,
                     double high_m, double most_shift_m);

}  // namespace greatx::apps
