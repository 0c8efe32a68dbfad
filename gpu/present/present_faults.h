// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Losses that happen on purpose. A driver loses its device or a surface so rarely that nothing but this can
// try what follows.
#pragma once

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "gpu/vulkan.h"

namespace greatx::gpu {

class PresentFaults {
 public:
  struct Fault {
    uint64_t frame = 0;  ///< counted from 0 over all devices of a window
    VkResult result = VK_ERROR_DEVICE_LOST;
  };

  PresentFaults() = default;
  explicit PresentFaults(std::vector<Fault> faults) : faults_(std::move(faults)) {}

  void begin_frame() { ++frames_; }
  /// Returns the result that a call of this frame has instead of being made, if one of `results` is due. Each
  /// fault happens once. Otherwise returns VK_SUCCESS, and the call is to be made.
  VkResult take(std::initializer_list<VkResult> results) {
    const auto due = std::ranges::find_if(faults_, [&](const Fault& fault) {
      return fault.frame + 1 == frames_ && std::ranges::find(results, fault.result) != results.end();
    });
    if (due == faults_.end()) return VK_SUCCESS;
    const VkResult result = due->result;
    faults_.erase(due);
    return result;
  }

 private:
  std::vector<Fault> faults_;
  uint64_t frames_ = 0;
};

}  // namespace greatx::gpu
