// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "scene/generator/mesh/scene_writer.h"

namespace greatx::scene::generator {

/// Returns the names of the textures that every large city shows.
std::span<const char* const> city_textures();

void write_city(SceneWriter& writer, double size_m, uint64_t seed);

}  // namespace greatx::scene::generator
