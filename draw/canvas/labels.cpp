// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/canvas/labels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "draw/canvas/plot.h"

namespace greatx::io {

namespace {

constexpr int label_line = 17;  ///< of a label, pixels: less than theme::line_height, since it has few lines
constexpr int rim = 2;          ///< around a label, pixels

}  // namespace

Labels::Labels(Canvas& canvas, const Rect& area) : canvas_(canvas), area_(area) {
  for (const DrawnText& text : canvas.texts())
    if (text.rect.overlaps(area)) taken_.push_back(text.rect);
}

void Labels::keep_free(double x, double y, double radius) {
  const int left = static_cast<int>(std::floor(x - radius)), top = static_cast<int>(std::floor(y - radius));
  const int side = static_cast<int>(std::ceil(2.0 * radius)) + 1;
  taken_.push_back({left, top, side, side});
}

bool Labels::write(double x, double y, double radius, std::span<const std::string> lines, Color color) {
  int width = 0;
  for (const std::string& line : lines)
    width = std::max(width, Canvas::text_width(line, theme::text_scale) - theme::text_scale);
  const int height =
      label_line * (static_cast<int>(lines.size()) - 1) + (Canvas::glyph_height - 1) * theme::text_scale;
  const int r = static_cast<int>(std::ceil(radius)) + rim + 1, cx = static_cast<int>(std::lround(x)),
            cy = static_cast<int>(std::lround(y));
  // Left, middle and right of the mark; the text's edge next to it is even.
  const int columns[] = {cx - r - width, cx - width / 2, cx + r};
  const int rows[] = {cy - r - height, cy - height / 2, cy + r};
  constexpr Align sides[] = {Align::right, Align::center, Align::left};
  constexpr std::pair<size_t, size_t> places[] = {{2, 1}, {2, 0}, {2, 2}, {0, 1},
                                                  {0, 0}, {0, 2}, {1, 0}, {1, 2}};
  for (const auto& [column, row] : places) {
    const int left = columns[column], top = rows[row];
    const Rect room{left - rim, top - rim, width + 2 * rim, height + 2 * rim};
    if (!area_.contains(room) || std::ranges::any_of(taken_, [&](const Rect& t) { return t.overlaps(room); }))
      continue;
    const Align align = sides[column];
    const int at = align == Align::left ? left : align == Align::right ? left + width : left + width / 2;
    for (size_t i = 0; i < lines.size(); ++i)
      canvas_.rimmed_text(at, top + static_cast<int>(i) * label_line, lines[i], theme::text_scale, color,
                          canvas_.theme().halo, align);
    taken_.push_back(room);
    return true;
  }
  return false;
}

void draw_key(Canvas& canvas, const Rect& area, std::span<const KeyEntry> entries) {
  using Mark = KeyEntry::Mark;
  constexpr int mark_width = 24;
  int y = area.y;
  for (const KeyEntry& entry : entries) {
    if (y + theme::line_height > area.bottom()) return;
    const double cx = area.x + 9.0, cy = y + 11.0;
    if (entry.mark == Mark::square) {
      canvas.fill({area.x + 1, y + 3, 16, 16}, canvas.theme().border);
      canvas.fill({area.x + 2, y + 4, 14, 14}, entry.color);
    }
    if (entry.mark == Mark::disc) canvas.disc(cx, cy, 5.0, entry.color);
    if (entry.mark == Mark::line) canvas.line(area.x + 1, cy, area.x + 17, cy, 2.0, entry.color);
    // Marks of pictures lie on a patch of a picture's colour, on which they look the same in every theme.
    if (entry.mark == Mark::ring || entry.mark == Mark::cross)
      canvas.fill({area.x, y + 1, 20, 20}, canvas.theme().power(0.0));
    if (entry.mark == Mark::ring) canvas.circle(cx + 1.0, cy, 6.0, 1.8, entry.color);
    if (entry.mark == Mark::cross) {
      canvas.line(cx - 7.0, cy, cx - 2.0, cy, 1.6, entry.color);
      canvas.line(cx + 4.0, cy, cx + 9.0, cy, 1.6, entry.color);
      canvas.line(cx + 1.0, cy - 8.0, cx + 1.0, cy - 3.0, 1.6, entry.color);
      canvas.line(cx + 1.0, cy + 3.0, cx + 1.0, cy + 8.0, 1.6, entry.color);
    }
    const int x = area.x + (entry.mark == Mark::none ? 0 : mark_width);
    canvas.text(x, y + 4, fitted(entry.text, area.right() - x, theme::text_scale), theme::text_scale,
                canvas.theme().dim);
    y += theme::line_height;
  }
}

}  // namespace greatx::io
