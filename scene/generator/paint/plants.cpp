// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints sprays of leaves and needles and tufts of grass, with holes between them. Each quarter of a picture
// holds one.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

namespace {

constexpr int tuft_px = 128;  ///< width and height of a quarter

/// Sixteen directions in a half-plane, from left over up to right, times 64.
constexpr std::array<std::array<int, 2>, 17> directions{{{-64, 0},
                                                         {-63, 12},
                                                         {-59, 24},
                                                         {-53, 36},
                                                         {-45, 45},
                                                         {-36, 53},
                                                         {-24, 59},
                                                         {-12, 63},
                                                         {0, 64},
                                                         {12, 63},
                                                         {24, 59},
                                                         {36, 53},
                                                         {45, 45},
                                                         {53, 36},
                                                         {59, 24},
                                                         {63, 12},
                                                         {64, 0}}};

/// Paints a pointed leaf from (x, y) in a direction by calls of `paint`. One half is lighter than the other.
template <typename Paint>
void add_leaf(int x, int y, const std::array<int, 2>& toward, int length, const Rgb& color,
              const Paint& paint) {
  const auto [dx, dy] = toward;
  const int width = length * 5 / 8;
  for (int v = -length; v <= length; ++v)
    for (int u = -length; u <= length; ++u) {
      const int along = (u * dx + v * dy) / 64, across = (v * dx - u * dy) / 64;
      const int place = 2 * along - length;  // -length at the stalk, length at the tip
      if (along < 0 || along > length) continue;
      if (2 * std::abs(across) * length * length > width * (length * length - place * place)) continue;
      const int light = (across > 0 ? 10 : across < 0 ? -6 : 2) + 12 * along / length;
      paint(x + u, y + v, {color.r + light * 7 / 10, color.g + light, color.b + light / 2});
    }
}

/// One tuft of a picture. Places are (x, up): pixels from the left and from the lower edge.
class Tuft {
 public:
  Tuft(TexturePainter& painter, int quarter, uint32_t seed)
      : painter_(painter), x0_(quarter % 2 * tuft_px), y0_(quarter / 2 * tuft_px), seed_(seed) {}

  uint32_t draw(int i, int k) const { return hash(i, k, seed_); }
  void pixel(int x, int up, const Rgb& color) {
    if (x >= 0 && x < tuft_px && up >= 0 && up < tuft_px)
      painter_.cover(x0_ + x, y0_ + tuft_px - 1 - up, color);
  }
  void leaf(int x, int up, size_t toward, int length, const Rgb& color) {
    add_leaf(x, up, directions[toward], length, color,
             [&](int px, int py, const Rgb& of) { pixel(px, py, of); });
  }

 private:
  TexturePainter& painter_;
  int x0_, y0_;
  uint32_t seed_;
};

/// Returns a colour of leaves.
Rgb leaf_color(int tone) { return {tone * 74 / 100, tone, tone * 44 / 100}; }

/// Returns the reach of a spray of leaves from its middle towards (x, y), as a percentage of half the
/// quarter. It has lobes, so that no outline is round.
int reach_towards(int x, int y, int quarter) {
  const int sector = (x >= 0 ? 1 : 0) + (y >= 0 ? 2 : 0) + (std::abs(x) > std::abs(y) ? 4 : 0);
  return 80 + static_cast<int>(hash(sector, quarter, 615) % 20);
}

}  // namespace

TextureMaps leaves() {
  constexpr int size = 256;
  TexturePainter painter(size, size, {24, 36, 16});
  painter.blotches(64, 7, 61);
  // Leaves gather in clumps. Light from above falls on a clump's upper leaves; its lower ones, and the gaps
  // between clumps, are dark.
  for (int clump = 0; clump < 46; ++clump) {
    const int radius = 18 + static_cast<int>(hash(clump, 0, 63) % 20);
    const int cx = static_cast<int>(hash(clump, 1, 63) % size),
              cy = static_cast<int>(hash(clump, 2, 63) % size);
    const int tint = static_cast<int>(hash(clump, 3, 63) % 17) - 8;
    for (int i = 0; i < radius * radius / 9; ++i) {
      const int key = 1000 * clump + i;
      const int x = static_cast<int>(hash(key, 0, 62) % static_cast<uint32_t>(2 * radius)) - radius,
                y = static_cast<int>(hash(key, 1, 62) % static_cast<uint32_t>(2 * radius)) - radius;
      if (x * x + y * y > radius * radius) continue;
      const int length = 8 + static_cast<int>(hash(key, 2, 62) % 6);
      const int tone = 96 + tint - 44 * y / radius + static_cast<int>(hash(key, 3, 62) % 30) - 15;
      add_leaf(cx + x, cy + y, directions[hash(key, 4, 62) % directions.size()], length, leaf_color(tone),
               [&](int px, int py, const Rgb& color) { painter.rect(px, py, px + 1, py + 1, color); });
    }
  }
  return painter.maps();
}

