// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the mean colours of materials.
#pragma once

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Returns the mean base colour of a material, linear Rec. 709: its factor times the mean of about a thousand
/// texels of its texture.
dvec3 mean_color(const scene::Scene& scene, uint32_t material);

}  // namespace greatx::render
