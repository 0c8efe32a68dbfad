// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes the surroundings and the light that they send as shaders read them.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/light/surroundings.h"

namespace greatx::render {

/// Returns the words that shaders/camera/surroundings.glsl reads; the layout is in
/// shaders/shared/surroundings.h. Without `bounced_light`, which then reads nothing of it, the bounced light
/// is zero and is not gathered.
std::vector<uint32_t> surroundings_words(const Surroundings& surroundings, bool bounced_light);

}  // namespace greatx::render
