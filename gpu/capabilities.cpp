// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/capabilities.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <fmt/format.h>

namespace greatx::gpu {

namespace {

constexpr std::array ray_tracing_extensions = {VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
                                               VK_KHR_RAY_QUERY_EXTENSION_NAME,
                                               VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME};

/// Describes a feature bit that greatx uses: its place in the chain, its purpose, and whether greatx runs
/// without it.
struct FeatureUse {
  const char* name;
  const char* used_for;
  bool required;
  VkBool32* (*at)(FeatureChain&);
};

#define GREATX_FEATURE(part, bit, why)                                    \
  FeatureUse {                                                            \
#bit, why, true, [](FeatureChain & chain) { return &chain.part.bit; } \
  }
#define GREATX_OPTIONAL(part, bit, why)                                    \
  FeatureUse {                                                             \
#bit, why, false, [](FeatureChain & chain) { return &chain.part.bit; } \
  }

constexpr const char* texture_table = "textures of any number of sizes (else at most 16)";
constexpr const char* driver_rays = "rays traced by the driver (else by greatx's own trees)";

const FeatureUse feature_uses[] = {
    GREATX_FEATURE(core.features, shaderInt64, "buffer addresses in shaders"),
    GREATX_FEATURE(v12, bufferDeviceAddress, "buffers by address"),
    GREATX_FEATURE(v12, scalarBlockLayout, "structs shared by C++ and shaders"),
    GREATX_FEATURE(v12, timelineSemaphore, "counting ticks in flight"),
    GREATX_OPTIONAL(v12, runtimeDescriptorArray, texture_table),
    GREATX_OPTIONAL(v12, shaderSampledImageArrayNonUniformIndexing, texture_table),
    GREATX_OPTIONAL(v12, descriptorBindingPartiallyBound, texture_table),
    GREATX_FEATURE(v12, hostQueryReset, "timestamps"),
    GREATX_FEATURE(v13, synchronization2, "barriers"),
    GREATX_FEATURE(v13, dynamicRendering, "raster passes"),
    GREATX_FEATURE(v13, maintenance4, "workgroup sizes by specialization (LocalSizeId)"),
    GREATX_OPTIONAL(acceleration, accelerationStructure, driver_rays),
    GREATX_OPTIONAL(ray_query, rayQuery, driver_rays),
};
#undef GREATX_OPTIONAL
#undef GREATX_FEATURE

std::vector<VkExtensionProperties> extensions_of(VkPhysicalDevice physical) {
  uint32_t count = 0;
  GREATX_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GREATX_VK(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()));
  return extensions;
}

bool contains(const std::vector<VkExtensionProperties>& extensions, const char* name) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return std::strcmp(extension.extensionName, name) == 0; });
}

const char* type_name(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "cpu";
    default:
      return "other";
  }
}

/// Returns how many descriptors a pipeline may push; 0 without the extension.
uint32_t push_descriptors_of(VkPhysicalDevice physical) {
  if (!contains(extensions_of(physical), VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)) return 0;
  VkPhysicalDevicePushDescriptorPropertiesKHR push{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PUSH_DESCRIPTOR_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &push, {}};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  return push.maxPushDescriptors;
}

bool has_universal_queue(VkPhysicalDevice physical) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  return std::any_of(families.begin(), families.end(),
                     [=](const auto& f) { return (f.queueFlags & both) == both; });
}

}  // namespace

FeatureChain::FeatureChain(bool ray_tracing) {
  core.pNext = &v11;
  v11.pNext = &v12;
  v12.pNext = &v13;
  if (ray_tracing) {
    v13.pNext = &acceleration;
    acceleration.pNext = &ray_query;
  }
}

void request_features(FeatureChain& wanted, const FeatureChain& available) {
  for (const FeatureUse& use : feature_uses) *use.at(wanted) = *use.at(const_cast<FeatureChain&>(available));
}

