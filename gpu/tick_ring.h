// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines a ring of N slots in flight. Each slot has a command buffer, an upload and a readback arena, and
// timestamps. One timeline semaphore counts the submitted ticks. A tick is one submission.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "gpu/cmd.h"
#include "gpu/resources.h"

namespace greatx::gpu {

/// Represents memory that is handed out front to back and taken back all at once. It grows by a block when a
/// tick asks for more than any tick before it. A steady state allocates nothing.
class Arena {
 public:
  Arena() = default;
  Arena(Device& device, Memory memory, VkDeviceSize bytes, std::string name);
  /// Returns a slice aligned to 256 bytes. Its content is undefined.
  Slice allocate(VkDeviceSize bytes);
  template <typename T>
  Slice allocate_for(size_t count) {
    return allocate(sizeof(T) * count);
  }
  /// Copies `values` in.
  template <typename T>
  Slice put(std::span<const T> values) {
    const Slice slice = allocate(values.size_bytes());
    std::copy_n(reinterpret_cast<const std::byte*>(values.data()), values.size_bytes(), slice.mapped);
    return slice;
  }
  void reset();
  uint64_t growths() const { return growths_; }

 private:
  Device* device_ = nullptr;
  Memory memory_ = Memory::upload;
  std::string name_;
  std::vector<Buffer> blocks_;
  size_t block_ = 0;
  VkDeviceSize used_ = 0;
  uint64_t growths_ = 0;
};

/// Holds everything that one tick needs while it is in flight. Slices of its arenas are valid until the slot
/// is begun again.
struct TickSlot {
  uint32_t index = 0;
  Cmd* cmd = nullptr;  ///< valid between begin and submit
  Arena upload;
  Arena readback;
  Timestamps timestamps;
  uint64_t submission = 0;  ///< value of the timeline when the submission is done
  uint64_t number = 0;      ///< number of the submission on the device
};

class TickRing {
 public:
  TickRing(Device& device, uint32_t slots, VkDeviceSize upload_bytes, VkDeviceSize readback_bytes);
  ~TickRing();
  TickRing(const TickRing&) = delete;
  TickRing& operator=(const TickRing&) = delete;

  /// Returns the next slot in turn. Waits until the slot's last submission is done, resets its arenas and
  /// starts recording.
  TickSlot& begin();
  /// A submission counts as a tick, or as work before the first tick.
  enum class Kind { tick, setup };
  /// Ends the recording with a barrier from all writes to host reads, and submits the slot in one submission.
  void submit(TickSlot& slot, Kind kind = Kind::tick);
  /// Blocks until the slot's submission is done. Its readback arena and timestamps may then be read.
  void wait(const TickSlot& slot) const;
  uint32_t slot_count() const { return static_cast<uint32_t>(slots_.size()); }

 private:
  Device& device_;
  VkSemaphore timeline_ = VK_NULL_HANDLE;
  uint64_t submitted_ = 0;
  uint32_t next_ = 0;
  std::vector<TickSlot> slots_;
  std::vector<VkCommandPool> pools_;
  std::vector<Cmd> cmds_;
};

}  // namespace greatx::gpu
