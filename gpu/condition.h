// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Draws and dispatches that the GPU itself leaves out: VK_EXT_conditional_rendering. Copies, barriers and timestamps are
// executed all the same.
#pragma once

#include "gpu/cmd.h"

namespace greatx::gpu {

namespace sync {
inline constexpr Sync condition_read{VK_PIPELINE_STAGE_2_CONDITIONAL_RENDERING_BIT_EXT,
                                     VK_ACCESS_2_CONDITIONAL_RENDERING_READ_BIT_EXT};
}  // namespace sync

/// Usage of a buffer that holds conditions; 0 where the device knows none.
VkBufferUsageFlags condition_usage(const Device& device);
bool has_conditions(const Device& device);

/// Until the end of the C++ scope, draws and dispatches happen only if the word at `condition` is not 0 when the GPU comes
/// to them. An empty slice: unconditional. The word's writer must have been waited for (sync::condition_read).
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
