// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/device.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "gpu/capabilities.h"

namespace greatx::gpu {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";
constexpr const char* no_vulkan_help =
    "no Vulkan driver found: install one (Mesa's mesa-vulkan-drivers >= 24.1 brings lavapipe, which needs no "
    "GPU; "
    "scripts/setup.sh installs it)";

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

bool has_instance_extension(const char* name) {
  uint32_t count = 0;
  GREATX_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr));
  std::vector<VkExtensionProperties> extensions(count);
  GREATX_VK(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()));
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const auto& extension) { return !std::strcmp(extension.extensionName, name); });
}

VkInstance make_instance(bool validation, bool debug_utils, ValidationLog* log) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "greatx";
  application.apiVersion = VK_API_VERSION_1_3;
  std::vector<const char*> layers, extensions;
  if (validation) layers.push_back(validation_layer);
  if (debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

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

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

int preference(const DeviceInfo& info) {
  if (info.type == "discrete") return 4;
  if (info.type == "integrated") return 3;
  if (info.type == "virtual") return 2;
  return info.type == "cpu" ? 1 : 0;
}

bool environment_flag(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr && std::strcmp(value, "") != 0 && std::strcmp(value, "0") != 0;
}

}  // namespace

void ValidationLog::add(std::string message) {
  const std::lock_guard lock(mutex_);
  messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(messages_, {});
}

std::vector<DeviceInfo> list_devices() {
  ValidationLog log;
  const VkInstance instance = make_instance(false, false, &log);
  std::vector<DeviceInfo> infos;
  for (const VkPhysicalDevice physical : physical_devices(instance))
    infos.push_back(describe(physical, static_cast<uint32_t>(infos.size())));
  vkDestroyInstance(instance, nullptr);
  if (infos.empty()) throw UserError(no_vulkan_help);
  return infos;
}

const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, const std::string& select) {
  if (devices.empty()) throw UserError(no_vulkan_help);
  const DeviceInfo* chosen = nullptr;
  for (const DeviceInfo& info : devices) {
    if (!select.empty()) {
      // An index is not a part of a name: "1" does not select the llvmpipe whose name says LLVM 15.
      if (select == std::to_string(info.index)) {
        chosen = &info;
        break;
      }
      if (chosen == nullptr && lower(info.name).find(lower(select)) != std::string::npos) chosen = &info;
    } else if (info.usable() && (chosen == nullptr || preference(info) > preference(*chosen))) {
      chosen = &info;
    }
  }
  if (chosen != nullptr && chosen->usable()) return *chosen;
  std::string table;
  for (const DeviceInfo& info : devices)
    table += fmt::format("\n  {}: {} ({}): {}", info.index, info.name, info.driver,
                         info.usable() ? "usable" : fmt::format("lacks {}", fmt::join(info.missing(), ", ")));
  if (chosen != nullptr)
    throw_user_error("device '{}' lacks what greatx needs; the devices are:{}", chosen->name, table);
  if (!select.empty())
    throw_user_error("no Vulkan device matches '{}'; expected an index or a part of a name of:{}", select,
                     table);
  throw_user_error("no Vulkan device has what greatx needs:{}", table);
}

Device::Device(const DeviceOptions& options) {
  create_instance(options.validation || environment_flag("GREATX_VALIDATION"));
  const char* environment = std::getenv("GREATX_DEVICE");
  try {
    choose_physical(!options.select.empty() ? options.select : environment != nullptr ? environment : "");
    create_logical();
  } catch (...) {
    destroy_instance();
    throw;
  }
}

Device::~Device() {
  vkDeviceWaitIdle(device_);
  vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
  vkDestroyDevice(device_, nullptr);
  destroy_instance();
}

void Device::destroy_instance() {
  if (messenger_ != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance_, messenger_, nullptr);
  }
  vkDestroyInstance(instance_, nullptr);
}

void Device::create_instance(bool validation) {
  if (validation && !has_layer(validation_layer))
    throw_user_error(
        "validation was asked for, but the layer {} is not installed (Debian: vulkan-validationlayers)",
        validation_layer);
  debug_utils_ = has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  instance_ = make_instance(validation, debug_utils_, validation_log_.get());
  if (!validation || !debug_utils_) return;
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
  const VkDebugUtilsMessengerCreateInfoEXT info = messenger_info(validation_log_.get());
  GREATX_VK(create(instance_, &info, nullptr, &messenger_));
}

void Device::choose_physical(const std::string& select) {
  const std::vector<VkPhysicalDevice> devices = physical_devices(instance_);
  std::vector<DeviceInfo> infos;
  for (uint32_t i = 0; i < devices.size(); ++i) infos.push_back(describe(devices[i], i));
  info_ = choose_device(infos, select);
  physical_ = devices[info_.index];
}

