// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/textures.h"

#include <algorithm>
#include <cstdlib>
#include <map>

#include "core/error.h"
#include "scene/generator/canvas.h"

namespace greatx::scene::generator {

namespace {

/// 16 m across x 32 m along a street, its middle at x = 256: wheel tracks of the lanes, oil between them, patches,
/// cracks and a few covers.
Picture asphalt() {
  Canvas canvas(512, 1024, {80, 80, 82});
  canvas.blotches(256, 7, 11);
  canvas.blotches(32, 4, 12);
  const auto track = [&](double center_m, double half_m, int change) {
    for (const int side : {-1, 1}) {
      const int middle = 256 + static_cast<int>(32 * side * center_m), half = static_cast<int>(32 * half_m);
      for (int x = middle - half; x < middle + half; ++x) {
        const int fall = change * (half - std::abs(x - middle)) / half;
        canvas.shade(x, 0, x + 1, 1024, fall);
      }
    }
  };
  for (const double lane : {1.65, 5.1}) {
    track(lane - 0.75, 0.35, 8);  // polished by tyres
    track(lane + 0.75, 0.35, 8);
    track(lane, 0.45, -9);  // oil
  }
  track(7.6, 0.7, -12);          // gutters
  for (int i = 0; i < 9; ++i) {  // trenches, dug and filled
    const int x = static_cast<int>(hash(i, 0, 14) % 512), y = static_cast<int>(hash(i, 1, 14) % 1024);
    const int w = 24 + static_cast<int>(hash(i, 2, 14) % 70), h = 30 + static_cast<int>(hash(i, 3, 14) % 130);
    const int tone = i % 3 == 0 ? 9 : -13;
    canvas.shade(x, y, x + w, y + h, tone);
    for (const int edge : {0, w - 2}) canvas.shade(x + edge, y, x + edge + 2, y + h, -10);
    for (const int edge : {0, h - 2}) canvas.shade(x, y + edge, x + w, y + edge + 2, -10);
  }
  canvas.shade(255, 0, 257, 1024, -16);  // the seam between two lanes of the paver
  for (int i = 0; i < 26; ++i)
    canvas.crack(static_cast<int>(hash(i, 4, 14) % 512), static_cast<int>(hash(i, 5, 14) % 1024),
                 40 + static_cast<int>(hash(i, 6, 14) % 150), -22, 15 + static_cast<uint32_t>(i));
  canvas.speckle(8, 13);
  for (int i = 0; i < 5; ++i) {  // covers of 0.6 m and gullies
    const int x = i < 3 ? 256 + (i - 1) * 62 : 256 + (i == 3 ? -1 : 1) * 110, y = 120 + 190 * i;
    for (int dy = -10; dy <= 10; ++dy)
      for (int dx = -10; dx <= 10; ++dx) {
        const int r2 = dx * dx + dy * dy;
        if (r2 > 100) continue;
        const int tone = r2 > 72 ? 40 : (dx / 3 + dy / 3) % 2 == 0 ? 62 : 52;
        canvas.rect(x + dx, y + dy, x + dx + 1, y + dy + 1, {tone, tone - 1, tone - 3});
      }
  }
  return canvas.picture();
}

/// 6 m across x 24 m along: worn edges, a broken line in the middle, solid ones along the sides.
Picture country_road() {
  Canvas canvas(128, 512, {88, 86, 84});
  canvas.blotches(64, 8, 16);
  canvas.blotches(16, 4, 17);
  for (const int middle : {18, 46, 82, 110})
    for (int x = middle - 7; x <= middle + 7; ++x) canvas.shade(x, 0, x + 1, 512, 7 - std::abs(x - middle));
  for (int i = 0; i < 8; ++i)
    canvas.crack(static_cast<int>(hash(i, 0, 18) % 128), static_cast<int>(hash(i, 1, 18) % 512), 70, -20,
                 19 + static_cast<uint32_t>(i));
  canvas.speckle(8, 20);
  const auto worn = [&](int x, int y) { return hash(x / 2, y / 3, 23) % 9 != 0; };
  for (int y = 0; y < 512; ++y) {
    for (int x = 62; x < 65; ++x)
      if (y % 256 < 85 && worn(x, y)) canvas.rect(x, y, x + 1, y + 1, {206, 206, 200});
    for (const int edge : {5, 120})
      for (int x = edge; x < edge + 3; ++x)
        if (worn(x, y)) canvas.rect(x, y, x + 1, y + 1, {196, 196, 190});
    const int grass = static_cast<int>(hash(y / 4, 0, 24) % 3);
    canvas.rect(0, y, 1 + grass, y + 1, {92, 96, 66});
    canvas.rect(127 - grass, y, 128, y + 1, {92, 96, 66});
  }
  return canvas.picture();
}

Picture pavement() {
  // 2.4 m: slabs of 0.6 m, each of its own shade.
  Canvas canvas(128, 128, {158, 154, 147});
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      canvas.shade(32 * x, 32 * y, 32 * x + 32, 32 * y + 32, static_cast<int>(hash(x, y, 21) % 17) - 8);
  canvas.speckle(5, 22);
  for (int i = 0; i < 4; ++i) {
    canvas.shade(32 * i, 0, 32 * i + 1, 128, -38);
    canvas.shade(0, 32 * i, 128, 32 * i + 1, -38);
  }
  return canvas.picture();
}

Picture concrete() {
  Canvas canvas(128, 128, {160, 157, 150});
  canvas.blotches(32, 8, 31);
  canvas.speckle(4, 32);
  canvas.shade(0, 0, 1, 128, -22);
  canvas.shade(0, 0, 128, 1, -22);
  return canvas.picture();
}

Picture grass() {
  Canvas canvas(256, 256, {84, 104, 50});
  canvas.blotches(128, 5, 40);
  canvas.blotches(16, 7, 41);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const int blade = static_cast<int>(hash(x, y / 2, 43) % 5);
      canvas.add(x, y, {5 * blade - 10, 6 * blade - 12, 3 * blade - 6});
    }
  for (int i = 0; i < 240; ++i) {  // weeds and dry tufts
    const int x = static_cast<int>(hash(i, 0, 44) % 256), y = static_cast<int>(hash(i, 1, 44) % 256);
    const bool dry = hash(i, 2, 44) % 3 == 0;
    for (int dy = 0; dy < 3; ++dy)
      for (int dx = 0; dx < 3; ++dx) canvas.add(x + dx, y + dy, dry ? Rgb{22, 12, 0} : Rgb{-14, -8, -8});
  }
  return canvas.picture();
}

/// 40 m x 40 m of pasture: softer and larger than a lawn.
Picture pasture() {
  Canvas canvas(512, 512, {92, 108, 56});
  canvas.blotches(256, 8, 45);
  canvas.blotches(64, 9, 46);
  canvas.blotches(8, 6, 47);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) {
      const int blade = static_cast<int>(hash(x, y / 2, 48) % 5);
      canvas.add(x, y, {5 * blade - 10, 6 * blade - 12, 3 * blade - 6});
    }
  for (int i = 0; i < 420; ++i) {  // thistles, flowers, dung
    const int x = static_cast<int>(hash(i, 0, 49) % 512), y = static_cast<int>(hash(i, 1, 49) % 512);
    const uint32_t kind = hash(i, 2, 49) % 6;
    canvas.add(x, y, kind == 0 ? Rgb{70, 66, 30} : kind == 1 ? Rgb{60, 60, 60} : Rgb{-22, -16, -14});
    canvas.add(x + 1, y, kind < 2 ? Rgb{20, 20, 10} : Rgb{-16, -10, -10});
    canvas.add(x, y + 1, Rgb{-14, -9, -9});
  }
  return canvas.picture();
}

