// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Keeps the pipelines of a device that their owners no longer need, for the next owner that asks for the same
// ones. A program that makes many simulators on one device, one after the other, then compiles each of its
// shaders once: lavapipe takes half of the time of a short run to do so, and its VkPipelineCache keeps
// nothing. A run makes each of its pipelines once and has no use for this; a device keeps none unless a
// KeptPipelines stands beside it.
//
// A pipeline has one owner at a time, so that an owner may treat it as its own. The layouts with which it was
// made stay with it.
#pragma once

#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <string>

#include "gpu/vulkan.h"

namespace greatx::gpu {

class Device;

/// Represents a pipeline and what it was made with.
struct KeptPipeline {
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
};

/// Destroys what is not null.
void destroy(const Device& device, const KeptPipeline& kept);

class KeptPipelines {
 public:
  /// From now on, pipelines of the device are kept. Beyond `most`, the one that was given first is destroyed.
  explicit KeptPipelines(const Device& device, size_t most = 400);
  /// Destroys them. The device still lives then. Pipelines that are still in use are destroyed by their
  /// owners.
  ~KeptPipelines();
  KeptPipelines(const KeptPipelines&) = delete;
  KeptPipelines& operator=(const KeptPipelines&) = delete;

  /// Returns the keeper of a device, or null.
  static KeptPipelines* of(const Device& device);

  /// Says what the pipelines of a layout are made of: all that the driver is told about them, in a text.
  void describe(VkPipelineLayout layout, std::string what);
  /// Hands out a pipeline of that description, if one is kept.
  std::optional<KeptPipeline> take(const std::string& what);
  /// Keeps a pipeline whose owner is done with it and whose layout was described. Destroys it otherwise.
  void give(const KeptPipeline& kept);
  size_t count() const;

 private:
  struct Entry {
    std::string what;
    KeptPipeline kept;
  };
  const Device& device_;
  const size_t most_;
  mutable std::mutex mutex_;
  std::list<Entry> idle_;    ///< in the order in which they were given
  std::list<Entry> in_use_;  ///< described ones; only their layout is set
};

}  // namespace greatx::gpu
