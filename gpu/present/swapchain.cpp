// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/present/swapchain.h"

#include <algorithm>

#include "core/error.h"

namespace greatx::gpu {

namespace {

/// Prefers 8 bits a channel without a conversion to sRGB, which the interface's colours have already.
VkSurfaceFormatKHR choose_format(VkPhysicalDevice physical, VkSurfaceKHR surface) {
  uint32_t count = 0;
  GREATX_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, nullptr));
  std::vector<VkSurfaceFormatKHR> formats(count);
  GREATX_VK(vkGetPhysicalDeviceSurfaceFormatsKHR(physical, surface, &count, formats.data()));
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
  if (formats.empty()) throw_user_error("the window offers no format of pixels; --offscreen needs none");
  return formats.front();
}

}  // namespace

Swapchain::Swapchain(const PresentDevice& device, const Surface& surface, PresentFaults& faults)
    : device_(device), surface_(surface), faults_(faults) {}

Swapchain::~Swapchain() {
  device_.wait_idle();
  destroy_semaphores();
  vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
}

void Swapchain::destroy_semaphores() {
  for (const VkSemaphore semaphore : rendered_) vkDestroySemaphore(device_.handle(), semaphore, nullptr);
  rendered_.clear();
}

bool Swapchain::create(VkExtent2D extent) {
  VkSurfaceCapabilitiesKHR can;
  GREATX_VK(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_.handle(), &can));
  if (can.currentExtent.width != ~0u) extent = can.currentExtent;
  extent.width = std::min(extent.width, can.maxImageExtent.width);
  extent.height = std::min(extent.height, can.maxImageExtent.height);
  if (extent.width == 0 || extent.height == 0) return false;
  const VkSurfaceFormatKHR format = choose_format(device_.physical(), surface_.handle());
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_.handle();
  info.minImageCount = std::max(can.minImageCount, 2u);
  if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
  info.imageFormat = format.format;
  info.imageColorSpace = format.colorSpace;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = can.currentTransform;
  info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  if (!(can.supportedCompositeAlpha & info.compositeAlpha))
    info.compositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // every driver has it
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  device_.wait_idle();
  VkSwapchainKHR fresh = VK_NULL_HANDLE;
  GREATX_VK(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &fresh));
  vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
  swapchain_ = fresh;
  extent_ = extent;
  uint32_t count = 0;
  GREATX_VK(vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, nullptr));
  images_.resize(count);
  GREATX_VK(vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, images_.data()));
  destroy_semaphores();
  const VkSemaphoreCreateInfo semaphore{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  rendered_.resize(count);
  for (VkSemaphore& rendered : rendered_)
    GREATX_VK(vkCreateSemaphore(device_.handle(), &semaphore, nullptr, &rendered));
  return true;
}

std::optional<uint32_t> Swapchain::acquire(VkExtent2D extent, VkSemaphore acquired) {
  if (extent.width == 0 || extent.height == 0) return {};
  if (stale_ || extent.width != wanted_.width || extent.height != wanted_.height) {
    if (!create(extent)) return {};
    wanted_ = extent;
    stale_ = false;
  }
  uint32_t image = 0;
  VkResult result = faults_.take({VK_ERROR_SURFACE_LOST_KHR, VK_ERROR_OUT_OF_DATE_KHR});
  if (result == VK_SUCCESS)
    result =
        vkAcquireNextImageKHR(device_.handle(), swapchain_, UINT64_MAX, acquired, VK_NULL_HANDLE, &image);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) {
    stale_ = true;
    return {};
  }
  check_vk(result, "vkAcquireNextImageKHR");
  // A suboptimal image is shown all the same; the next frame has a swapchain that fits.
  if (result == VK_SUBOPTIMAL_KHR) stale_ = true;
  return image;
}

void Swapchain::present(uint32_t image) {
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &rendered_[image];
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &image;
  const VkResult result = vkQueuePresentKHR(device_.queue(), &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
    stale_ = true;
  else
    check_vk(result, "vkQueuePresentKHR");
}

}  // namespace greatx::gpu
