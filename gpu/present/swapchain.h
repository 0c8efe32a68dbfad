// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "gpu/present/present_device.h"
#include "gpu/present/present_faults.h"

namespace greatx::gpu {

/// The images of a window. It re-creates itself when the window has another size, or when the window system
/// says that it no longer fits. Where the surface itself is lost, it throws VulkanError.
class Swapchain {
 public:
  Swapchain(const PresentDevice& device, const Surface& surface, PresentFaults& faults);
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  /// Returns the next image, which `acquired` signals; none if the window has no extent now (it is
  /// minimised) or has just changed: then there is nothing to present in this frame. `extent` is the
  /// window's, in pixels.
  std::optional<uint32_t> acquire(VkExtent2D extent, VkSemaphore acquired);
  /// Shows the image once its semaphore rendered(image) is signalled.
  void present(uint32_t image);

  VkImage image(uint32_t index) const { return images_[index]; }
  VkSemaphore rendered(uint32_t index) const { return rendered_[index]; }
  VkExtent2D extent() const { return extent_; }

 private:
  /// Returns false if the window has no extent.
  bool create(VkExtent2D extent);
  void destroy_semaphores();

  const PresentDevice& device_;
  const Surface& surface_;
  PresentFaults& faults_;
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D wanted_{0, 0}, extent_{0, 0};
  bool stale_ = true;
  std::vector<VkImage> images_;
  std::vector<VkSemaphore> rendered_;  ///< [images]
};

}  // namespace greatx::gpu
