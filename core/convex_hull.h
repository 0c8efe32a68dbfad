// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/vec.h"

namespace greatx {

/// Returns the convex hull counter-clockwise, without collinear points (A. M. Andrew, Information Processing
/// Letters 9, 216, 1979). It begins at the point of the least x, and among those of the least y.
std::vector<dvec2> convex_hull(std::vector<dvec2> points);

}  // namespace greatx
