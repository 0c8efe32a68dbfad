// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the colours of pictures, in one table with a column for each theme: dark for screens, light for
// paper.
//
//   Theme  = the colours of page, text and marks, the colour maps of values, the colours of lines and of ids
//   Canvas = carries one theme (canvas.h), so that whatever draws on it asks it for colours by their purpose
//
// The light theme prints on white, and people with any of the three common kinds of colour blindness can tell
// its lines apart: its maps rise steadily in lightness, and its lines have the colours of M. Okabe and K. Ito
// ("Color Universal Design", 2008) without yellow and black. tests/io/canvas_test.cpp checks both.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace greatx::io {

struct Color {
  uint8_t r = 0, g = 0, b = 0;
};

/// A colour for each value of 0..1.
using ColorMap = Color (*)(double);

struct Theme {
  explicit Theme() = default;  // no list of three numbers, which may be a Color, becomes a theme
  const char* name;
  Color page, panel, border, grid;  ///< behind everything, behind plots, around them, within them
  Color text, dim;                  ///< titles and values; what is less important
  Color sky;                        ///< pixels that see nothing
  Color outline;                    ///< of buildings in maps
  // Marks and writing over pictures and maps of power, whose colours are the same in both themes.
  Color detection, false_alarm, truth, over, halo;
  ColorMap heights;               ///< from low to high
  ColorMap depths;                ///< from near to far
  ColorMap power;                 ///< dBm, dB, luminance
  ColorMap velocities;            ///< from approaching to receding; 0 is in the middle
  std::span<const Color> series;  ///< of lines; they repeat
  std::span<const Color> ids;     ///< of ids, 0 first; empty: hues by color_of_id(uint32_t)
};

const Theme& dark_theme();
const Theme& light_theme();
/// Returns the theme of a name, "dark" or "light", or null.
const Theme* theme_called(std::string_view name);

/// Returns a colour of Turbo by Anton Mikhailov (polynomial of degree 5 by Ruofei Du, Apache-2.0); t in 0..1.
Color turbo(double t);
/// Returns a colour of Viridis (polynomial of degree 6 by Matt Zucker, public domain); t in 0..1.
Color viridis(double t);
/// Returns the colour of an id. Successive ids have clearly different colours; 0 is dark grey.
Color color_of_id(uint32_t id);
/// The same in a theme.
Color color_of_id(const Theme& theme, uint32_t id);
/// Returns the colour of the n-th line of a plot. The colours repeat after eight lines.
Color color_of_series(size_t n);
Color color_of_series(const Theme& theme, size_t n);

}  // namespace greatx::io
