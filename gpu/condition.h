// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets the GPU itself skip draws and dispatches, by VK_EXT_conditional_rendering. Copies, barriers and
// timestamps are executed in any case.
#pragma once

#include "gpu/cmd.h"

namespace greatx::gpu {

namespace sync {
inline constexpr Sync condition_read{VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT,
                                     VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT};
}  // namespace sync

/// Returns the usage of a buffer that holds conditions, or 0 if the device has no conditional rendering.
VkBufferUsageFlags condition_usage(const Device& device);
bool has_conditions(const Device& device);

/// Makes draws and dispatches conditional until the end of the C++ scope. They happen only if the word at
/// `condition` is not 0 when the GPU reaches them. With an empty slice they always happen. A barrier must
/// come before, from the writer of the word to sync::condition_read.
class Condition {
 public:
  Condition(Cmd& cmd, const Slice& condition);
  ~Condition();
  Condition(const Condition&) = delete;
  Condition& operator=(const Condition&) = delete;

 private:
  Cmd* cmd_;  ///< null: unconditional
};

}  // namespace greatx::gpu
