// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lines through points on the plane.
#pragma once

#include <vector>

#include "core/vec.h"

namespace greatx::scene::place {

double line_length(const std::vector<dvec2>& line);

/// Returns the part of a line between two lengths from its start.
std::vector<dvec2> part_of_line(const std::vector<dvec2>& line, double from_m, double to_m);

/// Cuts the corners within a line four times (Chaikin 1974); the ends stay.
std::vector<dvec2> without_corners(std::vector<dvec2> line);

/// Returns a line moved to its right.
std::vector<dvec2> moved_right(const std::vector<dvec2>& line, double by_m);

/// Returns the points of a line, and points between them so that none are more than `step_m` apart.
std::vector<dvec2> points_along(const std::vector<dvec2>& line, double step_m);

}  // namespace greatx::scene::place
