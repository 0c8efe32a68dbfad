// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace greatx {

/// Holds one shader of the program, compiled to SPIR-V at build time and embedded.
struct SpirvModule {
  std::string_view name;  ///< path below shaders/ without ".glsl", e.g. "lidar/sweep.comp"
  std::span<const uint32_t> words;
};

/// Returns every embedded shader.
std::span<const SpirvModule> spirv_modules();

}  // namespace greatx
