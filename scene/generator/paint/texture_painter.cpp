// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/generator/paint/texture_painter.h"

#include <algorithm>
#include <cmath>

#include "scene/generator/paint/lettering.h"

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

TexturePainter::TexturePainter(int width, int height, const Rgb& color)
    : width_(width), height_(height), colors_(static_cast<size_t>(width * height), color) {}

size_t TexturePainter::index(int x, int y) const {
  if (x < 0 || x >= width_) x = ((x % width_) + width_) % width_;
  if (y < 0 || y >= height_) y = ((y % height_) + height_) % height_;
  return static_cast<size_t>(y * width_ + x);
}

void TexturePainter::rect(int x0, int y0, int x1, int y1, const Rgb& color) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) colors_[index(x, y)] = color;
}

void TexturePainter::rect(int x0, int y0, int x1, int y1, const Rgb& color, int roughness) {
  rect(x0, y0, x1, y1, color);
  if (surface_.empty()) return;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) surface_[index(x, y)] = {0, roughness, 0};
}

void TexturePainter::add(int x, int y, const Rgb& change) {
  Rgb& c = colors_[index(x, y)];
  c = {c.r + change.r, c.g + change.g, c.b + change.b};
}

void TexturePainter::mix(int x, int y, const Rgb& color, int share) {
  Rgb& c = colors_[index(x, y)];
  const auto mixed = [&](int from, int to) { return from + (to - from) * share / 16; };
  c = {mixed(c.r, color.r), mixed(c.g, color.g), mixed(c.b, color.b)};
}

namespace {

/// Writes a text with its middle at (x, y), not wider than `width`.
void write_centered(std::string_view words, int x, int y, int width, int height, int thick,
                    const InkPixel& ink) {
  while (height > 5 && text_width(words, height) > width) --height;
  write_text(words, x - (text_width(words, height) - height / 3) / 2, y - height / 2, height, thick, ink);
}

}  // namespace

void TexturePainter::text(std::string_view words, int x, int y, int width, int height, int thick,
                          const Rgb& color) {
  write_centered(words, x, y, width, height, thick,
                 [&](int px, int py, int share) { mix(px, py, color, share); });
}

void TexturePainter::lit_text(int layer, std::string_view words, int x, int y, int width, int height,
                              int thick, const Rgb& color) {
  write_centered(words, x, y, width, height, thick, [&](int px, int py, int share) {
    if (share > 7) light(layer, px, py, px + 1, py + 1, color);
  });
}

void TexturePainter::shade(int x0, int y0, int x1, int y1, int change) {
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) add(x, y, {change, change, change});
}

void TexturePainter::speckle(int amount, uint32_t seed) {
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int change = (static_cast<int>(hash(x, y, seed) % 5) - 2) * amount / 2;
      add(x, y, {change, change, change});
    }
}

void TexturePainter::blotches(int cell, const Rgb& amount, uint32_t seed) {
  const int columns = width_ / cell, rows = height_ / cell;
  const auto node = [&](int x, int y) {
    return static_cast<int>(hash(x % columns, y % rows, seed) % 257) - 128;
  };
  const auto smooth = [&](int t) { return (3 * cell - 2 * t) * t * t; };  // as a fraction of cell^3
  const int cube = cell * cell * cell;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int cx = x / cell, cy = y / cell, sx = smooth(x % cell), sy = smooth(y % cell);
      const int64_t low = int64_t{node(cx, cy)} * (cube - sx) + int64_t{node(cx + 1, cy)} * sx;
      const int64_t high = int64_t{node(cx, cy + 1)} * (cube - sx) + int64_t{node(cx + 1, cy + 1)} * sx;
      const int64_t value = (low / cube * (cube - sy) + high / cube * sy) / cube;
      const int strength = static_cast<int>(value);
      add(x, y, {strength * amount.r / 128, strength * amount.g / 128, strength * amount.b / 128});
    }
}

void TexturePainter::use_roughness(int roughness) { surface_.assign(colors_.size(), {0, roughness, 0}); }

void TexturePainter::metal_everywhere(int metallic) {
  for (Rgb& s : surface_) s.b = metallic;
}

void TexturePainter::crack(int x, int y, int length, int change, uint32_t seed) {
  for (int i = 0; i < length; ++i) {
    shade(x, y + i, x + 1, y + i + 1, change);
    const uint32_t step = hash(i, length, seed) % 5;
    if (step == 0) --x;
    if (step == 1) ++x;
  }
}

void TexturePainter::light(int layer, int x0, int y0, int x1, int y1, const Rgb& color) {
  std::vector<Rgb>& lit = lit_[static_cast<size_t>(layer)];
  if (lit.empty()) lit.assign(colors_.size(), {});
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) lit[index(x, y)] = color;
}

void TexturePainter::raise(int x0, int y0, int x1, int y1, int height) {
  if (relief_.empty()) relief_.assign(colors_.size(), 0);
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) relief_[index(x, y)] = height;
}

Raster TexturePainter::halved(const std::vector<Rgb>& pixels) const {
  if (pixels.empty()) return {};
  Raster result{static_cast<uint32_t>(width_ / 2), static_cast<uint32_t>(height_ / 2), {}};
  for (int y = 0; y + 1 < height_; y += 2)
    for (int x = 0; x + 1 < width_; x += 2) {
      const Rgb &a = pixels[index(x, y)], &b = pixels[index(x + 1, y)], &c = pixels[index(x, y + 1)],
                &d = pixels[index(x + 1, y + 1)];
      for (const int sum : {a.r + b.r + c.r + d.r, a.g + b.g + c.g + d.g, a.b + b.b + c.b + d.b})
        result.rgb.push_back(static_cast<uint8_t>(std::clamp(sum / 4, 0, 255)));
    }
  return result;
}

Raster TexturePainter::normals() const {
  if (relief_.empty()) return {};
  Raster result{static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), {}};
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const int dx = relief_[index(x + 1, y)] - relief_[index(x - 1, y)];
      const int up = relief_[index(x, y - 1)] - relief_[index(x, y + 1)];
      // The slopes extend over two pixels of 16 units. The square root of an integer is the same on every
      // machine.
      const double length = std::sqrt(static_cast<double>(dx * dx + up * up + 32 * 32));
      for (const int part : {-dx, -up, 32})
        result.rgb.push_back(static_cast<uint8_t>(std::lround(127.5 + 127.5 * part / length)));
    }
  return result;
}

Raster TexturePainter::whole(const std::vector<Rgb>& pixels) const {
  if (pixels.empty()) return {};
  Raster result{static_cast<uint32_t>(width_), static_cast<uint32_t>(height_), {}};
  result.rgb.reserve(3 * pixels.size());
  for (const Rgb& p : pixels)
    for (const int c : {p.r, p.g, p.b}) result.rgb.push_back(static_cast<uint8_t>(std::clamp(c, 0, 255)));
  return result;
}

TextureMaps TexturePainter::maps() const {
  TextureMaps result;
  result.color = whole(colors_);
  result.alpha = alpha_;
  result.metallic_roughness = whole(surface_);
  result.normal = normals();
  for (size_t layer = 0; layer < lit_.size(); ++layer) result.lit[layer] = halved(lit_[layer]);
  return result;
}

}  // namespace greatx::scene::generator
