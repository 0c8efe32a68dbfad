// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/cmd.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "gpu/capabilities.h"

namespace greatx::gpu {

namespace {

struct UseInfo {
  VkImageLayout layout;
  Sync sync;
};

UseInfo info_of(ImageUse use) {
  constexpr VkPipelineStageFlags2 shaders =
      VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  switch (use) {
    case ImageUse::undefined:
      return {VK_IMAGE_LAYOUT_UNDEFINED, sync::none};
    case ImageUse::color_target:
      return {VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
              {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
               VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT}};
    case ImageUse::depth_target:
      return {
          VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
          {VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
           VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT}};
    case ImageUse::sampled:
      return {VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, {shaders, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT}};
    case ImageUse::storage:
      return {VK_IMAGE_LAYOUT_GENERAL,
              {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
               VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT}};
    case ImageUse::transfer_source:
      return {VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, sync::transfer_read};
    case ImageUse::transfer_target:
      return {VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, sync::transfer_write};
  }
  throw ContractError("unknown use of an image");
}

VkImageMemoryBarrier2 image_barrier(const Image& image, const UseInfo& from, const UseInfo& to, uint32_t mip,
                                    uint32_t mip_count) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.sync.stage;
  barrier.srcAccessMask = from.sync.access;
  barrier.dstStageMask = to.sync.stage;
  barrier.dstAccessMask = to.sync.access;
  barrier.oldLayout = from.layout;
  barrier.newLayout = to.layout;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle();
  barrier.subresourceRange = {image.aspect(), mip, mip_count, 0, image.layers()};
  return barrier;
}

void pipeline_barrier(VkCommandBuffer cmd, const VkImageMemoryBarrier2& barrier) {
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(cmd, &info);
}

VkBufferImageCopy whole_mip(const Image& image, VkDeviceSize offset, uint32_t mip) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {image.aspect(), mip, 0, image.layers()};
  region.imageExtent = {std::max(1u, image.desc().width >> mip), std::max(1u, image.desc().height >> mip), 1};
  return region;
}

}  // namespace

GroupGrid group_grid(uint64_t groups) {
  constexpr uint64_t most = 65535;
  const uint64_t rows = (groups + most - 1) / most;
  GREATX_CHECK(rows <= most, "{} groups, expected at most {}", groups, most * most);
  if (rows == 0) return {};
  return {static_cast<uint32_t>((groups + rows - 1) / rows), static_cast<uint32_t>(rows)};
}

Descriptor Descriptor::buffer(uint32_t slot, const Slice& slice) {
  Descriptor descriptor;
  descriptor.slot = slot;
  descriptor.type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  descriptor.buffer_info = {slice.buffer, slice.offset, slice.size};
  return descriptor;
}

Descriptor Descriptor::sampled(uint32_t slot, const Image& image, const Sampler& sampler) {
  Descriptor descriptor;
  descriptor.slot = slot;
  descriptor.type = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  descriptor.image_info = {sampler.handle(), image.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  return descriptor;
}

Descriptor Descriptor::storage(uint32_t slot, const Image& image) {
  Descriptor descriptor;
  descriptor.slot = slot;
  descriptor.type = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
  descriptor.image_info = {VK_NULL_HANDLE, image.view(), VK_IMAGE_LAYOUT_GENERAL};
  return descriptor;
}

Descriptor Descriptor::acceleration(uint32_t slot, const AccelerationStructure& structure) {
  Descriptor descriptor;
  descriptor.slot = slot;
  descriptor.type = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR;
  descriptor.structure = structure.handle();
  return descriptor;
}

Cmd::Scope::Scope(Cmd& cmd, std::string_view name) : cmd_(cmd), index_(~0u) {
  ++cmd.device_->counters().passes;
  if (const auto begin = cmd.device_->functions().begin_label; begin != nullptr) {
    const std::string text(name);
    VkDebugUtilsLabelEXT label{VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT};
    label.pLabelName = text.c_str();
    begin(cmd.handle_, &label);
  }
  Timestamps* stamps = cmd.timestamps_;
  if (stamps == nullptr) return;
  // The scope is labelled and counted, but not timed.
  if (stamps->names_.size() >= stamps->max_scopes_) return;
  index_ = static_cast<uint32_t>(stamps->names_.size());
  stamps->names_.emplace_back(name);
  vkCmdWriteTimestamp2(cmd.handle_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, stamps->pool_, 2 * index_);
}

Cmd::Scope::~Scope() {
  if (index_ != ~0u)
    vkCmdWriteTimestamp2(cmd_.handle_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, cmd_.timestamps_->pool_,
                         2 * index_ + 1);
  if (const auto end = cmd_.device_->functions().end_label; end != nullptr) end(cmd_.handle_);
}

void Cmd::barrier(const Sync& from, const Sync& to) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(handle_, &info);
}

