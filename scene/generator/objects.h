// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Single objects, foot at the origin, z up; vehicles look along x.
#pragma once

#include <string>
#include <vector>

#include "scene/generator/mesh_builder.h"

namespace greatx::scene::generator {

/// A broad-leaved tree some 7 m high; `shape` (any number) varies crown and colour.
MeshBuilder make_tree(int shape);
/// A conifer some 9 m high.
MeshBuilder make_conifer();
/// A street lamp with its arm along +x; the lens is at lamp_light_position.
MeshBuilder make_lamp();
inline const dvec3 lamp_light_position{1.5, 0.0, 6.2};
MeshBuilder make_bench();
/// `variant` "hatchback" or "van"; `paint` a material; `detailed` adds rims, plates and door lines for close views.
MeshBuilder make_car(const std::string& variant, const std::string& paint, bool detailed);
/// Steel mast for a base station; nothing reaches above 24.6 m, so that an antenna at 25 m sees all around.
MeshBuilder make_mast();

/// A quadrotor in parts, origin at its centre.
struct Quadrotor {
  MeshBuilder body;
  MeshBuilder rotor;                 ///< about its own hub, z up
  std::vector<dvec3> rotor_centers;  ///< front left, front right, rear right, rear left
};
/// `diagonal_m`: distance between opposite motors.
Quadrotor make_quadrotor(double diagonal_m);

}  // namespace greatx::scene::generator
