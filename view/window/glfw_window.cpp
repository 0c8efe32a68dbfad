// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A real window, by GLFW.
#include <algorithm>
#include <optional>
#include <utility>

#define GLFW_INCLUDE_VULKAN
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>

#include "core/error.h"
#include "view/window/imgui_window.h"

namespace greatx::view {

namespace {

std::string glfw_message() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text == nullptr ? "no reason is known" : text;
}

/// GLFW itself: it ends after every window.
class Glfw {
 public:
  Glfw() {
    if (glfwInit() != GLFW_TRUE)
      throw_user_error(
          "no display: a window cannot be opened ({}); --offscreen draws without one, and xvfb-run gives one",
          glfw_message());
  }
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;

  std::vector<std::string> extensions() const {
    uint32_t count = 0;
    const char** const names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr)
      throw_user_error("no window can be opened for Vulkan ({}); --offscreen draws without one",
                       glfw_message());
    return {names, names + count};
  }
};

class GlfwHandle {
 public:
  explicit GlfwHandle(const WindowOptions& options) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    window_ = glfwCreateWindow(options.width, options.height, options.title.c_str(), nullptr, nullptr);
    if (window_ == nullptr)
      throw_user_error("no window can be opened ({}); --offscreen draws without one", glfw_message());
  }
  ~GlfwHandle() { glfwDestroyWindow(window_); }
  GlfwHandle(const GlfwHandle&) = delete;
  GlfwHandle& operator=(const GlfwHandle&) = delete;
  GLFWwindow* get() const { return window_; }

 private:
  GLFWwindow* window_ = nullptr;
};

VkSurfaceKHR make_surface(const gpu::PresentInstance& instance, GLFWwindow* window) {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  GREATX_VK(glfwCreateWindowSurface(instance.handle(), window, nullptr, &surface));
  return surface;
}

class GlfwWindow final : public ImGuiWindow {
 public:
  explicit GlfwWindow(const WindowOptions& options)
      : ImGuiWindow(options),
        window_(options),
        scale_(options.scale),
        instance_(glfw_.extensions(), options.validation),
        surface_(std::in_place, instance_, make_surface(instance_, window_.get())) {
    ImGui_ImplGlfw_InitForOther(window_.get(), true);
    start(instance_, &*surface_, options);
  }
  ~GlfwWindow() override {
    stop();
    ImGui_ImplGlfw_Shutdown();
  }

  void set_title(const std::string& title) override { glfwSetWindowTitle(window_.get(), title.c_str()); }
  bool minimized() const override { return glfwGetWindowAttrib(window_.get(), GLFW_ICONIFIED) != 0; }
  double pixel_scale() const override {
    if (scale_ > 0.0) return scale_;
    float x = 1.0f, y = 1.0f;
    glfwGetWindowContentScale(window_.get(), &x, &y);
    return x > 1.0f ? x : 1.0;
  }
  int width() const override { return size().first; }
  int height() const override { return size().second; }
  std::vector<std::string> validation_messages() override { return instance_.validation_log()->take(); }

 private:
  std::pair<int, int> size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_.get(), &width, &height);
    return {width, height};
  }
  bool poll(double wait_s) override {
    // A minimised window draws nothing, so nothing else would make it wait.
    if (minimized()) wait_s = std::max(wait_s, 0.05);
    if (wait_s > 0.0)
      glfwWaitEventsTimeout(wait_s);
    else
      glfwPollEvents();
    return glfwWindowShouldClose(window_.get()) == 0;
  }
  const gpu::Surface* remake_surface() override {
    surface_.reset();  // a window has one at a time
    return &surface_.emplace(instance_, make_surface(instance_, window_.get()));
  }
  void begin_input() override {
    ImGui_ImplGlfw_NewFrame();
    // A display may count its mouse in other units than pixels. ImGui here counts in pixels throughout, so
    // that fonts, the scene's picture and scripts are exact.
    ImGuiIO& io = ImGui::GetIO();
    const ImVec2 ratio = io.DisplayFramebufferScale;
    if (!(ratio.x > 0.0f) || !(ratio.y > 0.0f) || (ratio.x == 1.0f && ratio.y == 1.0f)) return;
    io.DisplaySize = {io.DisplaySize.x * ratio.x, io.DisplaySize.y * ratio.y};
    io.DisplayFramebufferScale = {1.0f, 1.0f};
    if (ImGui::IsMousePosValid(&io.MousePos)) {
      io.MousePos.x *= ratio.x;
      io.MousePos.y *= ratio.y;
    }
  }
  void press_key(const InputEvent& event, bool down) override {
    // The backend takes its modifiers from the keys that are down.
    const int action = down ? GLFW_PRESS : GLFW_RELEASE;
    const auto key = [&](int code) { ImGui_ImplGlfw_KeyCallback(window_.get(), code, 0, action, 0); };
    if (event.control) key(GLFW_KEY_LEFT_CONTROL);
    if (event.shift) key(GLFW_KEY_LEFT_SHIFT);
    if (event.alt) key(GLFW_KEY_LEFT_ALT);
    key(event.key);
  }
  void change_window(const InputEvent& event) override {
    switch (event.kind) {
      case InputEvent::Kind::resize:
        glfwSetWindowSize(window_.get(), static_cast<int>(event.x), static_cast<int>(event.y));
        break;
      case InputEvent::Kind::minimize:
        glfwIconifyWindow(window_.get());
        break;
      case InputEvent::Kind::scale:
        scale_ = event.x;
        break;
      default:
        glfwRestoreWindow(window_.get());
    }
  }

  Glfw glfw_;
  GlfwHandle window_;
  double scale_;  ///< 0: as the display asks for
  gpu::PresentInstance instance_;
  std::optional<gpu::Surface> surface_;
};

}  // namespace

std::unique_ptr<Window> open_glfw_window(const WindowOptions& options) {
  return std::make_unique<GlfwWindow>(options);
}

}  // namespace greatx::view
