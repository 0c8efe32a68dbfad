// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes wires that hang between two points.
#pragma once

#include <span>
#include <vector>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// The curve of a flexible wire of even weight that hangs between (0, 0) and (span, rise), metres:
/// y = bottom + scale (cosh((x - lowest) / scale) - 1). `scale` is the horizontal tension over the weight of
/// a metre.
struct Catenary {
  double scale = 1.0, lowest = 0.0, bottom = 0.0;
  double height(double x) const;
  /// The length of the wire between two places x.
  double length(double from, double to) const;
};

/// Returns the catenary whose tension lets a level span of the same length sag by `sag` in its middle, m.
/// Expects 0 < sag <= span.
Catenary catenary(double span, double rise, double sag);

/// Returns `pieces` + 1 points along a wire between two points that do not stand above each other, at equal
/// horizontal distances. Between two of them the chord lies above the wire by about sag / pieces^2 at most.
std::vector<dvec3> hanging_wire(const dvec3& from, const dvec3& to, double sag, int pieces);

/// Adds a closed wire along a line of points, a prism of three sides whose corners lie `radius` metres from
/// it.
void add_wire(MeshBuilder& mesh, int material, std::span<const dvec3> line, double radius);

}  // namespace greatx::scene::generator
