// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks the scene as a whole.
#pragma once

#include "scene/description/scene.h"
#include "sim/check/finding.h"

namespace greatx::sim {

/// Finds a static world that seems to lie on its side, as a file whose y axis points up does if it is taken
/// for one whose z axis does. Ground and roofs face upwards, and nothing is as large in a place that people
/// build. The world seems to lie on its side if the surfaces that face one of the other five directions
/// (within 25 degrees) have more than twice the area of those that face up, and the world is also higher than
/// it is long in that direction.
std::vector<Finding> check_scene(const scene::Scene& scene);

}  // namespace greatx::sim
