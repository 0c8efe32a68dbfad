// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Axes and colour bars on a Canvas, and the contact sheet's colours.
#pragma once

#include <string>
#include <vector>

#include "draw/canvas/canvas.h"

namespace greatx::io {

namespace theme {
inline constexpr Color page{17, 19, 24};
inline constexpr Color panel{26, 29, 36};
inline constexpr Color border{62, 67, 78};
inline constexpr Color grid{44, 48, 58};
inline constexpr Color text{226, 230, 238};
inline constexpr Color dim{150, 157, 170};
inline constexpr int text_scale = 2;
inline constexpr int line_height = 22;  ///< of text at that scale
}  // namespace theme

/// A scale from values to 0..1, linear or logarithmic.
struct Scale {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;
  double at(double value) const;
  /// About `count` round values within the scale; 1, 2, 5 times powers of ten.
  std::vector<double> ticks(int count) const;
};
/// Covers the values; logarithmic if they are positive and span more than a factor of `log_above`.
Scale scale_for(double low, double high, double log_above = 1e300);
/// The round number (1, 2, 5 times a power of ten) next to value, not above it.
double round_down(double value);
/// Short: "0.05", "250", "1e-07".
std::string tick_text(double value);

/// Ticks and label below a plot; takes 2 * theme::line_height below it.
void draw_x_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label);
/// Ticks and label left of a plot.
void draw_y_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label);
/// A bar with its ends and unit written at its sides, filling `rect` (one line of text high).
void draw_color_bar(Canvas& canvas, const Rect& rect, const Scale& scale, Color (*map)(double),
                    const std::string& unit);
/// A vertical bar with ticks at its right.
void draw_color_scale(Canvas& canvas, const Rect& bar, const Scale& scale, Color (*map)(double),
                      const std::string& label);

}  // namespace greatx::io
