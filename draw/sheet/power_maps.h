// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the maps of power that a radar's panels and those of a channel that senses show: levels in dBm, one
// map for each row, on one scale.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "draw/canvas/plot.h"

namespace greatx::io {

class PowerMaps {
 public:
  /// Adds the map [ranges, columns] of the next row, W, and returns its levels, dBm.
  const std::vector<double>& add(std::span<const float> watts, int64_t columns) {
    columns_ = columns;
    std::vector<double>& levels = levels_.emplace_back();
    for (const float watt : watts)
      levels.push_back(watt > 0.0f ? 10.0 * std::log10(double{watt}) + 30.0 : -400.0);
    return levels;
  }
  /// Sets the scale from 1 dB below `floor`, the lowest median of a map (the noise), to `top`. It is 12 to 60
  /// dB wide. Stronger cells have the colour of its end, so that a single bright wall does not hide the
  /// street.
  void set_scale(double floor, double top) {
    scale_ = {std::max(floor - 1.0, top - 60.0), std::max(top, floor + 11.0), false};
  }
  int64_t columns() const { return columns_; }
  double level(size_t row, int64_t range, int64_t column) const {
    return levels_[row][static_cast<size_t>(range * columns_ + column)];
  }
  Color color(size_t row, int64_t range, int64_t column) const {
    return viridis(std::clamp(scale_.at(level(row, range, column)), 0.0, 1.0));
  }
  void draw_scale(Canvas& canvas, const Rect& legend) const {
    draw_color_bar(canvas, legend, scale_, viridis, "dBm");
  }

 private:
  int64_t columns_ = 1;
  std::vector<std::vector<double>> levels_;
  Scale scale_{-140.0, -80.0, false};
};

}  // namespace greatx::io
