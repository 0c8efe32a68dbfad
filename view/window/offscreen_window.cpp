// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A window that exists in memory alone. Unless asked otherwise, its time goes on by a sixtieth of a second
// with every frame, so that two runs of a script draw the same.
#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "view/window/imgui_window.h"

namespace greatx::view {

namespace {

using Clock = std::chrono::steady_clock;

class OffscreenWindow final : public ImGuiWindow {
 public:
  explicit OffscreenWindow(const WindowOptions& options)
      : ImGuiWindow(options),
        instance_({}, options.validation),
        width_(options.width),
        height_(options.height),
        scale_(options.scale > 0.0 ? options.scale : 1.0),
        wall_clock_(options.wall_clock) {
    ImGui::GetIO().BackendPlatformName = "greatx offscreen";
    // ImGui's own keys by GLFW's codes, as its backend for GLFW sets them.
    ImGuiIO& io = ImGui::GetIO();
    const std::pair<ImGuiKey, int> keys[] = {
        {ImGuiKey_Tab, 258},      {ImGuiKey_LeftArrow, 263}, {ImGuiKey_RightArrow, 262},
        {ImGuiKey_UpArrow, 265},  {ImGuiKey_DownArrow, 264}, {ImGuiKey_PageUp, 266},
        {ImGuiKey_PageDown, 267}, {ImGuiKey_Home, 268},      {ImGuiKey_End, 269},
        {ImGuiKey_Delete, 261},   {ImGuiKey_Backspace, 259}, {ImGuiKey_Space, 32},
        {ImGuiKey_Enter, 257},    {ImGuiKey_Escape, 256},    {ImGuiKey_A, 'A'},
        {ImGuiKey_C, 'C'},        {ImGuiKey_V, 'V'},         {ImGuiKey_X, 'X'},
        {ImGuiKey_Y, 'Y'},        {ImGuiKey_Z, 'Z'}};
    for (const auto& [key, code] : keys) io.KeyMap[key] = code;
    start(instance_, nullptr, options);
  }
  ~OffscreenWindow() override { stop(); }

  void set_title(const std::string&) override {}
  bool minimized() const override { return minimized_; }
  double pixel_scale() const override { return scale_; }
  int width() const override { return width_; }
  int height() const override { return height_; }
  std::vector<std::string> validation_messages() override { return instance_.validation_log()->take(); }

 private:
  bool poll(double wait_s) override {
    std::this_thread::sleep_for(std::chrono::duration<double>(wait_s));
    return true;
  }
  void begin_input() override {
    ImGuiIO& io = ImGui::GetIO();
    io.DisplaySize = {static_cast<float>(width_), static_cast<float>(height_)};
    const Clock::time_point now = Clock::now();
    const float passed_s = std::chrono::duration<float>(now - std::exchange(last_frame_, now)).count();
    io.DeltaTime = wall_clock_ ? std::max(passed_s, 1e-6f) : 1.0f / 60.0f;
  }
  void change_window(const InputEvent& event) override {
    if (event.kind == InputEvent::Kind::scale) {
      scale_ = event.x;
      return;
    }
    minimized_ = event.kind == InputEvent::Kind::minimize;
    if (event.kind != InputEvent::Kind::resize) return;
    width_ = static_cast<int>(event.x);
    height_ = static_cast<int>(event.y);
  }

  gpu::PresentInstance instance_;
  int width_, height_;
  double scale_;
  const bool wall_clock_;
  Clock::time_point last_frame_ = Clock::now();
  bool minimized_ = false;
};

}  // namespace

std::unique_ptr<Window> open_offscreen_window(const WindowOptions& options) {
  return std::make_unique<OffscreenWindow>(options);
}

}  // namespace greatx::view
