// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes pipelines from embedded SPIR-V. Their constructors return before the driver has compiled the shaders,
// which threads of the device do (gpu/pipeline_builds.h). Set 0 holds push descriptors, which are written
// while recording. Set 1, if a pass asks for it, is a table of textures that lives as long as the scene.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/pipeline_builds.h"
#include "gpu/resources.h"

namespace greatx::gpu {

/// Returns the words of an embedded shader ("lidar/sweep.comp"), or of one of its variants
/// ("lidar/sweep.comp.tree"; cmake/GreatxShaders.cmake lists them). Throws ContractError if there is none of
/// that name.
std::span<const uint32_t> spirv(std::string_view name);

struct Binding {
  uint32_t slot = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
};

/// Represents a fixed array of combined image samplers for set 1, binding 0, visible to fragment and compute
/// shaders.
class TextureTable {
 public:
  TextureTable() = default;
  /// Images must be in ImageUse::sampled when they are used. The table may be empty; shaders then must not
  /// index it. If `few`, it has most_tried_arrays entries, those at the end the same as the first, and
  /// pipelines take the variants of shaders that know each entry by a constant index (lib/textures.glsl).
  /// `textures` then holds one image at least.
  TextureTable(Device& device, std::span<const VkDescriptorImageInfo> textures, bool few,
               std::string_view name);
  ~TextureTable();
  TextureTable(TextureTable&& other) noexcept;
  TextureTable& operator=(TextureTable&& other) noexcept;
  VkDescriptorSetLayout layout() const { return layout_; }
  VkDescriptorSet set() const { return set_; }
  bool few() const { return few_; }
  uint32_t count() const { return count_; }

 private:
  Device* device_ = nullptr;
  bool few_ = false;
  uint32_t count_ = 0;  ///< of descriptors
  VkDescriptorSetLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// Represents the common part of both kinds of pipeline.
class Pipeline {
 public:
  Pipeline() = default;
  ~Pipeline();
  Pipeline(Pipeline&& other) noexcept;
  Pipeline& operator=(Pipeline&& other) noexcept;
  /// Waits until the pipeline is built, and throws VulkanError if that fails. Only one thread at a time calls
  /// this.
  VkPipeline handle() const;
  VkPipelineLayout layout() const { return layout_; }
  VkPipelineBindPoint bind_point() const { return bind_point_; }
  VkShaderStageFlags push_constant_stages() const { return stages_; }
  uint32_t push_constant_bytes() const { return push_bytes_; }
  VkDescriptorSet texture_set() const { return texture_set_; }
  explicit operator bool() const { return layout_ != VK_NULL_HANDLE; }

 protected:
  void create_layout(Device& device, std::span<const Binding> bindings, uint32_t push_bytes,
                     const TextureTable* textures, VkShaderStageFlags stages);
  /// Counts the pipeline and has `make` called once, on any thread. `make` outlives this object.
  void begin_build(std::string_view name, std::function<VkPipeline()> make);

  Device* device_ = nullptr;
  mutable std::shared_ptr<PipelineBuild> build_;  ///< null once handle() has taken the pipeline
  mutable VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkDescriptorSet texture_set_ = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point_ = VK_PIPELINE_BIND_POINT_COMPUTE;
  VkShaderStageFlags stages_ = 0;
  uint32_t push_bytes_ = 0;
};

struct ComputeDesc {
  std::string shader;                ///< "folder/name.comp"
  std::vector<Binding> bindings;     ///< bindings of set 0
  uint32_t push_constant_bytes = 0;  ///< at most 128
  /// Values of constant_id 0, 1, 2, ... (bool: 0 or 1; float: its bits).
  std::vector<uint32_t> specialization;
  const TextureTable* textures = nullptr;
};

class ComputePipeline : public Pipeline {
 public:
  ComputePipeline() = default;
  ComputePipeline(Device& device, const ComputeDesc& desc, std::string_view name);
};

struct GraphicsDesc {
  std::string vertex_shader;    ///< vertices are pulled from buffers: there is no vertex input state
  std::string fragment_shader;  ///< empty: depth only
  std::vector<Binding> bindings;
  uint32_t push_constant_bytes = 0;
  std::vector<uint32_t> specialization;  ///< the same for both stages
  const TextureTable* textures = nullptr;
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  /// Front faces wind counter-clockwise in clip space as Vulkan sees it.
  VkCullModeFlags cull = VK_CULL_MODE_NONE;
  VkFrontFace front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;  ///< reversed depth
  bool depth_write = true;
  bool multiply = false;  ///< colours are multiplied onto those of the targets instead of replacing them
  float depth_bias_constant = 0.0f, depth_bias_slope = 0.0f;
};

/// Viewport and scissor are dynamic; Cmd::begin_rendering sets them.
class GraphicsPipeline : public Pipeline {
 public:
  GraphicsPipeline() = default;
  GraphicsPipeline(Device& device, const GraphicsDesc& desc, std::string_view name);
};

}  // namespace greatx::gpu
