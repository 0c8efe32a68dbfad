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
#include "gpu/instance.h"
#include "gpu/pipeline_builds.h"

namespace greatx::gpu {

namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

constexpr std::pair<Tracer, std::string_view> tracer_names[] = {
    {Tracer::automatic, "auto"}, {Tracer::driver, "driver"}, {Tracer::tree, "tree"}};

int preference(const DeviceInfo& info) {
  if (info.type == "discrete") return 4;
  if (info.type == "integrated") return 3;
  if (info.type == "virtual") return 2;
  return info.type == "cpu" ? 1 : 0;
}

}  // namespace

std::string_view name_of(Tracer tracer) {
  for (const auto& [value, name] : tracer_names)
    if (value == tracer) return name;
  throw ContractError(fmt::format("tracer {}", static_cast<uint32_t>(tracer)));
}

std::optional<Tracer> tracer_of(std::string_view name) {
  for (const auto& [value, known] : tracer_names)
    if (known == name) return value;
  return std::nullopt;
}

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
  const VkInstance instance = make_instance(false, {}, &log);
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
    choose_tracer(options.tracer);
    create_logical();
  } catch (...) {
    destroy_instance();
    throw;
  }
}

Device::~Device() {
  pipeline_builds_.reset();
  vkDeviceWaitIdle(device_);
  vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
  vkDestroyDevice(device_, nullptr);
  destroy_instance();
}

void Device::destroy_instance() { gpu::destroy_instance(instance_, messenger_); }

void Device::create_instance(bool validation) {
  debug_utils_ = has_instance_extension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  instance_ = make_instance(validation, {}, validation_log_.get());
  if (validation) messenger_ = make_messenger(instance_, validation_log_.get());
}

void Device::choose_physical(const std::string& select) {
  const std::vector<VkPhysicalDevice> devices = physical_devices(instance_);
  std::vector<DeviceInfo> infos;
  for (uint32_t i = 0; i < devices.size(); ++i) infos.push_back(describe(devices[i], i));
  info_ = choose_device(infos, select);
  physical_ = devices[info_.index];
}

void Device::choose_tracer(Tracer wish) {
  const char* environment = std::getenv("GREATX_TRACER");
  if (wish == Tracer::automatic && environment != nullptr && *environment != '\0') {
    const std::optional<Tracer> named = tracer_of(environment);
    if (!named)
      throw_user_error("the environment variable GREATX_TRACER: expected auto, driver or tree, found '{}'",
                       environment);
    wish = *named;
  }
  tracer_ = wish == Tracer::automatic ? info_.best_tracer() : wish;
  if (tracer_ == Tracer::driver && !info_.has_ray_query())
    throw_user_error("the tracer 'driver': device '{}' ({}) has no ray queries; expected auto or tree",
                     info_.name, info_.driver);
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

  const bool ray_tracing = has_ray_tracing_extensions(physical_);
  FeatureChain available(ray_tracing), wanted(ray_tracing);
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
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, nullptr, {}};
  if (ray_tracing) properties.pNext = &acceleration;
  vkGetPhysicalDeviceProperties2(physical_, &properties);
  limits_ = properties.properties.limits;
  scratch_alignment_ = std::max(1u, acceleration.minAccelerationStructureScratchOffsetAlignment);
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);

  const auto load = [&](const char* name) { return vkGetDeviceProcAddr(device_, name); };
#define GREATX_LOAD(member, name) functions_.member = reinterpret_cast<PFN_##name>(load(#name))
  GREATX_LOAD(push_descriptor_set, vkCmdPushDescriptorSetKHR);
  if (ray_tracing) {
    GREATX_LOAD(create_acceleration_structure, vkCreateAccelerationStructureKHR);
    GREATX_LOAD(destroy_acceleration_structure, vkDestroyAccelerationStructureKHR);
    GREATX_LOAD(acceleration_structure_build_sizes, vkGetAccelerationStructureBuildSizesKHR);
    GREATX_LOAD(acceleration_structure_address, vkGetAccelerationStructureDeviceAddressKHR);
    GREATX_LOAD(build_acceleration_structures, vkCmdBuildAccelerationStructuresKHR);
  }
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
  pipeline_builds_ = std::make_unique<PipelineBuilds>();
  spdlog::debug("device {}: {} ({}), tracer: {}", info_.index, info_.name, info_.driver, name_of(tracer_));
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
