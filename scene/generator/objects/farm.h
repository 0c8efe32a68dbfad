// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

// Buildings have the ridge along y, the ground at z = 0, and foundations 1 m deep.
MeshBuilder make_farmhouse(double scale);
MeshBuilder make_barn(double scale, bool red);
MeshBuilder make_silo(double scale);
/// Makes a wooden pole along z, whose cross-arm along y carries two insulators.
MeshBuilder make_pole();
/// Where the wires lie on the insulators of a pole: metres to its left and right, and above its foot.
inline constexpr double pole_wire_y_m = 0.8, pole_wire_z_m = 6.92;
/// Makes a round bale of straw, 1.3 m in diameter, which lies along y.
MeshBuilder make_bale();
/// Makes a trailer of two axles, 5 m along x without its drawbar.
MeshBuilder make_trailer();
/// Makes a fence of posts and two rails, `length_m` along x from the origin, over level ground.
MeshBuilder make_rail_fence(double length_m);

}  // namespace greatx::scene::generator
