// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the passes that draw shadow maps what they share.
#pragma once

#include <string_view>

#include "gpu/pipeline.h"
#include "gpu/resources.h"
#include "scene/device/gpu_scene.h"

namespace greatx::render {

inline constexpr VkFormat shadow_map_format = VK_FORMAT_D32_SFLOAT;

/// Returns a square depth map that shaders sample.
gpu::Image shadow_map(gpu::Device& device, uint32_t size, std::string_view name);

/// Returns whether an alpha mask cuts holes into a primitive.
bool has_holes(const scene::Scene& scene, uint32_t primitive);

/// Returns a pipeline that draws casters by the named vertex shader, with holes if `masked`. `desc` holds the
/// bindings and push constants that this shader has beside the scene's.
gpu::GraphicsPipeline shadow_pipeline(const scene::GpuScene& scene, gpu::GraphicsDesc desc, bool masked,
                                      std::string_view name);

}  // namespace greatx::render
