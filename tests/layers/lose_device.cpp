// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A Vulkan layer that loses the device: after GREATX_LOSE_AFTER submissions, every vkQueueSubmit2 and every
// vkWaitSemaphores returns VK_ERROR_DEVICE_LOST, as after a reset of the driver. Tests put it under the
// program by VK_LAYER_PATH and VK_INSTANCE_LAYERS; the program itself knows nothing of it.
#include <atomic>
#include <cstdlib>
#include <cstring>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

// One instance and one device are enough for a test.
PFN_vkGetInstanceProcAddr next_instance_proc = nullptr;
PFN_vkGetDeviceProcAddr next_device_proc = nullptr;
PFN_vkQueueSubmit2 next_submit = nullptr;
PFN_vkWaitSemaphores next_wait = nullptr;
VkInstance the_instance = VK_NULL_HANDLE;
std::atomic<long> submissions{0};

long lose_after() {
  const char* text = std::getenv("GREATX_LOSE_AFTER");
  return text != nullptr ? std::strtol(text, nullptr, 10) : -1;
}
bool is_lost() { return lose_after() >= 0 && submissions.load() > lose_after(); }

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                      VkFence fence) {
  ++submissions;
  return is_lost() ? VK_ERROR_DEVICE_LOST : next_submit(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL wait(VkDevice device, const VkSemaphoreWaitInfo* info, uint64_t timeout) {
  return is_lost() ? VK_ERROR_DEVICE_LOST : next_wait(device, info, timeout);
}

/// Returns the link of the chain that the loader has left for this layer, and moves it on.
template <typename LayerInfo, VkStructureType type>
LayerInfo* link_of(const void* chain) {
  for (auto* info = static_cast<LayerInfo*>(const_cast<void*>(chain)); info != nullptr;
       info = static_cast<LayerInfo*>(const_cast<void*>(info->pNext)))
    if (info->sType == type && info->function == VK_LAYER_LINK_INFO) return info;
  return nullptr;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* info,
                                               const VkAllocationCallbacks* allocator, VkInstance* instance) {
  auto* link = link_of<VkLayerInstanceCreateInfo, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO>(info->pNext);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  next_instance_proc = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto next =
      reinterpret_cast<PFN_vkCreateInstance>(next_instance_proc(VK_NULL_HANDLE, "vkCreateInstance"));
  const VkResult result = next(info, allocator, instance);
  if (result == VK_SUCCESS) the_instance = *instance;
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                             const VkAllocationCallbacks* allocator, VkDevice* device) {
  auto* link = link_of<VkLayerDeviceCreateInfo, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO>(info->pNext);
  if (link == nullptr) return VK_ERROR_INITIALIZATION_FAILED;
  next_device_proc = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
  link->u.pLayerInfo = link->u.pLayerInfo->pNext;
  const auto next = reinterpret_cast<PFN_vkCreateDevice>(next_instance_proc(the_instance, "vkCreateDevice"));
  const VkResult result = next(physical, info, allocator, device);
  if (result != VK_SUCCESS) return result;
  next_submit = reinterpret_cast<PFN_vkQueueSubmit2>(next_device_proc(*device, "vkQueueSubmit2"));
  next_wait = reinterpret_cast<PFN_vkWaitSemaphores>(next_device_proc(*device, "vkWaitSemaphores"));
  return result;
}

}  // namespace

extern "C" {

VK_LAYER_EXPORT PFN_vkVoidFunction VKAPI_CALL greatx_lose_device_proc(VkDevice device, const char* name) {
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(greatx_lose_device_proc);
  if (std::strcmp(name, "vkQueueSubmit2") == 0) return reinterpret_cast<PFN_vkVoidFunction>(submit);
  if (std::strcmp(name, "vkWaitSemaphores") == 0) return reinterpret_cast<PFN_vkVoidFunction>(wait);
  return next_device_proc(device, name);
}

VK_LAYER_EXPORT PFN_vkVoidFunction VKAPI_CALL greatx_lose_instance_proc(VkInstance instance,
                                                                        const char* name) {
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(greatx_lose_instance_proc);
  if (std::strcmp(name, "vkCreateInstance") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
  if (std::strcmp(name, "vkCreateDevice") == 0) return reinterpret_cast<PFN_vkVoidFunction>(create_device);
  if (std::strcmp(name, "vkGetDeviceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(greatx_lose_device_proc);
  if (std::strcmp(name, "vkQueueSubmit2") == 0) return reinterpret_cast<PFN_vkVoidFunction>(submit);
  if (std::strcmp(name, "vkWaitSemaphores") == 0) return reinterpret_cast<PFN_vkVoidFunction>(wait);
  return next_instance_proc != nullptr ? next_instance_proc(instance, name) : nullptr;
}

}  // extern "C"
