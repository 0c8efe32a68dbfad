// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "renderer/camera_view.h"

namespace greatx::render {

namespace {

constexpr VkFormat color_format = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat ids_format = VK_FORMAT_R32G32_UINT;
constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;

template <typename T>
std::vector<T> copied(const gpu::Slice& slice, size_t count) {
  if (slice.buffer == VK_NULL_HANDLE) return {};
  const std::span<T> values = slice.as<T>();
  return std::vector<T>(values.begin(), values.begin() + static_cast<ptrdiff_t>(count));
}

}  // namespace

double saturation_luminance(double ev100) { return 1.2 * std::exp2(ev100); }

CameraPass::CameraPass(const SceneLighting& lighting, const CameraDesc& desc)
    : lighting_(&lighting),
      scene_(&lighting.scene()),
      desc_(desc),
      effects_(lighting.effects()),
      surface_scope_(desc.name + " surfaces"),
      develop_scope_(desc.name + " develop") {
  check();
  bound_primitives();
  group_primitives();
  build_pipelines();
  create_images();
}

void CameraPass::check() const {
  const auto require = [&](bool holds, const char* field, const char* expected, double found) {
    if (!holds) throw_user_error("camera {}: {}: expected {}, found {}", desc_.name, field, expected, found);
  };
  const double most = scene_->device().limits().maxImageDimension2D;
  require(desc_.width >= 1 && desc_.width <= most, "width", "1 to the device's largest image", desc_.width);
  require(desc_.height >= 1 && desc_.height <= most, "height", "1 to the device's largest image",
          desc_.height);
  require(std::isfinite(desc_.fx) && desc_.fx > 0.0, "fx", "a positive number of pixels", desc_.fx);
  require(std::isfinite(desc_.fy) && desc_.fy > 0.0, "fy", "a positive number of pixels", desc_.fy);
  require(std::isfinite(desc_.cx), "cx", "a number of pixels", desc_.cx);
  require(std::isfinite(desc_.cy), "cy", "a number of pixels", desc_.cy);
  require(std::isfinite(desc_.near_m) && desc_.near_m > 0.0, "near_m", "a positive number of metres",
          desc_.near_m);
  require(desc_.msaa == 1 || desc_.msaa == 4, "msaa", "1 or 4", desc_.msaa);
  require(desc_.exposure_ev100 >= -20.0 && desc_.exposure_ev100 <= 24.0, "exposure_ev100", "-20 to 24",
          desc_.exposure_ev100);
  require(desc_.outputs.color() || desc_.outputs.ids(), "outputs", "at least one", 0);
  const size_t materials = scene_->scene().materials.size();
  require(!desc_.outputs.material || materials < 65535, "outputs.material",
          "a scene of at most 65534 materials", double(materials));
}

void CameraPass::bound_primitives() {
  const scene::Scene& scene = scene_->scene();
  spheres_.reserve(scene.primitives.size());
  for (const scene::Primitive& primitive : scene.primitives) {
    scene::Bounds bounds;
    for (uint32_t i = 0; i < primitive.index_count; ++i)
      bounds.add(dvec3(scene.positions[scene.indices[primitive.first_index + i]]));
    spheres_.push_back({bounds.center(), 0.5 * glm::length(bounds.size())});
  }
}

void CameraPass::group_primitives() {
  const scene::Scene& scene = scene_->scene();
  const bool color = desc_.outputs.color();
  for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
    const scene::Primitive& primitive = scene.primitives[i];
    if (desc_.excluded_body && scene.instances[primitive.instance].body == *desc_.excluded_body) continue;
    const scene::PbrMaterial& pbr = scene.materials[primitive.material].pbr;
    const bool glows = effects_.emissive && pbr.emissive_texture >= 0;
    const bool textured = color && effects_.textures &&
                          (pbr.base_color_texture >= 0 || pbr.metallic_roughness_texture >= 0 || glows);
    const bool masked = effects_.alpha_mask && pbr.alpha_mode == scene::AlphaMode::mask;
    const bool normal_mapped = color && effects_.normal_maps && pbr.normal_texture >= 0;
    auto group = std::ranges::find_if(groups_, [&](const Group& g) {
      return g.textured == textured && g.masked == masked && g.normal_mapped == normal_mapped;
    });
    if (group == groups_.end()) {
      groups_.push_back({});
      group = std::prev(groups_.end());
      group->textured = textured;
      group->masked = masked;
      group->normal_mapped = normal_mapped;
    }
    group->primitives.push_back(i);
  }
}

