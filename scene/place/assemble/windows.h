// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Divides a wall into windows and what is around them.
#pragma once

#include <array>
#include <vector>

#include "scene/place/buildings/complex.h"

namespace greatx::scene::place {

/// The lattice of windows of a façade: one in each bay and storey.
struct WindowLattice {
  double start_m = 0.0;  ///< of the wall on its façade
  double bay_m = 3.0;    ///< width of a bay
  double base_z = 0.0;   ///< of the ground floor
  double storey_m = 3.0;
  int storeys = 1;
};

struct WallTriangle {
  std::array<dvec3, 3> corners;  ///< counter-clockwise from outside
  bool window = false;
};

/// Returns the triangles of a wall with those windows that lie within it with a margin of 0.2 m. A window is
/// 0.45 of the bay wide and 0.45 of the storey high, and begins 0.3 of the storey above the floor. All lie in
/// the plane of the wall; the corners of the wall's outline stay as they are.
std::vector<WallTriangle> with_windows(const WallPiece& wall, const WindowLattice& lattice);

}  // namespace greatx::scene::place
