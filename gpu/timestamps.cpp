// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "gpu/cmd.h"

namespace greatx::gpu {

Timestamps::Timestamps(Device& device, uint32_t max_scopes) : device_(&device), max_scopes_(max_scopes) {
  VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
  info.queryType = VK_QUERY_TYPE_TIMESTAMP;
  info.queryCount = 2 * max_scopes;
  GREATX_VK(vkCreateQueryPool(device.handle(), &info, nullptr, &pool_));
  vkResetQueryPool(device.handle(), pool_, 0, 2 * max_scopes);
}
Timestamps::~Timestamps() {
  if (pool_ == VK_NULL_HANDLE) return;
  device_->finish();
  vkDestroyQueryPool(device_->handle(), pool_, nullptr);
}
Timestamps::Timestamps(Timestamps&& other) noexcept { *this = std::move(other); }
Timestamps& Timestamps::operator=(Timestamps&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(pool_, other.pool_);
  std::swap(max_scopes_, other.max_scopes_);
  std::swap(names_, other.names_);
  std::swap(copy_, other.copy_);
  return *this;
}

void Timestamps::reset() {
  vkResetQueryPool(device_->handle(), pool_, 0, 2 * max_scopes_);
  names_.clear();
  copy_ = {};
}

void Timestamps::record_copy(Cmd& cmd, const Slice& to) {
  copy_ = to;
  if (names_.empty()) return;
  vkCmdCopyQueryPoolResults(cmd.handle(), pool_, 0, static_cast<uint32_t>(2 * names_.size()), to.buffer,
                            to.offset, sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT);
}

std::vector<PassTime> Timestamps::read() const {
  if (names_.empty()) return {};
  const std::span<const uint64_t> stamps = copy_.as<uint64_t>();
  const double milliseconds = static_cast<double>(device_->limits().timestampPeriod) * 1e-6;
  std::vector<PassTime> times;
  for (size_t i = 0; i < names_.size(); ++i)
    times.push_back({names_[i], static_cast<double>(stamps[2 * i + 1] - stamps[2 * i]) * milliseconds});
  return times;
}

}  // namespace greatx::gpu
