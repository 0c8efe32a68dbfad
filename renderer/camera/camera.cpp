// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/camera.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "renderer/camera/camera_view.h"
#include "renderer/camera/develop.h"
#include "renderer/camera/edges.h"
#include "renderer/camera/lamps.h"
#include "renderer/camera/meter.h"

namespace greatx::render {

LensGeometry lens_geometry(const CameraDesc& desc) {
  return {desc.name, desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy, desc.distortion};
}

double saturation_luminance(double ev100) { return 1.2 * std::exp2(ev100); }

double stored_luminance(const CameraDesc& desc, const SceneLighting& lighting) {
  if (!desc.automatic_exposure) return saturation_luminance(desc.exposure_ev100);
  return anchor_luminance(lighting.ground_illuminance_lux());
}

CameraPass::CameraPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting),
      scene_(&lighting.scene()),
      desc_(desc),
      effects_(lighting.effects()),
      visibility_scope_(desc.name + " visibility"),
      shade_scope_(desc.name + " shade") {
  check();
  const bool shaded = desc_.outputs.color() || desc_.outputs.luminance;
  desc_.smooth_edges = desc_.smooth_edges && shaded;
  desc_.outputs.seen = desc_.outputs.seen || desc_.smooth_edges;
  pinhole_ = std::make_unique<PinholeView>(pinhole_of(desc_));
  const uint32_t most = scene_->device().limits().maxImageDimension2D;
  if (std::max(pinhole_->width, pinhole_->height) > most)
    throw_user_error(
        "camera {}: distortion: expected a pinhole picture of at most {} pixels along a side, found {} x {}",
        desc_.name, most, pinhole_->width, pinhole_->height);
  bound_primitives();
  sort_primitives();
  build_pipelines();
  create_images();
  create_pictures();
  upload_lens();
  if (desc_.smooth_edges) edges_ = std::make_unique<EdgePass>(*lighting_, desc_);
  if (desc_.outputs.arrays()) develop_ = std::make_unique<DevelopPass>(*lighting_, desc_);
}

CameraPass::~CameraPass() = default;

std::vector<uint32_t> CameraPass::visible(std::span<const uint32_t> primitives, const CameraView& view) {
  const scene::Scene& scene = scene_->scene();
  struct Drawn {
    double nearest;
    uint32_t primitive;
  };
  std::vector<Drawn> drawn;
  drawn.reserve(primitives.size());
  for (const uint32_t i : primitives) {
    const uint32_t body = scene.instances[scene.primitives[i].instance].body;
    const dvec3 center = lighting_->body_poses()[body].apply(spheres_[i].center) - view.eye;
    if (view.outside(center, spheres_[i].radius)) continue;
    drawn.push_back({glm::dot(view.forward, center) - spheres_[i].radius, i});
  }
  culled_ += static_cast<uint32_t>(primitives.size() - drawn.size());
  drawn_ += static_cast<uint32_t>(drawn.size());
  // The order is front to back, so that hidden triangles cost only a depth test. It is total, so that ties
  // come out the same every time.
  std::ranges::sort(drawn, [](const Drawn& a, const Drawn& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.primitive < b.primitive;
  });
  std::vector<uint32_t> order;
  order.reserve(drawn.size());
  for (const Drawn& d : drawn) order.push_back(d.primitive);
  return order;
}

gpu::Slice CameraPass::upload_lamps(gpu::TickSlot& slot, const CameraView& view) {
  std::vector<uint32_t> words(1);
  lamps_ = {};
  if (effects_.punctual_lights)
    words = cluster_lamps(view, scene_->scene().lights, lighting_->body_poses(), lamps_);
  return slot.upload.put(std::span<const uint32_t>(words));
}

