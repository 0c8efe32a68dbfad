// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Says how much memory buffers and images take.
#pragma once

#include <cstdint>

#include "gpu/device.h"

namespace greatx::gpu {

struct MemoryUse {
  /// Bytes of the buffers and images of all Devices of this process. The window's own device
  /// (gpu/present) is not among them.
  uint64_t allocated_bytes = 0;
  /// Bytes that the process uses in the device's largest local heap, and may use there at present
  /// (VK_EXT_memory_budget). Both are 0 if the driver does not say.
  uint64_t used_bytes = 0, budget_bytes = 0;
};

/// May be called from any thread while the device lives.
MemoryUse memory_use(const Device& device);

/// Counts an allocation, or one that is gone. Buffers and images call these.
void count_allocated(uint64_t bytes);
void count_freed(uint64_t bytes);

}  // namespace greatx::gpu
