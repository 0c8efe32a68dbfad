// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The triangles of a user interface, and the pipeline that draws them.
#pragma once

#include <cstdint>
#include <vector>

#include "gpu/present/present_device.h"

namespace greatx::gpu {

/// Names a texture of a Presenter.
using PresentTextureId = uint32_t;

struct UiVertex {
  float x = 0, y = 0;  ///< pixels of the window
  float u = 0, v = 0;
  uint32_t rgba = 0;  ///< R in the lowest byte, sRGB
};

/// Draws some of the triangles, cut off outside a rectangle.
struct UiCommand {
  VkRect2D clip{};
  PresentTextureId texture = 0;
  uint32_t first_index = 0, index_count = 0;
  uint32_t first_vertex = 0;  ///< is added to the indices
};

/// Everything that a frame draws, in order. Later triangles cover earlier ones.
struct UiDrawing {
  std::vector<UiVertex> vertices;
  std::vector<uint16_t> indices;
  std::vector<UiCommand> commands;
};

/// Owns the pipeline, the sampler and the descriptor sets of textures.
class UiPipeline {
 public:
  static constexpr uint32_t most_textures = 512;

  UiPipeline(const PresentDevice& device, VkRenderPass render_pass);
  ~UiPipeline();
  UiPipeline(const UiPipeline&) = delete;
  UiPipeline& operator=(const UiPipeline&) = delete;

  /// Throws UserError if there are most_textures already.
  VkDescriptorSet make_set(VkImageView view);
  void free_set(VkDescriptorSet set);
  void begin(VkCommandBuffer cmd, VkExtent2D extent) const;
  void bind(VkCommandBuffer cmd, VkDescriptorSet set) const;

 private:
  void make_layouts();
  void make_pipeline(VkRenderPass render_pass);

  const PresentDevice& device_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout_ = VK_NULL_HANDLE;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
  VkDescriptorPool pool_ = VK_NULL_HANDLE;
  uint32_t sets_ = 0;
};

}  // namespace greatx::gpu
