// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes bicycles, motorcycles and their riders.
#pragma once

#include <cstdint>

#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/objects/shapes.h"

namespace greatx::scene::generator {

/// Writes a two-wheeler: its root, its wheels, the child `rider` (class person) with nodes for the legs in
/// riding position, and its lights.
void write_two_wheeler(SceneWriter& writer, const VehicleShape& shape, uint64_t seed);

}  // namespace greatx::scene::generator
