// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes what one sees through the windows of a car: seats, dashboard, the inside of the doors. Radio does
// not see it.
#pragma once

#include "scene/generator/mesh/mesh_builder.h"

namespace greatx::scene::generator {

/// The room for a cabin. x is measured from the middle of the car, z from the ground.
struct CabinRoom {
  double front, rear;         ///< x of the lower edges of windscreen and rear window
  double seats;               ///< x of the B pillar, behind which the backs of the front seats stand
  double floor, belt, roof;   ///< z: what one sees at the bottom, lower edge of the side windows, roof
  double half_width, roof_y;  ///< y of the sides at the belt line, and of the roof's edge
  double rear_roof;           ///< x of the upper edge of the rear window
  bool load = false;          ///< a van: a wall behind the front seats instead of other seats
  bool plain = false;         ///< a parked car: few triangles
};

void add_cabin(MeshBuilder& mesh, const CabinRoom& room);

}  // namespace greatx::scene::generator
