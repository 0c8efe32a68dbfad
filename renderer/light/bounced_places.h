// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The grid of places at which the effect `bounced_light` knows the light of the surroundings, as shaders read
// it.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/light/surroundings.h"

namespace greatx::render {

/// Appends the words of `columns` x `rows` places (shaders/shared/surroundings.h): the light at two heights
/// over the ground.
void put_bounced_light(std::vector<uint32_t>& words, const Surroundings& surroundings, uint32_t columns,
                       uint32_t rows);

}  // namespace greatx::render
