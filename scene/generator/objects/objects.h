// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes single objects with the foot at the origin and z up.
#pragma once

#include <string>
#include <vector>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

MeshBuilder make_bench();
/// Makes a steel mast for a base station. No part reaches above 24.6 m, so that an antenna at 25 m sees all
/// around.
MeshBuilder make_mast();

/// A quadrotor in parts, with the origin at its centre.
struct Quadrotor {
  MeshBuilder body;
  MeshBuilder rotor;                 ///< about its own hub, z up
  std::vector<dvec3> rotor_centers;  ///< front left, front right, rear right, rear left
};
/// Makes a quadrotor. `diagonal_m` is the distance between opposite motors.
Quadrotor make_quadrotor(double diagonal_m);

}  // namespace greatx::scene::generator
