// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints ground: streets, pavements, lawns, fields.
#include <algorithm>
#include <cstdlib>

#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

/// Paints 16 m across x 32 m along a street, with its middle at x = 256: wheel tracks of the lanes, oil
/// between them, patches, cracks and a few manhole covers.
TextureMaps asphalt() {
  TexturePainter painter(512, 1024, {87, 86, 86});
  painter.blotches(256, 9, 11);
  painter.blotches(64, {6, 5, 4}, 10);
  painter.blotches(16, 5, 12);
  const auto track = [&](double center_m, double half_m, int change) {
    for (const int side : {-1, 1}) {
      const int middle = 256 + static_cast<int>(32 * side * center_m), half = static_cast<int>(32 * half_m);
      for (int x = middle - half; x < middle + half; ++x) {
        const int fall = change * (half - std::abs(x - middle)) / half;
        painter.shade(x, 0, x + 1, 1024, fall);
      }
    }
  };
  for (const double lane : {1.65, 5.1}) {
    track(lane - 0.75, 0.35, 12);  // polished by tyres
    track(lane + 0.75, 0.35, 12);
    track(lane, 0.45, -15);  // oil
  }
  track(6.7, 0.5, 10);           // dust beside the kerb
  track(7.6, 0.8, -18);          // gutters
  for (int i = 0; i < 5; ++i) {  // where somebody braked
    const int lane = i % 2 == 0 ? 53 : 163, x = 256 + (i % 4 < 2 ? lane : -lane);
    const int y = static_cast<int>(hash(i, 10, 14) % 1024),
              length = 90 + static_cast<int>(hash(i, 11, 14) % 160);
    for (const int tyre : {-25, 20})
      for (int k = 0; k < length; ++k)
        painter.shade(x + tyre + k / 60, y + k, x + tyre + k / 60 + 5, y + k + 1,
                      -20 * std::min({k, length - k, 40}) / 40);
  }
  for (int i = 0; i < 70; ++i) {  // drops of oil, most of them where cars wait
    const int lane = i % 2 == 0 ? 53 : 163,
              x = 256 + (i % 4 < 2 ? lane : -lane) + static_cast<int>(hash(i, 12, 14) % 24) - 12;
    const int y = static_cast<int>(hash(i, 13, 14) % (i % 3 == 0 ? 1024 : 300)), r = 1 + i % 4;
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; ++dx)
        if (dx * dx + dy * dy <= r * r) painter.add(x + dx, y + dy, {-26, -26, -24});
  }
  for (int i = 0; i < 9; ++i) {  // trenches, dug and filled
    const int x = static_cast<int>(hash(i, 0, 14) % 512), y = static_cast<int>(hash(i, 1, 14) % 1024);
    const int w = 24 + static_cast<int>(hash(i, 2, 14) % 70), h = 30 + static_cast<int>(hash(i, 3, 14) % 130);
    const int tone = i % 3 == 0 ? 15 : -19;
    painter.shade(x, y, x + w, y + h, tone);
    for (const int edge : {0, w - 2}) painter.shade(x + edge, y, x + edge + 2, y + h, -10);
    for (const int edge : {0, h - 2}) painter.shade(x, y + edge, x + w, y + edge + 2, -10);
  }
  painter.shade(255, 0, 257, 1024, -16);  // the seam between two lanes of the paver
  for (int i = 0; i < 26; ++i)
    painter.crack(static_cast<int>(hash(i, 4, 14) % 512), static_cast<int>(hash(i, 5, 14) % 1024),
                  40 + static_cast<int>(hash(i, 6, 14) % 150), -22, 15 + static_cast<uint32_t>(i));
  for (int i = 0; i < 8; ++i) {  // cracks that were sealed with tar
    int x = static_cast<int>(hash(i, 7, 14) % 512);
    const int y = static_cast<int>(hash(i, 8, 14) % 1024),
              length = 90 + static_cast<int>(hash(i, 9, 14) % 180);
    for (int k = 0; k < length; ++k) {
      painter.shade(x, y + k, x + 3, y + k + 1, -24);
      const uint32_t step = hash(k / 2, i, 9) % 7;
      x += step == 0 ? -1 : step == 1 ? 1 : 0;
    }
  }
  painter.speckle(8, 13);
  for (int i = 0; i < 5; ++i) {  // manhole covers of 0.6 m, and gullies
    const int x = i < 3 ? 256 + (i - 1) * 62 : 256 + (i == 3 ? -1 : 1) * 110, y = 120 + 190 * i;
    for (int dy = -10; dy <= 10; ++dy)
      for (int dx = -10; dx <= 10; ++dx) {
        const int r2 = dx * dx + dy * dy;
        if (r2 > 100) continue;
        const int tone = r2 > 72 ? 40 : (dx / 3 + dy / 3) % 2 == 0 ? 62 : 52;
        painter.rect(x + dx, y + dy, x + dx + 1, y + dy + 1, {tone, tone - 1, tone - 3});
      }
  }
  return painter.maps();
}

