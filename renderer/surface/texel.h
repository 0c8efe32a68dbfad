// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/vec.h"
#include "scene/description/scene.h"

namespace greatx::render {

/// Returns the colour of a texel of a texture, linear whatever the texture's encoding is.
dvec3 linear_texel(const scene::Texture& texture, size_t column, size_t row);

}  // namespace greatx::render
