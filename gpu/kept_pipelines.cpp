// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "gpu/kept_pipelines.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/error.h"
#include "gpu/device.h"

namespace greatx::gpu {

namespace {

/// Knows the keepers of all devices. A device has no member for its keeper, since a run has none.
struct Keepers {
  std::mutex mutex;
  std::map<const Device*, KeptPipelines*> all;
};
Keepers& keepers() {
  static Keepers known;
  return known;
}

}  // namespace

void destroy(const Device& device, const KeptPipeline& kept) {
  vkDestroyPipeline(device.handle(), kept.pipeline, nullptr);
  vkDestroyPipelineLayout(device.handle(), kept.layout, nullptr);
  vkDestroyDescriptorSetLayout(device.handle(), kept.set_layout, nullptr);
}

KeptPipelines::KeptPipelines(const Device& device, size_t most) : device_(device), most_(most) {
  const std::lock_guard lock(keepers().mutex);
  GREATX_CHECK(keepers().all.try_emplace(&device, this).second, "the device has a keeper of pipelines");
}

KeptPipelines::~KeptPipelines() {
  {
    const std::lock_guard lock(keepers().mutex);
    keepers().all.erase(&device_);
  }
  for (const Entry& entry : idle_) destroy(device_, entry.kept);
}

KeptPipelines* KeptPipelines::of(const Device& device) {
  const std::lock_guard lock(keepers().mutex);
  const auto found = keepers().all.find(&device);
  return found == keepers().all.end() ? nullptr : found->second;
}

void KeptPipelines::describe(VkPipelineLayout layout, std::string what) {
  const std::lock_guard lock(mutex_);
  in_use_.push_back({std::move(what), {VK_NULL_HANDLE, layout, VK_NULL_HANDLE}});
}

std::optional<KeptPipeline> KeptPipelines::take(const std::string& what) {
  const std::lock_guard lock(mutex_);
  const auto found = std::ranges::find(idle_, what, &Entry::what);
  if (found == idle_.end()) return std::nullopt;
  const KeptPipeline kept = found->kept;
  in_use_.push_back({std::move(found->what), {VK_NULL_HANDLE, kept.layout, VK_NULL_HANDLE}});
  idle_.erase(found);
  return kept;
}

void KeptPipelines::give(const KeptPipeline& kept) {
  const std::lock_guard lock(mutex_);
  const auto used =
      std::ranges::find(in_use_, kept.layout, [](const Entry& entry) { return entry.kept.layout; });
  const bool known = used != in_use_.end();
  if (known && kept.pipeline != VK_NULL_HANDLE && most_ > 0) {
    if (idle_.size() == most_) {
      destroy(device_, idle_.front().kept);
      idle_.pop_front();
    }
    idle_.push_back({std::move(used->what), kept});
  } else {
    destroy(device_, kept);
  }
  if (known) in_use_.erase(used);
}

size_t KeptPipelines::count() const {
  const std::lock_guard lock(mutex_);
  return idle_.size();
}

}  // namespace greatx::gpu
