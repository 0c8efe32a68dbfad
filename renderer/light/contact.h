// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Contact occlusion: the sky's light that moving bodies hide from what is near them. A body stands for itself
// as its bounding box, whose opacity is the share of the box that the body fills as seen along its axes. The
// shader looks only at the boxes of a point's cell in a level grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// The box of a body with its parts, in the body's frame.
struct ContactBox {
  uint32_t body = 0, last_part = 0;  ///< the bodies body ... last_part belong to it
  dvec3 center{0.0}, half_size{0.0};
  double opacity = 1.0;  ///< share of the box's silhouettes that is filled, by area
  double reach = 0.0;    ///< m from its surface
};

/// On level ground beside a box, the share that is left out beyond its reach is below this.
inline constexpr double contact_least_share = 0.01;
inline constexpr double contact_farthest_m = 12.0;

/// Returns the boxes of all moving bodies with triangles, by body.
std::vector<ContactBox> contact_boxes(const scene::Scene& scene);

/// Returns the words that shaders/camera/contact.glsl reads (shaders/shared/contact.h has their layout).
/// `body_poses` are in local coordinates; the index is the body.
std::vector<uint32_t> contact_words(std::span<const ContactBox> boxes, std::span<const Pose> body_poses);

}  // namespace greatx::render
