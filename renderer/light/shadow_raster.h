// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the passes that draw maps of depth what they share: those of the sun, of lamps and of the rain.
// Depth is reversed, as in renderer/light/shadow.h.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "gpu/cmd.h"
#include "gpu/pipeline.h"
#include "gpu/resources.h"
#include "renderer/light/casters.h"
#include "scene/device/gpu_scene.h"
#include "shaders/shared/camera.h"

namespace greatx::render {

/// Returns a square depth map that shaders sample. `also` are further uses.
gpu::Image shadow_map(gpu::Device& device, uint32_t size, std::string_view name, VkImageUsageFlags also = 0);
/// Returns the sampler that compares with such a map. What lies beyond its rim is lit, unless it `repeats`.
gpu::Sampler shadow_sampler(gpu::Device& device, std::string_view name, bool repeats = false);

/// Returns a pipeline that draws casters by the named vertex shader, with holes if `masked`. `desc` holds the
/// bindings and push constants that this shader has beside the scene's.
gpu::GraphicsPipeline shadow_pipeline(const scene::GpuScene& scene, gpu::GraphicsDesc desc, bool masked,
                                      std::string_view name);
/// Returns such a pipeline with push constants CasterConstants. `moving` casters stand where their bodies
/// are.
gpu::GraphicsPipeline caster_pipeline(const scene::GpuScene& scene, bool moving, bool masked,
                                      std::string_view name);
/// Returns such a pipeline for panes, which fill a part of the texels (camera/shadow_pane.frag.glsl).
/// Its vertex shader is camera/pane_caster.vert or camera/pane_moving_shadow.vert.
gpu::GraphicsPipeline pane_shadow_pipeline(const scene::GpuScene& scene, gpu::GraphicsDesc desc,
                                           std::string_view name);
/// Returns such a pipeline for static panes, with push constants CasterConstants.
gpu::GraphicsPipeline pane_caster_pipeline(const scene::GpuScene& scene, std::string_view name);
/// The bodies that move and cast shadows in the light of lamps, and the pipelines that draw them.
struct MovingCasters {
  std::vector<BodyCaster> bodies;
  gpu::GraphicsPipeline opaque, masked;  ///< null if nothing is drawn with them
};
/// With `alpha_mask`, primitives with holes are drawn apart.
MovingCasters moving_casters(const scene::GpuScene& scene, bool alpha_mask);
/// Returns the descriptors that a pipeline of static casters needs; those for panes with the records of
/// materials.
std::vector<gpu::Descriptor> static_caster_descriptors(const scene::GpuScene& scene,
                                                       const gpu::Buffer* panes = nullptr);
/// Draws a body's parts with the bound pipeline. The scene's indices are bound.
void draw_casters(gpu::Cmd& cmd, std::span<const CasterRange> ranges);
/// Draws primitives with the bound pipeline. The scene's indices are bound.
void draw_casters(gpu::Cmd& cmd, const scene::Scene& scene, std::span<const uint32_t> primitives);

}  // namespace greatx::render
