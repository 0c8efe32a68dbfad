// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Places everything of a contact sheet or of a frame of an animation in a grid. It knows sizes alone, so that
// tests can try thousands of combinations: nothing overlaps, and everything is inside.
//
//   frame panels   fill rows of columns_for() tiles, a band. A band of a contact sheet has a row of pictures
//                  for each moment, with the moment's time in the gutter at the left. Below the last row are
//                  the keys of the band's panels.
//   plots          of a contact sheet stand below all bands, equally wide. Those of an animation are tiles of
//                  the grid, behind the frame panels, so that they are there however many pictures there are.
#pragma once

#include <vector>

#include "draw/canvas/canvas.h"

namespace greatx::io {

/// Lengths of the layout, pixels.
namespace sheet {
inline constexpr int margin = 28, gap = 14;
inline constexpr int tile_width = 400, legend_height = 24, title_height = 30, row_gap = 10;
inline constexpr int gutter = 132;                         ///< of a contact sheet
inline constexpr int plot_height = 400, plot_width = 440;  ///< of a contact sheet; the least width
inline constexpr size_t most_rows = 12, most_moments = 4;  ///< of a contact sheet
}  // namespace sheet

struct LayoutWish {
  std::vector<double> aspects;    ///< of frame panels: height over width of their pictures
  std::vector<size_t> key_lines;  ///< of frame panels
  size_t moments = 1, plots = 0;
  int header = 0;          ///< pixels above the first band
  bool animation = false;  ///< no gutter, and plots are tiles
  size_t least_columns = 1;
};

struct SheetLayout {
  struct Tile {
    Rect title, key;
    std::vector<Rect> pictures, legends;  ///< one for each moment
  };
  struct Plot {
    Rect title, area;
  };
  int width = 0, height = 0;  ///< even, as videos need it
  Rect header;
  std::vector<Tile> tiles;
  std::vector<Plot> plots;
  std::vector<std::vector<Rect>> times;  ///< [band][moment], in the gutter; empty in an animation
};

/// Returns how many tiles stand side by side: all of up to five; 4 of up to 8, 5 of up to 10, 6 of up to 24,
/// 8 of more. In an animation 3 of up to 9, but 2 of 4; 4 of up to 16, 6 of up to 30, 8 of more.
size_t columns_for(size_t tiles, bool animation);
/// Returns how many moments a contact sheet shows: sheet::most_moments, but fewer if the bands of its panels
/// would then have more than sheet::most_rows rows.
size_t moments_for(size_t frame_panels);
SheetLayout sheet_layout(const LayoutWish& wish);

/// Returns the largest rectangle of the aspect (height over width) in the middle of the tile, at least one
/// pixel wide and high.
Rect fit(const Rect& tile, double aspect);
/// Returns the height of a tile for pictures up to this aspect, kept within reason.
int tile_height(double tallest_aspect);

}  // namespace greatx::io
