// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paints the texture maps of a surface, which repeat in both directions. All of it is in integers, so that
// the maps are the same on every machine.
#pragma once

#include <array>
#include <cstdint>

#include "scene/generator/paint/textures.h"

namespace greatx::scene::generator {

struct Rgb {
  int r = 0, g = 0, b = 0;
};

/// 32 well-mixed bits of (x, y, seed).
uint32_t hash(int x, int y, uint32_t seed);

/// Every coordinate wraps around; rectangles are half-open, [x0, x1) x [y0, y1).
class TexturePainter {
 public:
  TexturePainter(int width, int height, const Rgb& color);

  int width() const { return width_; }
  int height() const { return height_; }
  void fill(const Rgb& color) { rect(0, 0, width_, height_, color); }
  void rect(int x0, int y0, int x1, int y1, const Rgb& color);
  /// The same with a roughness (0...255) of its own, not metallic.
  void rect(int x0, int y0, int x1, int y1, const Rgb& color, int roughness);
  void add(int x, int y, const Rgb& change);
  /// Lighter or darker by `change`.
  void shade(int x0, int y0, int x1, int y1, int change);
  /// Noise per pixel: five levels within +-amount.
  void speckle(int amount, uint32_t seed);
  /// Smooth noise: values within +-amount on a lattice of `cell` pixels (which divides width and height).
  void blotches(int cell, int amount, uint32_t seed);
  /// A wandering line of `length` pixels, mostly along y, darker by `change`: a crack.
  void crack(int x, int y, int length, int change, uint32_t seed);
  /// Starts a metallic-roughness picture.
  void use_roughness(int roughness);
  void metal_everywhere(int metallic);
  /// Light that comes out by night, picture `layer` of lit_pictures; starts that picture, dark.
  void light(int layer, int x0, int y0, int x1, int y1, const Rgb& color);
  /// Height over the plane, in pixels/16; starts a normal picture.
  void raise(int x0, int y0, int x1, int y1, int height);
  /// What is lit at half the resolution: nobody sees the difference. Roughness as large as the colour: a
  /// renderer may then look both up at once.
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
};

}  // namespace greatx::scene::generator