/// Paints 6 m across x 24 m along a road: worn edges, a broken line in the middle, solid lines along the
/// sides.
TextureMaps country_road() {
  TexturePainter painter(128, 512, {88, 86, 84});
  painter.blotches(64, 8, 16);
  painter.blotches(16, 4, 17);
  for (const int middle : {18, 46, 82, 110})
    for (int x = middle - 7; x <= middle + 7; ++x) painter.shade(x, 0, x + 1, 512, 7 - std::abs(x - middle));
  for (int i = 0; i < 8; ++i)
    painter.crack(static_cast<int>(hash(i, 0, 18) % 128), static_cast<int>(hash(i, 1, 18) % 512), 70, -20,
                  19 + static_cast<uint32_t>(i));
  painter.speckle(8, 20);
  const auto worn = [&](int x, int y) { return hash(x / 2, y / 3, 23) % 9 != 0; };
  for (int y = 0; y < 512; ++y) {
    for (int x = 62; x < 65; ++x)
      if (y % 256 < 85 && worn(x, y)) painter.rect(x, y, x + 1, y + 1, {206, 206, 200});
    for (const int edge : {5, 120})
      for (int x = edge; x < edge + 3; ++x)
        if (worn(x, y)) painter.rect(x, y, x + 1, y + 1, {196, 196, 190});
    const int grass = static_cast<int>(hash(y / 4, 0, 24) % 3);
    painter.rect(0, y, 1 + grass, y + 1, {92, 96, 66});
    painter.rect(127 - grass, y, 128, y + 1, {92, 96, 66});
  }
  return painter.maps();
}

/// Paints 9.6 m x 9.6 m of slabs of 0.6 m: each with its own shade, some replaced, some cracked, with stains,
/// chewing gum and moss in the joints.
TextureMaps pavement() {
  TexturePainter painter(512, 512, {156, 152, 145});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) {
      const uint32_t draw = hash(x, y, 21);
      const int shade = static_cast<int>(draw % 15) - 7 + (draw % 29 == 0 ? 16 : draw % 23 == 0 ? -14 : 0);
      painter.shade(32 * x, 32 * y, 32 * x + 32, 32 * y + 32, shade);
    }
  painter.blotches(256, {-8, -8, -9}, 25);
  painter.blotches(64, 7, 26);
  painter.speckle(5, 22);
  for (int i = 0; i < 16; ++i) {
    painter.shade(32 * i, 0, 32 * i + 1, 512, -36);
    painter.shade(0, 32 * i, 512, 32 * i + 1, -36);
  }
  for (int i = 0; i < 22; ++i) {  // stains, and moss along joints
    const int x = static_cast<int>(hash(i, 0, 27) % 512), y = static_cast<int>(hash(i, 1, 27) % 512);
    const int r = 4 + static_cast<int>(hash(i, 2, 27) % 14);
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; ++dx) {
        const int r2 = dx * dx + 2 * dy * dy;
        if (r2 < r * r)
          painter.add(x + dx, y + dy,
                      {-14 + 12 * r2 / (r * r), -13 + 12 * r2 / (r * r), -12 + 11 * r2 / (r * r)});
      }
  }
  for (int i = 0; i < 90; ++i)
    painter.shade(static_cast<int>(hash(i, 3, 28) % 512), static_cast<int>(hash(i, 4, 28) % 512),
                  static_cast<int>(hash(i, 3, 28) % 512) + 2, static_cast<int>(hash(i, 4, 28) % 512) + 2,
                  -34);
  for (int i = 0; i < 9; ++i) {
    const int x = 32 * static_cast<int>(hash(i, 5, 29) % 16), y = 32 * static_cast<int>(hash(i, 6, 29) % 16);
    painter.crack(x + 8 + static_cast<int>(hash(i, 7, 29) % 16), y + 1, 31, -38,
                  30 + static_cast<uint32_t>(i));
  }
  return painter.maps();
}

