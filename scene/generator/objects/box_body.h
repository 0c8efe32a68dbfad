// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The bodies of lorries, buses and trams by parameters: boxes with large flat sides.
#pragma once

#include "scene/generator/objects/shapes.h"
#include "scene/generator/objects/vehicle_parts.h"

namespace greatx::scene::generator {

/// Returns the body, without wheels, of a lorry, a bus or a tram. Throws ContractError for another shape.
VehicleBody make_box_body(const VehicleShape& shape, int paint);

}  // namespace greatx::scene::generator
