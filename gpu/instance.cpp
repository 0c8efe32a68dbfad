// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/instance.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "core/error.h"
#include "gpu/bundled_driver.h"

namespace greatx::gpu {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
}  // namespace

const char* const no_vulkan_help =
    "no Vulkan driver found: install one (Mesa's mesa-vulkan-drivers >= 24.1 brings lavapipe, which needs no "
    "GPU; "
    "scripts/setup.sh installs it)";

namespace {

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  // The layer's own start-up notices (settings, versions) are not faults of the program.
  if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT && data->pMessageIdName != nullptr &&
      std::strstr(data->pMessageIdName, "VUID") == nullptr &&
      std::strstr(data->pMessageIdName, "SYNC-") == nullptr &&
      std::strstr(data->pMessageIdName, "UNASSIGNED") == nullptr &&
      std::strstr(data->pMessage, "loader") != nullptr)
    return VK_FALSE;
  if (severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT)
    static_cast<ValidationLog*>(user)->add(data->pMessage);
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(ValidationLog* log) {
  VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  info.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType =
      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT;
  info.pfnUserCallback = on_message;
  info.pUserData = log;
  return info;
}

bool has_layer(const char* name) {
  uint32_t count = 0;
  GREATX_VK(vkEnumerateInstanceLayerProperties(&count, nullptr));
  std::vector<VkLayerProperties> layers(count);
  GREATX_VK(vkEnumerateInstanceLayerProperties(&count, layers.data()));
  return std::any_of(layers.begin(), layers.end(),
                     [&](const auto& layer) { return !std::strcmp(layer.layerName, name); });
}

}  // namespace

bool has_instance_extension(const char* name) {
  offer_bundled_driver();
  uint32_t count = 0;
  GREATX_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GREATX_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()));
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return !std::strcmp(extension.extensionName, name); });
}

VkInstance make_instance(bool validation, std::span<const std::string> extra, ValidationLog* log) {
  offer_bundled_driver();
  if (validation && !has_layer(validation_layer))
    throw_user_error(
        "validation was asked for, but the layer {} is not installed (Debian: vulkan-validationlayers)",
        validation_layer);
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "greatx";
  application.apiVersion = VK_API_VERSION_1_3;
  std::vector<const char*> layers, extensions;
  if (validation) layers.push_back(validation_layer);
  if (has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME))
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  for (const std::string& extension : extra) extensions.push_back(extension.c_str());

  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  info.enabledLayerCount = static_cast<uint32_t>(layers.size());
  info.ppEnabledLayerNames = layers.data();
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(log);
  const VkValidationFeatureEnableEXT enabled[] = {
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = enabled;
  if (validation) {
    features.pNext = &messenger;
    info.pNext = &features;
  }
  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result = vkCreateInstance(&info, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER) throw UserError(no_vulkan_help);
  GREATX_VK(result);
  return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  uint32_t count = 0;
  VkResult result = vkEnumeratePhysicalDevices(instance, &count, nullptr);
  // The loader says "initialization failed" where there is no driver.
  if (result == VK_ERROR_INITIALIZATION_FAILED || count == 0) return {};
  GREATX_VK(result);
  std::vector<VkPhysicalDevice> devices(count);
  GREATX_VK(vkEnumeratePhysicalDevices(instance, &count, devices.data()));
  return devices;
}

VkDebugUtilsMessengerEXT make_messenger(VkInstance instance, ValidationLog* log) {
  if (!has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) return VK_NULL_HANDLE;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
  const VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(log);
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  GREATX_VK(create(instance, &info, nullptr, &messenger));
  return messenger;
}

void destroy_instance(VkInstance instance, VkDebugUtilsMessengerEXT messenger) {
  if (messenger != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance, messenger, nullptr);
  }
  vkDestroyInstance(instance, nullptr);
}

bool environment_flag(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && std::strcmp(value, "") != 0 && std::strcmp(value, "0") != 0;
}

}  // namespace greatx::gpu