void Device::create_logical() {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
  constexpr VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  while (queue_family_ + 1 < count && (families[queue_family_].queueFlags & both) != both) ++queue_family_;

  const float priority = 1.0f;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
  queue.queueFamilyIndex = queue_family_;
  queue.queueCount = 1;
  queue.pQueuePriorities = &priority;

  FeatureChain available(true), wanted(true);
  vkGetPhysicalDeviceFeatures2(physical_, &available.core);
  request_features(wanted, available);
  const std::vector<const char*> extensions = wanted_extensions(physical_);
  VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &wanted.core};
  VkPhysicalDeviceConditionalRenderingFeaturesEXT conditional{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_CONDITIONAL_RENDERING_FEATURES_EXT, &wanted.core, VK_TRUE, VK_FALSE};
  const bool has_conditions = has_conditional_rendering(physical_);
  if (has_conditions) info.pNext = &conditional;
  info.queueCreateInfoCount = 1;
  info.pQueueCreateInfos = &queue;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  GREATX_VK(vkCreateDevice(physical_, &info, nullptr, &device_));
  vkGetDeviceQueue(device_, queue_family_, 0, &queue_);

  VkPhysicalDeviceAccelerationStructurePropertiesKHR acceleration{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &acceleration, {}};
  vkGetPhysicalDeviceProperties2(physical_, &properties);
  limits_ = properties.properties.limits;
  scratch_alignment_ = std::max(1u, acceleration.minAccelerationStructureScratchOffsetAlignment);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

  const auto load = [&](const char* name) { return vkGetDeviceProcAddr(device_, name); };
#define GREATX_LOAD(member, name) functions_.member = reinterpret_cast<PFN_##name>(load(#name))
  GREATX_LOAD(push_descriptor_set, vkCmdPushDescriptorSetKHR);
  GREATX_LOAD(create_acceleration_structure, vkCreateAccelerationStructureKHR);
  GREATX_LOAD(destroy_acceleration_structure, vkDestroyAccelerationStructureKHR);
  GREATX_LOAD(acceleration_structure_build_sizes, vkGetAccelerationStructureBuildSizesKHR);
  GREATX_LOAD(acceleration_structure_address, vkGetAccelerationStructureDeviceAddressKHR);
  GREATX_LOAD(build_acceleration_structures, vkCmdBuildAccelerationStructuresKHR);
  if (has_conditions) {
    GREATX_LOAD(begin_condition, vkCmdBeginConditionalRenderingEXT);
    GREATX_LOAD(end_condition, vkCmdEndConditionalRenderingEXT);
  }
  if (debug_utils_) {
    GREATX_LOAD(set_object_name, vkSetDebugUtilsObjectNameEXT);
    GREATX_LOAD(begin_label, vkCmdBeginDebugUtilsLabelEXT);
    GREATX_LOAD(end_label, vkCmdEndDebugUtilsLabelEXT);
  }
#undef GREATX_LOAD
  const VkPipelineCacheCreateInfo cache{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  GREATX_VK(vkCreatePipelineCache(device_, &cache, nullptr, &pipeline_cache_));
  spdlog::debug("device {}: {} ({})", info_.index, info_.name, info_.driver);
}

uint32_t Device::memory_type(uint32_t allowed_bits, VkMemoryPropertyFlags required,
                             VkMemoryPropertyFlags preferred) const {
  for (const VkMemoryPropertyFlags flags : {required | preferred, required})
    for (uint32_t i = 0; i < memory_.memoryTypeCount; ++i)
      if ((allowed_bits & (1u << i)) && (memory_.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw_user_error("device '{}' has no memory type with flags {:#x}", info_.name, required);
}

void Device::set_name(VkObjectType type, uint64_t handle, std::string_view name) const {
  if (functions_.set_object_name == nullptr) return;
  const std::string text(name);
  VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
  info.objectType = type;
  info.objectHandle = handle;
  info.pObjectName = text.c_str();
  GREATX_VK(functions_.set_object_name(device_, &info));
}

std::string Device::name_of_large(VkBuffer buffer) const {
  const auto found = large_.find(buffer);
  return found == large_.end() ? "a buffer" : found->second;
}

void Device::wait_idle() const { GREATX_VK(vkDeviceWaitIdle(device_)); }

void Device::finished(uint64_t submission) {
  uint64_t known = finished_;
  while (known < submission && !finished_.compare_exchange_weak(known, submission)) continue;
}

void Device::finish() noexcept {
  const uint64_t submission = submitted_;
  if (finished_ >= submission) return;
  vkDeviceWaitIdle(device_);  // fails if the device is lost: then nothing runs either
  finished(submission);
}

}  // namespace greatx::gpu
