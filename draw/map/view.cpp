// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/map/view.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::apps {

MapPixels map_pixels(const sim::MapGrid& grid, uint32_t side) {
  const uint32_t longer = std::max(grid.columns, grid.rows);
  MapPixels pixels;
  pixels.min_m = grid.min_m;
  pixels.max_m = grid.max_m();
  const auto count = [&](uint32_t cells) {
    if (longer <= side) return cells * (side / longer);
    return std::max(1u, static_cast<uint32_t>(std::lround(static_cast<double>(cells) / longer * side)));
  };
  pixels.width = count(grid.columns);
  pixels.height = count(grid.rows);
  return pixels;
}

PictureView top_view(const MapPixels& pixels, const dvec3& origin, double level_m, double low_m,
                     double high_m, double most_shift_m) {
  constexpr double highest = 1e5, clearance = 10.0;
  const dvec2 size = pixels.max_m - pixels.min_m, middle = 0.5 * (pixels.min_m + pixels.max_m);
  const double reach = 0.5 * glm::length(size);
  const double above = std::max(high_m - level_m, 0.0), below = std::max(level_m - low_m, 0.0);
  // A point dz above the level and r from the middle is shown where the ray through it meets the level. It is
  // shifted by r dz / (h - dz).
  const double height = std::min(highest, std::max({reach * above / most_shift_m + above,
                                                    reach * below / most_shift_m, above + clearance, reach}));
  PictureView view;
  view.width = pixels.width;
  view.height = pixels.height;
  view.fx = pixels.width / size.x * height;
  view.fy = pixels.height / size.y * height;
  view.cx = 0.5 * pixels.width;
  view.cy = 0.5 * pixels.height;
  view.near_m = 0.5 * (height - above);
  // The camera looks straight down, and the top of the picture is in the north.
  view.local_from_sensor = {dvec3(middle, level_m + height) - origin,
                            orientation_from_yaw_pitch_roll(0.5 * pi, 0.5 * pi, 0.0)};
  return view;
}

}  // namespace greatx::apps
