// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What greatx asks of a Vulkan device, in one place: the query for `greatx info` and the device's creation
// read the same chain of feature structs.
#pragma once

#include <vector>

#include "gpu/device.h"

namespace greatx::gpu {

/// Chain of feature structs; not movable, since its members point at each other.
struct FeatureChain {
  VkPhysicalDeviceFeatures2 core{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
  VkPhysicalDeviceVulkan11Features v11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
  VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
  VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR};
  VkPhysicalDeviceRayQueryFeaturesKHR ray_query{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};

  /// Links the structs of core versions and, where `ray_tracing`, those of the extensions.
  explicit FeatureChain(bool ray_tracing);
  FeatureChain(const FeatureChain&) = delete;
  FeatureChain& operator=(const FeatureChain&) = delete;
};

/// Sets in `wanted` what greatx uses, as far as `available` has it.
void request_features(FeatureChain& wanted, const FeatureChain& available);

/// Everything `greatx info` says of one device.
DeviceInfo describe(VkPhysicalDevice physical, uint32_t index);

/// Device extensions that greatx switches on where they exist.
std::vector<const char*> wanted_extensions(VkPhysicalDevice physical);
bool has_ray_tracing_extensions(VkPhysicalDevice physical);
/// VK_EXT_conditional_rendering and its feature: what the GPU decides to leave out (gpu/condition.h).
bool has_conditional_rendering(VkPhysicalDevice physical);

}  // namespace greatx::gpu