/// 48 m x 48 m of a field, light grey, coloured by the material: rows of 0.75 m along x, the wheel tracks of a sprayer
/// every 24 m, patches that grew better or worse. What is low is dark: colour and relief have the same heights.
Picture crop() {
  Canvas canvas(512, 512, {204, 204, 198});
  canvas.blotches(256, 14, 51);
  canvas.blotches(64, 12, 52);
  canvas.blotches(16, 6, 53);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) {
      const int phase = y % 8, furrow = 5 * std::min(phase, 8 - phase);
      const int clod = 5 * static_cast<int>(hash(x / 2, y / 2, 54) % 5) - 10, height = clod - furrow;
      canvas.add(x, y, {height, height, height});
      // Of a pixel of 9.4 cm: furrows 12 cm deep, clods as high. In steps of 5 there are few slopes: a small file.
      canvas.raise(x, y, x + 1, y + 1, height);
    }
  for (int y = 40; y < 512; y += 256)
    for (const int track : {0, 19})
      for (int x = 0; x < 512; ++x) {
        const int deep = -46 + static_cast<int>(hash(x / 3, y, 55) % 5) * 5;
        canvas.add(x, y + track, {deep + 6, deep, deep});
        canvas.add(x, y + track + 1, {deep + 6, deep, deep});
        canvas.add(x, y + track + 2, {deep / 2, deep / 2, deep / 2});
        canvas.raise(x, y + track, x + 1, y + track + 3, -25);
      }
  return canvas.picture();
}

