// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds poles, wires and rails, and lists those that are too thin for the samples of a picture. A pixel's
// centre sees a wire of 0.2 pixels in one pixel of five, so that the picture shows specks that come and go.
// The camera therefore shows the exact share of each pixel that the outline of such a line covers
// (shaders/camera/lines.glsl). Depth and ids stay those of the pixel's centre.
//
// Shading knows nothing of lines. The host lists the pixels under lines, and a second dispatch
// (shaders/camera/shade_lines.glsl) blends the lines into these alone. A view without lines records nothing,
// and its picture has the bytes that it has without the effect.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Returns whether a primitive may hold thin lines: it stands still, has no holes, and is of a pole, a lamp,
/// a mast or street furniture.
bool may_hold_lines(const scene::Scene& scene, uint32_t primitive);

/// Returns whether the pictures of a camera show thin lines by their shares: it smooths edges, its lens does
/// not distort, its rows are exposed at once, and no event camera looks at its pictures from other instants.
bool wants_lines(const CameraEffects& effects, const CameraDesc& desc);

/// Holds the lines that a view sees: the words that shaders/camera/lines.glsl reads (shaders/shared/lines.h
/// has their layout), and the number of pixels under lines. Both are empty if it sees none.
struct LinesInView {
  std::vector<uint32_t> words;
  uint32_t pixels = 0;
};

class ThinLines {
 public:
  /// Finds the slim prisms of the primitives that may hold lines: closed rings of at least three
  /// quadrilaterals of two triangles each, at least six times as long as wide, which is 0.25 m at most. Their
  /// triangles follow each other in the scene, but for the ends.
  explicit ThinLines(const scene::Scene& scene);

  size_t size() const { return prisms_.size(); }
  /// Returns the prisms that are no wider than `line_most_pixels` all along in this view, near ones first.
  LinesInView in_view(const CameraView& view) const;

 private:
  /// Holds an edge along a prism, in local coordinates, and the first triangle of the side between it and the
  /// next one.
  struct Edge {
    dvec3 from, to;
    uint32_t triangle = 0;
  };
  struct Prism {
    uint32_t first_edge = 0, edge_count = 0;
    uint32_t first_triangle = 0, triangle_count = 0;
    dvec3 from{0.0}, to{0.0};  ///< the middles of its ends
    double radius = 0.0;       ///< of its edges around the axis between them, at most
  };
  struct Line;
  struct Axis;
  class Tiles;
  void add_primitive(const scene::Scene& scene, const scene::Primitive& primitive);
  /// Returns whether a prism is a line in this view. Then it describes it.
  bool project(const Prism& prism, const CameraView& view, Line& line) const;
  /// Finds where a line lies in the picture and how wide it is.
  void find_rims(const Prism& prism, const CameraView& view, const Axis& axis, Line& line) const;
  /// Finds the sides that face the eye in the middle of each half of a line, halfway along.
  void find_sides(const Prism& prism, const CameraView& view, const Axis& axis, Line& line) const;

  std::vector<Prism> prisms_;
  std::vector<Edge> edges_;
};

}  // namespace greatx::render