bool has_ray_tracing_extensions(VkPhysicalDevice physical) {
  const auto extensions = extensions_of(physical);
  return std::all_of(ray_tracing_extensions.begin(), ray_tracing_extensions.end(),
                     [&](const char* name) { return contains(extensions, name); });
}

bool has_conditional_rendering(VkPhysicalDevice physical) {
  if (!contains(extensions_of(physical), VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME)) return false;
  VkPhysicalDeviceConditionalRenderingFeaturesEXT conditional{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT};
  VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &conditional, {}};
  vkGetPhysicalDeviceFeatures2(physical, &features);
  return conditional.conditionalRendering == VK_TRUE;
}

std::vector<const char*> wanted_extensions(VkPhysicalDevice physical) {
  std::vector<const char*> names{VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME};
  if (has_conditional_rendering(physical)) names.push_back(VK_EXT_CONDITIONAL_RENDERING_EXTENSION_NAME);
  if (has_ray_tracing_extensions(physical))
    names.insert(names.end(), ray_tracing_extensions.begin(), ray_tracing_extensions.end());
  return names;
}

DeviceInfo describe(VkPhysicalDevice physical, uint32_t index) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &driver, {}};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  const VkPhysicalDeviceProperties& p = properties.properties;
  const bool vulkan_1_3 = p.apiVersion >= VK_API_VERSION_1_3;

  DeviceInfo info;
  info.index = index;
  info.name = p.deviceName;
  info.type = type_name(p.deviceType);
  info.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
  info.api_version = fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(p.apiVersion),
                                 VK_API_VERSION_MINOR(p.apiVersion), VK_API_VERSION_PATCH(p.apiVersion));
  VkPhysicalDeviceMemoryProperties memory{};
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info.memory_bytes = std::max<uint64_t>(info.memory_bytes, memory.memoryHeaps[i].size);

  info.capabilities.push_back({"Vulkan 1.3", "everything", true, vulkan_1_3});
  info.capabilities.push_back(
      {"graphics and compute queue", "one submission a tick", true, has_universal_queue(physical)});
  info.capabilities.push_back({VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME, "descriptors while recording", true,
                               contains(extensions_of(physical), VK_KHR_PUSH_DESCRIPTOR_EXTENSION_NAME)});
  const uint32_t pushed = push_descriptors_of(physical);
  info.capabilities.push_back(
      {fmt::format("maxPushDescriptors of {} (found {})", most_push_descriptors, pushed), "shading", true,
       pushed >= most_push_descriptors});
  if (vulkan_1_3) {
    FeatureChain available(has_ray_tracing_extensions(physical));
    vkGetPhysicalDeviceFeatures2(physical, &available.core);
    for (const FeatureUse& use : feature_uses)
      info.capabilities.push_back({use.name, use.used_for, use.required, *use.at(available) == VK_TRUE});
    info.capabilities.push_back({"conditionalRendering", "adaptive steps of event cameras", false,
                                 has_conditional_rendering(physical)});
  }
  return info;
}

std::vector<std::string> DeviceInfo::missing() const {
  std::vector<std::string> names;
  for (const Capability& capability : capabilities)
    if (capability.required && !capability.available) names.push_back(capability.name);
  return names;
}

bool DeviceInfo::has(std::string_view capability) const {
  return std::any_of(capabilities.begin(), capabilities.end(),
                     [&](const Capability& c) { return c.name == capability && c.available; });
}

bool DeviceInfo::has_ray_query() const { return has("accelerationStructure") && has("rayQuery"); }

bool DeviceInfo::has_texture_table() const {
  return has("runtimeDescriptorArray") && has("shaderSampledImageArrayNonUniformIndexing") &&
         has("descriptorBindingPartiallyBound");
}

Tracer DeviceInfo::best_tracer() const {
  return type == "cpu" || !has_ray_query() ? Tracer::tree : Tracer::driver;
}

}  // namespace greatx::gpu
