// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/paint/windows.h"

#include <algorithm>

namespace greatx::scene::generator {

namespace {

/// Returns the light behind a window of a home, sRGB: bulbs of 2700 to 3500 K, shades, a kitchen, a screen.
Rgb home_light(uint32_t pick) {
  static constexpr Rgb lights[] = {{255, 196, 120}, {255, 206, 140}, {240, 170, 92}, {255, 214, 158},
                                   {196, 128, 66},  {255, 226, 190}, {170, 104, 50}, {96, 124, 190}};
  return lights[pick % 8];
}

}  // namespace

Rgb dimmed(const Rgb& c, int percent) {
  return {c.r * percent / 100, c.g * percent / 100, c.b * percent / 100};
}

Rgb night_light(Use use, int layer, int x, int y, uint32_t seed) {
  const uint32_t night = seed * 7u + static_cast<uint32_t>(layer) * 101u;
  switch (use) {
    case Use::home:
      return hash(x, y, night) % 100 < (layer == 0 ? 42u : 33u) ? home_light(hash(y, x, night + 1)) : Rgb{};
    case Use::office: {
      const int room = x / 3;
      if (hash(room, y, night) % 100 >= (layer == 0 ? 34u : 22u)) return {};
      return hash(room, y, night + 2) % 3 == 0 ? Rgb{255, 222, 178} : Rgb{232, 236, 240};
    }
    default:
      return hash(x, y, night) % 100 < 82 ? Rgb{255, 238, 212} : Rgb{90, 80, 70};
  }
}

void light_pane(TexturePainter& painter, int layer, int x0, int y0, int x1, int y1, const Rgb& light, Use use,
                uint32_t seed) {
  if (light.r + light.g + light.b == 0) return;
  const int h = y1 - y0, w = x1 - x0;
  for (int y = 0; y < h; ++y) {
    const int percent = use == Use::shop ? 100 - 14 * y / h : 100 - 34 * y / h;
    painter.light(layer, x0, y0 + y, x1, y0 + y + 1, dimmed(light, percent));
  }
  if (use == Use::office)  // rows of lamps below the ceiling
    painter.light(layer, x0, y0 + h / 8, x1, y0 + h / 8 + 3, {255, 255, 250});
  for (int i = 0; i < 3; ++i) {
    const int left = x0 + static_cast<int>(hash(i, x0, seed) % static_cast<uint32_t>(std::max(1, w - 6)));
    const int high = h / 6 + static_cast<int>(hash(i, y0, seed + 1) % static_cast<uint32_t>(h / 4 + 1));
    const int wide = 5 + static_cast<int>(hash(i, w, seed + 2) % 10);
    painter.light(layer, left, y1 - high, std::min(left + wide, x1), y1, dimmed(light, 55));
  }
}

void window(TexturePainter& painter, int x0, int y0, int x1, int y1, const WindowStyle& style,
            uint32_t seed) {
  painter.rect(x0, y0, x1, y1, style.frame, 120);
  const int w = (x1 - x0 - style.frame_px * (style.columns + 1)) / style.columns;
  const int h = (y1 - y0 - style.frame_px * (style.rows + 1)) / style.rows;
  // All panes have the same dressing, since one household lives behind them. Shops have none.
  const uint32_t dressing = style.use == Use::shop ? 9u : hash(x0, y0, seed) % 10;
  const Rgb cloth = hash(x0, y0, seed + 3) % 3 == 0 ? Rgb{122, 96, 80} : Rgb{168, 162, 150};
  for (int c = 0; c < style.columns; ++c)
    for (int r = 0; r < style.rows; ++r) {
      const int px = x0 + style.frame_px + c * (w + style.frame_px),
                py = y0 + style.frame_px + r * (h + style.frame_px);
      const int tint = static_cast<int>(hash(c + x0, r + y0, seed) % 5) * 5 - 12;
      for (int y = 0; y < h; ++y) {
        const int sky = 34 * (h - y) / h;
        painter.rect(px, py + y, px + w, py + y + 1, {40 + sky + tint, 52 + sky + tint, 64 + sky + tint}, 28);
      }
      const bool office = style.use != Use::home;
      for (int layer = 0; layer < lit_pictures; ++layer) {
        const Rgb light = night_light(style.use, layer, office ? px / 40 : x0, y0, seed);
        light_pane(painter, layer, px, py, px + w, py + h, light, style.use, seed + static_cast<uint32_t>(c));
        if (light.r == 0 || office) continue;
        if (dressing == 1) painter.light(layer, px, py, px + w, py + h / 2, dimmed(light, 58));
        if (dressing == 2 && c == 0) painter.light(layer, px, py, px + w / 2, py + h, dimmed(light, 62));
        if (dressing == 3) painter.light(layer, px, py, px + w, py + h, dimmed(light, 66));
      }
      if (dressing == 1 && r == 0) painter.rect(px, py, px + w, py + h / 2, {176, 170, 156}, 60);  // blind
      if (dressing == 2 && c == 0) painter.rect(px, py, px + w / 2, py + h, cloth, 60);
      if (dressing == 2 && c + 1 == style.columns) painter.rect(px + w / 2, py, px + w, py + h, cloth, 60);
      if (dressing == 3) painter.rect(px, py, px + w, py + h, {150, 148, 142}, 50);  // net curtain
    }
  painter.shade(x0, y0, x1, y0 + 5, -45);
  painter.shade(x0, y0, x0 + 3, y1, -30);
}

void streaks(TexturePainter& painter, int x0, int x1, int y, uint32_t seed) {
  for (int x = x0; x < x1; ++x) {
    const uint32_t h = hash(x / 2, y, seed);
    if (h % 3 != 0) continue;
    // Some streaks run far down. A few are the rust of a screw.
    const int length = 8 + static_cast<int>(h / 4 % (h / 128 % 7 == 0 ? 60 : 26));
    const bool rust = h / 1024 % 23 == 0;
    for (int k = 0; k < length; ++k) {
      const int soot = 14 * (length - k) / length;
      painter.add(x, y + k, rust ? Rgb{-soot / 2, -2 * soot, -3 * soot} : Rgb{-soot, -soot, -soot});
    }
  }
}

}  // namespace greatx::scene::generator
