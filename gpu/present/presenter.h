// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The frames of a user interface. They are drawn into one picture, and only where something has changed. The
// picture is then copied into the window, or only kept: so a window and a run without one draw the same, and
// the last picture can be read.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "gpu/present/present_device.h"
#include "gpu/present/present_faults.h"
#include "gpu/present/swapchain.h"
#include "gpu/present/ui_changes.h"
#include "gpu/present/ui_pipeline.h"

namespace greatx::gpu {

class Presenter {
 public:
  static constexpr uint32_t frames_in_flight = 2;

  /// The texels of all textures, which outlive a device that is lost.
  struct Texels {
    VkExtent2D extent{0, 0};
    bool opaque = false;
    std::vector<std::byte> rgba;  ///< empty: there were none yet
  };
  using AllTexels = std::map<PresentTextureId, Texels>;

  /// `surface` is null without a window. All three outlive the presenter.
  Presenter(const PresentDevice& device, const Surface* surface, PresentFaults& faults);
  ~Presenter();
  Presenter(const Presenter&) = delete;
  Presenter& operator=(const Presenter&) = delete;

  /// Draws a frame of `extent` pixels: the updates of textures, then the triangles. Shows it in the window,
  /// if there is one and it can be shown. An empty extent draws nothing. After a VulkanError for which
  /// is_loss() is true, device, surface and presenter must be made anew.
  void frame(VkExtent2D extent, const UiDrawing& drawing);
  /// Returns the pixels of the last frame, RGBA, [height, width, 4], and its extent; empty before the first.
  std::vector<std::byte> read_back();
  VkExtent2D extent() const { return last_extent_; }

  /// Makes a texture. Its content is undefined until update(). `opaque`: the alpha of all its texels is 255.
  PresentTextureId make_texture(VkExtent2D extent, bool opaque);
  VkExtent2D extent_of(PresentTextureId texture) const;
  /// Replaces the texels from the next frame on, RGBA, [height, width, 4].
  void update(PresentTextureId texture, std::vector<std::byte> rgba);
  /// The texture may still be in use by frames in flight: it is destroyed after them.
  void drop(PresentTextureId texture);
  /// Takes the texels of all textures, to give them to another presenter. This one is of no use then.
  AllTexels take_texels();
  /// Makes the textures with their ids. To be called once, before any other texture is made.
  void restore(AllTexels texels);
  static bool is_loss(VkResult result) {
    return result == VK_ERROR_DEVICE_LOST || result == VK_ERROR_SURFACE_LOST_KHR;
  }

 private:
  /// What one frame in flight needs.
  struct Frame {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer cmd = VK_NULL_HANDLE;
    VkFence done = VK_NULL_HANDLE;
    VkSemaphore acquired = VK_NULL_HANDLE;
    std::unique_ptr<PresentBuffer> staging, vertices, indices;
  };
  struct Texture {
    std::unique_ptr<PresentImage> image;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<std::byte> texels;  ///< kept, because the device may be lost
    bool opaque = false;
    bool pending = false;  ///< the image does not have them yet
    bool shown = false;    ///< it has had texels
    uint64_t version = 0;  ///< of the texels, among those of all textures
  };
  struct Dropped {
    Texture texture;
    uint64_t after_frame = 0;
  };

  void make_render_pass();
  Texture texture_of(VkExtent2D extent, bool opaque);
  bool covers(const UiCommand& command, const UiDrawing& drawing, const VkRect2D& part) const;
  void make_frame(Frame& frame);
  void fit_canvas(VkExtent2D extent);
  void fit(std::unique_ptr<PresentBuffer>& buffer, VkDeviceSize bytes, VkBufferUsageFlags usage);
  void record_updates(Frame& frame);
  void record_drawing(Frame& frame, VkExtent2D extent, const UiDrawing& drawing);
  void bind_triangles(Frame& frame, VkExtent2D extent, const UiDrawing& drawing);
  void record_part(Frame& frame, const VkRect2D& part, const UiDrawing& drawing);
  void record_copy(Frame& frame, uint32_t image);
  void submit(Frame& frame, std::optional<uint32_t> image);
  void sweep();

  const PresentDevice& device_;
  PresentFaults& faults_;
  std::unique_ptr<Swapchain> swapchain_;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  std::unique_ptr<UiPipeline> pipeline_;
  std::array<Frame, frames_in_flight> frames_;
  // The queue works in order, so the frames in flight share a picture.
  std::unique_ptr<PresentImage> canvas_;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
  bool canvas_is_new_ = true;
  UiChanges changes_;
  uint64_t texel_versions_ = 0;
  uint64_t frame_ = 0;  ///< number of the next frame
  VkExtent2D last_extent_{0, 0};
  std::map<PresentTextureId, Texture> textures_;
  std::vector<Dropped> dropped_;
  PresentTextureId next_texture_ = 1;
};

}  // namespace greatx::gpu
