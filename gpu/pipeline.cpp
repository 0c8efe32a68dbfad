// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/pipeline.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "gpu/capabilities.h"
#include "gpu/kept_pipelines.h"
#include "shaders/shared/scene.h"
#include "shaders/spirv.h"

namespace greatx::gpu {

namespace {

constexpr VkShaderStageFlags graphics_stages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

/// Represents a shader module that lives while a pipeline is built.
class Module {
 public:
  Module(Device& device, std::string_view name) : device_(device) {
    const std::span<const uint32_t> words = spirv(name);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = words.size_bytes();
    info.pCode = words.data();
    GREATX_VK(vkCreateShaderModule(device.handle(), &info, nullptr, &module_));
    device.set_name(VK_OBJECT_TYPE_SHADER_MODULE, reinterpret_cast<uint64_t>(module_), name);
  }
  ~Module() { vkDestroyShaderModule(device_.handle(), module_, nullptr); }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit,
                                        const VkSpecializationInfo* specialization) const {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = bit;
    info.module = module_;
    info.pName = "main";
    info.pSpecializationInfo = specialization;
    return info;
  }

 private:
  Device& device_;
  VkShaderModule module_ = VK_NULL_HANDLE;
};

/// Holds the values of constant_id 0, 1, 2, ... and the memory that the Vulkan struct points at.
struct Specialization {
  explicit Specialization(std::span<const uint32_t> values) {
    for (uint32_t i = 0; i < values.size(); ++i)
      entries.push_back({i, static_cast<uint32_t>(i * sizeof(uint32_t)), sizeof(uint32_t)});
    info = {static_cast<uint32_t>(entries.size()), entries.data(), values.size_bytes(), values.data()};
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;
  std::vector<VkSpecializationMapEntry> entries;
  VkSpecializationInfo info{};
};

/// Returns the name of the shader for a kind of texture table.
std::string variant_of(const std::string& shader, const TextureTable* textures) {
  return textures != nullptr && textures->few() ? shader + ".few" : shader;
}

VkPipeline make_compute(Device& device, const std::string& shader, std::span<const uint32_t> constants,
                        VkPipelineLayout layout) {
  const Module module(device, shader);
  const Specialization specialization(constants);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = module.stage(VK_SHADER_STAGE_COMPUTE_BIT, &specialization.info);
  info.layout = layout;
  VkPipeline made = VK_NULL_HANDLE;
  GREATX_VK(vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &made));
  return made;
}

/// `desc` names the variant of its fragment shader.
VkPipeline make_graphics(Device& device, const GraphicsDesc& desc, VkPipelineLayout layout) {
  const Specialization specialization(desc.specialization);
  const Module vertex(device, desc.vertex_shader);
  std::vector<VkPipelineShaderStageCreateInfo> stages{
      vertex.stage(VK_SHADER_STAGE_VERTEX_BIT, &specialization.info)};
  std::vector<std::unique_ptr<Module>> fragment;
  if (!desc.fragment_shader.empty()) {
    fragment.push_back(std::make_unique<Module>(device, desc.fragment_shader));
    stages.push_back(fragment[0]->stage(VK_SHADER_STAGE_FRAGMENT_BIT, &specialization.info));
  }

  const VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.cullMode = desc.cull;
  raster.frontFace = desc.front_face;
  raster.depthBiasEnable = desc.depth_bias_constant != 0.0f || desc.depth_bias_slope != 0.0f;
  raster.depthBiasConstantFactor = desc.depth_bias_constant;
  raster.depthBiasSlopeFactor = desc.depth_bias_slope;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo multisample{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  multisample.rasterizationSamples = desc.samples;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = desc.depth_format != VK_FORMAT_UNDEFINED;
  depth.depthWriteEnable = desc.depth_write;
  depth.depthCompareOp = desc.depth_compare;
  VkPipelineColorBlendAttachmentState attachment{};
  attachment.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                              VK_COLOR_COMPONENT_A_BIT;
  if (desc.multiply) {
    attachment.blendEnable = VK_TRUE;
    attachment.srcColorBlendFactor = attachment.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
    attachment.dstColorBlendFactor = VK_BLEND_FACTOR_SRC_COLOR;
    attachment.dstAlphaBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
  }
  const std::vector<VkPipelineColorBlendAttachmentState> attachments(desc.color_formats.size(), attachment);
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = states;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = static_cast<uint32_t>(desc.color_formats.size());
  rendering.pColorAttachmentFormats = desc.color_formats.data();
  rendering.depthAttachmentFormat = desc.depth_format;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &multisample;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline made = VK_NULL_HANDLE;
  GREATX_VK(vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info, nullptr, &made));
  return made;
}

/// Some drivers crash beyond their limit (lavapipe of Mesa 22.3 with 35 samplers of 32).
void check_samplers(const Device& device, std::span<const Binding> bindings, const TextureTable* textures) {
  const auto own = std::ranges::count(bindings, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, &Binding::type);
  const auto samplers = static_cast<uint32_t>(own) + (textures != nullptr ? textures->count() : 0);
  if (samplers > device.limits().maxPerStageDescriptorSamplers)
    throw_user_error("a shader reads {} textures, '{}' lets it read {} (maxPerStageDescriptorSamplers)",
                     samplers, device.info().name, device.limits().maxPerStageDescriptorSamplers);
}

/// Describes what both kinds of pipeline have: the layout and the constants.
template <typename Desc>
std::string common_text(const Desc& desc) {
  std::string text = fmt::format("push {} constants {} bindings", desc.push_constant_bytes,
                                 fmt::join(desc.specialization, ","));
  for (const Binding& binding : desc.bindings)
    text += fmt::format(" {}:{}", binding.slot, static_cast<int>(binding.type));
  if (desc.textures != nullptr)
    text += fmt::format(" {} textures {}", desc.textures->count(), desc.textures->few() ? "few" : "many");
  return text;
}

std::string text_of(const ComputeDesc& desc) {
  return fmt::format("compute {} {}", desc.shader, common_text(desc));
}

std::string text_of(const GraphicsDesc& desc) {
  std::string text =
      fmt::format("graphics {} + {} {} colours", desc.vertex_shader, desc.fragment_shader, common_text(desc));
  for (const VkFormat format : desc.color_formats) text += fmt::format(" {}", static_cast<int>(format));
  return text + fmt::format(" depth {} {} {} samples {} cull {} {} multiply {} bias {} {}",
                            static_cast<int>(desc.depth_format), static_cast<int>(desc.depth_compare),
                            desc.depth_write, static_cast<int>(desc.samples), desc.cull,
                            static_cast<int>(desc.front_face), desc.multiply, desc.depth_bias_constant,
                            desc.depth_bias_slope);
}

/// Replaces a layout that was just made by a kept pipeline of the same description, with its layouts. Returns
/// null if there is none; the pipeline that is to be built is then known to the keeper of the device, if it
/// has one.
template <typename Desc>
VkPipeline take_kept(Device& device, const Desc& desc, std::string_view name, VkPipelineLayout& layout,
                     VkDescriptorSetLayout& set_layout) {
  KeptPipelines* const keeper = KeptPipelines::of(device);
  if (keeper == nullptr) return VK_NULL_HANDLE;
  std::string text = text_of(desc);
  const std::optional<KeptPipeline> kept = keeper->take(text);
  if (!kept) {
    keeper->describe(layout, std::move(text));
    return VK_NULL_HANDLE;
  }
  destroy(device, {VK_NULL_HANDLE, layout, set_layout});
  layout = kept->layout;
  set_layout = kept->set_layout;
  ++device.counters().pipelines_built;
  device.counters().pipelines.emplace_back(name);
  device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(kept->pipeline), name);
  return kept->pipeline;
}

}  // namespace

