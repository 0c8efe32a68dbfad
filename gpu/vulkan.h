// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>

#include <vulkan/vulkan.h>

namespace greatx::gpu {

/// Reports a Vulkan call that failed: the text of the call and the name of the result. The exit code is 2.
class VulkanError : public std::runtime_error {
 public:
  VulkanError(VkResult result, const char* call);
  VkResult result() const { return result_; }

 private:
  VkResult result_;
};

const char* name_of(VkResult result);

inline void check_vk(VkResult result, const char* call) {
  if (result < VK_SUCCESS) [[unlikely]]
    throw VulkanError(result, call);
}

}  // namespace greatx::gpu

#define GREATX_VK(call) ::greatx::gpu::check_vk((call), #call)
