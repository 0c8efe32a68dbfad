// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The part of CameraPass that shades what the visibility pass has drawn.
#include <algorithm>

#include "renderer/camera/camera.h"
#include "renderer/camera/camera_view.h"
#include "renderer/camera/draw_list.h"
#include "renderer/camera/faces.h"
#include "renderer/camera/mirror.h"
#include "renderer/camera/pane_groups.h"
#include "renderer/camera/panes.h"
#include "shaders/shared/lines.h"

namespace greatx::render {

gpu::ComputeDesc CameraPass::shading() const {
  gpu::ComputeDesc shade;
  shade.shader = multisampled() ? "camera/shade_multisampled.comp" : "camera/shade.comp";
  shade.bindings = SceneLighting::surface_bindings();
  for (const gpu::Binding& binding : SceneLighting::bindings()) shade.bindings.push_back(binding);
  for (const gpu::Binding& binding : NearShadows::bindings()) shade.bindings.push_back(binding);
  shade.bindings.push_back({shared::lights_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  shade.bindings.push_back({shared::lens_binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER});
  shade.bindings.push_back({shared::face_pixels_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  shade.bindings.push_back({shared::visibility_binding, multisampled()
                                                            ? VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER
                                                            : VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  for (const uint32_t slot : {shared::shade_color_binding, shared::shade_luminance_binding,
                              shared::shade_seen_binding, shared::shade_mirror_binding})
    shade.bindings.push_back({slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  shade.push_constant_bytes = sizeof(shared::CameraConstants);
  shade.textures = &scene_->textures().table();
  shade.specialization.resize(shared::shade_spec_count);
  shade.specialization[shared::spec_color] = desc_.outputs.color();
  shade.specialization[shared::spec_triangle_address] = lighting_->surfaces().by_address();
  shade.specialization[shared::spec_luminance] = desc_.outputs.luminance;
  shade.specialization[shared::spec_ids] = desc_.outputs.ids();
  shade.specialization[shared::spec_sun] = effects_.sun;
  shade.specialization[shared::spec_sky] = effects_.sky;
  shade.specialization[shared::spec_static_shadows] = effects_.static_shadows;
  shade.specialization[shared::spec_moving_shadows] = effects_.moving_shadows;
  shade.specialization[shared::spec_pane_shadows] = lighting_->shadows().panes() != nullptr;
  shade.specialization[shared::spec_shadow_cascades] = near_shadows_ ? near_shadows_->cascades() : 0;
  shade.specialization[shared::spec_textures] = effects_.textures && draws_->textured();
  shade.specialization[shared::spec_normal_maps] = effects_.normal_maps && draws_->normal_mapped();
  shade.specialization[shared::spec_emissive] = effects_.emissive && draws_->emissive();
  shade.specialization[shared::spec_switched_lamps] = effects_.switched_lamps && draws_->switched();
  shade.specialization[shared::spec_lights] = effects_.punctual_lights && !scene_->scene().lights.empty();
  shade.specialization[shared::spec_beams] = std::ranges::any_of(
      scene_->scene().lights,
      [](const scene::PunctualLight& light) { return light.beam == scene::PunctualLight::Beam::passing; });
  shade.specialization[shared::spec_specular] = effects_.specular;
  shade.specialization[shared::spec_haze] = effects_.haze;
  shade.specialization[shared::spec_night_sky] = effects_.night_sky;
  shade.specialization[shared::spec_markings] = effects_.markings;
  shade.specialization[shared::spec_clouds] = effects_.clouds;
  shade.specialization[shared::spec_horizon] = static_cast<uint32_t>(lighting_->horizon_kind());
  shade.specialization[shared::spec_ambient_occlusion] = effects_.ambient_occlusion;
  shade.specialization[shared::spec_distortion] = desc_.distortion.any() || faces_;
  shade.specialization[shared::spec_faces] = faces_ != nullptr;
  shade.specialization[shared::spec_range] = desc_.wide.any();
  shade.specialization[shared::spec_wet_surfaces] = effects_.wet_surfaces;
  shade.specialization[shared::spec_snow_cover] = effects_.snow_cover;
  shade.specialization[shared::spec_mirrors] = wants_mirrors(effects_, desc_);
  shade.specialization[shared::spec_lamp_shadows] = effects_.lamp_shadows;
  shade.specialization[shared::spec_beam_shadows] = effects_.beam_shadows;
  shade.specialization[shared::spec_lamp_halos] = effects_.lamp_halos;
  shade.specialization[shared::spec_contact_occlusion] = effects_.contact_occlusion;
  shade.specialization[shared::spec_bounced_light] = effects_.bounced_light;
  shade.specialization[shared::spec_glass] = effects_.glass;
  shade.specialization[shared::spec_panes] = !draws_->panes().empty();
  shade.specialization[shared::spec_blend] = desc_.parts;
  const auto arrays_of = [&](scene::TextureReference scene::MaterialTextures::*use) {
    return scene_->textures().arrays_of(use);
  };
  shade.specialization[shared::spec_base_color_arrays] = arrays_of(&scene::MaterialTextures::base_color);
  shade.specialization[shared::spec_metallic_roughness_arrays] =
      arrays_of(&scene::MaterialTextures::metallic_roughness);
  shade.specialization[shared::spec_normal_arrays] = arrays_of(&scene::MaterialTextures::normal);
  shade.specialization[shared::spec_emissive_arrays] = arrays_of(&scene::MaterialTextures::emissive);
  return shade;
}

void CameraPass::record_shading(gpu::TickSlot& slot, const CameraView& view, const gpu::Slice& pixels,
                                uint32_t line_pixels) {
  gpu::Cmd& cmd = *slot.cmd;
  cmd.transition(visibility_, multisampled() ? gpu::ImageUse::sampled : gpu::ImageUse::storage);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);  // waits for readers of the picture before
  const PictureBuffers& picture = edges_ ? shaded_ : picture_;
  std::vector<gpu::Descriptor> descriptors = lighting_->surface_descriptors();
  for (const gpu::Descriptor& descriptor : lighting_->descriptors()) descriptors.push_back(descriptor);
  for (const gpu::Descriptor& descriptor :
       near_shadows_ ? near_shadows_->descriptors() : NearShadows::no_descriptors(lighting_->shadows()))
    descriptors.push_back(descriptor);
  descriptors.push_back(gpu::Descriptor::buffer(shared::lights_binding, upload_lamps(slot, view)));
  descriptors.push_back(gpu::Descriptor::sampled(shared::lens_binding, lens_, texel_sampler_));
  descriptors.push_back(gpu::Descriptor::buffer(shared::shade_mirror_binding, beside_));
  const auto bind = [&](const gpu::ComputePipeline& with, std::vector<gpu::Descriptor> own,
                        const gpu::Slice& listed) {
    own.push_back(gpu::Descriptor::buffer(shared::face_pixels_binding, listed));
    own.insert(own.end(), descriptors.begin(), descriptors.end());
    cmd.bind(with);
    cmd.push(own);
    cmd.constants(view.constants);
  };
  constexpr uint32_t group_pixels = shared::shade_group_width * shared::shade_group_height;
  const auto shade_faces = [&] {
    cmd.dispatch_linear(pixels.size / sizeof(shared::FacePixel), group_pixels);
  };
  const auto shade_panes = [&] {
    const auto pane_descriptors = panes_->descriptors(texel_sampler_);
    if (faces_) {
      bind(panes_->shade(), pane_descriptors, pixels);
      return shade_faces();
    }
    // The list is of the view's pixels, and a lens that distorts shows them elsewhere.
    const std::vector<uint32_t> groups =
        desc_.distortion.any()
            ? all_groups(desc_.width, desc_.height)
            : pane_groups(scene_->scene(), draws_->panes(), seen_panes_, lighting_->body_poses(), view);
    const size_t all = size_t{desc_.width} * desc_.height;
    const size_t mirror_bytes = mirror_ ? all * sizeof(shared::uvec3) : 0;
    cmd.barrier(gpu::sync::compute, gpu::sync::transfer_write);
    cmd.fill(beside_.slice().part(mirror_bytes, all * sizeof(uint32_t)), 0);
    cmd.barrier(gpu::sync::transfer_write, gpu::sync::compute);
    if (groups.empty()) return;
    bind(panes_->shade(), pane_descriptors, slot.upload.put(std::span<const uint32_t>(groups)));
    cmd.dispatch_linear(uint64_t{group_pixels} * groups.size(), group_pixels);
  };
  const std::vector<gpu::Descriptor> own{
      multisampled() ? gpu::Descriptor::sampled(shared::visibility_binding, visibility_, texel_sampler_)
                     : gpu::Descriptor::storage(shared::visibility_binding, visibility_),
      gpu::Descriptor::buffer(shared::shade_color_binding, mirror_ ? dry_ : picture.color),
      gpu::Descriptor::buffer(shared::shade_luminance_binding, picture.luminance),
      gpu::Descriptor::buffer(shared::shade_seen_binding, seen_)};
  {
    const auto scope = cmd.scope(shade_scope_);
    if ((view.constants.first & shared::camera_sees_panes) != 0) {
      shade_panes();
      cmd.barrier(gpu::sync::compute, gpu::sync::compute);
    }
    bind(shade_, own, pixels);
    if (faces_)
      shade_faces();
    else
      cmd.dispatch((desc_.width + shared::shade_group_width - 1) / shared::shade_group_width,
                   (desc_.height + shared::shade_group_height - 1) / shared::shade_group_height);
  }
  if (line_pixels == 0) return;
  const auto scope = cmd.scope(lines_scope_);
  cmd.barrier(gpu::sync::compute, gpu::sync::compute);
  bind(shade_lines_, own, pixels);
  cmd.dispatch_linear(line_pixels, shared::line_group_pixels);
}

}  // namespace greatx::render
