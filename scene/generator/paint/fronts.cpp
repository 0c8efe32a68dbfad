// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints fronts that are not walls of bays: shops, farmhouses, dormers, posters.
#include <array>
#include <string_view>

#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"
#include "scene/generator/paint/windows.h"

namespace greatx::scene::generator {

namespace {

/// One of the shops of the picture: its board, its letters, and where its door is.
struct Shop {
  std::string_view name;
  Rgb board, letters, frame;
  int door;                  ///< left edge of the door, pixels
  std::array<int, 4> panes;  ///< left and right edges of the two windows, pixels
  bool awning;
};

constexpr int shop_px = 256;
constexpr std::array<Shop, 6> shops{{
    {"BAKERY", {70, 46, 34}, {230, 206, 150}, {58, 44, 36}, 104, {14, 98, 158, 242}, false},
    {"BOOKS", {112, 34, 30}, {240, 228, 200}, {52, 50, 50}, 196, {14, 100, 106, 190}, true},
    {"FLORIST", {38, 74, 50}, {232, 226, 190}, {206, 202, 190}, 14, {68, 152, 158, 242}, false},
    {"TAILOR", {44, 58, 74}, {214, 214, 206}, {46, 50, 54}, 104, {14, 98, 158, 242}, false},
    {"CAFE 24", {60, 54, 50}, {222, 156, 78}, {84, 60, 42}, 196, {14, 100, 106, 190}, true},
    {"OPTICS", {206, 208, 206}, {30, 66, 110}, {120, 124, 126}, 14, {68, 152, 158, 242}, false},
}};

/// Paints what stands in a shop's window: boards with wares of several sizes, by day behind a dark pane.
void add_goods(TexturePainter& painter, int x0, int x1, uint32_t shop) {
  static constexpr std::array<Rgb, 7> wares{{{196, 90, 60},
                                             {220, 180, 90},
                                             {90, 130, 170},
                                             {200, 196, 186},
                                             {120, 150, 80},
                                             {168, 120, 150},
                                             {236, 232, 224}}};
  const auto paint = [&](int left, int top, int right, int bottom, const Rgb& color) {
    painter.rect(left, top, right, bottom, dimmed(color, 52), 70);
    for (int layer = 0; layer < lit_pictures; ++layer)
      painter.light(layer, left, top, right, bottom, dimmed(color, 88));
  };
  for (int board = 0; board < 3; ++board) {
    const int floor = 157 - 27 * board;
    if (board > 0) paint(x0 + 4, floor, x1 - 4, floor + 2, {150, 136, 116});
    int x = x0 + 5;
    for (int i = 0; x < x1 - 12; ++i) {
      const int key = 64 * board + i + x0;
      const int wide = 4 + static_cast<int>(hash(key, 0, 248 + shop) % 9),
                high = 6 + static_cast<int>(hash(key, 1, 248 + shop) % 17);
      if (hash(key, 2, 248 + shop) % 4 != 0)
        paint(x, floor - high, x + wide, floor, wares[hash(key, 3, 248 + shop) % wares.size()]);
      x += wide + 2 + static_cast<int>(hash(key, 4, 248 + shop) % 4);
    }
  }
}

/// Darkens the rim of an opening that lies 0.2 m back in its wall: its lintel and its left side throw a
/// shadow, and its sill is dusty.
void recess(TexturePainter& painter, int x0, int y0, int x1, int y1) {
  for (int k = 0; k < 9; ++k) {
    painter.shade(x0, y0 + k, x1, y0 + k + 1, -54 + 6 * k);
    painter.shade(x0 + k, y0, x0 + k + 1, y1, -36 + 4 * k);
  }
  painter.shade(x0, y1 - 2, x1, y1, 26);
}

void add_shop(TexturePainter& painter, const Shop& shop, int left, uint32_t number) {
  painter.shade(left, 0, left + 5, 180, 8);  // pillars
  painter.shade(left + 5, 0, left + 7, 180, -26);
  painter.rect(left + 10, 12, left + 246, 44, shop.board, 150);
  painter.shade(left + 10, 12, left + 246, 14, 24);
  painter.shade(left + 10, 42, left + 246, 44, -30);
  painter.text(shop.name, left + 128, 28, 190, 18, 4, shop.letters);
  for (int layer = 0; layer < lit_pictures; ++layer)
    if ((number + static_cast<uint32_t>(layer)) % 3 != 2)
      painter.lit_text(layer, shop.name, left + 128, 28, 190, 18, 4, shop.letters);
  const WindowStyle pane{.frame = shop.frame, .columns = 1, .rows = 1, .frame_px = 3, .use = Use::shop};
  const uint32_t seed = 243 + 10 * number;
  for (const size_t k : {0u, 2u}) {
    const int x0 = left + shop.panes[k], x1 = left + shop.panes[k + 1];
    window(painter, x0, 48, x1, 160, pane, seed + static_cast<uint32_t>(k));
    add_goods(painter, x0, x1, number);
    recess(painter, x0, 48, x1, 160);
    // The panel below has a frame, and dirt at its foot.
    painter.rect(x0, 160, x1, 178, dimmed(shop.frame, 85), 190);
    painter.shade(x0 + 4, 164, x1 - 4, 165, -24);
    painter.shade(x0 + 4, 174, x1 - 4, 175, 20);
  }
  const int door = left + shop.door;
  window(painter, door, 48, door + 46, 180,
         {.frame = shop.frame, .columns = 1, .rows = 1, .frame_px = 6, .use = Use::shop}, seed + 4);
  recess(painter, door, 48, door + 46, 180);
  painter.rect(door + 2, 76, door + 44, 80, shop.frame, 150);         // a transom
  painter.rect(door + 36, 116, door + 39, 140, {178, 180, 182}, 90);  // a handle
  painter.rect(door + 12, 96, door + 30, 104, {226, 224, 216}, 120);
  painter.text("OPEN", door + 21, 100, 17, 6, 1, {150, 30, 30});
  if (shop.awning) {
    for (int stripe = 0; stripe < 9; ++stripe)
      painter.rect(left + 12 + 26 * stripe, 44, left + 38 + 26 * stripe, 62,
                   stripe % 2 == 0 ? shop.board : Rgb{214, 206, 190}, 220);
    painter.shade(left + 10, 62, left + 246, 70, -50);
    for (int layer = 0; layer < lit_pictures; ++layer)
      painter.light(layer, left + 12, 44, left + 246, 62, {});
  }
}

}  // namespace

TextureMaps shopfront() {
  TexturePainter painter(static_cast<int>(shops.size()) * shop_px, 180, {132, 126, 118});
  painter.use_roughness(220);
  painter.blotches(4, 5, 241);
  for (size_t i = 0; i < shops.size(); ++i)
    add_shop(painter, shops[i], static_cast<int>(i) * shop_px, static_cast<uint32_t>(i));
  for (int x = 0; x < painter.width(); ++x) {  // dirt that has splashed up
    const int high = 5 + static_cast<int>(hash(x / 7, 0, 254) % 9);
    for (int k = 0; k < high; ++k) painter.shade(x, 179 - k, x + 1, 180 - k, -40 * (high - k) / high);
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