void CameraPass::record(gpu::TickSlot& slot, const Pose& local_from_sensor, const FrameNumber& frame,
                        const ExposurePart& part) {
  GREATX_CHECK(desc_.parts || (part.first && part.last), "camera {}: built for whole exposures", desc_.name);
  CameraView view(*pinhole_, desc_.near_m, local_from_sensor, lighting_->shadows().frame(),
                  1.0 / stored_luminance(desc_, *lighting_));
  view.constants.weight = part.weight;
  view.constants.first = part.first;
  view.constants.size = desc_.width | desc_.height << 16;
  record_visibility(*slot.cmd, view);
  record_shading(slot, view);
  if (!part.last) return;
  if (edges_)
    edges_->record(slot, view, gpu::Descriptor::sampled(shared::lens_binding, lens_, texel_sampler_),
                   {shaded_, seen_, picture_});
  if (develop_) develop_->record(slot, picture_.color, seen_, frame);
}

void CameraPass::record_visibility(gpu::Cmd& cmd, const CameraView& view) {
  const auto scope = cmd.scope(visibility_scope_);
  cmd.transition(visibility_, gpu::ImageUse::color_target, true);
  cmd.transition(depth_, gpu::ImageUse::depth_target, true);
  gpu::RenderTargets targets;
  targets.color.push_back({.image = &visibility_, .clear = {.uint32 = {0, 0, 0, 0}}});
  targets.depth = &depth_;
  targets.width = pinhole_->width;
  targets.height = pinhole_->height;
  drawn_ = culled_ = 0;
  cmd.begin_rendering(targets);
  const auto draw_all = [&](const gpu::GraphicsPipeline& with, std::span<const uint32_t> primitives) {
    const std::vector<uint32_t> order = visible(primitives, view);
    if (order.empty()) return;
    cmd.bind(with);
    cmd.push(scene_->raster_descriptors());
    cmd.constants(view.constants);
    for (const uint32_t i : order) {
      const scene::Primitive& primitive = scene_->scene().primitives[i];
      cmd.draw_range(primitive.first_index, primitive.index_count, i);
    }
  };
  draw_all(visibility_still_, still_);
  draw_all(visibility_moving_, moving_);
  draw_all(visibility_masked_, masked_);
  cmd.end_rendering();
}

void CameraPass::record_shading(gpu::TickSlot& slot, const CameraView& view) {
  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(shade_scope_);
  cmd.transition(visibility_, multisampled() ? gpu::ImageUse::sampled : gpu::ImageUse::storage);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);  // for the readers of the picture before
  const Picture& picture = edges_ ? shaded_ : picture_;
  std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
  for (const gpu::Descriptor& descriptor : lighting_->descriptors()) descriptors.push_back(descriptor);
  for (const gpu::Descriptor& descriptor : lighting_->surfaces().descriptors())
    descriptors.push_back(descriptor);
  descriptors.push_back(gpu::Descriptor::buffer(shared::lights_binding, upload_lamps(slot, view)));
  descriptors.push_back(gpu::Descriptor::sampled(shared::lens_binding, lens_, texel_sampler_));
  descriptors.push_back(
      multisampled() ? gpu::Descriptor::sampled(shared::visibility_binding, visibility_, texel_sampler_)
                     : gpu::Descriptor::storage(shared::visibility_binding, visibility_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::shade_color_binding, picture.color));
  descriptors.push_back(gpu::Descriptor::buffer(shared::shade_luminance_binding, picture.luminance));
  descriptors.push_back(gpu::Descriptor::buffer(shared::shade_seen_binding, seen_));
  cmd.bind(shade_);
  cmd.push(descriptors);
  cmd.constants(view.constants);
  cmd.dispatch((desc_.width + shared::shade_group_width - 1) / shared::shade_group_width,
               (desc_.height + shared::shade_group_height - 1) / shared::shade_group_height);
}

CameraImages CameraPass::collect(const gpu::TickSlot& slot) const {
  return develop_ ? develop_->collect(slot) : CameraImages{.width = desc_.width, .height = desc_.height};
}

}  // namespace greatx::render