std::span<const uint32_t> spirv(std::string_view name) {
  for (const SpirvModule& module : spirv_modules())
    if (module.name == name) return module.words;
  throw ContractError(fmt::format("no embedded shader is called '{}'", name));
}

TextureTable::TextureTable(Device& device, std::span<const VkDescriptorImageInfo> textures, bool few,
                           std::string_view name)
    : device_(&device), few_(few) {
  std::vector<VkDescriptorImageInfo> images(textures.begin(), textures.end());
  if (few) {
    GREATX_CHECK(!images.empty() && images.size() <= shared::most_tried_arrays, "{} textures", images.size());
    images.resize(shared::most_tried_arrays, images[0]);
  }
  const uint32_t count = std::max<uint32_t>(1, static_cast<uint32_t>(images.size()));
  count_ = count;
  const VkDescriptorBindingFlags partially = VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT;
  VkDescriptorSetLayoutBindingFlagsCreateInfo flags{
      VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO};
  flags.bindingCount = 1;
  flags.pBindingFlags = &partially;
  const VkDescriptorSetLayoutBinding binding{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count,
                                             VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT,
                                             nullptr};
  VkDescriptorSetLayoutCreateInfo layout{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  if (!few) layout.pNext = &flags;
  layout.bindingCount = 1;
  layout.pBindings = &binding;
  GREATX_VK(vkCreateDescriptorSetLayout(device.handle(), &layout, nullptr, &layout_));

  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, count};
  VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool.maxSets = 1;
  pool.poolSizeCount = 1;
  pool.pPoolSizes = &size;
  GREATX_VK(vkCreateDescriptorPool(device.handle(), &pool, nullptr, &pool_));
  VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  allocate.descriptorPool = pool_;
  allocate.descriptorSetCount = 1;
  allocate.pSetLayouts = &layout_;
  GREATX_VK(vkAllocateDescriptorSets(device.handle(), &allocate, &set_));
  device.set_name(VK_OBJECT_TYPE_DESCRIPTOR_SET, reinterpret_cast<uint64_t>(set_), name);
  if (images.empty()) return;
  VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
  write.dstSet = set_;
  write.descriptorCount = static_cast<uint32_t>(images.size());
  write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  write.pImageInfo = images.data();
  vkUpdateDescriptorSets(device.handle(), 1, &write, 0, nullptr);
}

