// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/pane_groups.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "shaders/shared/camera.h"

namespace greatx::render {

namespace {

/// Panes of more triangles count as their boxes, so that large ones cost little here.
constexpr uint32_t most_triangles = 512;
/// The rasterizer rounds, and samples lie beside the centres of pixels.
constexpr double margin_px = 1.0;

/// Marks the groups that are touched.
class Marks {
 public:
  explicit Marks(const CameraView& view)
      : view_(&view),
        columns_((view.pinhole.width + shared::shade_group_width - 1) / shared::shade_group_width),
        rows_((view.pinhole.height + shared::shade_group_height - 1) / shared::shade_group_height),
        marked_(size_t{columns_} * rows_, 0) {}

  /// Marks the rectangle around the points, which are in local axes, from the eye. What comes nearer than the
  /// nearest visible depth may be anywhere in the view.
  void mark(std::span<const dvec3> points) {
    const PinholeView& p = view_->pinhole;
    dvec2 low(std::max(p.width, p.height)), high(0.0);
    for (const dvec3& point : points) {
      const double depth = glm::dot(view_->forward, point);
      if (depth < double(view_->constants.near_m)) {
        low = dvec2(0.0);
        high = dvec2(p.width, p.height);
        break;
      }
      const dvec2 at(p.cx + p.fx * glm::dot(view_->right, point) / depth,
                     p.cy + p.fy * glm::dot(view_->down, point) / depth);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
    const dvec2 size(shared::shade_group_width, shared::shade_group_height), last(columns_, rows_);
    const dvec2 from = glm::max(glm::floor((low - margin_px) / size), dvec2(0.0)),
                to = glm::min(glm::floor((high + margin_px) / size), last - 1.0);
    for (double row = from.y; row <= to.y; ++row)
      for (double column = from.x; column <= to.x; ++column)
        marked_[static_cast<size_t>(row) * columns_ + static_cast<size_t>(column)] = 1;
  }

  std::vector<uint32_t> groups() const {
    std::vector<uint32_t> found;
    for (uint32_t row = 0; row < rows_; ++row)
      for (uint32_t column = 0; column < columns_; ++column)
        if (marked_[size_t{row} * columns_ + column] != 0) found.push_back(column | row << 16);
    return found;
  }

 private:
  const CameraView* view_;
  uint32_t columns_, rows_;
  std::vector<uint8_t> marked_;
};

}  // namespace

std::vector<uint32_t> pane_groups(const scene::Scene& scene, std::span<const DrawPiece> panes,
                                  std::span<const uint32_t> order, std::span<const Pose> poses,
                                  const CameraView& view) {
  Marks marks(view);
  for (const uint32_t number : order) {
    const DrawPiece& pane = panes[number];
    const Pose& pose = poses[pane.body];
    const auto from_eye = [&](const dvec3& p) { return pose.apply(p) - view.eye; };
    if (pane.index_count > 3 * most_triangles) {
      std::array<dvec3, 8> corners;
      for (size_t k = 0; k < 8; ++k)
        corners[k] = from_eye({(k & 1 ? pane.bounds.max : pane.bounds.min).x,
                               (k & 2 ? pane.bounds.max : pane.bounds.min).y,
                               (k & 4 ? pane.bounds.max : pane.bounds.min).z});
      marks.mark(corners);
      continue;
    }
    for (uint32_t i = pane.first_index; i < pane.first_index + pane.index_count; i += 3) {
      std::array<dvec3, 3> corners;
      for (uint32_t k = 0; k < 3; ++k) corners[k] = from_eye(dvec3(scene.positions[scene.indices[i + k]]));
      marks.mark(corners);
    }
  }
  return marks.groups();
}

std::vector<uint32_t> all_groups(uint32_t width, uint32_t height) {
  std::vector<uint32_t> groups;
  for (uint32_t y = 0; y < height; y += shared::shade_group_height)
    for (uint32_t x = 0; x < width; x += shared::shade_group_width)
      groups.push_back(x / shared::shade_group_width | y / shared::shade_group_height << 16);
  return groups;
}

}  // namespace greatx::render
