// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/present/presenter.h"

#include <algorithm>
#include <cstring>
#include <ranges>
#include <utility>

#include "core/error.h"

namespace greatx::gpu {

namespace {

void begin(VkCommandBuffer cmd) {
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GREATX_VK(vkBeginCommandBuffer(cmd, &info));
}

VkBufferImageCopy whole(VkExtent2D extent) {
  VkBufferImageCopy copy{};
  copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  copy.imageExtent = {extent.width, extent.height, 1};
  return copy;
}

}  // namespace

Presenter::Presenter(const PresentDevice& device, const Surface* surface, PresentFaults& faults)
    : device_(device), faults_(faults) {
  make_render_pass();
  pipeline_ = std::make_unique<UiPipeline>(device_, render_pass_);
  for (Frame& frame : frames_) make_frame(frame);
  if (surface != nullptr) swapchain_ = std::make_unique<Swapchain>(device_, *surface, faults);
}

Presenter::~Presenter() {
  device_.wait_idle();
  swapchain_.reset();
  pipeline_.reset();
  for (Frame& frame : frames_) {
    vkDestroySemaphore(device_.handle(), frame.acquired, nullptr);
    vkDestroyFence(device_.handle(), frame.done, nullptr);
    vkDestroyCommandPool(device_.handle(), frame.pool, nullptr);
  }
  vkDestroyFramebuffer(device_.handle(), framebuffer_, nullptr);
  vkDestroyRenderPass(device_.handle(), render_pass_, nullptr);
}

void Presenter::make_render_pass() {
  VkAttachmentDescription color{};
  color.format = PresentImage::format;
  color.samples = VK_SAMPLE_COUNT_1_BIT;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  color.initialLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  color.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &reference;
  // Before: the drawing and the copy of the frame before, and the copies into textures. After: the copy out.
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, VK_PIPELINE_STAGE_TRANSFER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
       VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT,
       VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT,
       VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_SHADER_READ_BIT,
       0},
      {0, VK_SUBPASS_EXTERNAL, VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT,
       VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT, 0}};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 1;
  info.pAttachments = &color;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  GREATX_VK(vkCreateRenderPass(device_.handle(), &info, nullptr, &render_pass_));
}

void Presenter::make_frame(Frame& frame) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device_.queue_family();
  GREATX_VK(vkCreateCommandPool(device_.handle(), &pool, nullptr, &frame.pool));
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = frame.pool;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  GREATX_VK(vkAllocateCommandBuffers(device_.handle(), &allocate, &frame.cmd));
  VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
  GREATX_VK(vkCreateFence(device_.handle(), &fence, nullptr, &frame.done));
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  GREATX_VK(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, &frame.acquired));
}

