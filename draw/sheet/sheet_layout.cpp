// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/sheet/sheet_layout.h"

#include <algorithm>
#include <cmath>

#include "draw/canvas/plot.h"

namespace greatx::io {

namespace {

using namespace sheet;

constexpr size_t one_row = 5;  ///< so many panels stand in one row
constexpr int key_gap = 6;     ///< above a key

int even(int length) { return length + length % 2; }

/// Places bands one below the other.
class Grid {
 public:
  Grid(const LayoutWish& wish, size_t columns)
      : wish_(wish),
        columns_(columns),
        left_(margin + (wish.animation ? 0 : gutter)),
        y_(margin + wish.header) {}

  /// Adds the tiles of frame panels [first, last), and `plots` plots behind them.
  void add_band(SheetLayout& layout, size_t first, size_t last, size_t plots) {
    double tallest = 0.0;
    size_t lines = 0;
    for (size_t i = first; i < last; ++i) {
      tallest = std::max(tallest, wish_.aspects[i]);
      lines = std::max(lines, wish_.key_lines[i]);
    }
    const int picture_height = tile_height(first == last ? 0.75 : tallest), top = y_ + title_height;
    const int row = picture_height + legend_height + row_gap;
    const int rows = static_cast<int>(wish_.moments) * row;
    const int key = lines == 0 ? 0 : key_gap + static_cast<int>(lines) * theme::line_height;
    for (size_t i = first; i < last; ++i) {
      SheetLayout::Tile& tile = layout.tiles.emplace_back();
      const int x = column_x(i - first);
      tile.title = {x, y_, tile_width, title_height};
      for (size_t m = 0; m < wish_.moments; ++m) {
        const int y = top + static_cast<int>(m) * row;
        tile.pictures.push_back({x, y, tile_width, picture_height});
        tile.legends.push_back({x, y + picture_height + 2, tile_width, legend_height - 4});
      }
      tile.key = {x, top + rows - row_gap + key_gap, tile_width,
                  static_cast<int>(wish_.key_lines[i]) * theme::line_height};
    }
    for (size_t i = 0; i < plots; ++i) {
      const int x = column_x(last - first + i);
      layout.plots.push_back({{x, y_, tile_width, title_height}, {x, top, tile_width, rows - row_gap + key}});
    }
    if (!wish_.animation) {
      std::vector<Rect>& times = layout.times.emplace_back();
      for (size_t m = 0; m < wish_.moments; ++m)
        times.push_back({margin, top + static_cast<int>(m) * row, gutter - 8, 2 * theme::line_height});
    }
    y_ = top + rows + key + (wish_.animation ? 0 : gap);
  }
  int y() const { return y_; }
  int width() const { return left_ + static_cast<int>(columns_) * (tile_width + gap) - gap + margin; }

 private:
  int column_x(size_t column) const { return left_ + static_cast<int>(column) * (tile_width + gap); }
  const LayoutWish& wish_;
  size_t columns_;
  int left_, y_;
};

/// Places plots below all bands: as many side by side as have the least width, equally wide.
int add_plots(SheetLayout& layout, size_t plots, int y) {
  if (plots == 0) return y;
  const int inner = layout.width - 2 * margin;
  const int most = std::max(1, (inner + gap) / (plot_width + gap));
  const int rows = (static_cast<int>(plots) + most - 1) / most,
            per_row = (static_cast<int>(plots) + rows - 1) / rows;
  const int width = (inner - (std::max(per_row, 2) - 1) * gap) / std::max(per_row, 2);
  for (int i = 0; i < static_cast<int>(plots); ++i) {
    const int x = margin + i % per_row * (width + gap), top = y + i / per_row * (title_height + plot_height);
    layout.plots.push_back({{x, top, width, title_height}, {x, top + title_height, width, plot_height}});
  }
  return y + rows * (title_height + plot_height);
}

}  // namespace

size_t columns_for(size_t tiles, bool animation) {
  if (animation) {
    if (tiles <= 3 || tiles == 4) return tiles == 4 ? 2 : std::max<size_t>(tiles, 1);
    return tiles <= 9 ? 3 : tiles <= 16 ? 4 : tiles <= 30 ? 6 : 8;
  }
  if (tiles <= one_row) return std::max<size_t>(tiles, 1);
  return tiles <= 8 ? 4 : tiles <= 10 ? 5 : tiles <= 24 ? 6 : 8;
}

size_t moments_for(size_t frame_panels) {
  const size_t columns = columns_for(frame_panels, false), bands = (frame_panels + columns - 1) / columns;
  return bands == 0 ? most_moments : std::clamp<size_t>(most_rows / bands, 1, most_moments);
}

SheetLayout sheet_layout(const LayoutWish& wish) {
  GREATX_CHECK(wish.key_lines.size() == wish.aspects.size(), "{} keys of {} panels", wish.key_lines.size(),
               wish.aspects.size());
  const size_t panels = wish.aspects.size(), tiles = panels + (wish.animation ? wish.plots : 0);
  const size_t filled = columns_for(tiles, wish.animation);
  const size_t columns = std::max(filled, wish.least_columns);
  SheetLayout layout;
  Grid grid(wish, columns);
  layout.width = even(grid.width());
  size_t placed_plots = 0;
  for (size_t first = 0; first < tiles; first += filled) {
    const size_t begin = std::min(first, panels), end = std::min(first + filled, panels);
    const size_t plots = std::min(filled - (end - begin), tiles - first - (end - begin));
    grid.add_band(layout, begin, end, plots);
    placed_plots += plots;
  }
  int bottom = grid.y();
  if (!wish.animation) bottom = add_plots(layout, wish.plots - placed_plots, bottom);
  layout.header = {margin, margin, layout.width - 2 * margin, wish.header};
  layout.height = even(bottom + (wish.animation ? margin / 2 - row_gap : margin));
  return layout;
}

Rect fit(const Rect& tile, double aspect) {
  const double shape = std::clamp(aspect, 1e-4, 1e4);
  const int width = std::clamp(static_cast<int>(std::lround(tile.height / shape)), 1, tile.width);
  const int height = std::clamp(static_cast<int>(std::lround(width * shape)), 1, tile.height);
  return {tile.x + (tile.width - width) / 2, tile.y + (tile.height - height) / 2, width, height};
}

int tile_height(double tallest_aspect) {
  return static_cast<int>(std::lround(tile_width * std::clamp(tallest_aspect, 0.5, 1.0)));
}

}  // namespace greatx::io
