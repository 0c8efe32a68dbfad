// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws casters of shadows into maps of depth that are not the sun's: those of lamps, and that of the rain.
// Depth is reversed, as in renderer/light/shadow.h.
#pragma once

#include <span>
#include <vector>

#include "gpu/cmd.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/weather.h"

namespace greatx::render {

/// Returns whether the alpha mask of a primitive's material cuts holes into it.
bool has_mask(const scene::Scene& scene, uint32_t primitive);

/// Returns a pipeline with push constants CasterConstants. `moving` casters stand where their bodies are.
gpu::GraphicsPipeline caster_pipeline(const scene::GpuScene& scene, bool moving, bool masked);

/// Returns the descriptors that a pipeline of static casters needs.
std::vector<gpu::Descriptor> static_caster_descriptors(const scene::GpuScene& scene);

/// Draws primitives with the bound pipeline. The scene's indices are bound.
void draw_casters(gpu::Cmd& cmd, const scene::Scene& scene, std::span<const uint32_t> primitives);

/// Returns a map of depth.
gpu::Image caster_map(gpu::Device& device, uint32_t size, VkImageUsageFlags extra_usage,
                      std::string_view name);
/// Returns the sampler that compares with such a map. What lies beyond its rim is lit.
gpu::Sampler caster_sampler(gpu::Device& device, std::string_view name);

}  // namespace greatx::render