void CameraPass::build_pipelines() {
  gpu::Device& device = scene_->device();
  const bool color = desc_.outputs.color(), ids = desc_.outputs.ids();
  gpu::GraphicsDesc desc;
  desc.bindings = scene::GpuScene::bindings(false);
  if (color) {
    for (const gpu::Binding& binding : SceneLighting::bindings()) desc.bindings.push_back(binding);
    desc.bindings.push_back({shared::lights_binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
    desc.color_formats.push_back(color_format);
  }
  if (ids) desc.color_formats.push_back(ids_format);
  desc.push_constant_bytes = sizeof(shared::CameraConstants);
  desc.textures = &scene_->textures();
  desc.depth_format = depth_format;
  desc.samples = static_cast<VkSampleCountFlagBits>(desc_.msaa);
  desc.vertex_shader = "camera/surface.vert";
  desc.fragment_shader = !color ? "camera/surface_ids.frag"
                         : ids  ? "camera/surface.frag"
                                : "camera/surface_color.frag";

  std::vector<uint32_t> effects(shared::surface_spec_count);
  effects[shared::spec_sun] = effects_.sun;
  effects[shared::spec_sky] = effects_.sky;
  effects[shared::spec_static_shadows] = effects_.static_shadows;
  effects[shared::spec_moving_shadows] = effects_.moving_shadows;
  effects[shared::spec_emissive] = effects_.emissive;
  effects[shared::spec_lights] = effects_.punctual_lights;
  effects[shared::spec_specular] = effects_.specular;
  effects[shared::spec_multisampled] = desc_.msaa > 1;
  for (Group& group : groups_) {
    desc.specialization = effects;
    desc.specialization[shared::spec_textures] = group.textured;
    desc.specialization[shared::spec_normal_maps] = group.normal_mapped;
    desc.specialization[shared::spec_alpha_mask] = group.masked;
    group.pipeline = gpu::GraphicsPipeline(
        device, desc,
        fmt::format("{} surface{}{}{}", desc_.name, group.textured ? " textured" : "",
                    group.normal_mapped ? " normal-mapped" : "", group.masked ? " masked" : ""));
  }
  if (color && effects_.sky) {
    desc.specialization = effects;
    desc.vertex_shader = "camera/sky.vert";
    desc.fragment_shader = ids ? "camera/sky.frag" : "camera/sky_color.frag";
    desc.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    desc.depth_write = false;
    sky_ = gpu::GraphicsPipeline(device, desc, desc_.name + " sky");
  }

  gpu::ComputeDesc develop;
  develop.shader = "camera/develop.comp";
  develop.bindings = scene::GpuScene::bindings(false);
  develop.bindings.push_back({shared::develop_color_binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  develop.bindings.push_back({shared::develop_ids_binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  develop.push_constant_bytes = sizeof(shared::DevelopConstants);
  develop.specialization.resize(shared::develop_spec_count);
  develop.specialization[shared::develop_spec_rgb] = desc_.outputs.rgb;
  develop.specialization[shared::develop_spec_hdr] = desc_.outputs.hdr;
  develop.specialization[shared::develop_spec_depth] = desc_.outputs.depth;
  develop.specialization[shared::develop_spec_instance] = desc_.outputs.instance;
  develop.specialization[shared::develop_spec_semantic] = desc_.outputs.semantic;
  develop.specialization[shared::develop_spec_material] = desc_.outputs.material;
  develop_ = gpu::ComputePipeline(device, develop, desc_.name + " develop");
}

void CameraPass::create_images() {
  gpu::Device& device = scene_->device();
  const auto image = [&](VkFormat format, uint32_t samples, VkImageUsageFlags usage, const char* what,
                         bool wanted) {
    return gpu::Image(device,
                      {.format = format,
                       .width = wanted ? desc_.width : 1,
                       .height = wanted ? desc_.height : 1,
                       .samples = static_cast<VkSampleCountFlagBits>(samples),
                       .usage = usage},
                      fmt::format("{} {}", desc_.name, what));
  };
  constexpr VkImageUsageFlags target = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  constexpr VkImageUsageFlags kept =
      target | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  const bool color = desc_.outputs.color(), ids = desc_.outputs.ids();
  color_ = image(color_format, 1, kept, "radiance", color);
  ids_ = image(ids_format, 1, kept, "ids", ids);
  depth_ = image(depth_format, desc_.msaa, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, "depth", true);
  if (desc_.msaa > 1 && color)
    color_samples_ = image(color_format, desc_.msaa, target, "radiance samples", true);
  if (desc_.msaa > 1 && ids) ids_samples_ = image(ids_format, desc_.msaa, target, "id samples", true);
}

std::vector<uint32_t> CameraPass::visible(const Group& group, const CameraView& view) {
  const scene::Scene& scene = scene_->scene();
  struct Drawn {
    double nearest;
    uint32_t primitive;
  };
  std::vector<Drawn> drawn;
  drawn.reserve(group.primitives.size());
  for (const uint32_t i : group.primitives) {
    const uint32_t body = scene.instances[scene.primitives[i].instance].body;
    const dvec3 center = lighting_->body_poses()[body].apply(spheres_[i].center) - view.eye;
    if (view.outside(center, spheres_[i].radius)) {
      ++culled_;
      continue;
    }
    drawn.push_back({glm::dot(view.forward, center) - spheres_[i].radius, i});
  }
  // Front to back: what is hidden is never shaded. The order is total, so ties come out the same every time.
  std::ranges::sort(drawn, [](const Drawn& a, const Drawn& b) {
    return a.nearest != b.nearest ? a.nearest < b.nearest : a.primitive < b.primitive;
  });
  std::vector<uint32_t> order;
  order.reserve(drawn.size());
  for (const Drawn& d : drawn) order.push_back(d.primitive);
  return order;
}

gpu::Slice CameraPass::upload_lights(gpu::TickSlot& slot, const CameraView& view) const {
  std::vector<shared::GpuLight> lights;
  if (effects_.punctual_lights) {
    for (const scene::PunctualLight& light : scene_->scene().lights) {
      const Pose& pose = lighting_->body_poses()[light.body];
      const dvec3 position = pose.apply(light.position) - view.eye;
      const bool directional = light.type == scene::PunctualLight::Type::directional;
      // A lamp whose range ends before the view begins lights nothing in it.
      if (!directional && light.range_m > 0.0f && view.outside(position, light.range_m)) continue;
      lights.push_back(light_block(light, position, pose.rotate(light.direction)));
    }
  }
  const gpu::Slice slice =
      slot.upload.allocate(4 + std::max<size_t>(lights.size(), 1) * sizeof(shared::GpuLight));
  const auto count = static_cast<uint32_t>(lights.size());
  std::memcpy(slice.mapped, &count, sizeof count);
  std::memcpy(slice.mapped + 4, lights.data(), lights.size() * sizeof(shared::GpuLight));
  return slice;
}

void CameraPass::record(gpu::TickSlot& slot, const Pose& local_from_sensor) {
  record_surfaces(slot, CameraView(desc_, local_from_sensor, lighting_->shadows().frame()));
  record_develop(slot);
}

void CameraPass::record_surfaces(gpu::TickSlot& slot, const CameraView& view) {
  const bool color = desc_.outputs.color(), ids = desc_.outputs.ids(), multisampled = desc_.msaa > 1;
  gpu::Cmd& cmd = *slot.cmd;
  std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
  if (color) {
    for (const gpu::Descriptor& descriptor : lighting_->descriptors()) descriptors.push_back(descriptor);
    descriptors.push_back(gpu::Descriptor::buffer(shared::lights_binding, upload_lights(slot, view)));
  }

  const auto scope = cmd.scope(surface_scope_);
  gpu::RenderTargets targets;
  const auto add_target = [&](gpu::Image& samples, gpu::Image& result, VkClearColorValue clear) {
    cmd.transition(result, gpu::ImageUse::color_target, true);
    if (multisampled) cmd.transition(samples, gpu::ImageUse::color_target, true);
    targets.color.push_back({.image = multisampled ? &samples : &result,
                             .resolve = multisampled ? &result : nullptr,
                             .clear = clear,
                             .keep = false});
  };
  if (color) add_target(color_samples_, color_, {.float32 = {0.0f, 0.0f, 0.0f, 1.0f}});
  if (ids) add_target(ids_samples_, ids_, {.uint32 = {0x7f800000u, 0u, 0u, 0u}});  // +inf, nothing
  cmd.transition(depth_, gpu::ImageUse::depth_target, true);
  targets.depth = &depth_;
  targets.width = desc_.width;
  targets.height = desc_.height;

  drawn_ = culled_ = 0;
  cmd.begin_rendering(targets);
  for (const Group& group : groups_) {
    const std::vector<uint32_t> primitives = visible(group, view);
    if (primitives.empty()) continue;
    cmd.bind(group.pipeline);
    cmd.push(descriptors);
    cmd.constants(view.constants);
    cmd.bind_indices(scene_->indices());
    for (const uint32_t i : primitives) {
      const scene::Primitive& primitive = scene_->scene().primitives[i];
      cmd.draw_indexed(primitive.first_index, primitive.index_count, i);
    }
    drawn_ += static_cast<uint32_t>(primitives.size());
  }
  if (sky_) {
    cmd.bind(sky_);
    cmd.push(descriptors);
    cmd.constants(view.constants);
    cmd.draw(3);
  }
  cmd.end_rendering();
}

void CameraPass::record_develop(gpu::TickSlot& slot) {
  const CameraOutputs& outputs = desc_.outputs;
  const size_t groups =
      (size_t(desc_.width) * desc_.height + shared::develop_pixels - 1) / shared::develop_pixels;
  const auto words = [&](bool wanted, size_t per_group) {
    return wanted ? slot.readback.allocate(4 * per_group * groups) : gpu::Slice{};
  };
  Readback readback;
  readback.rgb = words(outputs.rgb, 3);
  readback.hdr = words(outputs.hdr, 12);
  readback.depth = words(outputs.depth, 4);
  readback.instance = words(outputs.instance, 4);
  readback.semantic = words(outputs.semantic, 1);
  readback.material = words(outputs.material, 2);
  if (readbacks_.size() <= slot.index) readbacks_.resize(slot.index + 1);
  readbacks_[slot.index] = readback;

  gpu::Cmd& cmd = *slot.cmd;
  const auto scope = cmd.scope(develop_scope_);
  cmd.transition(color_, gpu::ImageUse::storage, !outputs.color());
  cmd.transition(ids_, gpu::ImageUse::storage, !outputs.ids());
  cmd.bind(develop_);
  std::vector<gpu::Descriptor> descriptors = scene_->raster_descriptors();
  descriptors.push_back(gpu::Descriptor::storage(shared::develop_color_binding, color_));
  descriptors.push_back(gpu::Descriptor::storage(shared::develop_ids_binding, ids_));
  cmd.push(descriptors);
  shared::DevelopConstants constants{};
  constants.rgb = readback.rgb.address;
  constants.hdr = readback.hdr.address;
  constants.depth = readback.depth.address;
  constants.instance = readback.instance.address;
  constants.semantic = readback.semantic.address;
  constants.material = readback.material.address;
  constants.width = desc_.width;
  constants.height = desc_.height;
  constants.radiance_scale = float(saturation_luminance(desc_.exposure_ev100));
  cmd.constants(constants);
  cmd.dispatch(static_cast<uint32_t>((groups + shared::develop_group_size - 1) / shared::develop_group_size));
}

CameraImages CameraPass::collect(const gpu::TickSlot& slot) const {
  GREATX_CHECK(slot.index < readbacks_.size(), "camera {}: nothing was recorded into slot {}", desc_.name,
               slot.index);
  const Readback& from = readbacks_[slot.index];
  const size_t count = size_t(desc_.width) * desc_.height;
  CameraImages images;
  images.width = desc_.width;
  images.height = desc_.height;
  images.rgb = copied<uint8_t>(from.rgb, 3 * count);
  images.hdr = copied<float>(from.hdr, 3 * count);
  images.depth = copied<float>(from.depth, count);
  images.instance = copied<uint32_t>(from.instance, count);
  images.semantic = copied<uint8_t>(from.semantic, count);
  images.material = copied<uint16_t>(from.material, count);
  return images;
}

}  // namespace greatx::render