void Presenter::fit_canvas(VkExtent2D extent) {
  if (canvas_ && canvas_->extent().width == extent.width && canvas_->extent().height == extent.height) return;
  device_.wait_idle();
  vkDestroyFramebuffer(device_.handle(), framebuffer_, nullptr);
  framebuffer_ = VK_NULL_HANDLE;
  canvas_ = std::make_unique<PresentImage>(
      device_, extent, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  canvas_is_new_ = true;
  changes_.forget();
  const VkImageView view = canvas_->view();
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = render_pass_;
  info.attachmentCount = 1;
  info.pAttachments = &view;
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  GREATX_VK(vkCreateFramebuffer(device_.handle(), &info, nullptr, &framebuffer_));
}

/// Makes the buffer larger if it has less than `bytes`.
void Presenter::fit(std::unique_ptr<PresentBuffer>& buffer, VkDeviceSize bytes, VkBufferUsageFlags usage) {
  if (!buffer || buffer->mapped().size() < bytes)
    buffer = std::make_unique<PresentBuffer>(device_, bytes + bytes / 2, usage);
}

void Presenter::record_updates(Frame& frame) {
  VkDeviceSize bytes = 0;
  for (const auto& [id, texture] : textures_)
    if (texture.pending) bytes += texture.texels.size();
  if (bytes == 0) return;
  fit(frame.staging, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  VkDeviceSize offset = 0;
  for (auto& [id, texture] : textures_) {
    if (!std::exchange(texture.pending, false)) continue;
    std::memcpy(frame.staging->mapped().data() + offset, texture.texels.data(), texture.texels.size());
    const VkImage image = texture.image->handle();
    change_layout(frame.cmd, image,
                  texture.shown ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy = whole(texture.image->extent());
    copy.bufferOffset = std::exchange(offset, offset + texture.texels.size());
    vkCmdCopyBufferToImage(frame.cmd, frame.staging->handle(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    change_layout(frame.cmd, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    texture.shown = true;
  }
}

void Presenter::record_drawing(Frame& frame, VkExtent2D extent, const UiDrawing& drawing) {
  const std::vector<VkRect2D> parts = changes_.update(
      extent, drawing, [this](PresentTextureId texture) { return textures_.at(texture).version; });
  if (parts.empty()) return;
  if (std::exchange(canvas_is_new_, false))
    change_layout(frame.cmd, canvas_->handle(), VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  VkRenderPassBeginInfo pass{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  pass.renderPass = render_pass_;
  pass.framebuffer = framebuffer_;
  pass.renderArea.extent = extent;
  vkCmdBeginRenderPass(frame.cmd, &pass, VK_SUBPASS_CONTENTS_INLINE);
  bind_triangles(frame, extent, drawing);
  for (const VkRect2D& part : parts) record_part(frame, part, drawing);
  vkCmdEndRenderPass(frame.cmd);
}

void Presenter::bind_triangles(Frame& frame, VkExtent2D extent, const UiDrawing& drawing) {
  if (drawing.indices.empty()) return;
  const VkDeviceSize vertex_bytes = drawing.vertices.size() * sizeof(UiVertex);
  const VkDeviceSize index_bytes = drawing.indices.size() * sizeof(uint16_t);
  fit(frame.vertices, vertex_bytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  fit(frame.indices, index_bytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  std::memcpy(frame.vertices->mapped().data(), drawing.vertices.data(), vertex_bytes);
  std::memcpy(frame.indices->mapped().data(), drawing.indices.data(), index_bytes);
  const VkBuffer vertices = frame.vertices->handle();
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(frame.cmd, 0, 1, &vertices, &offset);
  vkCmdBindIndexBuffer(frame.cmd, frame.indices->handle(), 0, VK_INDEX_TYPE_UINT16);
  pipeline_->begin(frame.cmd, extent);
}

/// Tells whether the command is an opaque picture that hides all that was drawn before in the part.
bool Presenter::covers(const UiCommand& command, const UiDrawing& drawing, const VkRect2D& part) const {
  if (command.index_count != 6 || !textures_.at(command.texture).opaque) return false;
  const std::optional<VkRect2D> quad = opaque_quad(command, drawing);
  return quad && same_rect(intersection(intersection(*quad, command.clip), part), part);
}

/// Draws all that can be seen in a part of the picture.
void Presenter::record_part(Frame& frame, const VkRect2D& part, const UiDrawing& drawing) {
  const auto cover = std::find_if(drawing.commands.rbegin(), drawing.commands.rend(),
                                  [&](const UiCommand& command) { return covers(command, drawing, part); });
  if (cover == drawing.commands.rend()) {
    const VkClearAttachment black{VK_IMAGE_ASPECT_COLOR_BIT, 0, {}};
    const VkClearRect rect{part, 0, 1};
    vkCmdClearAttachments(frame.cmd, 1, &black, 1, &rect);
  }
  const auto first = cover == drawing.commands.rend() ? drawing.commands.begin() : cover.base() - 1;
  PresentTextureId bound = 0;
  for (const UiCommand& command : std::ranges::subrange(first, drawing.commands.end())) {
    const VkRect2D clip = intersection(command.clip, part);
    if (clip.extent.width == 0 || clip.extent.height == 0) continue;
    if (command.texture != bound) pipeline_->bind(frame.cmd, textures_.at(command.texture).set);
    bound = command.texture;
    vkCmdSetScissor(frame.cmd, 0, 1, &clip);
    vkCmdDrawIndexed(frame.cmd, command.index_count, 1, command.first_index,
                     static_cast<int32_t>(command.first_vertex), 0);
  }
}

void Presenter::record_copy(Frame& frame, uint32_t image) {
  const VkImage target = swapchain_->image(image);
  change_layout(frame.cmd, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const auto corner = [](VkExtent2D extent) {
    return VkOffset3D{static_cast<int32_t>(extent.width), static_cast<int32_t>(extent.height), 1};
  };
  VkImageBlit blit{};
  blit.srcSubresource = blit.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  blit.srcOffsets[1] = corner(canvas_->extent());
  blit.dstOffsets[1] = corner(swapchain_->extent());
  vkCmdBlitImage(frame.cmd, canvas_->handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_NEAREST);
  change_layout(frame.cmd, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
}

void Presenter::submit(Frame& frame, std::optional<uint32_t> image) {
  GREATX_VK(vkEndCommandBuffer(frame.cmd));
  const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  const VkSemaphore rendered = image ? swapchain_->rendered(*image) : VK_NULL_HANDLE;
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &frame.cmd;
  if (image) {
    submit.waitSemaphoreCount = submit.signalSemaphoreCount = 1;
    submit.pWaitSemaphores = &frame.acquired;
    submit.pWaitDstStageMask = &stage;
    submit.pSignalSemaphores = &rendered;
  }
  GREATX_VK(vkResetFences(device_.handle(), 1, &frame.done));
  check_vk(faults_.take({VK_ERROR_DEVICE_LOST}), "vkQueueSubmit, on purpose");
  GREATX_VK(vkQueueSubmit(device_.queue(), 1, &submit, frame.done));
}

void Presenter::frame(VkExtent2D extent, const UiDrawing& drawing) {
  if (extent.width == 0 || extent.height == 0) return;
  faults_.begin_frame();
  Frame& frame = frames_[frame_ % frames_in_flight];
  GREATX_VK(vkWaitForFences(device_.handle(), 1, &frame.done, VK_TRUE, UINT64_MAX));
  sweep();
  fit_canvas(extent);
  const std::optional<uint32_t> image =
      swapchain_ ? swapchain_->acquire(extent, frame.acquired) : std::nullopt;

  GREATX_VK(vkResetCommandPool(device_.handle(), frame.pool, 0));
  begin(frame.cmd);
  record_updates(frame);
  record_drawing(frame, extent, drawing);
  if (image) record_copy(frame, *image);
  submit(frame, image);
  if (image) swapchain_->present(*image);
  ++frame_;
  last_extent_ = extent;
}

std::vector<std::byte> Presenter::read_back() {
  if (frame_ == 0) return {};
  device_.wait_idle();
  const PresentImage& canvas = *canvas_;
  const PresentBuffer buffer(device_, canvas.bytes(), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  // The device is idle, so any frame's command buffer is free.
  const VkCommandBuffer cmd = frames_[0].cmd;
  GREATX_VK(vkResetCommandPool(device_.handle(), frames_[0].pool, 0));
  begin(cmd);
  const VkBufferImageCopy copy = whole(canvas.extent());
  vkCmdCopyImageToBuffer(cmd, canvas.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.handle(), 1,
                         &copy);
  const VkMemoryBarrier to_host{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &to_host, 0,
                       nullptr, 0, nullptr);
  GREATX_VK(vkEndCommandBuffer(cmd));
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &cmd;
  GREATX_VK(vkQueueSubmit(device_.queue(), 1, &submit, VK_NULL_HANDLE));
  device_.wait_idle();
  return {buffer.mapped().begin(), buffer.mapped().end()};
}

Presenter::Texture Presenter::texture_of(VkExtent2D extent, bool opaque) {
  GREATX_CHECK(extent.width > 0 && extent.height > 0, "a texture of {} x {}", extent.width, extent.height);
  Texture texture;
  texture.opaque = opaque;
  texture.image = std::make_unique<PresentImage>(
      device_, extent, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  texture.set = pipeline_->make_set(texture.image->view());
  return texture;
}

PresentTextureId Presenter::make_texture(VkExtent2D extent, bool opaque) {
  textures_.emplace(next_texture_, texture_of(extent, opaque));
  return next_texture_++;
}

Presenter::AllTexels Presenter::take_texels() {
  AllTexels all;
  for (auto& [id, texture] : textures_)
    all[id] = {texture.image->extent(), texture.opaque, std::move(texture.texels)};
  return all;
}

void Presenter::restore(AllTexels all) {
  for (auto& [id, texels] : all) {
    Texture& texture = textures_.emplace(id, texture_of(texels.extent, texels.opaque)).first->second;
    texture.pending = !texels.rgba.empty();
    texture.version = ++texel_versions_;
    texture.texels = std::move(texels.rgba);
    next_texture_ = std::max(next_texture_, id + 1);
  }
}

VkExtent2D Presenter::extent_of(PresentTextureId texture) const {
  return textures_.at(texture).image->extent();
}

void Presenter::update(PresentTextureId id, std::vector<std::byte> rgba) {
  Texture& texture = textures_.at(id);
  GREATX_CHECK(rgba.size() == texture.image->bytes(), "{} bytes for a texture of {}", rgba.size(),
               texture.image->bytes());
  texture.texels = std::move(rgba);
  texture.pending = true;
  texture.version = ++texel_versions_;
}

void Presenter::drop(PresentTextureId id) {
  const auto found = textures_.find(id);
  GREATX_CHECK(found != textures_.end(), "no texture {}", id);
  dropped_.push_back({std::move(found->second), frame_ + frames_in_flight});
  textures_.erase(found);
}

void Presenter::sweep() {
  std::erase_if(dropped_, [&](const Dropped& dropped) {
    if (frame_ < dropped.after_frame) return false;
    pipeline_->free_set(dropped.texture.set);
    return true;
  });
}

}  // namespace greatx::gpu
