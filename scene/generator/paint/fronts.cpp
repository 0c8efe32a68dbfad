// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints fronts that are not walls of bays: shops, farmhouses, dormers, posters.
#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"
#include "scene/generator/paint/windows.h"

namespace greatx::scene::generator {

TextureMaps shopfront() {
  TexturePainter painter(4 * 256, 180, {132, 126, 118});
  painter.use_roughness(220);
  painter.blotches(4, 5, 241);
  static constexpr Rgb fascias[] = {{44, 58, 74}, {112, 34, 30}, {38, 74, 50}, {60, 54, 50}};
  static constexpr Rgb letters[] = {{224, 214, 186}, {240, 228, 200}, {232, 220, 120}, {214, 150, 70}};
  static constexpr Rgb goods[] = {
      {196, 90, 60}, {220, 180, 90}, {90, 130, 170}, {200, 196, 186}, {120, 150, 80}};
  for (int shop = 0; shop < 4; ++shop) {
    const int left = 256 * shop;
    painter.rect(left + 10, 12, left + 246, 44, fascias[shop], 150);
    const WindowStyle display{
        .frame = {48, 48, 50}, .columns = 2, .rows = 1, .frame_px = 4, .use = Use::shop};
    const WindowStyle door{.frame = {60, 58, 56}, .columns = 2, .rows = 1, .frame_px = 5, .use = Use::shop};
    const uint32_t seed = 243 + 10 * static_cast<uint32_t>(shop);
    window(painter, left + 12, 48, left + 96, 160, display, seed);
    window(painter, left + 160, 48, left + 244, 160, display, seed + 2);
    window(painter, left + 104, 48, left + 152, 178, door, seed + 4);
    for (int i = 0; i < 14; ++i) {  // goods
      const int side = i % 2 == 0 ? 18 : 166, x = left + side + static_cast<int>(hash(i, shop, 248) % 62);
      const int w = 4 + static_cast<int>(hash(i, shop, 249) % 8),
                h = 8 + static_cast<int>(hash(i, shop, 250) % 34);
      const Rgb color = goods[hash(i, shop, 251) % 5];
      painter.rect(x, 156 - h, x + w, 156, dimmed(color, 55), 60);
      for (int layer = 0; layer < lit_pictures; ++layer) painter.light(layer, x, 156 - h, x + w, 156, color);
    }
    for (int letter = 0; letter < 11; ++letter) {
      const int w = 6 + static_cast<int>(hash(letter, shop, 242) % 6), x = left + 64 + 12 * letter;
      if (letter == 5 || hash(letter, shop, 244) % 7 == 0) continue;
      painter.rect(x, 21, x + w, 35, letters[shop], 150);
      for (int layer = 0; layer < lit_pictures; ++layer)
        if ((shop + layer) % 3 != 2) painter.light(layer, x, 21, x + w, 35, letters[shop]);
    }
    painter.rect(left + 12, 160, left + 96, 176, {96, 90, 84}, 210);
    painter.rect(left + 160, 160, left + 244, 176, {96, 90, 84}, 210);
    if (shop % 2 == 1) {  // an awning
      for (int stripe = 0; stripe < 9; ++stripe)
        painter.rect(left + 12 + 26 * stripe, 44, left + 38 + 26 * stripe, 62,
                     stripe % 2 == 0 ? fascias[shop] : Rgb{226, 220, 206}, 220);
      painter.shade(left + 10, 62, left + 246, 70, -50);
      for (int layer = 0; layer < lit_pictures; ++layer)
        painter.light(layer, left + 12, 44, left + 246, 62, {});
    } else {
      painter.shade(left + 10, 44, left + 246, 50, -40);
    }
  }
  return painter.maps();
}

TextureMaps farm_wall() {
  TexturePainter painter(4 * 160, 120, {216, 208, 190});
  painter.use_roughness(240);
  painter.blotches(40, 9, 251);
  painter.blotches(8, 4, 252);
  for (int bay = 0; bay < 4; ++bay) {
    const int left = 160 * bay;
    painter.rect(left + 54, 28, left + 106, 84, {120, 78, 52}, 220);
    for (const int x : {28, 108}) {  // shutters
      painter.rect(left + x, 30, left + x + 24, 82, {76, 96, 74}, 200);
      for (int slat = 34; slat < 80; slat += 5)
        painter.shade(left + x + 2, slat, left + x + 22, slat + 1, -24);
    }
    window(painter, left + 57, 31, left + 103, 81, {.frame = {228, 224, 214}, .columns = 2, .rows = 2}, 253);
    painter.rect(left + 52, 84, left + 108, 88, {170, 162, 148}, 230);
    streaks(painter, left + 52, left + 108, 88, 255);
  }
  for (int x = 0; x < 640; ++x)  // splashed foot
    painter.shade(x, 108 + static_cast<int>(hash(x / 6, 0, 254) % 5), x + 1, 120, -18);
  return painter.maps();
}

TextureMaps dormer() {
  TexturePainter painter(64, 64, {196, 192, 184});
  painter.use_roughness(200);
  window(painter, 10, 8, 54, 56, {.frame = {232, 230, 224}, .columns = 2, .rows = 1, .frame_px = 3}, 281);
  painter.rect(0, 0, 64, 5, {92, 98, 104}, 140);
  return painter.maps();
}

TextureMaps poster() {
  TexturePainter painter(64, 96, {40, 70, 110});
  const auto paint = [&](int x0, int y0, int x1, int y1, const Rgb& color) {
    painter.rect(x0, y0, x1, y1, color);
    for (int layer = 0; layer < lit_pictures; ++layer) painter.light(layer, x0, y0, x1, y1, color);
  };
  for (int y = 0; y < 96; ++y) paint(0, y, 64, y + 1, {60 + y, 110 + y / 2, 190 - y / 2});
  for (int dy = -18; dy <= 18; ++dy)
    for (int dx = -18; dx <= 18; ++dx)
      if (dx * dx + dy * dy < 330) paint(36 + dx, 38 + dy, 37 + dx, 39 + dy, {244, 196, 88});
  paint(6, 68, 50, 74, {250, 250, 246});
  paint(6, 78, 38, 82, {250, 250, 246});
  paint(0, 0, 64, 3, {36, 38, 40});
  paint(0, 93, 64, 96, {36, 38, 40});
  return painter.maps();
}

}  // namespace greatx::scene::generator
