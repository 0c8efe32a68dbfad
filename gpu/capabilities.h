// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// States in one place the demands of greatx on a Vulkan device. The query for `greatx info` and the creation
// of the device read the same chain of feature structs.
#pragma once

#include <vector>

#include "gpu/device.h"

namespace greatx::gpu {

/// The most descriptors that a pipeline of greatx pushes. Every device must have as many
/// (maxPushDescriptors); shading uses 31.
constexpr uint32_t most_push_descriptors = 32;

/// Holds a chain of feature structs. It cannot be moved, since its members point at each other.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
  VkPhysicalDeviceRayQueryFeaturesKHR ray_query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};

  /// Links the structs of the core versions and, if `ray_tracing`, those of the extensions.
  explicit FeatureChain(bool ray_tracing);
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
};

/// Sets in `wanted` the features that greatx uses, as far as `available` has them.
void request_features(FeatureChain& wanted, const FeatureChain& available);

/// Returns everything that `greatx info` says of one device.
DeviceInfo describe(VkPhysicalDevice physical, uint32_t index);

/// Returns the device extensions that greatx switches on where they exist.
std::vector<const char*> wanted_extensions(VkPhysicalDevice physical);
bool has_ray_tracing_extensions(VkPhysicalDevice physical);
/// Returns whether the device has VK_EXT_conditional_rendering and its feature, by which the GPU leaves out
/// work (gpu/condition.h).
bool has_conditional_rendering(VkPhysicalDevice physical);

}  // namespace greatx::gpu
