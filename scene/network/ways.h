// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lines of turns over junctions and of loops at the ends of streets, for those who make networks.
#pragma once

#include <vector>

#include "core/vec.h"

namespace greatx::scene {

/// Returns the points of a turn from the end of a lane to the start of another one, with the unit directions
/// of travel there. It is a Bezier curve of degree five whose three control points at each end lie on a line,
/// so that its curvature there is 0. Straight pieces lead to it where the corner is further from one end than
/// from the other.
std::vector<dvec2> turn_line(const dvec2& from, const dvec2& from_direction, const dvec2& to,
                             const dvec2& to_direction);

/// Returns the points of a loop with which one who leaves a street at `from` in the unit direction `out`
/// comes back at `to`, on the left: a swerve to the right, a quarter turn and another one to the left, and
/// straight back. Its bends have radii of 0.85 `reach_m` or more. It ends reach_m + 20 m beyond the street.
std::vector<dvec2> loop_line(const dvec2& from, const dvec2& to, const dvec2& out, double reach_m);

}  // namespace greatx::scene