/// 3 m x 3 m of foliage: clumps of leaves in the light before dark gaps.
Picture leaves() {
  Canvas canvas(128, 128, {40, 58, 24});
  canvas.blotches(32, 10, 61);
  for (int pass = 0; pass < 3; ++pass)
    for (int i = 0; i < 420; ++i) {
      const int x = static_cast<int>(hash(i, 3 * pass, 62) % 128),
                y = static_cast<int>(hash(i, 3 * pass + 1, 62) % 128);
      // Leaves gather where the coarse noise says so: gaps stay dark.
      const uint32_t clump = hash(x / 16, y / 16, 63) % 4;
      if (clump == 0 && pass > 0) continue;
      const int tone =
          52 + 17 * pass + static_cast<int>(hash(i, 3 * pass + 2, 62) % 22) + 4 * static_cast<int>(clump);
      const Rgb leaf{tone * 9 / 10, tone * 13 / 10, tone * 5 / 10};
      const bool tall = hash(i, pass, 64) % 2 == 0;
      const int w = tall ? 3 : 5, h = tall ? 5 : 3;
      canvas.rect(x, y, x + w, y + h, leaf);
      canvas.shade(x, y + h, x + w, y + h + 1, -18);
      canvas.shade(x, y, x + w - 1, y + 1, 10);
    }
  return canvas.picture();
}

Picture bark() {
  Canvas canvas(64, 64, {104, 84, 64});
  for (int x = 0; x < 64; ++x)
    canvas.shade(x, 0, x + 1, 64, static_cast<int>(hash(x / 3, 0, 71) % 5) * 9 - 18);
  canvas.speckle(8, 72);
  return canvas.picture();
}

/// 18 m x 18 m of a flat roof: sheets of bitumen or gravel, puddles dried up, moss.
Picture roof() {
  Canvas canvas(256, 256, {140, 136, 130});
  canvas.blotches(128, 10, 81);
  canvas.blotches(32, 9, 82);
  canvas.blotches(8, 5, 83);
  for (int i = 0; i < 256; i += 32) {
    canvas.shade(i, 0, i + 1, 256, -14);
    canvas.shade(i + 1, 0, i + 2, 256, 6);
  }
  for (int i = 0; i < 6; ++i) {
    const int x = static_cast<int>(hash(i, 0, 84) % 256), y = static_cast<int>(hash(i, 1, 84) % 256);
    const int r = 8 + static_cast<int>(hash(i, 2, 84) % 18);
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; ++dx)
        if (dx * dx + 2 * dy * dy < r * r) canvas.add(x + dx, y + dy, {-16, -14, -13});
  }
  canvas.speckle(12, 85);
  return canvas.picture();
}

/// 3.2 m: slates in courses of 0.2 m.
Picture slate() {
  Canvas canvas(128, 128, {92, 98, 108});
  for (int row = 0; row < 16; ++row)
    for (int i = 0; i < 16; ++i) {
      const int x = 8 * i + (row % 2) * 4, y = 8 * row;
      canvas.shade(x, y, x + 8, y + 8, static_cast<int>(hash(i, row, 86) % 6) * 5 - 13);
      canvas.shade(x, y, x + 1, y + 8, -18);
      canvas.shade(x, y + 7, x + 8, y + 8, -24);
    }
  canvas.blotches(64, 6, 87);
  return canvas.picture();
}

/// 1.6 m x 1.0 m photovoltaic modules.
Picture solar() {
  Canvas canvas(64, 64, {26, 34, 58});
  for (int i = 0; i < 64; i += 8) {
    canvas.shade(i, 0, i + 1, 64, 20);
    canvas.shade(0, i, 64, i + 1, 14);
  }
  canvas.rect(0, 0, 64, 2, {150, 154, 158});
  canvas.rect(0, 0, 2, 64, {150, 154, 158});
  return canvas.picture();
}

