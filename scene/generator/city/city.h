// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/mesh/seasons.h"

namespace greatx::scene::generator {

/// Returns the names of the textures that every large city shows.
std::span<const char* const> city_textures();

/// `writer` has the materials of the season (seasonal_library).
void write_city(SceneWriter& writer, double size_m, uint64_t seed, Season season = Season::summer);

}  // namespace greatx::scene::generator
