// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints what stands in streets: signs, bills, bicycles, awnings, grates, fences.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "scene/generator/paint/texture_painter.h"
#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

namespace {

constexpr int sign_px = 64;

/// One sign of the picture, by the number of SignKind. Places are from -31 to 32 about the sign's middle.
class Plate {
 public:
  Plate(TexturePainter& painter, int number)
      : painter_(painter), x0_(number % 4 * sign_px), y0_(number / 4 * sign_px) {}
  /// Paints the places where `is_in(x, y)` holds, on the front or in grey on the back.
  template <typename In>
  void fill(const In& is_in, const Rgb& color, bool back = false) {
    for (int y = -32; y < 32; ++y)
      for (int x = -32; x < 32; ++x)
        if (is_in(x, y)) painter_.cover(x0_ + x + 32, y0_ + y + 32 + (back ? 2 * sign_px : 0), color);
  }
  /// Paints a plate of this outline, front and back.
  template <typename In>
  void plate(const In& is_in, const Rgb& color) {
    fill(is_in, color);
    fill(is_in, {122, 124, 126}, true);
  }

 private:
  TexturePainter& painter_;
  int x0_, y0_;
};

auto disc(int radius) {
  return [radius](int x, int y) { return x * x + y * y < radius * radius; };
}
auto box(int x0, int y0, int x1, int y1) {
  return [=](int x, int y) { return x >= x0 && x < x1 && y >= y0 && y < y1; };
}
/// Returns a triangle that stands on its tip, smaller by `rim`.
auto yield_shape(int rim) {
  return
      [rim](int x, int y) { return y > -26 + rim && 100 * (y + 26) + 176 * std::abs(x) < 5200 - 200 * rim; };
}
auto octagon(int radius) {
  return [radius](int x, int y) {
    return std::max(std::abs(x), std::abs(y)) < radius && 10 * (std::abs(x) + std::abs(y)) < 14 * radius;
  };
}

constexpr Rgb white{232, 232, 228}, blue{28, 72, 150}, red{176, 28, 30}, black{24, 24, 26},
    yellow{226, 180, 40};

}  // namespace

TextureMaps traffic_signs() {
  TexturePainter painter(4 * sign_px, 4 * sign_px, {122, 124, 126});
  painter.cut_all();
  Plate crossing(painter, 0), no_parking(painter, 1), parking(painter, 2), priority(painter, 3),
      yield(painter, 4), stop(painter, 5), speed(painter, 6), one_way(painter, 7);
  crossing.plate(box(-30, -30, 30, 30), blue);
  crossing.fill([](int x, int y) { return y > -24 && y < 24 && std::abs(x) < 12 + (y + 24) / 3; }, white);
  crossing.fill(box(-3, -14, 4, 4), black);
  crossing.fill([](int x, int y) { return y >= 4 && y < 18 && std::abs(std::abs(x) - (y - 2) / 2) < 3; },
                black);
  crossing.fill([](int x, int y) { return x * x + (y + 18) * (y + 18) < 16; }, black);
  no_parking.plate(disc(30), red);
  no_parking.fill(disc(24), blue);
  no_parking.fill([](int x, int y) { return x * x + y * y < 576 && std::abs(x - y) < 6; }, red);
  parking.plate(box(-30, -30, 30, 30), blue);
  parking.fill(box(-12, -20, -5, 22), white);
  parking.fill(
      [](int x, int y) {
        const int r2 = (x + 2) * (x + 2) + (y + 9) * (y + 9);
        return x > -6 && r2 < 144 && r2 > 36;
      },
      white);
  priority.plate([](int x, int y) { return std::abs(x) + std::abs(y) < 31; }, white);
  priority.fill([](int x, int y) { return std::abs(x) + std::abs(y) < 23; }, yellow);
  yield.plate(yield_shape(0), red);
  yield.fill(yield_shape(7), white);
  stop.plate(octagon(30), white);
  stop.fill(octagon(28), red);
  static constexpr std::array<uint32_t, 4> letters{0x79cf, 0x7492, 0x7b6f, 0x7be4};  // S, T, O, P: 3 x 5 bits
  for (size_t letter = 0; letter < letters.size(); ++letter)
    for (int bit = 0; bit < 15; ++bit) {
      const int x = -22 + 12 * static_cast<int>(letter) + 3 * (bit % 3), y = -8 + 3 * (bit / 3);
      if ((letters[letter] >> (14 - bit) & 1u) != 0u) stop.fill(box(x, y, x + 3, y + 3), white);
    }
  speed.plate(disc(30), red);
  speed.fill(disc(23), white);
  for (const int x : {-15, 2}) speed.fill(box(x, -11, x + 13, 12), black);
  for (const int y : {-7, 2}) speed.fill(box(-15, y, -6, y + 5), white);
  speed.fill(box(6, -7, 11, 8), white);
  one_way.plate(box(-31, -13, 31, 13), blue);
  one_way.fill(box(-24, -3, 12, 4), white);
  one_way.fill([](int x, int y) { return x >= 8 && std::abs(y) < 26 - x; }, white);
  return painter.maps();
}

