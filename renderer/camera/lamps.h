// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which lamps light which part of a camera's view: clusters of screen tiles and slices of depth (O. Olsson, M. Billeter,
// U. Assarsson, "Clustered Deferred and Forward Shading", HPG 2012), made on the host for each picture. A pixel then
// looks at the lamps of its cluster alone, so that the cost follows the lamps that reach what is seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Illuminance at which a lamp that states no range ends, lux.
inline constexpr double lamp_least_lux = 1e-3;

/// Metres that a lamp reaches: its range, or sqrt(I / lamp_least_lux) if it states none; +inf for a directional one.
double lamp_reach(const scene::PunctualLight& light);

/// The words that shaders/camera/lamps.glsl reads (shaders/shared/camera.h has their layout). A lamp is in every cluster
/// that its light reaches and in few that it does not: bounds are those of a sphere around its cone.
/// `body_poses`: local coordinates, index = body.
std::vector<uint32_t> cluster_lamps(const CameraView& view, std::span<const scene::PunctualLight> lights,
                                    std::span<const Pose> body_poses, LampCounts& counts);

}  // namespace greatx::render
