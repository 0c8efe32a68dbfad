// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Chooses a GPU, queries its capabilities, and owns the one queue that takes all submissions.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/vulkan.h"

namespace greatx::gpu {

class PipelineBuilds;

/// Selects how rays meet triangles (shaders/lib/trace.glsl).
enum class Tracer : uint32_t {
  automatic,  ///< what Device::tracer says
  driver,     ///< the driver's ray queries
  tree,       ///< trees of greatx's own, which need no feature of the device
};

/// Describes a feature that greatx needs or could use, and whether a device has it.
struct Capability {
  std::string name;      ///< the name in Vulkan, e.g. "rayQuery"
  std::string used_for;  ///< its purpose in words
  bool required = true;
  bool available = false;
};

struct DeviceInfo {
  uint32_t index = 0;  ///< index in vkEnumeratePhysicalDevices
  std::string name;
  std::string type;    ///< "discrete", "integrated", "virtual", "cpu", "other"
  std::string driver;  ///< name and version text of the driver
  std::string api_version;
  std::vector<Capability> capabilities;
  uint64_t memory_bytes = 0;  ///< size of the largest device-local heap
  /// Returns the names of the required capabilities that are missing. greatx runs on the device if there are
  /// none.
  std::vector<std::string> missing() const;
  bool usable() const { return missing().empty(); }
  /// Returns whether the device has a capability of that name.
  bool has(std::string_view capability) const;
  /// Returns whether the driver traces rays.
  bool has_ray_query() const;
  /// Returns whether shaders may choose from a table of textures of any size by a number that differs between
  /// their lanes.
  bool has_texture_table() const;
  /// Returns the tracer that `automatic` means here: the tree on a CPU, which is measured to be faster there
  /// (docs/performance.md), and where the driver traces no rays; else the driver, whose rays hardware traces.
  Tracer best_tracer() const;
};

/// Returns every Vulkan device of the machine. Throws UserError if there is no Vulkan loader or no driver at
/// all.
std::vector<DeviceInfo> list_devices();

/// Returns the device of `devices` that `select` names by its index or by a part of its name
/// (case-insensitive), else the usable device of the best type. Throws UserError if no device is usable, or
/// if the named one lacks something; the message lists every device and the features that it lacks.
const DeviceInfo& choose_device(const std::vector<DeviceInfo>& devices, const std::string& select);

/// Keeps the messages of the validation layer for the tests and for the end of the program. It outlives the
/// device.
class ValidationLog {
 public:
  void add(std::string message);
  std::vector<std::string> take();

