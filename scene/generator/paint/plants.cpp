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

using LeafTone = Rgb (*)(int tone);
/// Returns a colour of leaves.
Rgb leaf_color(int tone) { return {tone * 74 / 100, tone, tone * 44 / 100}; }
/// Returns a tone of pale leaves, which the material colours.
Rgb pale_color(int tone) {
  const int light = 90 + tone * 9 / 8;
  return {light, light - 4, light - 14};
}
Rgb bark_color(int tone) { return {tone, tone * 94 / 100, tone * 86 / 100}; }

/// Returns the reach of a spray of leaves from its middle towards (x, y), as a percentage of half the
/// quarter. It has lobes, so that no outline is round.
int reach_towards(int x, int y, int quarter) {
  const int sector = (x >= 0 ? 1 : 0) + (y >= 0 ? 2 : 0) + (std::abs(x) > std::abs(y) ? 4 : 0);
  return 80 + static_cast<int>(hash(sector, quarter, 615) % 20);
}

}  // namespace

namespace {

TextureMaps leaves_of(LeafTone color_of) {
  constexpr int size = 256;
  TexturePainter painter(size, size, color_of(36));
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
      add_leaf(cx + x, cy + y, directions[hash(key, 4, 62) % directions.size()], length, color_of(tone),
               [&](int px, int py, const Rgb& color) { painter.rect(px, py, px + 1, py + 1, color); });
    }
  }
  return painter.maps();
}

TextureMaps leaf_sprays_of(LeafTone color_of) {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, color_of(62));
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
        tuft.leaf(x + middle, y + middle, toward, length, color_of(tone));
      }
  }
  return painter.maps();
}

/// Paints a twig from (x, y), in 64ths of a pixel with y upwards, and the twigs that leave it, by calls of
/// `paint`. Directions are numbers of `directions`.
template <typename Paint>
void add_twig(int x, int y, int toward, int length, int depth, uint32_t seed, const Paint& paint) {
  int side = hash(length, toward, seed) % 2 == 0 ? 1 : -1;
  for (int k = 0; k < length; ++k) {
    const auto& [dx, dy] = directions[static_cast<size_t>(std::clamp(toward, 0, 16))];
    x += dx;
    y += dy;
    const int thick = depth == 0 ? 3 - 2 * k / length : depth == 1 && 2 * k < length ? 2 : 1;
    const int tone = 104 + static_cast<int>(hash(x / 200, y / 200, seed) % 40) - 8 * depth;
    for (int w = 0; w < thick; ++w) paint(x / 64 + w, y / 64, bark_color(tone + 14 * w));
    const uint32_t draw = hash(k, length + 31 * depth, seed + static_cast<uint32_t>(toward));
    if (draw % 11 == 0) toward = std::clamp(toward + (draw / 16 % 2 == 0 ? 1 : -1), 1, 15);
    if (length < 8 || k < length / 6 || (k + static_cast<int>(seed)) % (10 - std::min(depth, 2)) != 0)
      continue;
    side = -side;
    const int out = std::clamp(toward + side * (2 + static_cast<int>(draw / 64 % 3)), 0, 16);
    const int reach = (length - k) * (46 + static_cast<int>(draw / 512 % 34)) / 100;
    if (reach > 5) add_twig(x, y, out, reach, depth + 1, seed * 5 + static_cast<uint32_t>(k), paint);
  }
}

}  // namespace

TextureMaps leaves() { return leaves_of(leaf_color); }
TextureMaps leaves_pale() { return leaves_of(pale_color); }
TextureMaps leaf_sprays() { return leaf_sprays_of(leaf_color); }
TextureMaps leaf_sprays_pale() { return leaf_sprays_of(pale_color); }

TextureMaps twigs() {
  constexpr int size = 256;
  TexturePainter painter(size, size, bark_color(96));
  painter.cut_all();
  for (int i = 0; i < 17; ++i) {
    const int x = static_cast<int>(hash(i, 0, 681) % size), y = static_cast<int>(hash(i, 1, 681) % size);
    const int toward = 5 + static_cast<int>(hash(i, 2, 681) % 7);
    add_twig(64 * x, 64 * y, toward, 70 + static_cast<int>(hash(i, 3, 681) % 40), 1,
             690 + static_cast<uint32_t>(i),
             [&](int px, int up, const Rgb& color) { painter.cover(px, size - 1 - up, color); });
  }
  return painter.maps();
}

TextureMaps twig_sprays() {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, bark_color(96));
  painter.cut_all();
  for (int quarter = 0; quarter < 4; ++quarter) {
    Tuft tuft(painter, quarter, 641 + static_cast<uint32_t>(quarter));
    for (int stem = 0; stem < 5; ++stem)
      add_twig(64 * (28 + 18 * stem), 0, 4 + 2 * stem, 84 + static_cast<int>(tuft.draw(stem, 0) % 34), 0,
               651 + 7 * static_cast<uint32_t>(quarter) + static_cast<uint32_t>(stem),
               [&](int px, int up, const Rgb& color) { tuft.pixel(px, up, color); });
  }
  return painter.maps();
}

TextureMaps fallen_leaves() {
  TexturePainter painter(2 * tuft_px, 2 * tuft_px, pale_color(70));
  painter.cut_all();
  constexpr int middle = tuft_px / 2;
  for (int quarter = 0; quarter < 4; ++quarter) {
    Tuft tuft(painter, quarter, 671 + static_cast<uint32_t>(quarter));
    for (int i = 0; i < 900; ++i) {
      const int x = static_cast<int>(tuft.draw(i, 0) % (tuft_px - 16)) + 8 - middle,
                y = static_cast<int>(tuft.draw(i, 1) % (tuft_px - 16)) + 8 - middle;
      const int reach = middle * reach_towards(x, y, quarter) / 100, far = x * x + y * y;
      // They lie in drifts, and are fewer towards the outline.
      if (far > reach * reach || static_cast<int>(tuft.draw(i, 2) % 100) < 96 * far / (reach * reach))
        continue;
      if (hash((x + 64) / 14, (y + 64) / 14, 677 + static_cast<uint32_t>(quarter)) % 3 == 0) continue;
      const int tone = 20 + static_cast<int>(tuft.draw(i, 3) % 110);
      tuft.leaf(x + middle, y + middle, tuft.draw(i, 4) % directions.size(),
                4 + static_cast<int>(tuft.draw(i, 5) % 4), pale_color(tone));
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