/// Paints 4 m x 4 m of white paint on asphalt, which tyres have worn off in places.
TextureMaps road_paint() {
  TexturePainter painter(128, 128, {224, 223, 216});
  painter.blotches(64, 10, 33);
  painter.blotches(16, 10, 34);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const int wear =
          static_cast<int>(hash(x / 8, y / 8, 35) % 40) + static_cast<int>(hash(x / 2, y / 3, 36) % 60);
      if (wear > 82) painter.rect(x, y, x + 1, y + 1, {132, 131, 128});
    }
  for (int i = 0; i < 7; ++i)
    painter.crack(static_cast<int>(hash(i, 0, 37) % 128), static_cast<int>(hash(i, 1, 37) % 128), 40, -60,
                  38 + static_cast<uint32_t>(i));
  return painter.maps();
}

namespace {

/// Paints blades of grass, two pixels long, all over a square texture.
void blades(TexturePainter& painter, int size, uint32_t seed) {
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int blade = static_cast<int>(hash(x, y / 2, seed) % 5);
      painter.add(x, y, {5 * blade - 10, 6 * blade - 12, 3 * blade - 6});
    }
}

}  // namespace

/// Paints 14 m x 14 m of a lawn: patches that are greener, drier or thinner than others, weeds, dry tufts.
TextureMaps grass() {
  TexturePainter painter(512, 512, {78, 102, 54});
  painter.blotches(256, {14, 6, 6}, 39);
  painter.blotches(64, {10, 6, 2}, 40);
  painter.blotches(16, {5, 7, 4}, 41);
  blades(painter, 512, 43);
  for (int i = 0; i < 900; ++i) {
    const int x = static_cast<int>(hash(i, 0, 44) % 512), y = static_cast<int>(hash(i, 1, 44) % 512);
    const bool dry = hash(i, 2, 44) % 3 == 0;
    for (int dy = 0; dy < 3; ++dy)
      for (int dx = 0; dx < 3; ++dx) painter.add(x + dx, y + dy, dry ? Rgb{24, 12, 0} : Rgb{-14, -8, -8});
  }
  return painter.maps();
}

/// Paints 40 m x 40 m of pasture, softer and larger than a lawn.
TextureMaps pasture() {
  TexturePainter painter(512, 512, {92, 108, 56});
  painter.blotches(256, 8, 45);
  painter.blotches(64, 9, 46);
  painter.blotches(8, 6, 47);
  blades(painter, 512, 48);
  for (int i = 0; i < 420; ++i) {  // thistles, flowers, dung
    const int x = static_cast<int>(hash(i, 0, 49) % 512), y = static_cast<int>(hash(i, 1, 49) % 512);
    const uint32_t kind = hash(i, 2, 49) % 6;
    painter.add(x, y, kind == 0 ? Rgb{70, 66, 30} : kind == 1 ? Rgb{60, 60, 60} : Rgb{-22, -16, -14});
    painter.add(x + 1, y, kind < 2 ? Rgb{20, 20, 10} : Rgb{-16, -10, -10});
    painter.add(x, y + 1, Rgb{-14, -9, -9});
  }
  return painter.maps();
}

/// Paints 48 m x 48 m of a field in light grey, which the material colours: rows of 0.75 m along x, the wheel
/// tracks of a sprayer every 24 m, and patches that grew better or worse. Low places are dark: colour and
/// relief have the same heights.
TextureMaps crop() {
  TexturePainter painter(512, 512, {204, 204, 198});
  painter.blotches(256, 14, 51);
  painter.blotches(64, 12, 52);
  painter.blotches(16, 6, 53);
  for (int y = 0; y < 512; ++y)
    for (int x = 0; x < 512; ++x) {
      const int phase = y % 8, furrow = 5 * std::min(phase, 8 - phase);
      const int clod = 5 * static_cast<int>(hash(x / 2, y / 2, 54) % 5) - 10, height = clod - furrow;
      painter.add(x, y, {height, height, height});
      // A pixel is 9.4 cm wide. Furrows are 12 cm deep, and clods are as high. Steps of 5 leave few different
      // slopes, which keeps the file small.
      painter.raise(x, y, x + 1, y + 1, height);
    }
  for (int y = 40; y < 512; y += 256)
    for (const int track : {0, 19})
      for (int x = 0; x < 512; ++x) {
        const int deep = -46 + static_cast<int>(hash(x / 3, y, 55) % 5) * 5;
        painter.add(x, y + track, {deep + 6, deep, deep});
        painter.add(x, y + track + 1, {deep + 6, deep, deep});
        painter.add(x, y + track + 2, {deep / 2, deep / 2, deep / 2});
        painter.raise(x, y + track, x + 1, y + track + 3, -25);
      }
  return painter.maps();
}

}  // namespace greatx::scene::generator
