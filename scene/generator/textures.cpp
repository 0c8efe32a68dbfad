// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/textures.h"

#include <algorithm>
#include <map>

#include "core/error.h"
#include "scene/generator/canvas.h"

namespace greatx::scene::generator {

namespace {

Picture asphalt() {
  Canvas canvas(256, 256, {78, 78, 80});
  canvas.blotches(64, 7, 11);
  canvas.blotches(16, 4, 12);
  canvas.speckle(9, 13);
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
  Canvas canvas(256, 256, {86, 108, 52});
  canvas.blotches(64, 10, 41);
  canvas.blotches(8, 7, 42);
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const int blade = static_cast<int>(hash(x, y / 2, 43) % 5);
      canvas.add(x, y, {6 * blade - 12, 7 * blade - 14, 3 * blade - 6});
    }
  return canvas.picture();
}

/// Rows along x; light grey, coloured by the material.
Picture crop() {
  Canvas canvas(128, 128, {205, 205, 200});
  for (int y = 0; y < 128; ++y) {
    const int phase = y % 16;
    canvas.shade(0, y, 128, y + 1, phase < 8 ? -4 * phase : -4 * (16 - phase));
  }
  canvas.blotches(32, 12, 51);
  canvas.speckle(14, 52);
  return canvas.picture();
}

Picture leaves() {
  Canvas canvas(128, 128, {66, 92, 38});
  canvas.blotches(16, 16, 61);
  for (int i = 0; i < 620; ++i) {
    const int x = static_cast<int>(hash(i, 0, 62) % 128), y = static_cast<int>(hash(i, 1, 62) % 128);
    const int light = static_cast<int>(hash(i, 2, 62) % 7) * 9 - 30;
    for (int dy = 0; dy < 4; ++dy)
      for (int dx = 0; dx < 4; ++dx)
        if ((dx != 0 && dx != 3) || (dy != 0 && dy != 3))
          canvas.add(x + dx, y + dy, {light, light + 3, light / 2});
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

Picture roof() {
  Canvas canvas(128, 128, {139, 135, 129});
  canvas.blotches(32, 9, 81);
  canvas.speckle(14, 82);
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

Picture roof_tiles() {
  // 2.4 m: eight courses of overlapping clay tiles, staggered.
  Canvas canvas(128, 128, {150, 82, 58});
  for (int row = 0; row < 8; ++row)
    for (int tile = 0; tile < 16; ++tile) {
      const int x = 8 * tile + (row % 2) * 4, y = 16 * row;
      canvas.shade(x, y, x + 8, y + 16, static_cast<int>(hash(tile, row, 111) % 7) * 6 - 18);
      canvas.shade(x, y, x + 1, y + 16, -34);
      canvas.shade(x, y + 13, x + 8, y + 16, -30);
      canvas.shade(x, y, x + 8, y + 3, 10);
    }
  canvas.speckle(6, 112);
  return canvas.picture();
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

Picture brick() {
  Canvas canvas(128, 128, {0, 0, 0});
  bricks(canvas, {146, 82, 64}, {164, 154, 142}, 121);
  canvas.blotches(64, 8, 122);
  return canvas.picture();
}

struct WindowStyle {
  Rgb frame{226, 224, 218};
  int columns = 2, rows = 1;
  int frame_px = 3;
};

/// A window set back in its wall: shadow under the lintel, frame, panes that mirror a paler sky towards the top,
/// perhaps a curtain or a blind.
void window(Canvas& canvas, int x0, int y0, int x1, int y1, const WindowStyle& style, uint32_t seed) {
  canvas.rect(x0, y0, x1, y1, style.frame, 120);
  const int w = (x1 - x0 - style.frame_px * (style.columns + 1)) / style.columns;
  const int h = (y1 - y0 - style.frame_px * (style.rows + 1)) / style.rows;
  for (int c = 0; c < style.columns; ++c)
    for (int r = 0; r < style.rows; ++r) {
      const int px = x0 + style.frame_px + c * (w + style.frame_px),
                py = y0 + style.frame_px + r * (h + style.frame_px);
      const int tint = static_cast<int>(hash(c, r, seed) % 5) * 4 - 8;
      for (int y = 0; y < h; ++y) {
        const int sky = 34 * (h - y) / h;
        canvas.rect(px, py + y, px + w, py + y + 1, {44 + sky + tint, 56 + sky + tint, 68 + sky + tint}, 28);
      }
      const uint32_t kind = hash(c, r, seed + 1) % 6;
      if (kind == 0) canvas.rect(px, py, px + w, py + h / 3, {176, 170, 156}, 60);  // blind
      if (kind == 1) canvas.rect(px, py, px + w / 3, py + h, {150, 142, 132}, 60);  // curtain
      if (kind == 2) canvas.rect(px + 2 * w / 3, py, px + w, py + h, {150, 142, 132}, 60);
    }
  canvas.shade(x0, y0, x1, y0 + 5, -45);
  canvas.shade(x0, y0, x0 + 3, y1, -30);
}

// Façades: 256 x 256 pixels for two bays of 3.0 m by two floors of 3.2 m. In each floor the lowest 0.85 m (34 pixels)
// is plain wall, so that a parapet may end there.

Picture facade_brick() {
  Canvas canvas(256, 256, {0, 0, 0});
  canvas.use_roughness(240);
  bricks(canvas, {146, 80, 62}, {166, 156, 144}, 131);
  canvas.blotches(64, 6, 132);
  for (int floor = 0; floor < 2; ++floor)
    for (int bay = 0; bay < 2; ++bay) {
      const int x = 128 * bay + 34, y = 128 * floor + 24;
      canvas.rect(x - 5, y - 9, x + 65, y, {184, 176, 162}, 230);        // lintel
      canvas.rect(x - 6, y + 70, x + 66, y + 75, {190, 182, 168}, 230);  // sill
      canvas.shade(x - 6, y + 75, x + 66, y + 78, -34);
      window(canvas, x, y, x + 60, y + 70, {.columns = 2, .rows = 2},
             static_cast<uint32_t>(140 + 2 * floor + bay));
    }
  canvas.rect(0, 252, 256, 256, {176, 168, 154}, 230);  // string course at every second floor
  return canvas.picture();
}

Picture facade_plaster() {
  Canvas canvas(256, 256, {218, 212, 200});
  canvas.use_roughness(240);
  canvas.blotches(64, 5, 151);
  canvas.speckle(3, 152);
  for (int floor = 0; floor < 2; ++floor)
    for (int bay = 0; bay < 2; ++bay) {
      const int x = 128 * bay + 40, y = 128 * floor + 22;
      canvas.rect(x - 5, y - 5, x + 53, y + 77, {236, 232, 222}, 230);
      window(canvas, x, y, x + 48, y + 72, {.frame = {240, 238, 232}, .columns = 2, .rows = 1},
             static_cast<uint32_t>(160 + 2 * floor + bay));
      if (bay == 0) {  // shutters
        canvas.rect(x - 24, y, x - 3, y + 72, {92, 104, 98}, 200);
        canvas.rect(x + 51, y, x + 72, y + 72, {92, 104, 98}, 200);
        for (int slat = 2; slat < 72; slat += 5) {
          canvas.shade(x - 22, y + slat, x - 5, y + slat + 1, -26);
          canvas.shade(x + 53, y + slat, x + 70, y + slat + 1, -26);
        }
      } else {  // a French balcony's railing
        for (int bar = -8; bar < 58; bar += 6)
          canvas.rect(x + bar, y + 40, x + bar + 2, y + 76, {48, 48, 50}, 120);
        canvas.rect(x - 10, y + 38, x + 60, y + 41, {48, 48, 50}, 120);
        canvas.rect(x - 10, y + 76, x + 60, y + 82, {196, 190, 178}, 230);
        canvas.shade(x - 10, y + 82, x + 60, y + 85, -40);
      }
    }
  return canvas.picture();
}

Picture facade_concrete() {
  Canvas canvas(256, 256, {168, 165, 158});
  canvas.use_roughness(235);
  canvas.blotches(64, 7, 171);
  canvas.speckle(4, 172);
  for (int floor = 0; floor < 2; ++floor) {
    canvas.shade(0, 128 * floor, 256, 128 * floor + 2, -44);
    for (int bay = 0; bay < 2; ++bay) {
      canvas.shade(128 * bay, 128 * floor, 128 * bay + 2, 128 * floor + 128, -40);
      const int x = 128 * bay + 18, y = 128 * floor + 26;
      canvas.shade(x - 3, y - 3, x + 95, y + 71, -22);
      window(canvas, x, y, x + 92, y + 68, {.frame = {70, 72, 76}, .columns = 3, .rows = 1},
             static_cast<uint32_t>(180 + 2 * floor + bay));
    }
  }
  return canvas.picture();
}

Picture facade_ribbon() {
  Canvas canvas(256, 256, {206, 203, 196});
  canvas.use_roughness(235);
  canvas.blotches(64, 4, 191);
  canvas.speckle(3, 192);
  for (int floor = 0; floor < 2; ++floor) {
    const int y = 128 * floor;
    window(canvas, 0, y + 22, 256, y + 92, {.frame = {84, 86, 90}, .columns = 6, .rows = 1},
           static_cast<uint32_t>(200 + floor));
    canvas.shade(0, y + 120, 256, y + 122, -26);
  }
  return canvas.picture();
}

Picture facade_glass() {
  Canvas canvas(256, 256, {96, 126, 142});
  canvas.use_roughness(26);
  for (int floor = 0; floor < 2; ++floor)
    for (int column = 0; column < 4; ++column) {
      const int x = 64 * column, y = 128 * floor;
      const int tint = static_cast<int>(hash(column, floor, 211) % 6) * 7 - 17;
      for (int row = 0; row < 94; ++row) {
        const int sky = (94 - row) / 3;
        canvas.rect(x, y + row, x + 64, y + row + 1, {80 + sky + tint, 112 + sky + tint, 132 + sky + tint},
                    22);
      }
      canvas.rect(x, y + 94, x + 64, y + 128, {62 + tint / 2, 84 + tint / 2, 98 + tint / 2}, 50);  // spandrel
      canvas.rect(x, y, x + 3, y + 128, {176, 180, 184}, 110);
      canvas.shade(x + 3, y, x + 5, y + 128, -20);
    }
  for (int floor = 0; floor < 2; ++floor) {
    canvas.rect(0, 128 * floor + 94, 256, 128 * floor + 97, {176, 180, 184}, 110);
    canvas.rect(0, 128 * floor, 256, 128 * floor + 3, {176, 180, 184}, 110);
  }
  return canvas.picture();
}

Picture facade_metal() {
  Canvas canvas(256, 256, {176, 180, 184});
  canvas.use_roughness(110);
  for (int x = 0; x < 256; ++x) {
    const int phase = x % 16;
    canvas.shade(x, 0, x + 1, 256, phase < 2 ? -34 : phase < 4 ? 12 : 0);
  }
  canvas.blotches(64, 4, 221);
  canvas.metal_everywhere(140);
  for (int floor = 0; floor < 2; ++floor) {
    const int y = 128 * floor;
    canvas.shade(0, y + 126, 256, y + 128, -40);
    for (int bay = 0; bay < 2; ++bay)
      window(canvas, 128 * bay + 14, y + 34, 128 * bay + 114, y + 84,
             {.frame = {60, 62, 66}, .columns = 3, .rows = 1}, static_cast<uint32_t>(230 + 2 * floor + bay));
  }
  return canvas.picture();
}

/// 6.0 m x 4.2 m: piers, a fascia with a sign, display windows and a door.
Picture shopfront() {
  Canvas canvas(256, 180, {132, 126, 118});
  canvas.use_roughness(220);
  canvas.speckle(4, 241);
  canvas.rect(10, 12, 246, 44, {54, 66, 78}, 150);
  for (int letter = 0; letter < 11; ++letter) {
    const int w = 6 + static_cast<int>(hash(letter, 0, 242) % 6);
    if (letter != 5) canvas.rect(64 + 12 * letter, 21, 64 + 12 * letter + w, 35, {224, 214, 186}, 150);
  }
  window(canvas, 12, 48, 96, 160, {.frame = {48, 48, 50}, .columns = 2, .rows = 1, .frame_px = 4}, 243);
  window(canvas, 160, 48, 244, 160, {.frame = {48, 48, 50}, .columns = 2, .rows = 1, .frame_px = 4}, 245);
  window(canvas, 104, 48, 152, 178, {.frame = {60, 58, 56}, .columns = 2, .rows = 1, .frame_px = 5}, 247);
  canvas.rect(12, 160, 96, 176, {96, 90, 84}, 210);
  canvas.rect(160, 160, 244, 176, {96, 90, 84}, 210);
  canvas.shade(10, 44, 246, 50, -40);
  return canvas.picture();
}

/// 4.0 m x 3.0 m of a farmhouse: whitewash, one window.
Picture farm_wall() {
  Canvas canvas(160, 120, {216, 208, 190});
  canvas.use_roughness(240);
  canvas.blotches(40, 8, 251);
  canvas.speckle(5, 252);
  canvas.rect(54, 28, 106, 84, {120, 78, 52}, 220);
  window(canvas, 57, 31, 103, 81, {.frame = {228, 224, 214}, .columns = 2, .rows = 2}, 253);
  canvas.rect(52, 84, 108, 88, {170, 162, 148}, 230);
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
  };
  const auto found = painters.find(name);
  GREATX_CHECK(found != painters.end(), "no texture called \"{}\"", name);
  return found->second();
}

}  // namespace greatx::scene::generator
