// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/paint/textures.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>

#include "core/error.h"
#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

TextureMaps concrete() {
  TexturePainter painter(128, 128, {160, 157, 150});
  painter.blotches(32, 8, 31);
  painter.speckle(4, 32);
  painter.shade(0, 0, 1, 128, -22);
  painter.shade(0, 0, 128, 1, -22);
  return painter.maps();
}

TextureMaps bark() {
  TexturePainter painter(64, 64, {104, 84, 64});
  for (int x = 0; x < 64; ++x)
    painter.shade(x, 0, x + 1, 64, static_cast<int>(hash(x / 3, 0, 71) % 5) * 9 - 18);
  painter.speckle(8, 72);
  return painter.maps();
}

/// Paints 2 m x 2 m of granite: kerb stones of 1 m.
TextureMaps kerb() {
  TexturePainter painter(128, 128, {182, 180, 174});
  painter.blotches(64, 9, 731);
  painter.blotches(16, 7, 732);
  painter.speckle(12, 733);
  for (int i = 0; i < 128; i += 64) {
    painter.shade(i, 0, i + 2, 128, -46);
    painter.shade(0, i, 128, i + 2, -46);
  }
  return painter.maps();
}

/// Paints 1.6 m x 1.6 m of the bark of a plane tree: long flakes of four tones with uneven rims.
TextureMaps bark_plane() {
  constexpr int size = 128, cell = 16;
  TexturePainter painter(size, size, {0, 0, 0});
  static constexpr std::array<Rgb, 4> tones{
      {{126, 118, 96}, {154, 146, 120}, {170, 162, 136}, {138, 130, 106}}};
  // Each flake is the surroundings of a point of a shaken grid. Rims wander by two pixels.
  const auto point = [](int column, int row, int axis) {
    const int wrapped = hash((column + 8) % 8, (row + 8) % 8, 75 + static_cast<uint32_t>(axis)) % cell;
    return cell * (axis == 0 ? column : row) + wrapped;
  };
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const int px = x + static_cast<int>(hash(x / 4, y / 4, 77) % 5) - 2,
                py = y + static_cast<int>(hash(x / 4, y / 4, 78) % 5) - 2;
      int nearest = 1 << 30, second = 1 << 30;
      uint32_t flake = 0;
      for (int row = y / cell - 2; row <= y / cell + 2; ++row)
        for (int column = x / cell - 1; column <= x / cell + 1; ++column) {
          const int dx = point(column, row, 0) - px, dy = point(column, row, 1) - py;
          const int far = 3 * dx * dx + dy * dy;
          if (far < nearest) {
            second = nearest;
            nearest = far;
            flake = hash((column + 8) % 8, (row + 8) % 8, 79);
          } else {
            second = std::min(second, far);
          }
        }
      Rgb color = tones[flake % tones.size()];
      const int rim = second - nearest < 24 ? -18 : 0;
      color = {color.r + rim, color.g + rim, color.b + rim};
      painter.rect(x, y, x + 1, y + 1, color);
    }
  painter.blotches(32, 7, 74);
  painter.speckle(7, 76);
  return painter.maps();
}

/// Paints the bark of a birch: white with short dark bands across.
TextureMaps bark_birch() {
  TexturePainter painter(64, 64, {206, 204, 196});
  painter.blotches(16, 9, 77);
  for (int i = 0; i < 40; ++i) {
    const int x = static_cast<int>(hash(i, 0, 78) % 64), y = static_cast<int>(hash(i, 1, 78) % 64);
    const int w = 4 + static_cast<int>(hash(i, 2, 78) % 14);
    painter.shade(x, y, x + w, y + 1 + static_cast<int>(hash(i, 3, 78) % 3), -90);
  }
  return painter.maps();
}

