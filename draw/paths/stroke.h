// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws anti-aliased lines and markers on a canvas.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "draw/canvas/canvas.h"
#include "draw/paths/view.h"

namespace greatx::apps {

/// Holds the fraction of each pixel that a shape covers. All parts that are added before paint() form one
/// shape. The shape is not denser where its parts overlap, so that a polyline has no visible joints.
class ShapeCoverage {
 public:
  ShapeCoverage(int width, int height);

  /// Adds a line with round ends; `width` in pixels.
  void line(const dvec2& a, const dvec2& b, double width);
  /// Adds the inside of a shape within the box low..high. `distance` returns the signed distance to the shape
  /// in pixels, negative inside.
  void shape(const dvec2& low, const dvec2& high, const std::function<double(const dvec2&)>& distance);
  /// Blends the colour into the canvas and clears the shape. `offset` is the position of pixel (0, 0) on the
  /// canvas.
  void paint(io::Canvas& canvas, const ivec2& offset, io::Color color, double opacity);

 private:
  int width_, height_;
  std::vector<float> share_;       ///< [height, width] covered fraction of each pixel
  std::vector<uint32_t> touched_;  ///< indices of the pixels whose share is not 0
};

/// Returns the signed distance in pixels from a point to the outline of the marker of an interaction: a disc
/// for reflection, a square on its corner for transmission, a triangle for diffraction, a star for
/// scattering. `offset` is the point relative to the marker's centre, and `radius` the marker's size in
/// pixels.
double marker_distance(rf::InteractionType type, const dvec2& offset, double radius);

/// Describes a straight part of a path in the picture, in pixels. It is either completely visible or
/// completely hidden.
struct Stretch {
  dvec2 a{0.0}, b{0.0};
  bool hidden = false;
};
/// Returns the segment from a to b (local coordinates) as the picture shows it. Parts behind the camera or
/// outside the picture are cut off. The rest is split where it passes behind a surface. With lens distortion
/// it is also split into short chords. `depth` [height, width] is the planar depth of the view.
std::vector<Stretch> stretches_of(const PictureView& view, std::span<const float> depth, const dvec3& a,
                                  const dvec3& b);

}  // namespace greatx::apps
