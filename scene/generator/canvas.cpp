// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/canvas.h"

#include <algorithm>

namespace greatx::scene::generator {

uint32_t hash(int x, int y, uint32_t seed) {
  uint32_t h =
      static_cast<uint32_t>(x) * 0x85EBCA6Bu ^ static_cast<uint32_t>(y) * 0xC2B2AE35u ^ seed * 0x27D4EB2Fu;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  return h ^ (h >> 15);
}

Canvas::Canvas(int width, int height, const Rgb& color)
    : width_(width), height_(height), colors_(static_cast<size_t>(width * height), color) {}

size_t Canvas::index(int x, int y) const {
  if (x < 0 || x >= width_) x = ((x % width_) + width_) % width_;
  if (y < 0 || y >= height_) y = ((y % height_) + height_) % height_;
  return static_cast<size_t>(y * width_ + x);
}

void Canvas::rect(int x0, int y0, int x1, int y1, const Rgb& color) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) colors_[index(x, y)] = color;
}

void Canvas::rect(int x0, int y0, int x1, int y1, const Rgb& color, int roughness) {
  rect(x0, y0, x1, y1, color);
  if (surface_.empty()) return;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) surface_[index(x, y)] = {0, roughness, 0};
}

void Canvas::add(int x, int y, const Rgb& change) {
  Rgb& c = colors_[index(x, y)];
  c = {c.r + change.r, c.g + change.g, c.b + change.b};
}

void Canvas::shade(int x0, int y0, int x1, int y1, int change) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) add(x, y, {change, change, change});
}

void Canvas::speckle(int amount, uint32_t seed) {
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int change = (static_cast<int>(hash(x, y, seed) % 5) - 2) * amount / 2;
      add(x, y, {change, change, change});
    }
}

void Canvas::blotches(int cell, int amount, uint32_t seed) {
  const int columns = width_ / cell, rows = height_ / cell;
  const auto node = [&](int x, int y) {
    return static_cast<int>(hash(x % columns, y % rows, seed) % 257) - 128;
  };
  const auto smooth = [&](int t) { return (3 * cell - 2 * t) * t * t; };  // of cell^3
  const int cube = cell * cell * cell;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int cx = x / cell, cy = y / cell, sx = smooth(x % cell), sy = smooth(y % cell);
      const int64_t low = int64_t{node(cx, cy)} * (cube - sx) + int64_t{node(cx + 1, cy)} * sx;
      const int64_t high = int64_t{node(cx, cy + 1)} * (cube - sx) + int64_t{node(cx + 1, cy + 1)} * sx;
      const int64_t value = (low / cube * (cube - sy) + high / cube * sy) / cube;
      const int change = static_cast<int>(value) * amount / 128;
      add(x, y, {change, change, change});
    }
}

void Canvas::use_roughness(int roughness) { surface_.assign(colors_.size(), {0, roughness, 0}); }

void Canvas::metal_everywhere(int metallic) {
  for (Rgb& s : surface_) s.b = metallic;
}

Picture Canvas::picture() const {
  Picture result{static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), {}, {}};
  const auto flatten = [](const std::vector<Rgb>& pixels) {
    std::vector<uint8_t> bytes;
    bytes.reserve(3 * pixels.size());
    for (const Rgb& p : pixels)
      for (const int c : {p.r, p.g, p.b}) bytes.push_back(static_cast<uint8_t>(std::clamp(c, 0, 255)));
    return bytes;
  };
  result.rgb = flatten(colors_);
  if (!surface_.empty()) result.metallic_roughness = flatten(surface_);
  return result;
}

}  // namespace greatx::scene::generator