TextureTable::~TextureTable() {
  if (layout_ == VK_NULL_HANDLE) return;
  device_->finish();
  vkDestroyDescriptorPool(device_->handle(), pool_, nullptr);
  vkDestroyDescriptorSetLayout(device_->handle(), layout_, nullptr);
}
TextureTable::TextureTable(TextureTable&& other) noexcept { *this = std::move(other); }
TextureTable& TextureTable::operator=(TextureTable&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(few_, other.few_);
  std::swap(count_, other.count_);
  std::swap(layout_, other.layout_);
  std::swap(pool_, other.pool_);
  std::swap(set_, other.set_);
  return *this;
}

void Pipeline::create_layout(Device& device, std::span<const Binding> bindings, uint32_t push_bytes,
                             const TextureTable* textures, VkShaderStageFlags stages) {
  GREATX_CHECK(push_bytes <= 128, "{} bytes of push constants", push_bytes);
  GREATX_CHECK(bindings.size() <= most_push_descriptors, "{} push descriptors", bindings.size());
  check_samplers(device, bindings, textures);
  device_ = &device;
  stages_ = stages;
  push_bytes_ = push_bytes;
  std::vector<VkDescriptorSetLayoutBinding> slots;
  for (const Binding& binding : bindings) slots.push_back({binding.slot, binding.type, 1, stages, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<uint32_t>(slots.size());
  set.pBindings = slots.data();
  GREATX_VK(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &set_layout_));

  const VkDescriptorSetLayout layouts[] = {set_layout_,
                                           textures != nullptr ? textures->layout() : VK_NULL_HANDLE};
  const VkPushConstantRange range{stages, 0, push_bytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = textures != nullptr ? 2 : 1;
  info.pSetLayouts = layouts;
  info.pushConstantRangeCount = push_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  GREATX_VK(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout_));
  if (textures != nullptr) texture_set_ = textures->set();
}

void Pipeline::begin_build(std::string_view name, std::function<VkPipeline()> make) {
  ++device_->counters().pipelines_built;
  device_->counters().pipelines.emplace_back(name);
  build_ =
      std::make_shared<PipelineBuild>([device = device_, name = std::string(name), make = std::move(make)] {
        const VkPipeline made = make();
        device->set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(made), name);
        return made;
      });
  device_->pipeline_builds().add(build_);
}

VkPipeline Pipeline::handle() const {
  if (build_ == nullptr) return pipeline_;
  pipeline_ = build_->get();
  build_ = nullptr;
  return pipeline_;
}

Pipeline::~Pipeline() {
  if (device_ == nullptr) return;
  if (build_ != nullptr) pipeline_ = build_->give_up();
  device_->finish();
  const KeptPipeline own{pipeline_, layout_, set_layout_};
  if (KeptPipelines* const keeper = KeptPipelines::of(*device_))
    keeper->give(own);
  else
    destroy(*device_, own);
}
Pipeline::Pipeline(Pipeline&& other) noexcept { *this = std::move(other); }
Pipeline& Pipeline::operator=(Pipeline&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(build_, other.build_);
  std::swap(pipeline_, other.pipeline_);
  std::swap(layout_, other.layout_);
  std::swap(set_layout_, other.set_layout_);
  std::swap(texture_set_, other.texture_set_);
  std::swap(bind_point_, other.bind_point_);
  std::swap(stages_, other.stages_);
  std::swap(push_bytes_, other.push_bytes_);
  return *this;
}

ComputePipeline::ComputePipeline(Device& device, const ComputeDesc& desc, std::string_view name) {
  bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  create_layout(device, desc.bindings, desc.push_constant_bytes, desc.textures, VK_SHADER_STAGE_COMPUTE_BIT);
  const std::string shader = variant_of(desc.shader, desc.textures);
  spirv(shader);  // throws here if there is none
  pipeline_ = take_kept(device, desc, name, layout_, set_layout_);
  if (pipeline_ != VK_NULL_HANDLE) return;
  begin_build(name, [&device, shader, constants = desc.specialization, layout = layout_] {
    return make_compute(device, shader, constants, layout);
  });
}

GraphicsPipeline::GraphicsPipeline(Device& device, const GraphicsDesc& desc, std::string_view name) {
  bind_point_ = VK_PIPELINE_BIND_POINT_GRAPHICS;
  create_layout(device, desc.bindings, desc.push_constant_bytes, desc.textures, graphics_stages);
  GraphicsDesc own = desc;
  if (!own.fragment_shader.empty()) own.fragment_shader = variant_of(desc.fragment_shader, desc.textures);
  for (const std::string& shader : {own.vertex_shader, own.fragment_shader})
    if (!shader.empty()) spirv(shader);  // throws here if there is none
  pipeline_ = take_kept(device, desc, name, layout_, set_layout_);
  if (pipeline_ != VK_NULL_HANDLE) return;
  own.textures = nullptr;  // may be gone when a thread comes to the build
  begin_build(
      name, [&device, own = std::move(own), layout = layout_] { return make_graphics(device, own, layout); });
}

}  // namespace greatx::gpu
