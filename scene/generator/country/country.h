// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// Writes farmland on a Terrain: fields, hedges, farms, woods, a pond, and a road with poles and lamps.
void write_country(SceneWriter& writer, double size_m, uint64_t seed);

}  // namespace greatx::scene::generator
