// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the sky as an octahedral picture (renderer/surface/octahedral.h).
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "renderer/light/sky.h"

namespace greatx::render {

/// Describes an octahedral environment map, RGBA half floats, one vector a mip level. Texels hold radiance /
/// scale.
struct EnvironmentMap {
  double scale = 1.0;
  std::vector<std::vector<uint16_t>> levels;
};
EnvironmentMap bake_environment(const Sky& sky, uint32_t size, uint32_t levels);

}  // namespace greatx::render
