// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes what one sees through the windows of buses, trams and lorries: floors, benches, poles, ceilings with
// lights, seats of drivers. Nobody sees what lies below the windows, so floors lie just there. Radio does not
// see any of it.
#pragma once

#include <vector>

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// A deck with seats. x is measured from the middle of the vehicle, z from the ground.
struct Saloon {
  double front = 0.0, rear = 0.0;  ///< x of its ends
  double half_width = 0.0;
  double floor = 0.0, ceiling = 0.0;
  double step = 1.0;             ///< from bench to bench
  std::vector<double> doors;     ///< x of doors, beside which there are poles in place of benches
  std::vector<dvec2> gaps = {};  ///< from x to x: no benches
};
void add_saloon(MeshBuilder& mesh, const Saloon& saloon);

/// The cab of a lorry behind its windows.
struct DriversCab {
  double front = 0.0, rear = 0.0;  ///< x of the windscreen and of the wall behind the seats
  double half_width = 0.0;
  double belt = 0.0;   ///< z of the lower edge of the windows
  bool alone = false;  ///< the driver's seat alone
};
void add_drivers_cab(MeshBuilder& mesh, const DriversCab& cab);

}  // namespace greatx::scene::generator
