// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records work outside the ticks, submits it and waits for it.
#include <cstring>

#include "gpu/cmd.h"

namespace greatx::gpu {

Buffer upload_buffer(Device& device, std::span<const std::byte> bytes, std::string_view name,
                     VkBufferUsageFlags extra_usage) {
  Buffer buffer(device, bytes.size(), Memory::device, name, extra_usage);
  if (bytes.empty()) return buffer;
  const Buffer staging(device, bytes.size(), Memory::upload, "staging");
  std::memcpy(staging.slice().mapped, bytes.data(), bytes.size());
  submit_setup(device, [&](Cmd& cmd) { cmd.copy(staging.slice().part(0, bytes.size()), buffer.slice()); });
  return buffer;
}

void upload_image(Device& device, Image& image, std::span<const std::span<const std::byte>> mips) {
  std::vector<Buffer> staging;
  for (const std::span<const std::byte> texels : mips) {
    staging.emplace_back(device, texels.size(), Memory::upload, "staging");
    std::memcpy(staging.back().slice().mapped, texels.data(), texels.size());
  }
  submit_setup(device, [&](Cmd& cmd) {
    cmd.transition(image, ImageUse::transfer_target, true);
    for (uint32_t mip = 0; mip < staging.size(); ++mip) cmd.copy(staging[mip].slice(), image, mip);
    cmd.transition(image, ImageUse::sampled);
  });
}

namespace detail {

SetupSubmission::SetupSubmission(Device& device) : device_(device), cmd_(device, VK_NULL_HANDLE, nullptr) {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = device.queue_family();
  GREATX_VK(vkCreateCommandPool(device.handle(), &pool, nullptr, &pool_));
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool_;
  allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  allocate.commandBufferCount = 1;
  VkCommandBuffer handle = VK_NULL_HANDLE;
  GREATX_VK(vkAllocateCommandBuffers(device.handle(), &allocate, &handle));
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  GREATX_VK(vkCreateFence(device.handle(), &fence, nullptr, &fence_));
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GREATX_VK(vkBeginCommandBuffer(handle, &begin));
  cmd_ = Cmd(device, handle, nullptr);
}

SetupSubmission::~SetupSubmission() {
  device_.finish();
  vkDestroyFence(device_.handle(), fence_, nullptr);
  vkDestroyCommandPool(device_.handle(), pool_, nullptr);
}

void SetupSubmission::submit_and_wait() {
  // Every later submission and the host see everything written here.
  cmd_.barrier({VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT},
               {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT,
                VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_HOST_READ_BIT});
  GREATX_VK(vkEndCommandBuffer(cmd_.handle()));
  VkCommandBufferSubmitInfo command{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  command.commandBuffer = cmd_.handle();
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &command;
  GREATX_VK(vkQueueSubmit2(device_.queue(), 1, &submit, fence_));
  const uint64_t number = device_.submitted();
  GREATX_VK(vkWaitForFences(device_.handle(), 1, &fence_, VK_TRUE, UINT64_MAX));
  device_.finished(number);
  ++device_.counters().setup_submits;
}

}  // namespace detail

}  // namespace greatx::gpu
