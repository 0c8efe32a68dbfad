// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/memory_use.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <vector>

namespace greatx::gpu {

namespace {

std::atomic<uint64_t> allocated_bytes{0};

bool has_budget(VkPhysicalDevice device) {
  uint32_t count = 0;
  if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr) != VK_SUCCESS) return false;
  std::vector<VkExtensionProperties> extensions(count);
  if (vkEnumerateDeviceExtensionProperties(device, nullptr, &count, extensions.data()) != VK_SUCCESS)
    return false;
  return std::ranges::any_of(extensions, [](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME) == 0;
  });
}

/// Asks a driver once, because the answer takes longer than the budget.
bool says_budget(VkPhysicalDevice device) {
  thread_local VkPhysicalDevice asked = VK_NULL_HANDLE;
  thread_local bool says = false;
  if (asked != device) says = has_budget(device);
  asked = device;
  return says;
}

}  // namespace

void count_allocated(uint64_t bytes) { allocated_bytes += bytes; }
void count_freed(uint64_t bytes) { allocated_bytes -= bytes; }

MemoryUse memory_use(const Device& device) {
  MemoryUse use;
  use.allocated_bytes = allocated_bytes;
  // A query of the physical device needs the extension to be there, not to be enabled.
  if (!says_budget(device.physical())) return use;
  VkPhysicalDeviceMemoryBudgetPropertiesEXT budget{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
  VkPhysicalDeviceMemoryProperties2 memory{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2, &budget};
  vkGetPhysicalDeviceMemoryProperties2(device.physical(), &memory);
  uint64_t largest = 0;
  for (uint32_t i = 0; i < memory.memoryProperties.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryProperties.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) == 0 || heap.size <= largest) continue;
    largest = heap.size;
    use.used_bytes = budget.heapUsage[i];
    use.budget_bytes = budget.heapBudget[i];
  }
  return use;
}

}  // namespace greatx::gpu
