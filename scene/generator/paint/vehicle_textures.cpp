// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints wheels, and the faces of people.
#include <array>

#include "scene/generator/paint/texture_painter.h"

namespace greatx::scene::generator {

namespace {

constexpr int wheel_px = 128;

/// Paints a disc of the given radius in half pixels about the middle.
template <typename Color>
void paint_disc(TexturePainter& painter, int radius, const Color& color) {
  for (int y = 0; y < wheel_px; ++y)
    for (int x = 0; x < wheel_px; ++x) {
      const int u = 2 * x - wheel_px + 1, v = 2 * y - wheel_px + 1;
      if (u * u + v * v <= radius * radius) painter.rect(x, y, x + 1, y + 1, color(u, v));
    }
}

void paint_tyre(TexturePainter& painter) {
  paint_disc(painter, 118, [](int, int) { return Rgb{44, 44, 46}; });
  paint_disc(painter, 90, [](int, int) { return Rgb{24, 24, 25}; });
}

}  // namespace

TextureMaps wheel_alloy() {
  TexturePainter painter(wheel_px, wheel_px, {30, 30, 31});
  painter.speckle(3, 301);
  paint_tyre(painter);
  paint_disc(painter, 86, [](int, int) { return Rgb{176, 178, 182}; });
  paint_disc(painter, 78, [](int, int) { return Rgb{34, 34, 36}; });
  // five pairs of spokes: directions by 72 degrees, times 1000
  constexpr std::array<std::array<int, 2>, 5> directions{
      {{0, 1000}, {951, 309}, {588, -809}, {-588, -809}, {-951, 309}}};
  paint_disc(painter, 82, [&](int u, int v) {
    for (const auto& d : directions) {
      const int along = (u * d[0] + v * d[1]) / 1000, across = (u * d[1] - v * d[0]) / 1000;
      const int offset = 4 + along / 8;
      const int off_axis = (across < 0 ? -across : across) - offset;
      if (along > 0 && off_axis > -5 && off_axis < 5)
        return off_axis > 2 ? Rgb{138, 140, 145} : Rgb{192, 194, 198};
    }
    return u * u + v * v > 78 * 78 ? Rgb{176, 178, 182} : Rgb{38, 38, 40};
  });
  paint_disc(painter, 20, [](int, int) { return Rgb{170, 172, 176}; });
  paint_disc(painter, 11, [](int, int) { return Rgb{60, 62, 66}; });
  return painter.maps();
}

TextureMaps wheel_steel() {
  TexturePainter painter(wheel_px, wheel_px, {30, 30, 31});
  painter.speckle(3, 311);
  paint_tyre(painter);
  paint_disc(painter, 84, [](int, int) { return Rgb{126, 128, 130}; });
  paint_disc(painter, 74, [](int, int) { return Rgb{158, 160, 162}; });
  // ten holes on a circle
  constexpr std::array<std::array<int, 2>, 10> holes{{{0, 58},
                                                      {34, 47},
                                                      {55, 18},
                                                      {55, -18},
                                                      {34, -47},
                                                      {0, -58},
                                                      {-34, -47},
                                                      {-55, -18},
                                                      {-55, 18},
                                                      {-34, 47}}};
  paint_disc(painter, 74, [&](int u, int v) {
    for (const auto& hole : holes) {
      const int a = u - hole[0], b = v - hole[1];
      if (a * a + b * b < 11 * 11) return Rgb{40, 40, 42};
    }
    return v < 0 ? Rgb{164, 166, 168} : Rgb{150, 152, 154};
  });
  paint_disc(painter, 36, [](int, int) { return Rgb{112, 114, 116}; });
  paint_disc(painter, 24, [](int, int) { return Rgb{142, 144, 146}; });
  return painter.maps();
}

TextureMaps car_side() {
  TexturePainter painter(512, 256, {255, 255, 255});
  for (const int top : {0, 128}) {
    const bool four = top == 0;
    const int belt = top + 3, sill = top + 121;
    // dust from the road
    for (int i = 0; i < 5; ++i) painter.shade(8, sill - 30 + 8 * i, 504, sill + 4, -3 - i);
    const auto joint = [&](int x, int y0, int y1) {
      painter.shade(x, y0, x + 1, y1, -150);
      painter.shade(x + 1, y0, x + 2, y1, -40);
    };
    const auto handle = [&](int x) {
      painter.shade(x, belt + 22, x + 15, belt + 27, -60);
      painter.shade(x, belt + 21, x + 15, belt + 23, 20);
      painter.shade(x, belt + 27, x + 15, belt + 28, -120);
    };
    const int rear = four ? 358 : 340;
    joint(153, belt, sill - 6);
    if (four) joint(256, belt, sill - 6);
    // the rear edge bends forward around the wheel
    joint(rear, belt, belt + 62);
    for (int i = 0; i < 48; ++i) {
      const int x = rear - i * i / (four ? 60 : 100);
      painter.shade(x, belt + 62 + i, x + 1, belt + 63 + i, -150);
    }
    const int end = rear - 47 * 47 / (four ? 60 : 100);
    painter.shade(153, sill - 8, end, sill - 7, -120);
    handle(four ? 234 : rear - 24);
    if (four) handle(rear - 22);
    // the flap of the tank
    for (const int edge : {0, 15}) {
      painter.shade(424 + edge, belt + 26, 425 + edge, belt + 42, -110);
      painter.shade(424, belt + 26 + edge, 440, belt + 27 + edge, -110);
    }
  }
  return painter.maps();
}

TextureMaps face() {
  TexturePainter painter(64, 64, {252, 250, 248});
  painter.blotches(16, 3, 321);
  for (const int side : {-1, 1}) {
    const int eye = 32 + 11 * side;
    painter.shade(eye - 7, 17, eye + 7, 29, -22);           // the hollow of the eye
    painter.rect(eye - 6, 16, eye + 6, 19, {112, 84, 70});  // brow
    painter.rect(eye - 5, 22, eye + 5, 26, {236, 234, 230});
    painter.rect(eye - 2, 21, eye + 2, 26, {46, 36, 30});
    painter.rect(eye - 5, 21, eye + 5, 22, {96, 74, 62});              // lid
    painter.shade(32 + 4 * side - 2, 26, 32 + 4 * side + 2, 38, -14);  // beside the nose
    painter.shade(32 + 16 * side - 5, 32, 32 + 16 * side + 5, 42, -6);
  }
  painter.shade(27, 38, 37, 41, -40);
  painter.rect(24, 48, 40, 50, {150, 88, 80});
  painter.rect(26, 50, 38, 53, {206, 142, 132});
  painter.shade(25, 54, 39, 56, -16);
  return painter.maps();
}

}  // namespace greatx::scene::generator
