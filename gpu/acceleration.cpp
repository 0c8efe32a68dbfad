// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/acceleration.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "gpu/cmd.h"

namespace greatx::gpu {

namespace {

VkDeviceAddress align_up(VkDeviceAddress value, VkDeviceAddress alignment) {
  return (value + alignment - 1) / alignment * alignment;
}

VkAccelerationStructureBuildSizesInfoKHR build_sizes(const Device& device,
                                                     const VkAccelerationStructureBuildGeometryInfoKHR& build,
                                                     const uint32_t* counts) {
  VkAccelerationStructureBuildSizesInfoKHR sizes{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
  device.functions().acceleration_structure_build_sizes(
      device.handle(), VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &build, counts, &sizes);
  return sizes;
}

VkAccelerationStructureGeometryKHR triangles(const BlasGeometry& geometry) {
  VkAccelerationStructureGeometryKHR result{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  result.geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR;
  result.flags = geometry.opaque ? VK_GEOMETRY_OPAQUE_BIT_KHR : 0;
  VkAccelerationStructureGeometryTrianglesDataKHR& data = result.geometry.triangles;
  data.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR;
  data.vertexFormat = VK_FORMAT_R32G32B32_SFLOAT;
  data.vertexData.deviceAddress = geometry.vertices;
  data.vertexStride = sizeof(vec3);
  data.maxVertex = geometry.max_vertex;
  data.indexType = VK_INDEX_TYPE_UINT32;
  data.indexData.deviceAddress = geometry.indices;
  return result;
}

/// Returns Vulkan's 3x4 rows for a matrix that glm stores by columns.
VkTransformMatrixKHR rows_of(const dmat4& m) {
  VkTransformMatrixKHR rows{};
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) rows.matrix[row][column] = static_cast<float>(m[column][row]);
  return rows;
}

}  // namespace

AccelerationStructure::~AccelerationStructure() {
  if (handle_ == VK_NULL_HANDLE) return;
  device_->finish();
  device_->functions().destroy_acceleration_structure(device_->handle(), handle_, nullptr);
}
AccelerationStructure::AccelerationStructure(AccelerationStructure&& other) noexcept {
  *this = std::move(other);
}
AccelerationStructure& AccelerationStructure::operator=(AccelerationStructure&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(address_, other.address_);
  std::swap(storage_, other.storage_);
  return *this;
}

void AccelerationStructure::create(Device& device, VkAccelerationStructureTypeKHR type, VkDeviceSize size,
                                   std::string_view name) {
  device_ = &device;
  storage_ =
      Buffer(device, size, Memory::device, name, VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR);
  VkAccelerationStructureCreateInfoKHR info{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR};
  info.buffer = storage_.handle();
  info.size = size;
  info.type = type;
  GREATX_VK(device.functions().create_acceleration_structure(device.handle(), &info, nullptr, &handle_));
  VkAccelerationStructureDeviceAddressInfoKHR address{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR};
  address.accelerationStructure = handle_;
  address_ = device.functions().acceleration_structure_address(device.handle(), &address);
  device.set_name(VK_OBJECT_TYPE_ACCELERATION_STRUCTURE_KHR, reinterpret_cast<uint64_t>(handle_), name);
}

Blas::Blas(Device& device, std::span<const BlasGeometry> geometries, std::string_view name) {
  std::vector<VkAccelerationStructureGeometryKHR> parts;
  std::vector<VkAccelerationStructureBuildRangeInfoKHR> ranges;
  std::vector<uint32_t> counts;
  for (const BlasGeometry& geometry : geometries) {
    parts.push_back(triangles(geometry));
    ranges.push_back({geometry.triangle_count, 0, 0, 0});
    counts.push_back(geometry.triangle_count);
  }
  VkAccelerationStructureBuildGeometryInfoKHR build{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
  build.type = VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR;
  build.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR;
  build.mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  build.geometryCount = static_cast<uint32_t>(parts.size());
  build.pGeometries = parts.data();
  const VkAccelerationStructureBuildSizesInfoKHR sizes = build_sizes(device, build, counts.data());
  create(device, build.type, sizes.accelerationStructureSize, name);

  const uint32_t alignment = device.scratch_alignment();
  const Buffer scratch(device, sizes.buildScratchSize + alignment, Memory::device, "blas scratch");
  build.dstAccelerationStructure = handle_;
  build.scratchData.deviceAddress = align_up(scratch.address(), alignment);
  const VkAccelerationStructureBuildRangeInfoKHR* range = ranges.data();
  submit_setup(device, [&](Cmd& cmd) {
    device.functions().build_acceleration_structures(cmd.handle(), 1, &build, &range);
  });
}

Tlas::Tlas(Device& device, uint32_t instance_count, std::string_view name) : instance_count_(instance_count) {
  instances_ = Buffer(device, instance_bytes(), Memory::device, "tlas instances",
                      VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR);
  VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  VkAccelerationStructureBuildGeometryInfoKHR build{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
  build.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  build.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
  build.geometryCount = 1;
  build.pGeometries = &geometry;
  const VkAccelerationStructureBuildSizesInfoKHR sizes = build_sizes(device, build, &instance_count_);
  create(device, build.type, sizes.accelerationStructureSize, name);
  scratch_ =
      Buffer(device, std::max(sizes.buildScratchSize, sizes.updateScratchSize) + device.scratch_alignment(),
             Memory::device, "tlas scratch");
}

VkDeviceSize Tlas::instance_bytes() const {
  return instance_count_ * sizeof(VkAccelerationStructureInstanceKHR);
}

void Tlas::record(Cmd& cmd, std::span<const TlasInstance> instances, const Slice& staging) {
  GREATX_CHECK(instances.size() == instance_count_, "{} instances for a structure of {}", instances.size(),
               instance_count_);
  for (size_t i = 0; i < instances.size(); ++i) {
    VkAccelerationStructureInstanceKHR row{};
    row.transform = rows_of(instances[i].local_from_body);
    row.instanceCustomIndex = instances[i].custom_index & 0xffffffu;
    row.mask = instances[i].mask & 0xffu;
    row.accelerationStructureReference = instances[i].blas->address();
    std::memcpy(staging.mapped + i * sizeof(row), &row, sizeof(row));
  }
  // The build of the last tick may still read the instances, and its rays may still read the structure.
  cmd.barrier({sync::build_read.stage | sync::ray_query_read.stage, sync::build_read.access},
              sync::transfer_write);
  if (instance_count_ > 0)
    cmd.copy(staging.part(0, instance_bytes()), instances_.slice().part(0, instance_bytes()));
  cmd.barrier(sync::transfer_write, sync::build_read);
  cmd.barrier(
      {sync::build_write.stage | sync::ray_query_read.stage,
       sync::build_write.access | sync::ray_query_read.access},
      {sync::build_write.stage, sync::build_write.access | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR});

  VkAccelerationStructureGeometryKHR geometry{VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR};
  geometry.geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR;
  geometry.geometry.instances.sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR;
  geometry.geometry.instances.data.deviceAddress = instances_.address();
  VkAccelerationStructureBuildGeometryInfoKHR build{
      VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR};
  build.type = VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR;
  build.flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR |
                VK_BUILD_ACCELERATION_STRUCTURE_ALLOW_UPDATE_BIT_KHR;
  build.mode = built_ ? VK_BUILD_ACCELERATION_STRUCTURE_MODE_UPDATE_KHR
                      : VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR;
  build.srcAccelerationStructure = built_ ? handle_ : VK_NULL_HANDLE;
  build.dstAccelerationStructure = handle_;
  build.geometryCount = 1;
  build.pGeometries = &geometry;
  build.scratchData.deviceAddress = align_up(scratch_.address(), device_->scratch_alignment());
  const VkAccelerationStructureBuildRangeInfoKHR range{instance_count_, 0, 0, 0};
  const VkAccelerationStructureBuildRangeInfoKHR* ranges = &range;
  device_->functions().build_acceleration_structures(cmd.handle(), 1, &build, &ranges);
  cmd.barrier(sync::build_write, sync::ray_query_read);
  Counters& counters = device_->counters();
  ++(built_ ? counters.tlas_refits : counters.tlas_builds);
  built_ = true;
}

}  // namespace greatx::gpu
