// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

// Buildings have the ridge along y, the ground at z = 0, and foundations 1 m deep.
MeshBuilder make_farmhouse(double scale);
MeshBuilder make_barn(double scale, bool red);
MeshBuilder make_silo(double scale);
MeshBuilder make_pole();
/// Adds a wire 4 cm thick between two points. It sags by `sag` in the middle, metres.
void add_wire(MeshBuilder& mesh, const dvec3& from, const dvec3& to, double sag);
/// Makes a round bale of straw, 1.3 m in diameter, which lies along y.
MeshBuilder make_bale();
/// Makes a trailer of two axles, 5 m along x without its drawbar.
MeshBuilder make_trailer();
/// Makes a fence of posts and two rails, `length_m` along x from the origin, over level ground.
MeshBuilder make_rail_fence(double length_m);

}  // namespace greatx::scene::generator
