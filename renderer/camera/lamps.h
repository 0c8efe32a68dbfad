// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Assigns lamps to clusters of a camera's view: screen tiles and slices of depth (O. Olsson, M. Billeter, U.
// Assarsson, "Clustered Deferred and Forward Shading", HPG 2012). The host makes the clusters for each
// picture. A pixel then looks only at the lamps of its cluster, so that the cost follows the lamps that reach
// the visible surfaces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "renderer/light/lamp_shadow.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Returns the words that shaders/camera/lamps.glsl reads (shaders/shared/camera.h has their layout). A lamp
/// is in every cluster that its light reaches and in few others: the bounds are those of a sphere around its
/// cone. `body_poses` are in local coordinates; the index is the body. `tiles` are those of the lamps'
/// shadows, by light; empty: none. With `halos` every column of tiles lists the most_halos lamps that give
/// its air the most light. `beams` are the tiles of spots that move in this picture.
std::vector<uint32_t> cluster_lamps(const CameraView& view, std::span<const scene::PunctualLight> lights,
                                    std::span<const Pose> body_poses, LampCounts& counts,
                                    std::span<const LampTile> tiles = {}, bool halos = false,
                                    std::span<const BeamTile> beams = {});

}  // namespace greatx::render
