// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Anti-aliased lines and markers on a canvas.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/paths/view.h"

namespace greatx::apps {

/// How much of each pixel something covers. What is drawn before paint() is one shape: where its parts
/// overlap it is not denser, so a bent line has no knots.
class ShapeCoverage {
 public:
  ShapeCoverage(int width, int height);

  /// A line with round ends.
  void line(const dvec2& a, const dvec2& b, double width);
  /// The inside of any shape: `distance` in pixels, negative inside, within the box.
  void shape(const dvec2& low, const dvec2& high, const std::function<double(const dvec2&)>& distance);
  /// Blends the colour in and forgets the shape. `offset`: where the picture's (0, 0) is on the canvas.
  void paint(io::Canvas& canvas, const ivec2& offset, io::Color color, double opacity);

 private:
  int width_, height_;
  std::vector<float> share_;       ///< [height, width]
  std::vector<uint32_t> touched_;  ///< pixels that are not zero
};

/// A marker's outline: signed distance in pixels from a point to the shape of an interaction (disc:
/// reflection, square on its corner: transmission, triangle: diffraction, star: scattering), `radius` its
/// size.
double marker_distance(rf::InteractionType type, const dvec2& offset, double radius);

/// A part of a stretch that is in sight, or behind something, all along; pixels.
struct Stretch {
  dvec2 a{0.0}, b{0.0};
  bool hidden = false;
};
/// A stretch from a to b (local coordinates) as the picture shows it: what is behind the camera or outside is
/// cut off, the rest is split where it goes behind a surface, and behind a lens that distorts into chords.
/// `depth` [height, width] of the view.
std::vector<Stretch> stretches_of(const PictureView& view, std::span<const float> depth, const dvec3& a,
                                  const dvec3& b);

}  // namespace greatx::apps
