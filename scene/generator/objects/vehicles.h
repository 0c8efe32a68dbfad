// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes cars that stand on the ground and face +x.
#pragma once

#include <string>

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// Makes a car. `variant` is "hatchback" or "van", `paint` names a material. `detailed` adds rims, plates and
/// pillars for close views and switches the lamps on; without `detailed` this is a parked car.
MeshBuilder make_car(const std::string& variant, const std::string& paint, bool detailed);

/// Writes a driving car: its mesh with low beams and tail lights (KHR_lights_punctual).
void write_car(SceneWriter& writer, const std::string& variant);

}  // namespace greatx::scene::generator