/// Paints two bicycles in side view, each of 1.76 m x 1.06 m.
TextureMaps bicycles() {
  TexturePainter painter(256, 256, {30, 30, 32});
  painter.cut_all();
  for (int which = 0; which < 2; ++which) {
    const int y0 = 128 * which;
    const Rgb frame = which == 0 ? Rgb{40, 88, 120} : Rgb{130, 40, 36};
    const auto line = [&](int xa, int ya, int xb, int yb, int half, const Rgb& color) {
      const int steps = 2 * std::max(std::abs(xb - xa), std::abs(yb - ya));
      for (int i = 0; i <= steps; ++i) {
        const int x = xa + (xb - xa) * i / steps, y = ya + (yb - ya) * i / steps;
        for (int dy = -half; dy <= half; ++dy)
          for (int dx = -half; dx <= half; ++dx)
            if (x + dx >= 0 && x + dx < 256 && y + dy >= 0 && y + dy < 128)
              painter.cover(x + dx, y0 + y + dy, color);
      }
    };
    for (const int hub : {52, 204}) {
      for (int y = -50; y <= 50; ++y)
        for (int x = -50; x <= 50; ++x) {
          const int r2 = x * x + y * y;
          if (r2 < 49 * 49 && r2 > 43 * 43) painter.cover(hub + x, y0 + 78 + y, {26, 26, 28});
          if (r2 <= 43 * 43 && r2 > 41 * 41) painter.cover(hub + x, y0 + 78 + y, {150, 150, 150});
        }
      for (const auto& [dx, dy] : {std::pair{40, 0}, std::pair{28, 28}, std::pair{0, 40}, std::pair{28, -28}})
        line(hub - dx, 78 - dy, hub + dx, 78 + dy, 0, {130, 130, 130});
    }
    line(52, 78, 112, 80, 2, frame);   // chain stay
    line(52, 78, 98, 34, 1, frame);    // seat stay
    line(92, 22, 112, 80, 2, frame);   // seat tube
    line(98, 36, 176, 30, 2, frame);   // top tube
    line(112, 80, 178, 38, 2, frame);  // down tube
    line(172, 12, 204, 78, 2, frame);  // fork
    line(80, 20, 108, 20, 3, {24, 22, 22});
    line(168, 12, 186, 8, 2, {24, 22, 22});
    line(104, 88, 120, 72, 2, {60, 60, 62});
  }
  return painter.maps();
}

