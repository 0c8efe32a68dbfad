// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A small Vulkan device that draws a user interface and shows it in a window. It needs no ray tracing and is
// apart from gpu::Device, whose one queue may be busy with a tick for longer than a frame of the window.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/vulkan.h"

namespace greatx::gpu {

/// Owns a Vulkan instance for windows.
class PresentInstance {
 public:
  /// `extensions` are those that the window system needs; none without a window. Throws UserError if there is
  /// no driver, or if the loader lacks an extension or the validation layer.
  PresentInstance(std::span<const std::string> extensions, bool validation);
  ~PresentInstance();
  PresentInstance(const PresentInstance&) = delete;
  PresentInstance& operator=(const PresentInstance&) = delete;

  VkInstance handle() const { return instance_; }
  std::shared_ptr<ValidationLog> validation_log() const { return log_; }

 private:
  std::shared_ptr<ValidationLog> log_ = std::make_shared<ValidationLog>();
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// Owns a surface of a window.
class Surface {
 public:
  Surface(const PresentInstance& instance, VkSurfaceKHR surface) : instance_(&instance), surface_(surface) {}
  ~Surface();
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;
  VkSurfaceKHR handle() const { return surface_; }

 private:
  const PresentInstance* instance_;
  VkSurfaceKHR surface_;
};

/// Owns a device with one queue. Everything that uses it is destroyed before it.
class PresentDevice {
 public:
  /// Takes the device that `select` names (an index or a part of a name), else a real GPU before a CPU. With
  /// a `surface` (null: none), only a device that can show pictures on it will do. Throws UserError that
  /// lists the devices if none fits.
  PresentDevice(const PresentInstance& instance, const Surface* surface, const std::string& select);
  ~PresentDevice();
  PresentDevice(const PresentDevice&) = delete;
  PresentDevice& operator=(const PresentDevice&) = delete;

  VkInstance instance() const { return instance_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkDevice handle() const { return device_; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const std::string& name() const { return name_; }
  /// Returns a memory type with all of `required`. Throws UserError if there is none.
  uint32_t memory_type(uint32_t allowed_bits, VkMemoryPropertyFlags required) const;
  void wait_idle() const { vkDeviceWaitIdle(device_); }

 private:
  void choose(const Surface* surface, const std::string& select);
  void create(bool swapchain);

  VkInstance instance_;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  uint32_t queue_family_ = 0;
  std::string name_;
  VkPhysicalDeviceMemoryProperties memory_{};
};

/// Owns a buffer that the host writes or reads, mapped for all its life.
class PresentBuffer {
 public:
  PresentBuffer(const PresentDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage);
  ~PresentBuffer();
  PresentBuffer(const PresentBuffer&) = delete;
  PresentBuffer& operator=(const PresentBuffer&) = delete;
  VkBuffer handle() const { return buffer_; }
  std::span<std::byte> mapped() const { return {mapped_, bytes_}; }

 private:
  const PresentDevice* device_;
  VkDeviceSize bytes_;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  std::byte* mapped_ = nullptr;
};

/// Owns an RGBA8 image in device memory and a view of it.
class PresentImage {
 public:
  static constexpr VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  PresentImage(const PresentDevice& device, VkExtent2D extent, VkImageUsageFlags usage);
  ~PresentImage();
  PresentImage(const PresentImage&) = delete;
  PresentImage& operator=(const PresentImage&) = delete;
  VkImage handle() const { return image_; }
  VkImageView view() const { return view_; }
  VkExtent2D extent() const { return extent_; }
  VkDeviceSize bytes() const { return VkDeviceSize{4} * extent_.width * extent_.height; }

 private:
  const PresentDevice* device_;
  VkExtent2D extent_;
  VkImage image_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
};

/// Records a change of an image's layout, with all that came before done and visible.
void change_layout(VkCommandBuffer cmd, VkImage image, VkImageLayout from, VkImageLayout to);

}  // namespace greatx::gpu
