// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The bodies of cars and vans by parameters: a closed shell over contours from the sill to the roof.
#pragma once

#include <string>

#include "scene/generator/objects/shapes.h"
#include "scene/generator/objects/vehicle_parts.h"

namespace greatx::scene::generator {

/// Returns whether a variant of "vehicle" is made by make_car_body.
bool is_car(const std::string& variant);

/// Returns the body of a car or a van without its wheels. `detailed` gives it wheel arches, pillars, mirrors,
/// lamps and plates; without it this is the shell of a parked car.
VehicleBody make_car_body(const VehicleShape& shape, int paint, bool detailed);

}  // namespace greatx::scene::generator
