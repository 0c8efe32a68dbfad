// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records commands in a straight line: scopes, explicit barriers, push descriptors, dispatches, draws,
// copies.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gpu/acceleration.h"
#include "gpu/pipeline.h"
#include "gpu/resources.h"

namespace greatx::gpu {

/// Describes one side of a barrier.
struct Sync {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
};
namespace sync {
inline constexpr Sync none{VK_PIPELINE_STAGE_2_NONE, 0};
inline constexpr Sync compute_write{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_WRITE_BIT};
inline constexpr Sync compute_read{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_READ_BIT};
/// Covers all accesses of compute shaders to buffers.
inline constexpr Sync compute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                              VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT};
inline constexpr Sync transfer_write{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Sync transfer_read{VK_PIPELINE_STAGE_2_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Sync host_read{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
inline constexpr Sync build_read{
    VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
    VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};
inline constexpr Sync build_write{VK_PIPELINE_STAGE_2_ACCELERATION_STRUCTURE_BUILD_BIT_KHR,
                                  VK_ACCESS_2_ACCELERATION_STRUCTURE_WRITE_BIT_KHR};
inline constexpr Sync ray_query_read{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
    VK_ACCESS_2_ACCELERATION_STRUCTURE_READ_BIT_KHR};
}  // namespace sync

/// Holds the groups of a dispatch along x and y.
struct GroupGrid {
  uint32_t x = 0, y = 0;
  friend bool operator==(const GroupGrid&, const GroupGrid&) = default;
};
/// Returns rows of at most 65535 groups, which every device takes along an axis. The rows are as even as they
/// can be: x * y is `groups` or up to y - 1 more.
GroupGrid group_grid(uint64_t groups);

/// Holds a descriptor that is pushed into set 0.
struct Descriptor {
  uint32_t slot = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  VkDescriptorBufferInfo buffer_info{};
  VkDescriptorImageInfo image_info{};
  VkAccelerationStructureKHR structure = VK_NULL_HANDLE;

  static Descriptor buffer(uint32_t slot, const Slice& slice);
  static Descriptor buffer(uint32_t slot, const Buffer& buffer) {
    return Descriptor::buffer(slot, buffer.slice());
  }
  static Descriptor sampled(uint32_t slot, const Image& image, const Sampler& sampler);
  static Descriptor storage(uint32_t slot, const Image& image);
  static Descriptor acceleration(uint32_t slot, const AccelerationStructure& structure);
};

struct ColorTarget {
  Image* image = nullptr;
  VkClearColorValue clear{};
};

struct RenderTargets {
  std::vector<ColorTarget> color;
  Image* depth = nullptr;
  float clear_depth = 0.0f;  ///< reversed depth: far is 0
  bool keep_depth = false;   ///< draws onto the depth that the image holds, instead of clear_depth
  uint32_t width = 0, height = 0;
};

/// Holds the time that a scope took on the GPU.
struct PassTime {
  std::string name;
  double milliseconds = 0.0;
};

class Cmd;

/// Represents the timestamps of one command buffer.
class Timestamps {
 public:
  Timestamps() = default;
  Timestamps(Device& device, uint32_t max_scopes);
  ~Timestamps();
  Timestamps(Timestamps&& other) noexcept;
  Timestamps& operator=(Timestamps&& other) noexcept;
  /// Records that the timestamps so far are copied to `to`, of bytes(). The submission then holds its own
  /// times: to ask the driver for them would make some drivers (lavapipe) wait for all later submissions.
  void record_copy(Cmd& cmd, const Slice& to);
  VkDeviceSize bytes() const { return 2 * sizeof(uint64_t) * names_.size(); }
  /// Returns the times in recording order. record_copy() was recorded, and the submission must be done.
  std::vector<PassTime> read() const;
  /// Resets the timestamps. Called before the command buffer is recorded anew.
  void reset();

 private:
  friend class Cmd;
  Device* device_ = nullptr;
  VkQueryPool pool_ = VK_NULL_HANDLE;
  uint32_t max_scopes_ = 0;
  std::vector<std::string> names_;
  Slice copy_;
};

/// Represents a command buffer that is being recorded. The caller records barriers and image transitions, one
/// at each hand-over.
class Cmd {
 public:
  Cmd(Device& device, VkCommandBuffer handle, Timestamps* timestamps)
      : device_(&device), handle_(handle), timestamps_(timestamps) {}

  /// Gives one pass a debug label and GPU timestamps, and counts it, until the end of the C++ scope. Scopes
  /// beyond the room of the tick's Timestamps are not timed.
  class Scope {
   public:
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    friend class Cmd;
    Scope(Cmd& cmd, std::string_view name);
    Cmd& cmd_;
    uint32_t index_;
  };
  [[nodiscard]] Scope scope(std::string_view name) { return Scope(*this, name); }

  void barrier(const Sync& from, const Sync& to);
  /// Records a transition to the next use. With `discard` the old content is not needed.
  void transition(Image& image, ImageUse use, bool discard = false);

  void bind(const Pipeline& pipeline);
  /// Pushes descriptors for the bound pipeline. Throws UserError naming the buffer if it is larger than this
  /// device lets a shader see at once (maxStorageBufferRange). A buffer that may grow so large is split, or
  /// read by its address.
  void push(std::initializer_list<Descriptor> descriptors) {
    push(std::span(descriptors.begin(), descriptors.size()));
  }
  void push(std::span<const Descriptor> descriptors);
  template <typename T>
  void constants(const T& values) {
    push_constants(&values, sizeof(T));
  }
  void dispatch(uint32_t x, uint32_t y = 1, uint32_t z = 1);
  /// Dispatches at least `invocations`, in rows of groups of `group_size` (along x). Shaders number the
  /// invocations by shaders/lib/linear.glsl and leave out those beyond their count. 0 invocations record
  /// nothing.
  void dispatch_linear(uint64_t invocations, uint32_t group_size);
  void bind_indices(const Buffer& buffer);  ///< uint32
  /// Draws without an index buffer: gl_VertexIndex counts from `first_vertex`, gl_InstanceIndex is
  /// `first_instance`.
  void draw_range(uint32_t first_vertex, uint32_t vertices, uint32_t first_instance);
  void draw_indexed(uint32_t first_index, uint32_t index_count, uint32_t first_instance);

  void begin_rendering(const RenderTargets& targets);
  /// Clears parts of the depth image that is being rendered to.
  void clear_depth(std::span<const VkRect2D> parts, float value);
  /// Restricts the following draws to a part of the targets, which clip space then fills.
  void viewport(const VkRect2D& part);
  void viewport(uint32_t x, uint32_t y, uint32_t size);  ///< a square
  void end_rendering();

  /// Returns whether the GPU may leave out the draws that are being recorded (gpu/condition.h).
  bool conditional() const { return conditional_; }

  void copy(const Slice& from, const Slice& to);
  /// The copies between images and slices take all layers of one mip, tightly packed.
  void copy(const Slice& from, const Image& to, uint32_t mip = 0);  ///< image in transfer_target
  /// Copies a square from an image in transfer_source to the same place of one in transfer_target.
  void copy_square(const Image& from, const Image& to, uint32_t x, uint32_t y, uint32_t size);
  void fill(const Slice& slice, uint32_t word);
  /// Fills the mips from 1 on from mip 0. The image is in transfer_target before and in sampled after.
  void generate_mipmaps(Image& image);

  VkCommandBuffer handle() const { return handle_; }
  Device& device() const { return *device_; }

 private:
  friend class Condition;
  void push_constants(const void* data, uint32_t bytes);
  void check_range(const Descriptor& descriptor) const;
  Device* device_;
  VkCommandBuffer handle_;
  Timestamps* timestamps_;
  const Pipeline* bound_ = nullptr;
  bool conditional_ = false;
};

/// Records set-up work outside the ticks with `record(cmd)`, submits it and waits.
template <typename F>
void submit_setup(Device& device, F&& record);

/// Returns a device-local buffer, filled from the host through a staging buffer and a set-up submission.
Buffer upload_buffer(Device& device, std::span<const std::byte> bytes, std::string_view name,
                     VkBufferUsageFlags extra_usage = 0);

/// Fills an image from the host, mip by mip, tightly packed, in one set-up submission. The image is then
/// ready to be sampled.
void upload_image(Device& device, Image& image, std::span<const std::span<const std::byte>> mips);

namespace detail {
class SetupSubmission {
 public:
  explicit SetupSubmission(Device& device);
  ~SetupSubmission();
  SetupSubmission(const SetupSubmission&) = delete;
  SetupSubmission& operator=(const SetupSubmission&) = delete;
  Cmd& cmd() { return cmd_; }
  void submit_and_wait();

 private:
  Device& device_;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  Cmd cmd_;
};
}  // namespace detail

template <typename F>
void submit_setup(Device& device, F&& record) {
  detail::SetupSubmission submission(device);
  record(submission.cmd());
  submission.submit_and_wait();
}

}  // namespace greatx::gpu
