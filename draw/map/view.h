// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A radio map's scene seen straight from above. No device: only where the camera stands.
#pragma once

#include <cstdint>

#include "draw/paths/view.h"
#include "sim/channel/radio_map.h"

namespace greatx::apps {

/// Which pixels show a grid: all of it and nothing else, north up.
struct MapPixels {
  uint32_t width = 0, height = 0;
  dvec2 min_m{0.0}, max_m{0.0};  ///< world

  /// Column and row (fractions) of a world position; pixel (i, j) reaches from i to i + 1 and j to j + 1.
  dvec2 at(const dvec2& world) const {
    return (dvec2(world.x, max_m.y) - dvec2(min_m.x, world.y)) / (max_m - min_m) * dvec2(width, height);
  }
};
/// Every cell gets the same whole number of pixels, so that the longer side has about `side` of them; grids
/// with more cells than that get `side` pixels.
MapPixels map_pixels(const sim::MapGrid& grid, uint32_t side);

/// A pinhole camera so high above the middle that what lies `low_m` to `high_m` (world z) is shown at most
/// `most_shift_m` beside where it is; what lies at `level_m` is exactly there. No higher than 100 km, where
/// depth is good to 6 mm (fp32).
PictureView top_view(const MapPixels& pixels, const dvec3& origin, double level_m, double low_m,
                     double high_m, double most_shift_m);

}  // namespace greatx::apps
