// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

// Ridge along y, ground at z = 0, foundations 1 m deep.
MeshBuilder make_farmhouse(double scale);
MeshBuilder make_barn(double scale, bool red);
MeshBuilder make_silo(double scale);
MeshBuilder make_pole();
/// A wire between two points that hangs through by `sag` in the middle, 4 cm thick.
void add_wire(MeshBuilder& mesh, const dvec3& from, const dvec3& to, double sag);

}  // namespace greatx::scene::generator
