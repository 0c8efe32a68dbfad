// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The seasons of generated scenes.
#pragma once

#include <string>
#include <vector>

#include "scene/generator/mesh/materials.h"

namespace greatx::scene::generator {

enum class Season { summer, spring, autumn, winter };

/// Returns "summer", "spring", "autumn", "winter", in the order of Season.
const std::vector<std::string>& season_names();

/// Returns material_library() as it looks in this season: the same materials under the same indices, of which
/// leaves, grass and crops have other colours and pictures. Radio properties do not change.
std::vector<MaterialSpec> seasonal_library(Season season);

}  // namespace greatx::scene::generator
