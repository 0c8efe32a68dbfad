// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/resources.h"

#include <algorithm>
#include <atomic>
#include <sys/resource.h>
#include <utility>

#include <fmt/format.h>

#include "gpu/cmd.h"
#include "gpu/memory_use.h"

namespace greatx::gpu {

namespace {

constexpr VkMemoryPropertyFlags mapped_flags =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

uint32_t memory_type_for(const Device& device, uint32_t bits, Memory memory) {
  switch (memory) {
    case Memory::device:
      return device.memory_type(bits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
    case Memory::upload:
      return device.memory_type(bits, mapped_flags, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    case Memory::readback:
      return device.memory_type(bits, mapped_flags, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
  }
  throw ContractError("unknown kind of memory");
}

/// A CPU driver (lavapipe) keeps all its memory in one nameless file, to which the limit on file sizes
/// applies. The file does not grow beyond that limit, no call reports this, and the first access ends the
/// process with a bus error.
std::atomic<uint64_t> bytes_in_file{0};

bool keeps_memory_in_file(const Device& device) { return device.info().type == "cpu"; }
uint64_t pages_of(VkDeviceSize size) { return (size + 4095) / 4096 * 4096; }

void take_from_file(const Device& device, VkDeviceSize size, std::string_view name) {
  if (!keeps_memory_in_file(device)) return;
  const uint64_t all = bytes_in_file += pages_of(size);
  struct rlimit limit {};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY || all <= limit.rlim_cur)
    return;
  bytes_in_file -= pages_of(size);
  throw_user_error(
      "device '{}' keeps its memory in a file: '{}' makes it {} bytes; expected a file-size limit (ulimit "
      "-f) "
      "of that at least, found {} bytes",
      device.info().name, name, all, limit.rlim_cur);
}

void give_back(const Device& device, VkDeviceSize size) {
  count_freed(size);
  if (keeps_memory_in_file(device)) bytes_in_file -= pages_of(size);
}

VkDeviceMemory allocate(Device& device, const VkMemoryRequirements& needs, uint32_t type, bool address,
                        std::string_view name) {
  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, address ? &flags : nullptr};
  info.allocationSize = needs.size;
  info.memoryTypeIndex = type;
  take_from_file(device, needs.size, name);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  const VkResult result = vkAllocateMemory(device.handle(), &info, nullptr, &memory);
  if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
    throw_user_error("device '{}' is out of memory: '{}' needs {} bytes", device.info().name, name,
                     needs.size);
  GREATX_VK(result);
  count_allocated(needs.size);
  return memory;
}

VkImageAspectFlags aspect_of(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

}  // namespace

Slice Slice::part(VkDeviceSize from, VkDeviceSize bytes) const {
  GREATX_CHECK(from + bytes <= size, "part [{}, +{}) of a slice of {} bytes", from, bytes, size);
  return {buffer, offset + from, bytes, address + from, mapped == nullptr ? nullptr : mapped + from};
}

Buffer::Buffer(Device& device, VkDeviceSize size, Memory memory, std::string_view name,
               VkBufferUsageFlags extra_usage)
    : device_(&device), size_(std::max<VkDeviceSize>(size, 16)) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = size_;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
               VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT | extra_usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  GREATX_VK(vkCreateBuffer(device.handle(), &info, nullptr, &buffer_));
  VkMemoryRequirements needs{};
  vkGetBufferMemoryRequirements(device.handle(), buffer_, &needs);
  memory_ = allocate(device, needs, memory_type_for(device, needs.memoryTypeBits, memory), true, name);
  GREATX_VK(vkBindBufferMemory(device.handle(), buffer_, memory_, 0));
  if (memory != Memory::device) {
    void* pointer = nullptr;
    GREATX_VK(vkMapMemory(device.handle(), memory_, 0, VK_WHOLE_SIZE, 0, &pointer));
    mapped_ = static_cast<std::byte*>(pointer);
  }
  VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  address.buffer = buffer_;
  address_ = vkGetBufferDeviceAddress(device.handle(), &address);
  device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer_), name);
  if (size_ > device.limits().maxStorageBufferRange) device.add_large(buffer_, name);
}

