// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/present/present_device.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "core/error.h"
#include "gpu/instance.h"

namespace greatx::gpu {

namespace {

/// A device, and the family of its queues that can draw and, where asked, present.
struct Candidate {
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkPhysicalDeviceProperties properties{};
  std::optional<uint32_t> family;
};

bool has_swapchain(VkPhysicalDevice physical) {
  uint32_t count = 0;
  GREATX_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GREATX_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()));
  return std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
    return std::string_view(extension.extensionName) == VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  });
}

Candidate candidate_of(VkPhysicalDevice physical, const Surface* surface) {
  Candidate candidate{physical, {}, {}};
  vkGetPhysicalDeviceProperties(physical, &candidate.properties);
  if (surface != nullptr && !has_swapchain(physical)) return candidate;
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  for (uint32_t i = 0; i < count && !candidate.family; ++i) {
    VkBool32 presents = VK_TRUE;
    if (surface != nullptr)
      GREATX_VK(vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, surface->handle(), &presents));
    if ((families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT) && presents) candidate.family = i;
  }
  return candidate;
}

int preference(const Candidate& candidate) {
  switch (candidate.properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 1;
  }
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

PresentInstance::PresentInstance(std::span<const std::string> extensions, bool validation) {
  for (const std::string& extension : extensions)
    if (!has_instance_extension(extension.c_str()))
      throw_user_error(
          "the Vulkan loader lacks the extension {}, which a window needs; --offscreen needs none",
          extension);
  validation |= environment_flag("GREATX_VALIDATION");
  instance_ = make_instance(validation, extensions, log_.get());
  if (validation) messenger_ = make_messenger(instance_, log_.get());
}
PresentInstance::~PresentInstance() { destroy_instance(instance_, messenger_); }

Surface::~Surface() { vkDestroySurfaceKHR(instance_->handle(), surface_, nullptr); }

PresentDevice::PresentDevice(const PresentInstance& instance, const Surface* surface,
                             const std::string& select)
    : instance_(instance.handle()) {
  choose(surface, select);
  create(surface != nullptr);
}
PresentDevice::~PresentDevice() {
  vkDeviceWaitIdle(device_);
  vkDestroyDevice(device_, nullptr);
}

void PresentDevice::choose(const Surface* surface, const std::string& select) {
  std::optional<Candidate> chosen;
  std::string table;
  uint32_t index = 0;
  for (const VkPhysicalDevice physical : physical_devices(instance_)) {
    const Candidate candidate = candidate_of(physical, surface);
    table += fmt::format("\n  {}: {}{}", index, candidate.properties.deviceName,
                         candidate.family ? "" : " (cannot show pictures in this window)");
    const bool named = select.empty() || select == std::to_string(index) ||
                       lower(candidate.properties.deviceName).find(lower(select)) != std::string::npos;
    if (named && candidate.family && (!chosen || preference(candidate) > preference(*chosen)))
      chosen = candidate;
    ++index;
  }
  if (index == 0) throw UserError(no_vulkan_help);
  if (!chosen)
    throw_user_error("no Vulkan device {}can show pictures in this window; --offscreen needs none:{}",
                     select.empty() ? "" : fmt::format("that '{}' names ", select), table);
  physical_ = chosen->physical;
  queue_family_ = *chosen->family;
  name_ = chosen->properties.deviceName;
}

void PresentDevice::create(bool swapchain) {
  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;
  const char* const extension = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = swapchain ? 1 : 0;
  info.ppEnabledExtensionNames = &extension;
  GREATX_VK(vkCreateDevice(physical_, &info, nullptr, &device_));
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

uint32_t PresentDevice::memory_type(uint32_t allowed_bits, VkMemoryPropertyFlags required) const {
  for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
    if ((allowed_bits & (1u << i)) && (memory_.memoryTypes[i].propertyFlags & required) == required) return i;
  throw_user_error("device '{}' has no memory type with flags {:#x}", name_, required);
}

PresentBuffer::PresentBuffer(const PresentDevice& device, VkDeviceSize bytes, VkBufferUsageFlags usage)
    : device_(&device), bytes_(bytes) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = bytes;
  info.usage = usage;
  GREATX_VK(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_));
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device.handle(), buffer_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memory_type(
      needs.memoryTypeBits, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  GREATX_VK(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_));
  GREATX_VK(vkBindBufferMemory(device.handle(), buffer_, memory_, 0));
  void* mapped = nullptr;
  GREATX_VK(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &mapped));
  mapped_ = static_cast<std::byte*>(mapped);
}
PresentBuffer::~PresentBuffer() {
  vkDestroyBuffer(device_->handle(), buffer_, nullptr);
  vkFreeMemory(device_->handle(), memory_, nullptr);
}

PresentImage::PresentImage(const PresentDevice& device, VkExtent2D extent, VkImageUsageFlags usage)
    : device_(&device), extent_(extent) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = info.arrayLayers = 1;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  GREATX_VK(vkCreateImage(device.handle(), &info, nullptr, &image_));
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), image_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memory_type(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  GREATX_VK(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_));
  GREATX_VK(vkBindImageMemory(device.handle(), image_, memory_, 0));
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = image_;
  view.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  GREATX_VK(vkCreateImageView(device.handle(), &view, nullptr, &view_));
}
PresentImage::~PresentImage() {
  vkDestroyImageView(device_->handle(), view_, nullptr);
  vkDestroyImage(device_->handle(), image_, nullptr);
  vkFreeMemory(device_->handle(), memory_, nullptr);
}

void change_layout(VkCommandBuffer cmd, VkImage image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdPipelineBarrier(cmd, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &barrier);
}

}  // namespace greatx::gpu
