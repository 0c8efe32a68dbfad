// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "scene/generator/canvas.h"
#include "scene/generator/textures.h"

namespace greatx::scene::generator {

namespace {

constexpr int bay_px = facade_bay_px, floor_px = facade_floor_px, wall_px = facade_bay_px * facade_bays;

/// Who is behind a window decides when and how it is lit.
enum class Use { home, office, shop };

struct WindowStyle {
  Rgb frame{226, 224, 218};
  int columns = 2, rows = 1;
  int frame_px = 3;
  Use use = Use::home;
};

Rgb dimmed(const Rgb& c, int percent) {
  return {c.r * percent / 100, c.g * percent / 100, c.b * percent / 100};
}

/// Light behind a window of a home, sRGB: bulbs of 2700 to 3500 K, shades, a kitchen, a screen.
Rgb home_light(uint32_t pick) {
  static constexpr Rgb lights[] = {{255, 196, 120}, {255, 206, 140}, {240, 170, 92}, {255, 214, 158},
                                   {196, 128, 66},  {255, 226, 190}, {170, 104, 50}, {96, 124, 190}};
  return lights[pick % 8];
}

/// Whether window (x, floor) is lit in `layer`, and its light; black: dark. Offices go out by rooms of three windows.
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

/// A lit pane: brighter towards the lamp above, furniture dark against it.
void light_pane(Canvas& canvas, int layer, int x0, int y0, int x1, int y1, const Rgb& light, Use use,
                uint32_t seed) {
  if (light.r + light.g + light.b == 0) return;
  const int h = y1 - y0, w = x1 - x0;
  for (int y = 0; y < h; ++y) {
    const int percent = use == Use::shop ? 100 - 14 * y / h : 100 - 34 * y / h;
    canvas.light(layer, x0, y0 + y, x1, y0 + y + 1, dimmed(light, percent));
  }
  if (use == Use::office)  // rows of lamps below the ceiling
    canvas.light(layer, x0, y0 + h / 8, x1, y0 + h / 8 + 3, {255, 255, 250});
  for (int i = 0; i < 3; ++i) {
    const int left = x0 + static_cast<int>(hash(i, x0, seed) % static_cast<uint32_t>(std::max(1, w - 6)));
    const int high = h / 6 + static_cast<int>(hash(i, y0, seed + 1) % static_cast<uint32_t>(h / 4 + 1));
    const int wide = 5 + static_cast<int>(hash(i, w, seed + 2) % 10);
    canvas.light(layer, left, y1 - high, std::min(left + wide, x1), y1, dimmed(light, 55));
  }
}

/// A window set back in its wall: shadow under the lintel, frame, panes that mirror a paler sky towards the top,
/// perhaps a curtain or a blind. By night some are lit.
void window(Canvas& canvas, int x0, int y0, int x1, int y1, const WindowStyle& style, uint32_t seed) {
  canvas.rect(x0, y0, x1, y1, style.frame, 120);
  const int w = (x1 - x0 - style.frame_px * (style.columns + 1)) / style.columns;
  const int h = (y1 - y0 - style.frame_px * (style.rows + 1)) / style.rows;
  // The same in all panes: one household. Shops show what they have.
  const uint32_t dressing = style.use == Use::shop ? 9u : hash(x0, y0, seed) % 10;
  const Rgb cloth = hash(x0, y0, seed + 3) % 3 == 0 ? Rgb{122, 96, 80} : Rgb{168, 162, 150};
  for (int c = 0; c < style.columns; ++c)
    for (int r = 0; r < style.rows; ++r) {
      const int px = x0 + style.frame_px + c * (w + style.frame_px),
                py = y0 + style.frame_px + r * (h + style.frame_px);
      const int tint = static_cast<int>(hash(c + x0, r + y0, seed) % 5) * 5 - 12;
      for (int y = 0; y < h; ++y) {
        const int sky = 34 * (h - y) / h;
        canvas.rect(px, py + y, px + w, py + y + 1, {40 + sky + tint, 52 + sky + tint, 64 + sky + tint}, 28);
      }
      const bool office = style.use != Use::home;
      for (int layer = 0; layer < lit_pictures; ++layer) {
        const Rgb light = night_light(style.use, layer, office ? px / 40 : x0, y0, seed);
        light_pane(canvas, layer, px, py, px + w, py + h, light, style.use, seed + static_cast<uint32_t>(c));
        if (light.r == 0 || office) continue;
        if (dressing == 1) canvas.light(layer, px, py, px + w, py + h / 2, dimmed(light, 58));
        if (dressing == 2 && c == 0) canvas.light(layer, px, py, px + w / 2, py + h, dimmed(light, 62));
        if (dressing == 3) canvas.light(layer, px, py, px + w, py + h, dimmed(light, 66));
      }
      if (dressing == 1 && r == 0) canvas.rect(px, py, px + w, py + h / 2, {176, 170, 156}, 60);  // blind
      if (dressing == 2 && c == 0) canvas.rect(px, py, px + w / 2, py + h, cloth, 60);
      if (dressing == 2 && c + 1 == style.columns) canvas.rect(px + w / 2, py, px + w, py + h, cloth, 60);
      if (dressing == 3) canvas.rect(px, py, px + w, py + h, {150, 148, 142}, 50);  // net curtain
    }
  canvas.shade(x0, y0, x1, y0 + 5, -45);
  canvas.shade(x0, y0, x0 + 3, y1, -30);
}

/// Soot and rain under a sill.
void streaks(Canvas& canvas, int x0, int x1, int y, uint32_t seed) {
  for (int x = x0; x < x1; ++x) {
    const uint32_t h = hash(x / 2, y, seed);
    if (h % 4 == 0) canvas.shade(x, y, x + 1, y + 6 + static_cast<int>(h / 4 % 16), -7);
  }
}

void bricks(Canvas& canvas, const Rgb& brick, const Rgb& mortar, uint32_t seed) {
  canvas.fill(mortar);
  for (int row = 0; row < canvas.height() / 4; ++row)
    for (int i = 0; i < canvas.width() / 8; ++i) {
      const int shade = static_cast<int>(hash(i, row, seed) % 6) * 7 - 18;
      canvas.rect(8 * i + (row % 2) * 4, 4 * row, 8 * i + (row % 2) * 4 + 7, 4 * row + 3,
                  {brick.r + shade, brick.g + shade, brick.b + shade});
    }
}

/// Bars of 2 pixels every 6 between x0 and x1, with a rail on top.
void railing(Canvas& canvas, int x0, int x1, int y0, int y1) {
  for (int x = x0; x < x1; x += 6) canvas.rect(x, y0, x + 2, y1, {44, 45, 48}, 120);
  canvas.rect(x0, y0 - 2, x1, y0 + 1, {44, 45, 48}, 120);
}

template <typename Paint>
void each_bay(const Paint& paint) {
  for (int floor = 0; floor < 2; ++floor)
    for (int bay = 0; bay < facade_bays; ++bay) paint(bay, bay_px * bay, floor_px * floor);
}

}  // namespace

Picture facade_brick() {
  Canvas canvas(wall_px, 2 * floor_px, {0, 0, 0});
  canvas.use_roughness(240);
  bricks(canvas, {146, 80, 62}, {166, 156, 144}, 131);
  canvas.blotches(128, 8, 132);
  each_bay([&](int, int left, int top) {
    const int x = left + 34, y = top + 24;
    canvas.rect(x - 5, y - 9, x + 65, y, {184, 176, 162}, 230);        // lintel
    canvas.rect(x - 6, y + 70, x + 66, y + 75, {190, 182, 168}, 230);  // sill
    canvas.shade(x - 6, y + 75, x + 66, y + 78, -34);
    streaks(canvas, x - 6, x + 66, y + 78, 133);
    window(canvas, x, y, x + 60, y + 70, {.columns = 2, .rows = 2}, 140);
  });
  canvas.rect(0, 252, wall_px, 256, {176, 168, 154}, 230);  // string course at every second floor
  return canvas.picture();
}

Picture facade_plaster() {
  Canvas canvas(wall_px, 2 * floor_px, {218, 212, 200});
  canvas.use_roughness(240);
  canvas.blotches(64, 6, 151);
  each_bay([&](int bay, int left, int top) {
    const int x = left + 40, y = top + 22;
    canvas.rect(x - 5, y - 5, x + 53, y + 77, {236, 232, 222}, 230);
    window(canvas, x, y, x + 48, y + 72, {.frame = {240, 238, 232}, .columns = 2, .rows = 1}, 160);
    if (bay % 2 == 0) {  // shutters, some of them closed
      const bool closed = hash(bay, top, 161) % 5 == 0;
      const int reach = closed ? 24 : 0;
      canvas.rect(x - 24 + reach, y, x - 3 + reach, y + 72, {92, 104, 98}, 200);
      canvas.rect(x + 51 - reach, y, x + 72 - reach, y + 72, {92, 104, 98}, 200);
      if (closed)
        for (int layer = 0; layer < lit_pictures; ++layer) canvas.light(layer, x, y, x + 48, y + 72, {});
      for (int slat = 2; slat < 72; slat += 5) {
        canvas.shade(x - 22 + reach, y + slat, x - 5 + reach, y + slat + 1, -26);
        canvas.shade(x + 53 - reach, y + slat, x + 70 - reach, y + slat + 1, -26);
      }
    } else {  // a French balcony
      railing(canvas, x - 10, x + 60, y + 40, y + 76);
      canvas.rect(x - 10, y + 76, x + 60, y + 82, {196, 190, 178}, 230);
      canvas.shade(x - 10, y + 82, x + 60, y + 85, -40);
    }
    streaks(canvas, x - 8, x + 58, y + 84, 153);
  });
  return canvas.picture();
}

Picture facade_stone() {
  Canvas canvas(wall_px, 2 * floor_px, {204, 192, 168});
  canvas.use_roughness(235);
  // Ashlar: courses of 0.4 m, blocks of 0.75 m.
  for (int row = 0; row < 16; ++row)
    for (int i = 0; i < wall_px / 32; ++i) {
      const int x = 32 * i + (row % 2) * 16, y = 16 * row;
      canvas.shade(x, y, x + 32, y + 16, static_cast<int>(hash(i, row, 261) % 7) * 3 - 9);
      canvas.shade(x, y, x + 1, y + 16, -20);
      canvas.shade(x, y, x + 32, y + 1, -24);
    }
  canvas.blotches(128, 7, 262);
  each_bay([&](int bay, int left, int top) {
    const int x = left + 40, y = top + 14;
    canvas.rect(x - 8, y - 6, x + 56, y + 84, {222, 212, 190}, 225);
    canvas.shade(x - 8, y + 78, x - 6, y + 84, -20);
    canvas.rect(x - 12, y - 10, x + 60, y - 4, {228, 220, 200}, 225);  // moulding
    canvas.shade(x - 12, y - 4, x + 60, y - 1, -38);
    window(canvas, x, y, x + 48, y + 82, {.frame = {232, 230, 224}, .columns = 2, .rows = 3}, 268);
    if (top == 0 || bay % 4 == 1) railing(canvas, x - 12, x + 62, y + 46, y + 84);
  });
  // A balcony's slab along the whole upper floor, and a cornice.
  canvas.rect(0, 96, wall_px, 102, {214, 206, 186}, 225);
  canvas.shade(0, 102, wall_px, 108, -44);
  canvas.rect(0, 224, wall_px, 229, {218, 210, 190}, 225);
  canvas.shade(0, 229, wall_px, 232, -30);
  return canvas.picture();
}

Picture facade_concrete() {
  Canvas canvas(wall_px, 2 * floor_px, {168, 165, 158});
  canvas.use_roughness(235);
  canvas.blotches(128, 8, 171);
  canvas.blotches(32, 5, 172);
  each_bay([&](int bay, int left, int top) {
    canvas.shade(left, top, left + bay_px, top + floor_px, static_cast<int>(hash(bay, top, 173) % 5) * 4 - 8);
    canvas.shade(left, top, left + bay_px, top + 2, -44);
    canvas.shade(left, top, left + 2, top + floor_px, -40);
    const int x = left + 18, y = top + 26;
    canvas.shade(x - 3, y - 3, x + 95, y + 71, -22);
    streaks(canvas, x, x + 92, y + 68, 174);
    window(canvas, x, y, x + 92, y + 68, {.frame = {70, 72, 76}, .columns = 3, .rows = 1}, 180);
    if (hash(bay, top, 175) % 6 == 0) {  // air conditioner
      canvas.rect(x + 30, y + 72, x + 58, y + 90, {206, 206, 200}, 170);
      canvas.rect(x + 34, y + 75, x + 48, y + 87, {96, 98, 100}, 190);
      canvas.shade(x + 30, y + 90, x + 60, y + 93, -30);
    }
  });
  return canvas.picture();
}

Picture facade_ribbon() {
  Canvas canvas(wall_px, 2 * floor_px, {206, 203, 196});
  canvas.use_roughness(235);
  canvas.blotches(128, 6, 191);
  for (int floor = 0; floor < 2; ++floor) {
    const int y = floor_px * floor;
    window(canvas, 0, y + 22, wall_px, y + 92,
           {.frame = {84, 86, 90}, .columns = 24, .rows = 1, .use = Use::office}, 200);
    streaks(canvas, 0, wall_px, y + 92, 194);
    canvas.shade(0, y + 120, wall_px, y + 122, -26);
    for (int x = 0; x < wall_px; x += 256) canvas.shade(x, y + 92, x + 2, y + floor_px, -24);
  }
  return canvas.picture();
}

Picture facade_glass() {
  Canvas canvas(wall_px, 2 * floor_px, {96, 126, 142});
  canvas.use_roughness(26);
  for (int floor = 0; floor < 2; ++floor)
    for (int column = 0; column < wall_px / 64; ++column) {
      const int x = 64 * column, y = floor_px * floor;
      const int tint = static_cast<int>(hash(column, floor, 211) % 6) * 7 - 17;
      const int blind = hash(column, floor, 212) % 7 == 0 ? 34 : 0;
      for (int row = 0; row < 94; ++row) {
        const int sky = (94 - row) / 3 + (row < 40 ? blind : 0);
        canvas.rect(x, y + row, x + 64, y + row + 1, {72 + sky + tint, 102 + sky + tint, 122 + sky + tint},
                    22);
      }
      for (int layer = 0; layer < lit_pictures; ++layer)
        light_pane(canvas, layer, x + 3, y + 3, x + 64, y + 94,
                   night_light(Use::office, layer, column, y, 213), Use::office, 214);
      canvas.rect(x, y + 94, x + 64, y + 128, {62 + tint / 2, 84 + tint / 2, 98 + tint / 2}, 50);  // spandrel
      canvas.rect(x, y, x + 3, y + 128, {176, 180, 184}, 110);
      canvas.shade(x + 3, y, x + 5, y + 128, -20);
    }
  for (int floor = 0; floor < 2; ++floor) {
    canvas.rect(0, 128 * floor + 94, wall_px, 128 * floor + 97, {176, 180, 184}, 110);
    canvas.rect(0, 128 * floor, wall_px, 128 * floor + 3, {176, 180, 184}, 110);
  }
  return canvas.picture();
}

Picture facade_metal() {
  Canvas canvas(wall_px, 2 * floor_px, {176, 180, 184});
  canvas.use_roughness(110);
  for (int x = 0; x < wall_px; ++x) {
    const int phase = x % 16;
    canvas.shade(x, 0, x + 1, 256, phase < 2 ? -34 : phase < 4 ? 12 : 0);
  }
  canvas.blotches(128, 5, 221);
  canvas.metal_everywhere(140);
  each_bay([&](int, int left, int top) {
    canvas.shade(left, top + 126, left + bay_px, top + 128, -40);
    window(canvas, left + 14, top + 34, left + 114, top + 84,
           {.frame = {60, 62, 66}, .columns = 3, .rows = 1, .use = Use::office}, 230);
  });
  return canvas.picture();
}

Picture facade_balcony() {
  Canvas canvas(wall_px, 2 * floor_px, {222, 218, 210});
  canvas.use_roughness(235);
  canvas.blotches(64, 4, 271);
  each_bay([&](int bay, int left, int top) {
    if (bay % 2 == 0) {
      window(canvas, left + 30, top + 26, left + 92, top + 88, {.frame = {66, 68, 70}, .columns = 2}, 272);
      streaks(canvas, left + 30, left + 92, top + 88, 273);
      return;
    }
    // A loggia: shaded recess, glass door, slab and a parapet of frosted glass.
    canvas.rect(left + 4, top + 8, left + 124, top + 100, {150, 146, 140}, 235);
    canvas.shade(left + 4, top + 8, left + 124, top + 26, -46);
    canvas.shade(left + 4, top + 8, left + 16, top + 100, -30);
    window(canvas, left + 26, top + 18, left + 112, top + 100, {.frame = {58, 60, 62}, .columns = 3}, 274);
    const bool plants = hash(bay, top, 275) % 3 == 0;
    if (plants)
      for (int x = 8; x < 60; x += 3) {
        const int high = 4 + static_cast<int>(hash(x, bay + top, 276) % 9);
        canvas.rect(left + x, top + 62 - high, left + x + 3, top + 62, {70, 96 + high, 48}, 240);
        for (int layer = 0; layer < lit_pictures; ++layer)
          canvas.light(layer, left + x, top + 62 - high, left + x + 3, top + 62, {});
      }
    canvas.rect(left + 2, top + 60, left + 126, top + 98, {150, 166, 170}, 60);
    for (int layer = 0; layer < lit_pictures; ++layer)
      canvas.light(layer, left, top + 58, left + 128, top + 108, {});
    canvas.rect(left + 2, top + 58, left + 126, top + 62, {70, 72, 74}, 110);
    for (int x = 2; x < 126; x += 31)
      canvas.rect(left + x, top + 60, left + x + 2, top + 98, {92, 94, 96}, 110);
    canvas.rect(left, top + 98, left + 128, top + 106, {200, 196, 188}, 230);
    canvas.shade(left, top + 106, left + 128, top + 111, -48);
  });
  return canvas.picture();
}

Picture shopfront() {
  Canvas canvas(4 * 256, 180, {132, 126, 118});
  canvas.use_roughness(220);
  canvas.blotches(4, 5, 241);
  static constexpr Rgb fascias[] = {{44, 58, 74}, {112, 34, 30}, {38, 74, 50}, {60, 54, 50}};
  static constexpr Rgb letters[] = {{224, 214, 186}, {240, 228, 200}, {232, 220, 120}, {214, 150, 70}};
  static constexpr Rgb goods[] = {
      {196, 90, 60}, {220, 180, 90}, {90, 130, 170}, {200, 196, 186}, {120, 150, 80}};
  for (int shop = 0; shop < 4; ++shop) {
    const int left = 256 * shop;
    canvas.rect(left + 10, 12, left + 246, 44, fascias[shop], 150);
    const WindowStyle display{
        .frame = {48, 48, 50}, .columns = 2, .rows = 1, .frame_px = 4, .use = Use::shop};
    const WindowStyle door{.frame = {60, 58, 56}, .columns = 2, .rows = 1, .frame_px = 5, .use = Use::shop};
    const uint32_t seed = 243 + 10 * static_cast<uint32_t>(shop);
    window(canvas, left + 12, 48, left + 96, 160, display, seed);
    window(canvas, left + 160, 48, left + 244, 160, display, seed + 2);
    window(canvas, left + 104, 48, left + 152, 178, door, seed + 4);
    for (int i = 0; i < 14; ++i) {  // what is for sale
      const int side = i % 2 == 0 ? 18 : 166, x = left + side + static_cast<int>(hash(i, shop, 248) % 62);
      const int w = 4 + static_cast<int>(hash(i, shop, 249) % 8),
                h = 8 + static_cast<int>(hash(i, shop, 250) % 34);
      const Rgb color = goods[hash(i, shop, 251) % 5];
      canvas.rect(x, 156 - h, x + w, 156, dimmed(color, 55), 60);
      for (int layer = 0; layer < lit_pictures; ++layer) canvas.light(layer, x, 156 - h, x + w, 156, color);
    }
    for (int letter = 0; letter < 11; ++letter) {
      const int w = 6 + static_cast<int>(hash(letter, shop, 242) % 6), x = left + 64 + 12 * letter;
      if (letter == 5 || hash(letter, shop, 244) % 7 == 0) continue;
      canvas.rect(x, 21, x + w, 35, letters[shop], 150);
      for (int layer = 0; layer < lit_pictures; ++layer)
        if ((shop + layer) % 3 != 2) canvas.light(layer, x, 21, x + w, 35, letters[shop]);
    }
    canvas.rect(left + 12, 160, left + 96, 176, {96, 90, 84}, 210);
    canvas.rect(left + 160, 160, left + 244, 176, {96, 90, 84}, 210);
    if (shop % 2 == 1) {  // an awning
      for (int stripe = 0; stripe < 9; ++stripe)
        canvas.rect(left + 12 + 26 * stripe, 44, left + 38 + 26 * stripe, 62,
                    stripe % 2 == 0 ? fascias[shop] : Rgb{226, 220, 206}, 220);
      canvas.shade(left + 10, 62, left + 246, 70, -50);
      for (int layer = 0; layer < lit_pictures; ++layer)
        canvas.light(layer, left + 12, 44, left + 246, 62, {});
    } else {
      canvas.shade(left + 10, 44, left + 246, 50, -40);
    }
  }
  return canvas.picture();
}

Picture farm_wall() {
  Canvas canvas(4 * 160, 120, {216, 208, 190});
  canvas.use_roughness(240);
  canvas.blotches(40, 9, 251);
  canvas.blotches(8, 4, 252);
  for (int bay = 0; bay < 4; ++bay) {
    const int left = 160 * bay;
    canvas.rect(left + 54, 28, left + 106, 84, {120, 78, 52}, 220);
    for (const int x : {28, 108}) {  // shutters
      canvas.rect(left + x, 30, left + x + 24, 82, {76, 96, 74}, 200);
      for (int slat = 34; slat < 80; slat += 5)
        canvas.shade(left + x + 2, slat, left + x + 22, slat + 1, -24);
    }
    window(canvas, left + 57, 31, left + 103, 81, {.frame = {228, 224, 214}, .columns = 2, .rows = 2}, 253);
    canvas.rect(left + 52, 84, left + 108, 88, {170, 162, 148}, 230);
    streaks(canvas, left + 52, left + 108, 88, 255);
  }
  for (int x = 0; x < 640; ++x)  // splashed foot
    canvas.shade(x, 108 + static_cast<int>(hash(x / 6, 0, 254) % 5), x + 1, 120, -18);
  return canvas.picture();
}

Picture dormer() {
  Canvas canvas(64, 64, {196, 192, 184});
  canvas.use_roughness(200);
  window(canvas, 10, 8, 54, 56, {.frame = {232, 230, 224}, .columns = 2, .rows = 1, .frame_px = 3}, 281);
  canvas.rect(0, 0, 64, 5, {92, 98, 104}, 140);
  return canvas.picture();
}

Picture poster() {
  Canvas canvas(64, 96, {40, 70, 110});
  const auto paint = [&](int x0, int y0, int x1, int y1, const Rgb& color) {
    canvas.rect(x0, y0, x1, y1, color);
    for (int layer = 0; layer < lit_pictures; ++layer) canvas.light(layer, x0, y0, x1, y1, color);
  };
  for (int y = 0; y < 96; ++y) paint(0, y, 64, y + 1, {60 + y, 110 + y / 2, 190 - y / 2});
  for (int dy = -18; dy <= 18; ++dy)
    for (int dx = -18; dx <= 18; ++dx)
      if (dx * dx + dy * dy < 330) paint(36 + dx, 38 + dy, 37 + dx, 39 + dy, {244, 196, 88});
  paint(6, 68, 50, 74, {250, 250, 246});
  paint(6, 78, 38, 82, {250, 250, 246});
  paint(0, 0, 64, 3, {36, 38, 40});
  paint(0, 93, 64, 96, {36, 38, 40});
  return canvas.picture();
}

}  // namespace greatx::scene::generator
