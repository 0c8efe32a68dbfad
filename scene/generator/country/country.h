// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/mesh/seasons.h"

namespace greatx::scene::generator {

/// Writes farmland on a Terrain: fields, hedges, farms, woods, a pond, and a road with poles and lamps.
/// `writer` has the materials of the season (seasonal_library).
void write_country(SceneWriter& writer, double size_m, uint64_t seed, Season season = Season::summer);

}  // namespace greatx::scene::generator