/// Paints 18 m x 18 m of a flat roof: sheets of bitumen or gravel, dried puddles, moss.
TextureMaps roof() {
  TexturePainter painter(256, 256, {140, 136, 130});
  painter.blotches(128, 10, 81);
  painter.blotches(32, 9, 82);
  painter.blotches(8, 5, 83);
  for (int i = 0; i < 256; i += 32) {
    painter.shade(i, 0, i + 1, 256, -14);
    painter.shade(i + 1, 0, i + 2, 256, 6);
  }
  for (int i = 0; i < 6; ++i) {
    const int x = static_cast<int>(hash(i, 0, 84) % 256), y = static_cast<int>(hash(i, 1, 84) % 256);
    const int r = 8 + static_cast<int>(hash(i, 2, 84) % 18);
    for (int dy = -r; dy <= r; ++dy)
      for (int dx = -r; dx <= r; ++dx)
        if (dx * dx + 2 * dy * dy < r * r) painter.add(x + dx, y + dy, {-16, -14, -13});
  }
  painter.speckle(12, 85);
  return painter.maps();
}

/// Paints 3.2 m x 3.2 m of slates in courses of 0.2 m.
TextureMaps slate() {
  TexturePainter painter(128, 128, {92, 98, 108});
  for (int row = 0; row < 16; ++row)
    for (int i = 0; i < 16; ++i) {
      const int x = 8 * i + (row % 2) * 4, y = 8 * row;
      painter.shade(x, y, x + 8, y + 8, static_cast<int>(hash(i, row, 86) % 6) * 5 - 13);
      painter.shade(x, y, x + 1, y + 8, -18);
      painter.shade(x, y + 7, x + 8, y + 8, -24);
    }
  painter.blotches(64, 6, 87);
  return painter.maps();
}

/// Paints a photovoltaic module of 1.6 m x 1.0 m.
TextureMaps solar() {
  TexturePainter painter(64, 64, {26, 34, 58});
  for (int i = 0; i < 64; i += 8) {
    painter.shade(i, 0, i + 1, 64, 20);
    painter.shade(0, i, 64, i + 1, 14);
  }
  painter.rect(0, 0, 64, 2, {150, 154, 158});
  painter.rect(0, 0, 2, 64, {150, 154, 158});
  return painter.maps();
}

TextureMaps corrugated() {
  TexturePainter painter(64, 64, {210, 212, 214});
  for (int x = 0; x < 64; ++x) {
    const int phase = x % 16;
    painter.shade(x, 0, x + 1, 64, phase < 8 ? 4 * phase - 16 : 4 * (15 - phase) - 16);
  }
  painter.blotches(32, 6, 91);
  painter.shade(0, 0, 64, 1, -30);
  return painter.maps();
}

TextureMaps boards() {
  TexturePainter painter(128, 128, {200, 196, 190});
  for (int board = 0; board < 8; ++board) {
    painter.shade(16 * board, 0, 16 * board + 16, 128, static_cast<int>(hash(board, 0, 101) % 5) * 10 - 20);
    painter.shade(16 * board, 0, 16 * board + 1, 128, -85);
  }
  for (int x = 0; x < 128; ++x)
    painter.shade(x, 0, x + 1, 128, static_cast<int>(hash(x, 1, 102) % 3) * 6 - 6);
  painter.speckle(7, 103);
  return painter.maps();
}

/// Paints 2.4 m x 2.4 m of clay tiles: eight courses that overlap, staggered. Each tile bulges across. Its
/// lower edge lies on the next tile, the thickness of a tile higher.
TextureMaps roof_tiles() {
  TexturePainter painter(128, 128, {150, 82, 58});
  for (int row = 0; row < 8; ++row)
    for (int tile = 0; tile < 16; ++tile) {
      const int x = 8 * tile + (row % 2) * 4, y = 16 * row;
      painter.shade(x, y, x + 8, y + 16, static_cast<int>(hash(tile, row, 111) % 7) * 6 - 18);
      painter.shade(x, y, x + 1, y + 16, -34);
      painter.shade(x, y + 13, x + 8, y + 16, -30);
      painter.shade(x, y, x + 8, y + 3, 10);
      for (int down = 0; down < 16; ++down)
        for (int k = 0; k < 8; ++k) {
          const int bulge = 9 * std::min(k, 7 - k);
          painter.raise(x + k, y + down, x + k + 1, y + down + 1, bulge + down);
        }
    }
  painter.blotches(64, 9, 113);
  painter.blotches(16, 7, 114);  // lichen
  painter.speckle(6, 112);
  return painter.maps();
}

