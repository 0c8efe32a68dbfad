// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints walls of eight bays and two floors.
#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"
#include "scene/generator/paint/windows.h"

namespace greatx::scene::generator {

namespace {

constexpr int bay_px = facade_bay_px, floor_px = facade_floor_px, wall_px = facade_bay_px * facade_bays;

void bricks(TexturePainter& painter, const Rgb& brick, const Rgb& mortar, uint32_t seed) {
  painter.fill(mortar);
  for (int row = 0; row < painter.height() / 4; ++row)
    for (int i = 0; i < painter.width() / 8; ++i) {
      const int shade = static_cast<int>(hash(i, row, seed) % 6) * 7 - 18;
      painter.rect(8 * i + (row % 2) * 4, 4 * row, 8 * i + (row % 2) * 4 + 7, 4 * row + 3,
                   {brick.r + shade, brick.g + shade, brick.b + shade});
    }
}

/// Paints bars of 2 pixels every 6 between x0 and x1, with a rail on top.
void railing(TexturePainter& painter, int x0, int x1, int y0, int y1) {
  for (int x = x0; x < x1; x += 6) painter.rect(x, y0, x + 2, y1, {44, 45, 48}, 120);
  painter.rect(x0, y0 - 2, x1, y0 + 1, {44, 45, 48}, 120);
}

template <typename Paint>
void each_bay(const Paint& paint) {
  for (int floor = 0; floor < 2; ++floor)
    for (int bay = 0; bay < facade_bays; ++bay) paint(bay, bay_px * bay, floor_px * floor);
}

}  // namespace

TextureMaps facade_brick() {
  TexturePainter painter(wall_px, 2 * floor_px, {0, 0, 0});
  painter.use_roughness(240);
  bricks(painter, {146, 80, 62}, {166, 156, 144}, 131);
  painter.blotches(128, 8, 132);
  each_bay([&](int, int left, int top) {
    const int x = left + 34, y = top + 24;
    painter.rect(x - 5, y - 9, x + 65, y, {184, 176, 162}, 230);        // lintel
    painter.rect(x - 6, y + 70, x + 66, y + 75, {190, 182, 168}, 230);  // sill
    painter.shade(x - 6, y + 75, x + 66, y + 78, -34);
    streaks(painter, x - 6, x + 66, y + 78, 133);
    window(painter, x, y, x + 60, y + 70, {.columns = 2, .rows = 2}, 140);
  });
  painter.rect(0, 252, wall_px, 256, {176, 168, 154}, 230);  // string course at every second floor
  return painter.maps();
}

TextureMaps facade_plaster() {
  TexturePainter painter(wall_px, 2 * floor_px, {218, 212, 200});
  painter.use_roughness(240);
  painter.blotches(64, 6, 151);
  each_bay([&](int bay, int left, int top) {
    const int x = left + 40, y = top + 22;
    painter.rect(x - 5, y - 5, x + 53, y + 77, {236, 232, 222}, 230);
    window(painter, x, y, x + 48, y + 72, {.frame = {240, 238, 232}, .columns = 2, .rows = 1}, 160);
    if (bay % 2 == 0) {  // shutters, some of them closed
      const bool closed = hash(bay, top, 161) % 5 == 0;
      const int reach = closed ? 24 : 0;
      painter.rect(x - 24 + reach, y, x - 3 + reach, y + 72, {92, 104, 98}, 200);
      painter.rect(x + 51 - reach, y, x + 72 - reach, y + 72, {92, 104, 98}, 200);
      if (closed)
        for (int layer = 0; layer < lit_pictures; ++layer) painter.light(layer, x, y, x + 48, y + 72, {});
      for (int slat = 2; slat < 72; slat += 5) {
        painter.shade(x - 22 + reach, y + slat, x - 5 + reach, y + slat + 1, -26);
        painter.shade(x + 53 - reach, y + slat, x + 70 - reach, y + slat + 1, -26);
      }
    } else {  // a French balcony
      railing(painter, x - 10, x + 60, y + 40, y + 76);
      painter.rect(x - 10, y + 76, x + 60, y + 82, {196, 190, 178}, 230);
      painter.shade(x - 10, y + 82, x + 60, y + 85, -40);
    }
    streaks(painter, x - 8, x + 58, y + 84, 153);
  });
  return painter.maps();
}

TextureMaps facade_stone() {
  TexturePainter painter(wall_px, 2 * floor_px, {204, 192, 168});
  painter.use_roughness(235);
  // Ashlar has courses of 0.4 m and blocks of 0.75 m.
  for (int row = 0; row < 16; ++row)
    for (int i = 0; i < wall_px / 32; ++i) {
      const int x = 32 * i + (row % 2) * 16, y = 16 * row;
      painter.shade(x, y, x + 32, y + 16, static_cast<int>(hash(i, row, 261) % 7) * 3 - 9);
      painter.shade(x, y, x + 1, y + 16, -20);
      painter.shade(x, y, x + 32, y + 1, -24);
    }
  painter.blotches(128, 7, 262);
  each_bay([&](int bay, int left, int top) {
    const int x = left + 40, y = top + 14;
    painter.rect(x - 8, y - 6, x + 56, y + 84, {222, 212, 190}, 225);
    painter.shade(x - 8, y + 78, x - 6, y + 84, -20);
    painter.rect(x - 12, y - 10, x + 60, y - 4, {228, 220, 200}, 225);  // moulding
    painter.shade(x - 12, y - 4, x + 60, y - 1, -38);
    window(painter, x, y, x + 48, y + 82, {.frame = {232, 230, 224}, .columns = 2, .rows = 3}, 268);
    if (top == 0 || bay % 4 == 1) railing(painter, x - 12, x + 62, y + 46, y + 84);
  });
  // the slab of a balcony along the whole upper floor, and a cornice
  painter.rect(0, 96, wall_px, 102, {214, 206, 186}, 225);
  painter.shade(0, 102, wall_px, 108, -44);
  painter.rect(0, 224, wall_px, 229, {218, 210, 190}, 225);
  painter.shade(0, 229, wall_px, 232, -30);
  return painter.maps();
}

TextureMaps facade_concrete() {
  TexturePainter painter(wall_px, 2 * floor_px, {168, 165, 158});
  painter.use_roughness(235);
  painter.blotches(128, 8, 171);
  painter.blotches(32, 5, 172);
  each_bay([&](int bay, int left, int top) {
    painter.shade(left, top, left + bay_px, top + floor_px,
                  static_cast<int>(hash(bay, top, 173) % 5) * 4 - 8);
    painter.shade(left, top, left + bay_px, top + 2, -44);
    painter.shade(left, top, left + 2, top + floor_px, -40);
    const int x = left + 18, y = top + 26;
    painter.shade(x - 3, y - 3, x + 95, y + 71, -22);
    streaks(painter, x, x + 92, y + 68, 174);
    window(painter, x, y, x + 92, y + 68, {.frame = {70, 72, 76}, .columns = 3, .rows = 1}, 180);
    if (hash(bay, top, 175) % 6 == 0) {  // air conditioner
      painter.rect(x + 30, y + 72, x + 58, y + 90, {206, 206, 200}, 170);
      painter.rect(x + 34, y + 75, x + 48, y + 87, {96, 98, 100}, 190);
      painter.shade(x + 30, y + 90, x + 60, y + 93, -30);
    }
  });
  return painter.maps();
}

TextureMaps facade_ribbon() {
  TexturePainter painter(wall_px, 2 * floor_px, {206, 203, 196});
  painter.use_roughness(235);
  painter.blotches(128, 6, 191);
  for (int floor = 0; floor < 2; ++floor) {
    const int y = floor_px * floor;
    window(painter, 0, y + 22, wall_px, y + 92,
           {.frame = {84, 86, 90}, .columns = 24, .rows = 1, .use = Use::office}, 200);
    streaks(painter, 0, wall_px, y + 92, 194);
    painter.shade(0, y + 120, wall_px, y + 122, -26);
    for (int x = 0; x < wall_px; x += 256) painter.shade(x, y + 92, x + 2, y + floor_px, -24);
  }
  return painter.maps();
}

TextureMaps facade_glass() {
  TexturePainter painter(wall_px, 2 * floor_px, {96, 126, 142});
  painter.use_roughness(26);
  for (int floor = 0; floor < 2; ++floor)
    for (int column = 0; column < wall_px / 64; ++column) {
      const int x = 64 * column, y = floor_px * floor;
      const int tint = static_cast<int>(hash(column, floor, 211) % 6) * 7 - 17;
      const int blind = hash(column, floor, 212) % 7 == 0 ? 34 : 0;
      for (int row = 0; row < 94; ++row) {
        const int sky = (94 - row) / 3 + (row < 40 ? blind : 0);
        painter.rect(x, y + row, x + 64, y + row + 1, {72 + sky + tint, 102 + sky + tint, 122 + sky + tint},
                     22);
      }
      for (int layer = 0; layer < lit_pictures; ++layer)
        light_pane(painter, layer, x + 3, y + 3, x + 64, y + 94,
                   night_light(Use::office, layer, column, y, 213), Use::office, 214);
      painter.rect(x, y + 94, x + 64, y + 128, {62 + tint / 2, 84 + tint / 2, 98 + tint / 2},
                   50);  // spandrel
      painter.rect(x, y, x + 3, y + 128, {176, 180, 184}, 110);
      painter.shade(x + 3, y, x + 5, y + 128, -20);
    }
  for (int floor = 0; floor < 2; ++floor) {
    painter.rect(0, 128 * floor + 94, wall_px, 128 * floor + 97, {176, 180, 184}, 110);
    painter.rect(0, 128 * floor, wall_px, 128 * floor + 3, {176, 180, 184}, 110);
  }
  return painter.maps();
}

TextureMaps facade_metal() {
  TexturePainter painter(wall_px, 2 * floor_px, {176, 180, 184});
  painter.use_roughness(110);
  for (int x = 0; x < wall_px; ++x) {
    const int phase = x % 16;
    painter.shade(x, 0, x + 1, 256, phase < 2 ? -34 : phase < 4 ? 12 : 0);
  }
  painter.blotches(128, 5, 221);
  painter.metal_everywhere(140);
  each_bay([&](int, int left, int top) {
    painter.shade(left, top + 126, left + bay_px, top + 128, -40);
    window(painter, left + 14, top + 34, left + 114, top + 84,
           {.frame = {60, 62, 66}, .columns = 3, .rows = 1, .use = Use::office}, 230);
  });
  return painter.maps();
}

TextureMaps facade_balcony() {
  TexturePainter painter(wall_px, 2 * floor_px, {222, 218, 210});
  painter.use_roughness(235);
  painter.blotches(64, 4, 271);
  each_bay([&](int bay, int left, int top) {
    if (bay % 2 == 0) {
      window(painter, left + 30, top + 26, left + 92, top + 88, {.frame = {66, 68, 70}, .columns = 2}, 272);
      streaks(painter, left + 30, left + 92, top + 88, 273);
      return;
    }
    // a loggia: a shaded recess, a glass door, a slab and a parapet of frosted glass
    painter.rect(left + 4, top + 8, left + 124, top + 100, {150, 146, 140}, 235);
    painter.shade(left + 4, top + 8, left + 124, top + 26, -46);
    painter.shade(left + 4, top + 8, left + 16, top + 100, -30);
    window(painter, left + 26, top + 18, left + 112, top + 100, {.frame = {58, 60, 62}, .columns = 3}, 274);
    const bool plants = hash(bay, top, 275) % 3 == 0;
    if (plants)
      for (int x = 8; x < 60; x += 3) {
        const int high = 4 + static_cast<int>(hash(x, bay + top, 276) % 9);
        painter.rect(left + x, top + 62 - high, left + x + 3, top + 62, {70, 96 + high, 48}, 240);
        for (int layer = 0; layer < lit_pictures; ++layer)
          painter.light(layer, left + x, top + 62 - high, left + x + 3, top + 62, {});
      }
    painter.rect(left + 2, top + 60, left + 126, top + 98, {150, 166, 170}, 60);
    for (int layer = 0; layer < lit_pictures; ++layer)
      painter.light(layer, left, top + 58, left + 128, top + 108, {});
    painter.rect(left + 2, top + 58, left + 126, top + 62, {70, 72, 74}, 110);
    for (int x = 2; x < 126; x += 31)
      painter.rect(left + x, top + 60, left + x + 2, top + 98, {92, 94, 96}, 110);
    painter.rect(left, top + 98, left + 128, top + 106, {200, 196, 188}, 230);
    painter.shade(left, top + 106, left + 128, top + 111, -48);
  });
  return painter.maps();
}

}  // namespace greatx::scene::generator