 private:
  std::mutex mutex_;
  std::vector<std::string> messages_;
};

struct DeviceOptions {
  /// Index or part of the name (case-insensitive). If it is empty, $GREATX_DEVICE is used, else the best
  /// usable real GPU, else a CPU.
  std::string select;
  /// Switches on core and synchronisation validation, as $GREATX_VALIDATION=1 does.
  bool validation = false;
  /// If it is automatic, $GREATX_TRACER ("driver", "tree") is used, else DeviceInfo::best_tracer.
  Tracer tracer = Tracer::automatic;
};

/// Returns "auto", "driver" or "tree".
std::string_view name_of(Tracer tracer);
/// Returns the tracer of that name, or nothing.
std::optional<Tracer> tracer_of(std::string_view name);

/// Counts the objects built and the work submitted. The summary of the run reads it, and so do the tests that
/// a run has only the effects that the scene calls for.
struct Counters {
  uint64_t pipelines_built = 0;
  uint64_t setup_submits = 0;  ///< uploads and builds before the first tick
  uint64_t submits = 0;        ///< one per tick
  uint64_t passes = 0;         ///< scopes recorded
  uint64_t dispatches = 0;
  uint64_t draws = 0;
  uint64_t tlas_builds = 0;
  uint64_t tlas_refits = 0;
  std::vector<std::string> pipelines;  ///< names, in the order built
};

/// Holds the entry points of extensions, loaded once.
struct Functions {
  PFN_vkCmdPushDescriptorSetKHR push_descriptor_set = nullptr;
  PFN_vkCreateAccelerationStructureKHR create_acceleration_structure = nullptr;  ///< null without ray queries
  PFN_vkDestroyAccelerationStructureKHR destroy_acceleration_structure = nullptr;
  PFN_vkGetAccelerationStructureBuildSizesKHR acceleration_structure_build_sizes = nullptr;
  PFN_vkGetAccelerationStructureDeviceAddressKHR acceleration_structure_address = nullptr;
  PFN_vkCmdBuildAccelerationStructuresKHR build_acceleration_structures = nullptr;
  PFN_vkCmdBeginConditionalRenderingEXT begin_condition = nullptr;  ///< null without conditional rendering
  PFN_vkCmdEndConditionalRenderingEXT end_condition = nullptr;
  PFN_vkSetDebugUtilsObjectNameEXT set_object_name = nullptr;  ///< null without debug utils
  PFN_vkCmdBeginDebugUtilsLabelEXT begin_label = nullptr;
  PFN_vkCmdEndDebugUtilsLabelEXT end_label = nullptr;
};

/// Represents the logical device. It can be neither copied nor moved, since everything else refers to it and
/// is destroyed before it. Recording and submitting happen on one thread.
class Device {
 public:
  /// Throws UserError naming the missing features if no device fits.
  explicit Device(const DeviceOptions& options = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  VkPhysicalDevice physical() const { return physical_; }
  VkQueue queue() const { return queue_; }
  uint32_t queue_family() const { return queue_family_; }
  const DeviceInfo& info() const { return info_; }
  /// Returns the tracer of all passes: the driver or the tree.
  Tracer tracer() const { return tracer_; }
  const Functions& functions() const { return functions_; }
  const VkPhysicalDeviceLimits& limits() const { return limits_; }
  uint32_t scratch_alignment() const { return scratch_alignment_; }
  Counters& counters() { return counters_; }
  const Counters& counters() const { return counters_; }
  VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
  /// Returns the threads that build this device's pipelines.
  PipelineBuilds& pipeline_builds() { return *pipeline_builds_; }
  std::shared_ptr<ValidationLog> validation_log() const { return validation_log_; }

  /// Returns a memory type with all of `required`, preferably with `preferred`. Throws UserError if there is
  /// none.
  uint32_t memory_type(uint32_t allowed_bits, VkMemoryPropertyFlags required,
                       VkMemoryPropertyFlags preferred) const;
  /// Names an object for validation messages and RenderDoc.
  void set_name(VkObjectType type, uint64_t handle, std::string_view name) const;
  void wait_idle() const;
  /// Registers the name of a buffer that may be larger than one descriptor, for the error message if it is
  /// bound whole.
  void add_large(VkBuffer buffer, std::string_view name) {
    large_.insert_or_assign(buffer, std::string(name));
  }
  void remove_large(VkBuffer buffer) { large_.erase(buffer); }
  std::string name_of_large(VkBuffer buffer) const;

  /// Returns the number of a submission that was just handed to the queue.
  uint64_t submitted() { return ++submitted_; }
  /// States that the host has waited for a submission. Those before it are then done, too, since there is one
  /// queue.
  void finished(uint64_t submission);
  /// Blocks while a submission may still run that the host has not waited for. The destructor of every object
  /// that a submission may use calls it first. An exception between a submission and its wait then leaves no
  /// GPU work on freed memory, whatever the order in which owners keep their members. The call costs nothing
  /// if the host has waited for all submissions.
  void finish() noexcept;

 private:
  void create_instance(bool validation);
  void destroy_instance();  ///< and the messenger, before it
  void choose_physical(const std::string& select);
  void choose_tracer(Tracer wish);
  void create_logical();

  std::shared_ptr<ValidationLog> validation_log_ = std::make_shared<ValidationLog>();
  VkInstance instance_ = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
  std::unique_ptr<PipelineBuilds> pipeline_builds_;
  uint32_t queue_family_ = 0;
  uint32_t scratch_alignment_ = 256;
  bool debug_utils_ = false;
  DeviceInfo info_;
  Tracer tracer_ = Tracer::tree;
  Functions functions_;
  VkPhysicalDeviceLimits limits_{};
  VkPhysicalDeviceMemoryProperties memory_{};
  Counters counters_;
  std::map<VkBuffer, std::string> large_;
  std::atomic<uint64_t> submitted_{0}, finished_{0};
};

}  // namespace greatx::gpu
