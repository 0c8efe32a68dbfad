// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/condition.h"

#include "core/error.h"

namespace greatx::gpu {

bool has_conditions(const Device& device) { return device.functions().begin_condition != nullptr; }

VkBufferUsageFlags condition_usage(const Device& device) {
  return has_conditions(device) ? VK_BUFFER_USAGE_CONDITIONAL_RENDERING_BIT_EXT : 0;
}

Condition::Condition(Cmd& cmd, const Slice& condition)
    : cmd_(condition.buffer != VK_NULL_HANDLE ? &cmd : nullptr) {
  if (cmd_ == nullptr) return;
  GREATX_CHECK(has_conditions(cmd.device()), "the device has no conditional rendering");
  VkConditionalRenderingBeginInfoEXT info{VK_STRUCTURE_TYPE_CONDITIONAL_RENDERING_BEGIN_INFO_EXT};
  info.buffer = condition.buffer;
  info.offset = condition.offset;
  cmd.device().functions().begin_condition(cmd.handle(), &info);
  cmd.conditional_ = true;
}

Condition::~Condition() {
  if (cmd_ == nullptr) return;
  cmd_->device().functions().end_condition(cmd_->handle());
  cmd_->conditional_ = false;
}

}  // namespace greatx::gpu