/// Paints the bills around a column: 3.6 m x 2.5 m.
TextureMaps column_bills() {
  TexturePainter painter(256, 192, {150, 146, 136});
  static constexpr Rgb papers[] = {
      {196, 60, 48}, {44, 84, 132}, {222, 196, 96}, {60, 110, 78}, {210, 204, 190}};
  static constexpr Rgb inks[] = {{236, 228, 210}, {28, 28, 32}, {240, 214, 120}};
  for (int i = 0; i < 26; ++i) {
    const int x = i % 7 * 38 + static_cast<int>(hash(i, 0, 701) % 7),
              y = i / 7 * 48 + static_cast<int>(hash(i, 1, 701) % 8);
    const int w = 26 + static_cast<int>(hash(i, 2, 701) % 9), h = 36 + static_cast<int>(hash(i, 3, 701) % 8);
    painter.rect(x, y, x + w, y + h, papers[hash(i, 4, 701) % 5]);
    const Rgb ink = inks[hash(i, 5, 701) % 3];
    painter.rect(x + 3, y + 4, x + w - 4, y + 9, ink);
    painter.rect(x + 6, y + 14, x + w - 7, y + 14 + static_cast<int>(hash(i, 6, 701) % 12), ink);
    for (int k = 0; k < 3; ++k)
      painter.rect(x + 4, y + h - 4 * k - 5, x + w - 6 - 3 * k, y + h - 4 * k - 3, ink);
  }
  painter.blotches(64, 10, 702);
  return painter.maps();
}

/// Paints stripes of cloth, 0.3 m wide each.
TextureMaps awning() {
  TexturePainter painter(64, 64, {224, 218, 204});
  for (int x = 0; x < 64; x += 32) painter.rect(x, 0, x + 16, 64, {120, 116, 112});
  painter.blotches(32, 8, 711);
  for (int y = 0; y < 64; ++y) painter.shade(0, y, 64, y + 1, -y / 5);
  return painter.maps();
}

/// Paints 1.5 m x 1.5 m: bars of iron over soil, and a ring around the trunk.
TextureMaps tree_grate() {
  TexturePainter painter(64, 64, {62, 52, 42});
  painter.speckle(10, 721);
  for (int i = 0; i < 64; i += 5) painter.rect(i, 0, i + 2, 64, {70, 70, 72});
  for (const int at : {0, 62}) {
    painter.rect(at, 0, at + 2, 64, {92, 92, 94});
    painter.rect(0, at, 64, at + 2, {92, 92, 94});
  }
  for (int y = -16; y <= 16; ++y)
    for (int x = -16; x <= 16; ++x) {
      const int r2 = x * x + y * y;
      if (r2 < 240)
        painter.rect(32 + x, 32 + y, 33 + x, 33 + y, r2 > 190 ? Rgb{92, 92, 94} : Rgb{66, 54, 42});
    }
  return painter.maps();
}

TextureMaps plinth() {
  TexturePainter painter(256, 128, {150, 146, 138});
  painter.blotches(64, 10, 731);
  painter.blotches(16, 5, 732);
  // A wall's foot is at v = 0 (a whole number of tiles), so that dirt lies at the picture's lower edge.
  for (int x = 0; x < 256; ++x) {
    const int high =
        24 + static_cast<int>(hash(x / 9, 0, 733) % 22) + static_cast<int>(hash(x / 2, 1, 733) % 7);
    for (int k = 0; k < high; ++k) painter.shade(x, 127 - k, x + 1, 128 - k, -44 * (high - k) / high);
  }
  for (int x = 0; x < 256; x += 64) painter.shade(x, 0, x + 1, 128, -26);
  return painter.maps();
}

/// Paints wires of a fence, 28 cm x 31 cm, with holes between them.
TextureMaps mesh_fence() {
  TexturePainter painter(32, 32, {150, 152, 154});
  painter.cut_all();
  for (int i = 0; i < 32; ++i)
    for (const int at : {0, 1, 8, 9, 16, 17, 24, 25}) {
      const int tone = 132 + static_cast<int>(hash(i, at, 741) % 36);
      painter.cover(at, i, {tone, tone + 2, tone + 4});
      if (at < 2) painter.cover(i, at, {tone, tone + 2, tone + 4});
    }
  return painter.maps();
}

}  // namespace greatx::scene::generator
