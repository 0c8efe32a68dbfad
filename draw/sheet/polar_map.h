// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws a range-azimuth map over the ground from above, forward up, for radars and for channels that sense.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/vec.h"
#include "draw/canvas/plot.h"

namespace greatx::io {

struct PolarAxes {
  double range_bin_m = 1.0, azimuth_min = -1.0, azimuth_max = 1.0;  ///< rad, positive to the left
  int64_t ranges = 1, azimuths = 1;
};

/// The sensor stands in the middle of the foot of the picture. Ranges up to `far_m` are shown.
class PolarMap {
 public:
  PolarMap(const PolarAxes& axes, double far_m) : axes_(axes), far_m_(far_m) {}

  /// Fills the picture with the colors of the cells (range, azimuth).
  void draw_cells(Canvas& canvas, const Rect& picture,
                  const std::function<Color(int64_t range, int64_t azimuth)>& color) const;
  /// Draws circles of equal range, and writes their ranges.
  void draw_rings(Canvas& canvas, const Rect& picture) const;
  void draw_ring_ranges(Canvas& canvas, const Rect& picture) const;
  /// Returns the pixel of a place `ahead` and `left` of the sensor, metres.
  dvec2 pixel_of(const Rect& picture, double ahead, double left) const;
  dvec2 place(const Rect& picture, double range_m, double azimuth) const;
  /// Says where pixel (x, y) is and which level, dBm, its cell has; empty outside of the picture.
  std::string text_at(const Rect& picture, int x, int y,
                      const std::function<double(int64_t range, int64_t azimuth)>& level) const;

 private:
  struct Layout {
    double foot_x, foot_y, pixels;  ///< the sensor's place; pixels a metre
  };
  struct Cell {
    int64_t range, azimuth;
  };
  Layout layout(const Rect& picture) const;
  std::optional<Cell> cell_of(double ahead, double left) const;

  PolarAxes axes_;
  double far_m_;
};

}  // namespace greatx::io