Buffer::~Buffer() {
  if (buffer_ == VK_NULL_HANDLE) return;
  device_->remove_large(buffer_);
  device_->finish();
  VkMemoryRequirements had{};
  vkGetBufferMemoryRequirements(device_->handle(), buffer_, &had);
  give_back(*device_, had.size);
  vkDestroyBuffer(device_->handle(), buffer_, nullptr);
  vkFreeMemory(device_->handle(), memory_, nullptr);
}

Buffer::Buffer(Buffer&& other) noexcept { *this = std::move(other); }
Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(buffer_, other.buffer_);
  std::swap(memory_, other.memory_);
  std::swap(size_, other.size_);
  std::swap(address_, other.address_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

Image::Image(Device& device, const ImageDesc& desc, std::string_view name) : device_(&device), desc_(desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = desc.mip_levels;
  info.arrayLayers = layers();
  info.samples = desc.samples;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  GREATX_VK(vkCreateImage(device.handle(), &info, nullptr, &image_));
  VkMemoryRequirements needs{};
  vkGetImageMemoryRequirements(device.handle(), image_, &needs);
  memory_ =
      allocate(device, needs, memory_type_for(device, needs.memoryTypeBits, Memory::device), false, name);
  GREATX_VK(vkBindImageMemory(device.handle(), image_, memory_, 0));

  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = image_;
  view.viewType = desc.layers == 0 ? VK_IMAGE_VIEW_TYPE_2D : VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  view.format = desc.format;
  view.subresourceRange = {aspect_of(desc.format), 0, desc.mip_levels, 0, layers()};
  GREATX_VK(vkCreateImageView(device.handle(), &view, nullptr, &view_));
  device.set_name(VK_OBJECT_TYPE_IMAGE, reinterpret_cast<uint64_t>(image_), name);
}

Image::~Image() {
  if (image_ == VK_NULL_HANDLE) return;
  device_->finish();
  VkMemoryRequirements had{};
  vkGetImageMemoryRequirements(device_->handle(), image_, &had);
  give_back(*device_, had.size);
  vkDestroyImageView(device_->handle(), view_, nullptr);
  vkDestroyImage(device_->handle(), image_, nullptr);
  vkFreeMemory(device_->handle(), memory_, nullptr);
}

Image::Image(Image&& other) noexcept { *this = std::move(other); }
Image& Image::operator=(Image&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(image_, other.image_);
  std::swap(view_, other.view_);
  std::swap(memory_, other.memory_);
  std::swap(desc_, other.desc_);
  std::swap(use_, other.use_);
  return *this;
}

VkImageAspectFlags Image::aspect() const { return aspect_of(desc_.format); }

Sampler::Sampler(Device& device, const SamplerDesc& desc, std::string_view name) : device_(&device) {
  const VkFilter filter = desc.linear ? VK_FILTER_LINEAR : VK_FILTER_NEAREST;
  const auto address = [](bool repeat) {
    return repeat ? VK_SAMPLER_ADDRESS_MODE_REPEAT : VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  };
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = filter;
  info.minFilter = filter;
  info.mipmapMode = desc.linear ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = address(desc.repeat_u);
  info.addressModeV = address(desc.repeat_v);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = desc.mipmaps ? VK_LOD_CLAMP_NONE : 0.0f;
  info.compareEnable = desc.compare_greater_or_equal;
  info.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
  GREATX_VK(vkCreateSampler(device.handle(), &info, nullptr, &sampler_));
  device.set_name(VK_OBJECT_TYPE_SAMPLER, reinterpret_cast<uint64_t>(sampler_), name);
}

Sampler::~Sampler() {
  if (sampler_ == VK_NULL_HANDLE) return;
  device_->finish();
  vkDestroySampler(device_->handle(), sampler_, nullptr);
}
Sampler::Sampler(Sampler&& other) noexcept { *this = std::move(other); }
Sampler& Sampler::operator=(Sampler&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(sampler_, other.sampler_);
  return *this;
}

}  // namespace greatx::gpu
