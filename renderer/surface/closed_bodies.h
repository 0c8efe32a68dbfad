// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the bodies, and the things of the static world, whose back faces nobody outside them ever sees.
#pragma once

#include <vector>

#include "scene/description/scene.h"

namespace greatx::render {

/// Returns, for each body, whether its triangles are closed surfaces that face outwards: every edge belongs
/// to as many triangles in one direction as in the other, and every connected part has a positive volume.
/// From outside, at every place of a picture, as many of its front faces cover the place as of its back
/// faces, and a front face is the nearest. Body 0, bodies without triangles, and bodies with materials that
/// have holes are not closed.
std::vector<bool> closed_bodies(const scene::Scene& scene);

/// Returns the same for each instance of the static world, of the triangles without holes alone; false for
/// instances of other bodies.
std::vector<bool> closed_instances(const scene::Scene& scene);

}  // namespace greatx::render
