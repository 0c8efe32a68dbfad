// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Cars, on the ground, looking along x.
#pragma once

#include <string>

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// `variant` "hatchback" or "van"; `paint` a material; `detailed` adds rims, plates and pillars for close
/// views, and switches the lamps on: without it, a parked car.
MeshBuilder make_car(const std::string& variant, const std::string& paint, bool detailed);

/// A car that drives: its mesh with low beams and tail lights (KHR_lights_punctual).
void write_car(SceneWriter& writer, const std::string& variant);

}  // namespace greatx::scene::generator