void Cmd::transition(Image& image, ImageUse use, bool discard) {
  UseInfo from = info_of(image.use_);
  if (discard) from.layout = VK_IMAGE_LAYOUT_UNDEFINED;
  pipeline_barrier(handle_, image_barrier(image, from, info_of(use), 0, image.desc_.mip_levels));
  image.use_ = use;
}

void Cmd::bind(const Pipeline& pipeline) {
  vkCmdBindPipeline(handle_, pipeline.bind_point(), pipeline.handle());
  if (pipeline.texture_set() != VK_NULL_HANDLE) {
    const VkDescriptorSet set = pipeline.texture_set();
    vkCmdBindDescriptorSets(handle_, pipeline.bind_point(), pipeline.layout(), 1, 1, &set, 0, nullptr);
  }
  bound_ = &pipeline;
}

void Cmd::push(std::span<const Descriptor> descriptors) {
  GREATX_CHECK(descriptors.size() <= most_push_descriptors, "{} descriptors", descriptors.size());
  std::array<VkWriteDescriptorSet, most_push_descriptors> writes{};
  std::array<VkWriteDescriptorSetAccelerationStructureKHR, most_push_descriptors> structures{};
  for (size_t i = 0; i < descriptors.size(); ++i) {
    check_range(descriptors[i]);
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstBinding = descriptors[i].slot;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = descriptors[i].type;
    writes[i].pBufferInfo = &descriptors[i].buffer_info;
    writes[i].pImageInfo = &descriptors[i].image_info;
    if (descriptors[i].structure != VK_NULL_HANDLE) {
      structures[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR, nullptr, 1,
                       &descriptors[i].structure};
      writes[i].pNext = &structures[i];
    }
  }
  device_->functions().push_descriptor_set(handle_, bound_->bind_point(), bound_->layout(), 0,
                                           static_cast<uint32_t>(descriptors.size()), writes.data());
}

void Cmd::check_range(const Descriptor& descriptor) const {
  const VkDeviceSize most = device_->limits().maxStorageBufferRange;
  if (descriptor.type != VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || descriptor.buffer_info.range <= most) return;
  throw_user_error("'{}' needs {} bytes; device '{}' lets a shader see {} bytes of a buffer at most",
                   device_->name_of_large(descriptor.buffer_info.buffer), descriptor.buffer_info.range,
                   device_->info().name, most);
}

void Cmd::push_constants(const void* data, uint32_t bytes) {
  GREATX_CHECK(bytes == bound_->push_constant_bytes(), "{} bytes of push constants for a pipeline with {}",
               bytes, bound_->push_constant_bytes());
  vkCmdPushConstants(handle_, bound_->layout(), bound_->push_constant_stages(), 0, bytes, data);
}

void Cmd::dispatch(uint32_t x, uint32_t y, uint32_t z) {
  const uint32_t* most = device_->limits().maxComputeWorkGroupCount;
  GREATX_CHECK(x <= most[0] && y <= most[1] && z <= most[2],
               "{} x {} x {} groups, the device takes {} x {} x {}", x, y, z, most[0], most[1], most[2]);
  vkCmdDispatch(handle_, x, y, z);
  ++device_->counters().dispatches;
}

void Cmd::dispatch_linear(uint64_t invocations, uint32_t group_size) {
  if (invocations == 0) return;
  const GroupGrid grid = group_grid((invocations + group_size - 1) / group_size);
  GREATX_CHECK(uint64_t{grid.x} * grid.y * group_size <= uint64_t{1} << 32,
               "{} invocations: their numbers have 32 bits", invocations);
  dispatch(grid.x, grid.y);
}

void Cmd::bind_indices(const Buffer& buffer) {
  vkCmdBindIndexBuffer(handle_, buffer.handle(), 0, VK_INDEX_TYPE_UINT32);
}

void Cmd::draw_range(uint32_t first_vertex, uint32_t vertices, uint32_t first_instance) {
  vkCmdDraw(handle_, vertices, 1, first_vertex, first_instance);
  ++device_->counters().draws;
}

void Cmd::draw_indexed(uint32_t first_index, uint32_t index_count, uint32_t first_instance) {
  vkCmdDrawIndexed(handle_, index_count, 1, first_index, 0, first_instance);
  ++device_->counters().draws;
}