/// Paints 2.56 m x 2.56 m of stretchers of 0.16 m by 0.08 m.
TextureMaps brick() {
  TexturePainter painter(128, 128, {164, 154, 142});
  for (int row = 0; row < 32; ++row)
    for (int i = 0; i < 16; ++i) {
      const int shade = static_cast<int>(hash(i, row, 121) % 6) * 7 - 18, x = 8 * i + (row % 2) * 4;
      painter.rect(x, 4 * row, x + 7, 4 * row + 3, {146 + shade, 82 + shade, 64 + shade});
    }
  painter.blotches(64, 8, 122);
  return painter.maps();
}

/// Paints 1.2 m x 1.3 m of a cabinet's front: two doors that meet at u = 0, louvres, locks, a sticker, a
/// scrawl that somebody has half wiped off, and dirt that splashed up from v = 0.
TextureMaps cabinet() {
  TexturePainter painter(128, 128, {186, 190, 186});
  painter.blotches(64, 7, 791);
  painter.blotches(16, 4, 792);
  for (const int left : {6, 70}) {
    for (int slat = 0; slat < 5; ++slat) {
      painter.shade(left + 12, 16 + 6 * slat, left + 40, 18 + 6 * slat, -58);
      painter.shade(left + 12, 18 + 6 * slat, left + 40, 19 + 6 * slat, 22);
    }
  }
  painter.rect(76, 66, 92, 76, {214, 196, 60});
  painter.text("8", 84, 71, 12, 6, 2, {40, 40, 38});
  painter.rect(4, 66, 7, 74, {64, 66, 68});
  // A scrawl: two waves of spray paint.
  for (int i = 0; i < 88; ++i) {
    const int wave = std::abs(i % 22 - 11);
    for (const int line : {0, 1})
      for (int dy = 0; dy < 3; ++dy)
        painter.mix(22 + i, 84 + (line == 0 ? wave : 13 - wave / 2) + dy,
                    line == 0 ? Rgb{52, 60, 96} : Rgb{120, 56, 66}, 9 - i / 16);
  }
  painter.shade(0, 2, 1, 128, -74);  // the joint of the doors
  painter.shade(1, 2, 2, 128, 18);
  painter.shade(63, 2, 65, 128, -26);
  for (int x = 0; x < 128; ++x) {
    const int high = 10 + static_cast<int>(hash(x / 5, 0, 793) % 13);
    for (int k = 0; k < high; ++k) painter.shade(x, 127 - k, x + 1, 128 - k, -58 * (high - k) / high);
    if (hash(x, 1, 794) % 9 == 0)  // rust and rain from the lid
      painter.shade(x, 2, x + 1, 10 + static_cast<int>(hash(x, 2, 795) % 40), -10);
  }
  return painter.maps();
}

}  // namespace

TextureMaps make_texture(const std::string& name) {
  static const std::map<std::string, TextureMaps (*)()> painters = {
      {"asphalt", asphalt},
      {"pavement", pavement},
      {"road_paint", road_paint},
      {"concrete", concrete},
      {"kerb", kerb},
      {"grass", grass},
      {"crop", crop},
      {"leaves", leaves},
      {"leaf_sprays", leaf_sprays},
      {"leaves_pale", leaves_pale},
      {"leaf_sprays_pale", leaf_sprays_pale},
      {"twigs", twigs},
      {"twig_sprays", twig_sprays},
      {"fallen_leaves", fallen_leaves},
      {"needle_sprays", needle_sprays},
      {"grass_tufts", grass_tufts},
      {"solar", solar},
      {"slate", slate},
      {"country_road", country_road},
      {"pasture", pasture},
      {"bark", bark},
      {"bark_plane", bark_plane},
      {"bark_birch", bark_birch},
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
      {"car_side", car_side},
      {"face", face},
      {"wheel_alloy", wheel_alloy},
      {"wheel_steel", wheel_steel},
      {"traffic_signs", traffic_signs},
      {"bicycles", bicycles},
      {"column_bills", column_bills},
      {"awning", awning},
      {"tree_grate", tree_grate},
      {"mesh_fence", mesh_fence},
      {"plinth", plinth},
      {"cabinet", cabinet},
  };
  const auto found = painters.find(name);
  GREATX_CHECK(found != painters.end(), "no texture called \"{}\"", name);
  return found->second();
}

}  // namespace greatx::scene::generator