Picture corrugated() {
  Canvas canvas(64, 64, {210, 212, 214});
  for (int x = 0; x < 64; ++x) {
    const int phase = x % 16;
    canvas.shade(x, 0, x + 1, 64, phase < 8 ? 4 * phase - 16 : 4 * (15 - phase) - 16);
  }
  canvas.blotches(32, 6, 91);
  canvas.shade(0, 0, 64, 1, -30);
  return canvas.picture();
}

Picture boards() {
  Canvas canvas(128, 128, {200, 196, 190});
  for (int board = 0; board < 8; ++board) {
    canvas.shade(16 * board, 0, 16 * board + 16, 128, static_cast<int>(hash(board, 0, 101) % 5) * 10 - 20);
    canvas.shade(16 * board, 0, 16 * board + 1, 128, -85);
  }
  for (int x = 0; x < 128; ++x) canvas.shade(x, 0, x + 1, 128, static_cast<int>(hash(x, 1, 102) % 3) * 6 - 6);
  canvas.speckle(7, 103);
  return canvas.picture();
}

/// 2.4 m: eight courses of clay tiles that overlap, staggered; each bulges across and lies with its lower edge, a tile's
/// thickness up, on the next.
Picture roof_tiles() {
  Canvas canvas(128, 128, {150, 82, 58});
  for (int row = 0; row < 8; ++row)
    for (int tile = 0; tile < 16; ++tile) {
      const int x = 8 * tile + (row % 2) * 4, y = 16 * row;
      canvas.shade(x, y, x + 8, y + 16, static_cast<int>(hash(tile, row, 111) % 7) * 6 - 18);
      canvas.shade(x, y, x + 1, y + 16, -34);
      canvas.shade(x, y + 13, x + 8, y + 16, -30);
      canvas.shade(x, y, x + 8, y + 3, 10);
      for (int down = 0; down < 16; ++down)
        for (int k = 0; k < 8; ++k) {
          const int bulge = 9 * std::min(k, 7 - k);
          canvas.raise(x + k, y + down, x + k + 1, y + down + 1, bulge + down);
        }
    }
  canvas.blotches(64, 9, 113);
  canvas.blotches(16, 7, 114);  // lichen
  canvas.speckle(6, 112);
  return canvas.picture();
}

/// 2.56 m: stretchers of 0.16 m by 0.08 m.
Picture brick() {
  Canvas canvas(128, 128, {164, 154, 142});
  for (int row = 0; row < 32; ++row)
    for (int i = 0; i < 16; ++i) {
      const int shade = static_cast<int>(hash(i, row, 121) % 6) * 7 - 18, x = 8 * i + (row % 2) * 4;
      canvas.rect(x, 4 * row, x + 7, 4 * row + 3, {146 + shade, 82 + shade, 64 + shade});
    }
  canvas.blotches(64, 8, 122);
  return canvas.picture();
}

}  // namespace

Picture make_texture(const std::string& name) {
  static const std::map<std::string, Picture (*)()> painters = {
      {"asphalt", asphalt},
      {"pavement", pavement},
      {"concrete", concrete},
      {"grass", grass},
      {"crop", crop},
      {"leaves", leaves},
      {"solar", solar},
      {"slate", slate},
      {"country_road", country_road},
      {"pasture", pasture},
      {"bark", bark},
      {"roof", roof},
      {"corrugated", corrugated},
      {"boards", boards},
      {"roof_tiles", roof_tiles},
      {"brick", brick},
      {"facade_brick", facade_brick},
      {"facade_plaster", facade_plaster},
      {"facade_concrete", facade_concrete},
      {"facade_ribbon", facade_ribbon},
      {"facade_glass", facade_glass},
      {"facade_metal", facade_metal},
      {"shopfront", shopfront},
      {"farm_wall", farm_wall},
      {"facade_stone", facade_stone},
      {"facade_balcony", facade_balcony},
      {"dormer", dormer},
      {"poster", poster},
  };
  const auto found = painters.find(name);
  GREATX_CHECK(found != painters.end(), "no texture called \"{}\"", name);
  return found->second();
}

}  // namespace greatx::scene::generator
