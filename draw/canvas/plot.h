// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws axes and colour bars on a Canvas, and says how large text is.
#pragma once

#include <string>
#include <vector>

#include "draw/canvas/canvas.h"

namespace greatx::io {

/// What draws on a canvas of the dark theme alone takes its colours from here, the others from
/// Canvas::theme().
namespace theme {
inline const Color page = dark_theme().page, panel = dark_theme().panel, border = dark_theme().border,
                   grid = dark_theme().grid, text = dark_theme().text, dim = dark_theme().dim;
inline constexpr int text_scale = 2;
inline constexpr int line_height = 22;  ///< of text at text_scale, pixels
}  // namespace theme

/// Maps values low..high to 0..1, linearly or logarithmically.
struct Scale {
  double low = 0.0, high = 1.0;
  bool logarithmic = false;
  double at(double value) const;
  /// Returns round values within the scale. On a linear scale these are about `count` multiples of 1, 2 or 5
  /// times a power of ten. On a logarithmic scale these are 1, 2 and 5 times the powers of ten, or the powers
  /// alone if there are more than three decades.
  std::vector<double> ticks(int count) const;
};
/// Returns a scale from low to high. It is logarithmic if both are positive and high / low is above
/// `log_above`. If high is not above low, the scale is a narrow linear one around low.
Scale scale_for(double low, double high, double log_above = 1e300);
/// Returns the largest of 1, 2 and 5 times a power of ten that is not above `value` (positive).
double round_down(double value);
/// Returns a short text such as "0.05", "250" or "1e-07".
std::string tick_text(double value);

/// Draws a faint line across a plot at each tick of an axis below it, or of one at its left.
void draw_x_grid(Canvas& canvas, const Rect& plot, const Scale& scale);
void draw_y_grid(Canvas& canvas, const Rect& plot, const Scale& scale);
/// Draws ticks and a label below a plot, about 2 * theme::line_height high.
void draw_x_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label);
/// Draws ticks and a label at the left of a plot.
void draw_y_axis(Canvas& canvas, const Rect& plot, const Scale& scale, const std::string& label);
/// Draws a line at an instant over a plot with time from left to right; nothing outside of the scale.
void mark_time_in(Canvas& canvas, const Rect& plot, const Scale& time, double time_s, Color color);
/// Draws a horizontal bar of colours into `rect` (one line of text high). The values of its ends and the unit
/// are at its sides.
void draw_color_bar(Canvas& canvas, const Rect& rect, const Scale& scale, ColorMap map,
                    const std::string& unit);
/// Draws a vertical bar of colours with ticks at its right and `label` above.
void draw_color_scale(Canvas& canvas, const Rect& bar, const Scale& scale, ColorMap map,
                      const std::string& label);

}  // namespace greatx::io
