// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws the shapes of overlays over the main view's picture. A line is solid where the scene does not hide it
// and faint where it does.
#pragma once

#include <cstdint>
#include <imgui.h>
#include <optional>
#include <span>

#include "draw/paths/view.h"
#include "view/overlay/shapes.h"

namespace greatx::view {

/// Says where a picture lies in the window and what it shows.
struct OverlayFrame {
  apps::PictureView view;           ///< of the picture
  std::span<const float> depth;     ///< [height, width] of the picture; empty: nothing hides anything
  dvec3 origin{0.0};                ///< of the scene: local = world - origin
  ImVec2 corner{0, 0}, size{0, 0};  ///< of the picture in the window, pixels

  /// Returns the place in the window of a point of the world, and its depth; behind the camera it is
  /// negative.
  dvec3 place(const dvec3& world) const;
  double scale() const { return size.x / static_cast<double>(view.width); }
};

/// The shape nearest to the cursor.
struct OverlayHit {
  uint32_t row = ~0u;        ///< into Shapes::rows
  double distance_px = 0.0;  ///< from the cursor
};

/// Draws `shapes`. Those of the row whose id is `highlighted` (0: none) are drawn wide. Returns the row under
/// `cursor`, within a few pixels.
std::optional<OverlayHit> draw_shapes(ImDrawList& list, const Shapes& shapes, const OverlayFrame& frame,
                                      const std::optional<ImVec2>& cursor, uint64_t highlighted);

/// Returns the distance of `p` from the line between `a` and `b`, pixels.
double distance_to_line(const ImVec2& p, const ImVec2& a, const ImVec2& b);

/// Draws the legend into the corner at `corner`, with one line of text for each entry.
void draw_legend(ImDrawList& list, const Shapes& shapes, const ImVec2& corner);

}  // namespace greatx::view
