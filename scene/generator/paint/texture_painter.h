// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints the texture maps of a surface, which repeat in both directions. The arithmetic is in integers, so
// that the maps are the same on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string_view>

#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

struct Rgb {
  int r = 0, g = 0, b = 0;
};

/// Returns 32 well-mixed bits of (x, y, seed).
uint32_t hash(int x, int y, uint32_t seed);

/// Paints into the maps of one surface. Every coordinate wraps around. Rectangles are half-open: [x0, x1) x
/// [y0, y1).
class TexturePainter {
 public:
  TexturePainter(int width, int height, const Rgb& color);

  int width() const { return width_; }
  int height() const { return height_; }
  void fill(const Rgb& color) { rect(0, 0, width_, height_, color); }
  void rect(int x0, int y0, int x1, int y1, const Rgb& color);
  /// Paints a rectangle that has its own roughness (0...255) and is not metallic.
  void rect(int x0, int y0, int x1, int y1, const Rgb& color, int roughness);
  void add(int x, int y, const Rgb& change);
  /// Mixes a share (0 to 16, of 16) of a colour into a pixel.
  void mix(int x, int y, const Rgb& color, int share);
  /// Writes capitals and digits (lettering.h) that are `height` pixels high, with the middle of the text at
  /// (x, y), at most `width` pixels wide: a longer text becomes smaller.
  void text(std::string_view words, int x, int y, int width, int height, int thick, const Rgb& color);
  /// Writes the same text as light into the map `layer` (see light).
  void lit_text(int layer, std::string_view words, int x, int y, int width, int height, int thick,
                const Rgb& color);
  /// Makes a rectangle lighter or darker by `change`.
  void shade(int x0, int y0, int x1, int y1, int change);
  /// Adds noise to each pixel: five levels within +-amount.
  void speckle(int amount, uint32_t seed);
  /// Adds smooth noise: values within +-amount on a lattice of `cell` pixels. `cell` divides width and
  /// height.
  void blotches(int cell, int amount, uint32_t seed) { blotches(cell, {amount, amount, amount}, seed); }
  /// As above, with another amount for each channel, so that the tint varies, too.
  void blotches(int cell, const Rgb& amount, uint32_t seed);
  /// Draws a crack: a wandering line of `length` pixels, mostly along y, darker by `change`.
  void crack(int x, int y, int length, int change, uint32_t seed);
  /// Starts a metallic-roughness map.
  void use_roughness(int roughness);
  void metal_everywhere(int metallic);
  /// Paints light that is visible by night into the map `layer` of lit_pictures. Starts that map, dark, if it
  /// does not exist.
  void light(int layer, int x0, int y0, int x1, int y1, const Rgb& color);
  /// Sets the height over the plane, in pixels/16. Starts a normal map if there is none.
  void raise(int x0, int y0, int x1, int y1, int height);
  /// Starts an alpha map that is a hole everywhere.
  void cut_all() { alpha_.assign(colors_.size(), 0); }
  /// Paints a pixel that is no hole.
  void cover(int x, int y, const Rgb& color) {
    colors_[index(x, y)] = color;
    alpha_[index(x, y)] = 255;
  }
  /// Returns the maps. The lit maps have half the resolution, which makes no visible difference. The
  /// roughness map is as large as the colour map, so that a renderer may look both up at once.
  TextureMaps maps() const;

 private:
  size_t index(int x, int y) const;
  Raster whole(const std::vector<Rgb>& pixels) const;
  Raster halved(const std::vector<Rgb>& pixels) const;
  Raster normals() const;

  int width_, height_;
  std::vector<Rgb> colors_;
  std::vector<Rgb> surface_;  ///< (unused, roughness, metallic); empty: not wanted
  std::array<std::vector<Rgb>, lit_pictures> lit_;
  std::vector<int> relief_;
  std::vector<uint8_t> alpha_;
};

}  // namespace greatx::scene::generator
