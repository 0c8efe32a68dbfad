// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What a window and a run without one share: the ImGui context, its drawing, textures and injected input.
#pragma once

#include <chrono>
#include <deque>
#include <imgui.h>

#include "gpu/present/presenter.h"
#include "view/window/window.h"

namespace greatx::view {

class ImGuiWindow : public Window {
 public:
  bool begin_frame(const FrameWait& wait) final;
  void end_frame() final;
  void finish() final { device_->wait_idle(); }
  Array screenshot() final;
  void inject(const InputEvent& event) final { injected_.push_back(event); }
  TextureId make_texture(const Array& picture) final;
  void update_texture(TextureId texture, const Array& picture) final;
  void drop_texture(TextureId texture) final;

 protected:
  explicit ImGuiWindow(const WindowOptions& options);
  ~ImGuiWindow() override;
  /// Starts drawing; `surface` is null without a window. To be called once, by the constructor of a subclass.
  void start(const gpu::PresentInstance& instance, const gpu::Surface* surface, const WindowOptions& options);
  /// Stops drawing, before the surface goes. To be called once, by the destructor of a subclass.
  void stop();

  /// Waits at most `wait_s` for input and takes it. Returns false if the window was closed.
  virtual bool poll(double wait_s) = 0;
  /// Sets ImGui's size, time and input for a new frame.
  virtual void begin_input() = 0;
  /// Changes the window itself: resize, minimize, restore.
  virtual void change_window(const InputEvent& event) = 0;
  /// A key of a script, given to ImGui as the window system would give it.
  virtual void press_key(const InputEvent& event, bool down);
  /// Makes the surface anew, because it is lost. Nothing uses the old one any more. Returns null without a
  /// window.
  virtual const gpu::Surface* remake_surface() { return nullptr; }

  /// Whether the input of a script holds the mouse, so that the real one must not move it.
  bool scripted() const { return scripted_; }

 private:
  bool wait_for_frame(const FrameWait& wait);
  /// Makes fonts and spaces of the size that pixel_scale() asks for, if it has changed.
  void follow_scale();
  void rebuild();
  void take_injected();
  void apply(const InputEvent& event);

  ImGuiContext* context_ = nullptr;
  std::string settings_file_, device_name_;
  const gpu::PresentInstance* instance_ = nullptr;
  gpu::PresentFaults faults_;
  std::chrono::steady_clock::time_point frame_began_;
  int losses_ = 0;  ///< since the last frame that was drawn
  std::unique_ptr<gpu::PresentDevice> device_;
  std::unique_ptr<gpu::Presenter> presenter_;
  std::deque<InputEvent> injected_;
  double scale_ = 0.0;  ///< of fonts and spaces; 0: there are none yet
  bool scripted_ = false;
  ImVec2 scripted_mouse_{0, 0};
  bool scripted_buttons_[3] = {false, false, false};
  float scripted_wheel_ = 0.0f;
};

std::unique_ptr<Window> open_glfw_window(const WindowOptions& options);
std::unique_ptr<Window> open_offscreen_window(const WindowOptions& options);

}  // namespace greatx::view
