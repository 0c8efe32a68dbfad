// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lists the groups of pixels that panes may cover, so that only these are shaded twice
// (renderer/camera/panes.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/camera/camera_view.h"
#include "renderer/camera/draw_list.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Returns groups of shared::shade_group_width x shade_group_height pixels of a view, row by row: column |
/// row << 16. They hold every pixel that a triangle of the panes touches, numbered by `order`; a few others
/// are among them. `poses` has one for each body.
std::vector<uint32_t> pane_groups(const scene::Scene& scene, std::span<const DrawPiece> panes,
                                  std::span<const uint32_t> order, std::span<const Pose> poses,
                                  const CameraView& view);
/// Returns all groups of a picture.
std::vector<uint32_t> all_groups(uint32_t width, uint32_t height);

}  // namespace greatx::render
