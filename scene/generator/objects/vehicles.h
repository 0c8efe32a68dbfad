// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes vehicles that stand on the ground and face +x.
#pragma once

#include <cstdint>
#include <string>

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// Makes a parked car of few triangles, without lights and with its wheels in the same mesh. `variant` is one
/// of vehicle_shapes() that has a body of a car or a van; `paint` names a material.
MeshBuilder make_parked_car(const std::string& variant, const std::string& paint);

/// Writes a driving vehicle: the root called `variant`, its wheels, and its lights (KHR_lights_punctual). The
/// seed picks the paint. Throws UserError for an unknown variant.
void write_vehicle(SceneWriter& writer, const std::string& variant, uint64_t seed);

/// Writes the kind "car": "hatchback" in red or "van" in white, as one mesh with its wheels, and its lights.
void write_car(SceneWriter& writer, const std::string& variant);

}  // namespace greatx::scene::generator
