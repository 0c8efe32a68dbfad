// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines buffers, images and samplers. They are move-only, and each has its memory and its name. As
// everything in gpu/, they wait before they are destroyed for submissions that the host has not waited for
// (Device::finish).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "gpu/device.h"

namespace greatx::gpu {

enum class Memory {
  device,    ///< fast for the GPU, not seen by the host
  upload,    ///< written by the host, read by the GPU; mapped, coherent
  readback,  ///< written by the GPU, read by the host; mapped, coherent, cached if there is such a kind
};

/// Describes a part of a buffer.
struct Slice {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;
  VkDeviceSize size = 0;
  VkDeviceAddress address = 0;
  std::byte* mapped = nullptr;  ///< null for device memory

  template <typename T>
  std::span<T> as() const {
    GREATX_CHECK(mapped != nullptr, "slice of {} bytes is not mapped", size);
    return {reinterpret_cast<T*>(mapped), size / sizeof(T)};
  }
  Slice part(VkDeviceSize from, VkDeviceSize bytes) const;
};

class Buffer {
 public:
  Buffer() = default;
  /// Makes a buffer that is usable as storage, as source and target of transfers, and by address;
  /// `extra_usage` adds to that. A size of 0 makes a buffer of 16 bytes, so that empty scenes need no special
  /// case.
  Buffer(Device& device, VkDeviceSize size, Memory memory, std::string_view name,
         VkBufferUsageFlags extra_usage = 0);
  ~Buffer();
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;

  VkBuffer handle() const { return buffer_; }
  VkDeviceSize size() const { return size_; }
  VkDeviceAddress address() const { return address_; }
  Slice slice() const { return {buffer_, 0, size_, address_, mapped_}; }
  explicit operator bool() const { return buffer_ != VK_NULL_HANDLE; }

 private:
  Device* device_ = nullptr;
  VkBuffer buffer_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  VkDeviceAddress address_ = 0;
  std::byte* mapped_ = nullptr;
};

/// Names the next use of an image. Its layout, stage and access follow from it.
enum class ImageUse {
  undefined,
  color_target,
  depth_target,
  sampled,
  storage,
  transfer_source,
  transfer_target
};

struct ImageDesc {
  VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
  uint32_t width = 1, height = 1;
  uint32_t mip_levels = 1;
  uint32_t layers = 0;  ///< 0: a plain image; else an array of this many layers
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
};

/// Represents a 2-D image, or an array of 2-D images, with one view of all its mip levels and layers.
/// Cmd::transition keeps track of its use, in recording order.
class Image {
 public:
  Image() = default;
  Image(Device& device, const ImageDesc& desc, std::string_view name);
  ~Image();
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;

  VkImage handle() const { return image_; }
  VkImageView view() const { return view_; }
  const ImageDesc& desc() const { return desc_; }
  uint32_t layers() const { return desc_.layers == 0 ? 1 : desc_.layers; }
  VkImageAspectFlags aspect() const;
  explicit operator bool() const { return image_ != VK_NULL_HANDLE; }

 private:
  friend class Cmd;
  Device* device_ = nullptr;
  VkImage image_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  VkDeviceMemory memory_ = VK_NULL_HANDLE;
  ImageDesc desc_;
  ImageUse use_ = ImageUse::undefined;
};

struct SamplerDesc {
  bool linear = true;
  bool repeat_u = true, repeat_v = true;
  bool mipmaps = false;
  bool compare_greater_or_equal = false;  ///< a shadow map's comparison sampler
};

class Sampler {
 public:
  Sampler() = default;
  Sampler(Device& device, const SamplerDesc& desc, std::string_view name);
  ~Sampler();
  Sampler(Sampler&& other) noexcept;
  Sampler& operator=(Sampler&& other) noexcept;
  VkSampler handle() const { return sampler_; }

 private:
  Device* device_ = nullptr;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

}  // namespace greatx::gpu
