// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the bodies, and the things of the static world, whose back faces nobody outside them ever sees.
#pragma once

#include <vector>

#include "scene/description/scene.h"

namespace greatx::render {

/// Returns, for each primitive, whether it is an inside: closed surfaces with panes
/// (renderer/surface/pane_color.h) hide it from all sides where panes count as solid. Both belong to one
/// body, or to one instance of the static world. No triangle of an inside crosses these surfaces, and a point
/// of each of its connected parts has a winding number of 1. Meshes with more than 4 million pairs of a
/// triangle of such a surface and another one have no insides, since each pair is looked at.
std::vector<bool> insides(const scene::Scene& scene);

/// Returns, for each body, whether its triangles but for the insides are closed surfaces that face outwards:
/// every edge belongs to as many in one direction as in the other, and connected parts have positive volumes.
/// From outside, at every place of a picture, as many of its front faces cover the place as of its back
/// faces, and a front face is the nearest. Body 0, bodies without triangles, and bodies with materials that
/// have holes are not closed.
std::vector<bool> closed_bodies(const scene::Scene& scene, const std::vector<bool>& insides = {});

/// Returns the same for each instance of the static world, of the triangles without holes alone; false for
/// instances of other bodies.
std::vector<bool> closed_instances(const scene::Scene& scene, const std::vector<bool>& insides = {});

/// All of them.
struct ClosedSurfaces {
  std::vector<bool> insides;            ///< by primitive
  std::vector<bool> bodies, instances;  ///< closed but for the insides
};
ClosedSurfaces closed_surfaces(const scene::Scene& scene);

}  // namespace greatx::render