TextureMaps leaf_sprays() {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, {44, 62, 26});
  painter.cut_all();
  constexpr int middle = tuft_px / 2;
  for (int quarter = 0; quarter < 4; ++quarter) {
    Tuft tuft(painter, quarter, 601 + static_cast<uint32_t>(quarter));
    for (int layer = 0; layer < 3; ++layer)
      for (int i = 0; i < 330; ++i) {
        const int key = 400 * layer + i;
        const int x = static_cast<int>(tuft.draw(key, 0) % tuft_px) - middle,
                  y = static_cast<int>(tuft.draw(key, 1) % tuft_px) - middle;
        const int length = 8 + static_cast<int>(tuft.draw(key, 3) % 6);
        const int reach = middle * reach_towards(x, y, quarter) / 100 - length / 2;
        const int far = x * x + y * y;
        if (far > reach * reach) continue;
        // Leaves gather in clumps, and are fewer towards the outline.
        if (hash((x + 64) / 18, (y + 64) / 18, 613 + static_cast<uint32_t>(quarter)) % 5 == 0 && layer > 0)
          continue;
        if (static_cast<int>(tuft.draw(key, 4) % 100) < 46 * far / (reach * reach)) continue;
        const size_t toward = tuft.draw(key, 2) % directions.size();
        const int tone = 66 + 22 * layer + static_cast<int>(tuft.draw(key, 5) % 36);
        tuft.leaf(x + middle, y + middle, toward, length, leaf_color(tone));
      }
  }
  return painter.maps();
}

TextureMaps needle_sprays() {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, {30, 44, 30});
  painter.cut_all();
  constexpr int middle = tuft_px / 2;
  for (int quarter = 0; quarter < 4; ++quarter) {
    Tuft tuft(painter, quarter, 631 + static_cast<uint32_t>(quarter));
    // A bough rises from the middle of the lower edge. Twigs with needles leave it on both sides.
    const auto twig = [&](int x, int up, int dx, int dy, int length, int key) {
      for (int k = 0; k < length; ++k) {
        const int px = x + k * dx / 64, py = up + k * dy / 64;
        const int tone = 58 + static_cast<int>(tuft.draw(key, k + 7) % 46) + 10 * k / length;
        const int reach = 3 + static_cast<int>(tuft.draw(key, k) % 4);
        for (const int side : {-1, 1})
          for (int n = 0; n <= reach; ++n)
            tuft.pixel(px - side * n * dy / 64 + n * dx / 90, py + side * n * dx / 64 + n * dy / 90,
                       leaf_color(tone - 3 * n));
      }
    };
    for (int i = 0; i < 22; ++i) {
      const int up = 4 + 5 * i, side = i % 2 == 0 ? 1 : -1;
      const int length = (126 - up) * (50 + static_cast<int>(tuft.draw(i, 90) % 24)) / 100;
      twig(middle, up, side * 50, 40, std::min(length, 72), 100 * i);
    }
    twig(middle, 0, 0, 64, 118, 9000);
  }
  return painter.maps();
}

TextureMaps grass_tufts() {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, {70, 90, 44});
  painter.cut_all();
  for (int quarter = 0; quarter < 4; ++quarter) {
    Tuft tuft(painter, quarter, 661 + static_cast<uint32_t>(quarter));
    for (int blade = 0; blade < 90; ++blade) {
      const int foot = 8 + static_cast<int>(tuft.draw(blade, 0) % (tuft_px - 16));
      const int reach = tuft_px / 2 - std::abs(foot - tuft_px / 2);
      const int high =
          std::min(120, 30 + 2 * reach) * (40 + static_cast<int>(tuft.draw(blade, 1) % 60)) / 100;
      const int lean = static_cast<int>(tuft.draw(blade, 2) % 51) - 25;
      const bool dry = tuft.draw(blade, 3) % 5 == 0;
      const int tone = 70 + static_cast<int>(tuft.draw(blade, 4) % 50);
      for (int up = 0; up < high; ++up) {
        const int x = foot + lean * up * up / (118 * 118), wide = up * 3 < high * 2 ? 3 : 2;
        const Rgb c = leaf_color(tone + up / 4);
        for (int k = 0; k < wide; ++k) tuft.pixel(x + k, up, dry ? Rgb{c.g, c.g * 9 / 10, c.b} : c);
      }
    }
  }
  return painter.maps();
}

}  // namespace greatx::scene::generator
