// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines acceleration structures. Each body has a bottom level, which is built once. The top level holds the
// bodies and is refitted when one of them has moved.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "gpu/resources.h"

namespace greatx::gpu {

class Cmd;

/// Holds one geometry (a range of triangles) of a bottom-level structure.
struct BlasGeometry {
  VkDeviceAddress vertices = 0;  ///< vec3 fp32, stride 12
  uint32_t max_vertex = 0;       ///< highest index + 1
  VkDeviceAddress indices = 0;   ///< uint32, address of the first index of the range
  uint32_t triangle_count = 0;
  bool opaque = true;  ///< false: shaders see each hit as a candidate (alpha mask)
};

class AccelerationStructure {
 public:
  AccelerationStructure() = default;
  ~AccelerationStructure();
  AccelerationStructure(AccelerationStructure&& other) noexcept;
  AccelerationStructure& operator=(AccelerationStructure&& other) noexcept;
  const VkAccelerationStructureKHR& handle() const { return handle_; }
  VkDeviceAddress address() const { return address_; }

 protected:
  void create(Device& device, VkAccelerationStructureTypeKHR type, VkDeviceSize size, std::string_view name);
  Device* device_ = nullptr;
  VkAccelerationStructureKHR handle_ = VK_NULL_HANDLE;
  VkDeviceAddress address_ = 0;
  Buffer storage_;
};

/// Represents a bottom level. A set-up submission of its own builds it, and the constructor waits for that.
/// It is fast to trace and cannot be updated.
class Blas : public AccelerationStructure {
 public:
  Blas() = default;
  Blas(Device& device, std::span<const BlasGeometry> geometries, std::string_view name);
};

/// Describes a body in the top level.
struct TlasInstance {
  const Blas* blas = nullptr;
  dmat4 local_from_body{1.0};
  uint32_t custom_index = 0;  ///< 24 bits
  uint32_t mask = 0xff;       ///< 8 bits
};

/// Represents the top level over a fixed number of instances.
class Tlas : public AccelerationStructure {
 public:
  Tlas() = default;
  Tlas(Device& device, uint32_t instance_count, std::string_view name);
  /// Records a build (the first time) or a refit into `cmd`. `instances` [instance_count] are copied into
  /// `staging`, a slice of upload memory of instance_bytes() that lives until the submission is done. The
  /// call includes the barriers towards ray queries.
  void record(Cmd& cmd, std::span<const TlasInstance> instances, const Slice& staging);
  VkDeviceSize instance_bytes() const;
  bool built() const { return built_; }

 private:
  uint32_t instance_count_ = 0;
  bool built_ = false;
  Buffer instances_;
  Buffer scratch_;
};

}  // namespace greatx::gpu