void Cmd::begin_rendering(const RenderTargets& targets) {
  std::vector<VkRenderingAttachmentInfo> color;
  for (const ColorTarget& target : targets.color) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = target.image->view();
    info.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    info.clearValue.color = target.clear;
    color.push_back(info);
  }
  VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (targets.depth != nullptr) {
    depth.imageView = targets.depth->view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = targets.keep_depth ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth.clearValue.depthStencil = {targets.clear_depth, 0};
  }
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea = {{0, 0}, {targets.width, targets.height}};
  info.layerCount = 1;
  info.colorAttachmentCount = static_cast<uint32_t>(color.size());
  info.pColorAttachments = color.data();
  info.pDepthAttachment = targets.depth != nullptr ? &depth : nullptr;
  vkCmdBeginRendering(handle_, &info);
  const VkViewport viewport{0.0f, 0.0f, static_cast<float>(targets.width), static_cast<float>(targets.height),
                            0.0f, 1.0f};
  vkCmdSetViewport(handle_, 0, 1, &viewport);
  vkCmdSetScissor(handle_, 0, 1, &info.renderArea);
}

void Cmd::clear_depth(std::span<const VkRect2D> parts, float value) {
  if (parts.empty()) return;
  VkClearAttachment attachment{};
  attachment.aspectMask = VK_IMAGE_ASPECT_DEPTH_BIT;
  attachment.clearValue.depthStencil = {value, 0};
  std::vector<VkClearRect> rects;
  rects.reserve(parts.size());
  for (const VkRect2D& part : parts) rects.push_back({part, 0, 1});
  vkCmdClearAttachments(handle_, 1, &attachment, static_cast<uint32_t>(rects.size()), rects.data());
}

void Cmd::viewport(const VkRect2D& part) {
  const VkViewport viewport{static_cast<float>(part.offset.x),
                            static_cast<float>(part.offset.y),
                            static_cast<float>(part.extent.width),
                            static_cast<float>(part.extent.height),
                            0.0f,
                            1.0f};
  vkCmdSetViewport(handle_, 0, 1, &viewport);
  vkCmdSetScissor(handle_, 0, 1, &part);
}

void Cmd::viewport(uint32_t x, uint32_t y, uint32_t size) {
  viewport({{static_cast<int32_t>(x), static_cast<int32_t>(y)}, {size, size}});
}

void Cmd::end_rendering() { vkCmdEndRendering(handle_); }

void Cmd::copy(const Slice& from, const Slice& to) {
  GREATX_CHECK(from.size <= to.size, "copy of {} bytes into {}", from.size, to.size);
  const VkBufferCopy region{from.offset, to.offset, from.size};
  vkCmdCopyBuffer(handle_, from.buffer, to.buffer, 1, &region);
}

void Cmd::copy(const Slice& from, const Image& to, uint32_t mip) {
  const VkBufferImageCopy region = whole_mip(to, from.offset, mip);
  vkCmdCopyBufferToImage(handle_, from.buffer, to.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void Cmd::copy_square(const Image& from, const Image& to, uint32_t x, uint32_t y, uint32_t size) {
  VkImageCopy region{};
  region.srcSubresource = {from.aspect(), 0, 0, 1};
  region.dstSubresource = {to.aspect(), 0, 0, 1};
  region.srcOffset = region.dstOffset = {static_cast<int32_t>(x), static_cast<int32_t>(y), 0};
  region.extent = {size, size, 1};
  vkCmdCopyImage(handle_, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(),
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void Cmd::fill(const Slice& slice, uint32_t word) {
  vkCmdFillBuffer(handle_, slice.buffer, slice.offset, slice.size, word);
}

void Cmd::generate_mipmaps(Image& image) {
  GREATX_CHECK(image.use_ == ImageUse::transfer_target, "mipmaps of an image that is not a transfer target");
  const UseInfo target = info_of(ImageUse::transfer_target), source = info_of(ImageUse::transfer_source);
  const auto extent = [&](uint32_t mip) {
    return VkOffset3D{static_cast<int32_t>(std::max(1u, image.desc_.width >> mip)),
                      static_cast<int32_t>(std::max(1u, image.desc_.height >> mip)), 1};
  };
  for (uint32_t mip = 1; mip < image.desc_.mip_levels; ++mip) {
    pipeline_barrier(handle_, image_barrier(image, target, source, mip - 1, 1));
    VkImageBlit blit{};
    blit.srcSubresource = {image.aspect(), mip - 1, 0, image.layers()};
    blit.srcOffsets[1] = extent(mip - 1);
    blit.dstSubresource = {image.aspect(), mip, 0, image.layers()};
    blit.dstOffsets[1] = extent(mip);
    vkCmdBlitImage(handle_, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.handle(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
  }
  const UseInfo sampled = info_of(ImageUse::sampled);
  const uint32_t last = image.desc_.mip_levels - 1;
  if (last > 0) pipeline_barrier(handle_, image_barrier(image, source, sampled, 0, last));
  pipeline_barrier(handle_, image_barrier(image, target, sampled, last, 1));
  image.use_ = ImageUse::sampled;
}

}  // namespace greatx::gpu
