// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The shell of a bus, a tram or a driver's cab: a rounded rectangle over several levels, with wheel arches.
#pragma once

#include <functional>
#include <vector>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// Where a cell of a shell is.
enum class ShellZone { front, front_corner, side, rear_corner, rear };

struct BoxShell {
  /// One contour. `inset` moves the sides inwards, `front` the front backwards, and `rear` the rear forwards.
  struct Level {
    double z = 0.0, inset = 0.0, front = 0.0, rear = 0.0;
  };
  double front_x = 0.0, rear_x = 0.0, half_width = 0.0;
  double corner = 0.3;           ///< size of the rounded corners as seen from above
  std::vector<Level> levels;     ///< from the bottom up
  std::vector<double> stations;  ///< x of further columns along the sides
  std::vector<double> arches;    ///< x of the axles that have wheel arches; their tops are below levels[1]
  double wheel_radius = 0.0, arch_radius = 0.0;
  int bottom = 0, roof = 0;
  /// Returns the material of the cell above `level` whose middle is at x.
  std::function<int(size_t level, ShellZone zone, double x)> cell;
};
void add_box_shell(MeshBuilder& mesh, const BoxShell& shell);

}  // namespace greatx::scene::generator
