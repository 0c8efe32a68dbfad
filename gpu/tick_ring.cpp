// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/tick_ring.h"

#include <algorithm>

#include <fmt/format.h>

namespace greatx::gpu {

namespace {
constexpr VkDeviceSize arena_alignment = 256;
constexpr uint32_t max_scopes = 1024;
}  // namespace

Arena::Arena(Device& device, Memory memory, VkDeviceSize bytes, std::string name)
    : device_(&device), memory_(memory), name_(std::move(name)) {
  blocks_.emplace_back(device, bytes, memory, name_);
}

Slice Arena::allocate(VkDeviceSize bytes) {
  const VkDeviceSize size = std::max<VkDeviceSize>(bytes, 16);
  while (block_ < blocks_.size() && used_ + size > blocks_[block_].size()) {
    ++block_;
    used_ = 0;
  }
  if (block_ == blocks_.size()) {
    blocks_.emplace_back(*device_, std::max(size, 2 * blocks_.back().size()), memory_,
                         fmt::format("{} block {}", name_, block_));
    ++growths_;
  }
  const Slice slice = blocks_[block_].slice().part(used_, size);
  used_ = (used_ + size + arena_alignment - 1) / arena_alignment * arena_alignment;
  return slice;
}

void Arena::reset() {
  block_ = 0;
  used_ = 0;
}

TickRing::TickRing(Device& device, uint32_t slots, VkDeviceSize upload_bytes, VkDeviceSize readback_bytes)
    : device_(device), slots_(slots) {
  VkSemaphoreTypeCreateInfo type{VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO};
  type.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, &type, 0};
  GREATX_VK(vkCreateSemaphore(device.handle(), &semaphore, nullptr, &timeline_));
  for (uint32_t i = 0; i < slots; ++i) {
    TickSlot& slot = slots_[i];
    slot.index = i;
    slot.upload = Arena(device, Memory::upload, upload_bytes, fmt::format("upload arena {}", i));
    slot.readback = Arena(device, Memory::readback, readback_bytes, fmt::format("readback arena {}", i));
    slot.timestamps = Timestamps(device, max_scopes);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queue_family();
    pools_.emplace_back();
    GREATX_VK(vkCreateCommandPool(device.handle(), &pool, nullptr, &pools_.back()));
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = pools_.back();
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer handle = VK_NULL_HANDLE;
    GREATX_VK(vkAllocateCommandBuffers(device.handle(), &allocate, &handle));
    cmds_.emplace_back(device, handle, &slot.timestamps);
  }
}

TickRing::~TickRing() {
  device_.finish();
  for (const VkCommandPool pool : pools_) vkDestroyCommandPool(device_.handle(), pool, nullptr);
  vkDestroySemaphore(device_.handle(), timeline_, nullptr);
}

TickSlot& TickRing::begin() {
  TickSlot& slot = slots_[next_];
  next_ = (next_ + 1) % slot_count();
  wait(slot);
  slot.upload.reset();
  slot.readback.reset();
  slot.timestamps.reset();
  GREATX_VK(vkResetCommandPool(device_.handle(), pools_[slot.index], 0));
  slot.cmd = &cmds_[slot.index];
  *slot.cmd = Cmd(device_, slot.cmd->handle(), &slot.timestamps);
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  GREATX_VK(vkBeginCommandBuffer(slot.cmd->handle(), &begin));
  return slot;
}

void TickRing::submit(TickSlot& slot, Kind kind) {
  slot.timestamps.record_copy(*slot.cmd, slot.readback.allocate(slot.timestamps.bytes()));
  slot.cmd->barrier({VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT}, sync::host_read);
  GREATX_VK(vkEndCommandBuffer(slot.cmd->handle()));
  slot.submission = ++submitted_;
  VkCommandBufferSubmitInfo command{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
  command.commandBuffer = slot.cmd->handle();
  VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
  signal.semaphore = timeline_;
  signal.value = slot.submission;
  signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
  submit.commandBufferInfoCount = 1;
  submit.pCommandBufferInfos = &command;
  submit.signalSemaphoreInfoCount = 1;
  submit.pSignalSemaphoreInfos = &signal;
  GREATX_VK(vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE));
  slot.number = device_.submitted();
  slot.cmd = nullptr;
  ++(kind == Kind::tick ? device_.counters().submits : device_.counters().setup_submits);
}

void TickRing::wait(const TickSlot& slot) const {
  if (slot.submission == 0) return;
  VkSemaphoreWaitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO};
  info.semaphoreCount = 1;
  info.pSemaphores = &timeline_;
  info.pValues = &slot.submission;
  GREATX_VK(vkWaitSemaphores(device_.handle(), &info, UINT64_MAX));
  device_.finished(slot.number);
}

}  // namespace greatx::gpu
