// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/window/imgui_window.h"

#include <algorithm>
#include <backends/imgui_impl_vulkan.h>
#include <filesystem>

#include "core/error.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

constexpr size_t most_textures = gpu::Presenter::most_textures - 1;  // one is the font

std::vector<std::byte> rgba_of(const Array& picture) {
  GREATX_CHECK(picture.dtype == DType::u8 && picture.shape.size() == 3 &&
                   (picture.shape[2] == 3 || picture.shape[2] == 4),
               "a picture of {} axes", picture.shape.size());
  if (picture.shape[2] == 4) return picture.bytes;
  const size_t pixels = picture.bytes.size() / 3;
  std::vector<std::byte> rgba(4 * pixels, std::byte{255});
  for (size_t i = 0; i < pixels; ++i) std::copy_n(&picture.bytes[3 * i], 3, &rgba[4 * i]);
  return rgba;
}

VkExtent2D extent_of(const Array& picture) {
  return {static_cast<uint32_t>(picture.shape.at(1)), static_cast<uint32_t>(picture.shape.at(0))};
}

void check_imgui(VkResult result) { gpu::check_vk(result, "Dear ImGui's Vulkan backend"); }

}  // namespace

ImGuiWindow::ImGuiWindow(const WindowOptions& options) : settings_file_(options.settings_file) {
  context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = settings_file_.empty() ? nullptr : settings_file_.c_str();
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
}
ImGuiWindow::~ImGuiWindow() { ImGui::DestroyContext(context_); }

void ImGuiWindow::start(const gpu::PresentInstance& instance, const gpu::Surface* surface,
                        const WindowOptions& options) {
  device_ = std::make_unique<gpu::PresentDevice>(instance, surface, options.device);
  presenter_ = std::make_unique<gpu::Presenter>(*device_, surface);
  ImGui_ImplVulkan_InitInfo info{};
  info.Instance = device_->instance();
  info.PhysicalDevice = device_->physical();
  info.Device = device_->handle();
  info.QueueFamily = device_->queue_family();
  info.Queue = device_->queue();
  info.DescriptorPool = presenter_->descriptor_pool();
  info.MinImageCount = info.ImageCount = gpu::Presenter::frames_in_flight;
  info.CheckVkResultFn = check_imgui;
  started_ = ImGui_ImplVulkan_Init(&info, presenter_->render_pass());
  set_style(static_cast<float>(pixel_scale()));
  presenter_->run_now([](VkCommandBuffer cmd) { ImGui_ImplVulkan_CreateFontsTexture(cmd); });
  ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void ImGuiWindow::stop() {
  if (device_ == nullptr) return;
  device_->wait_idle();
  if (started_) ImGui_ImplVulkan_Shutdown();
  presenter_.reset();
  device_.reset();
}

bool ImGuiWindow::begin_frame(double wait_s) {
  if (!poll(injected_.empty() ? wait_s : 0.0)) return false;
  take_injected();
  ImGui_ImplVulkan_NewFrame();
  begin_input();
  ImGuiIO& io = ImGui::GetIO();
  if (scripted_) {
    io.MousePos = scripted_mouse_;
    std::copy_n(scripted_buttons_, 3, io.MouseDown);
    io.MouseWheel = std::exchange(scripted_wheel_, 0.0f);
  }
  ImGui::NewFrame();
  return true;
}

void ImGuiWindow::take_injected() {
  if (injected_.empty()) return;
  // One event a frame, as a person is slower than a frame: ImGui sees each press and release.
  const InputEvent event = injected_.front();
  injected_.pop_front();
  apply(event);
}

void ImGuiWindow::apply(const InputEvent& event) {
  using Kind = InputEvent::Kind;
  switch (event.kind) {
    case Kind::move:
      scripted_ = true;
      scripted_mouse_ = {static_cast<float>(event.x), static_cast<float>(event.y)};
      break;
    case Kind::press:
    case Kind::release:
      scripted_ = true;
      scripted_mouse_ = {static_cast<float>(event.x), static_cast<float>(event.y)};
      scripted_buttons_[std::clamp(event.button, 0, 2)] = event.kind == Kind::press;
      break;
    case Kind::wheel:
      scripted_ = true;
      scripted_wheel_ += static_cast<float>(event.y);
      break;
    case Kind::key_down:
    case Kind::key_up:
      press_key(event, event.kind == Kind::key_down);
      break;
    case Kind::text:
      ImGui::GetIO().AddInputCharactersUTF8(event.text.c_str());
      break;
    case Kind::resize:
    case Kind::minimize:
    case Kind::restore:
      change_window(event);
      break;
  }
}

void ImGuiWindow::press_key(const InputEvent& event, bool down) {
  ImGuiIO& io = ImGui::GetIO();
  if (event.key > 0 && event.key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[event.key] = down;
  io.KeyCtrl = down && event.control;
  io.KeyShift = down && event.shift;
  io.KeyAlt = down && event.alt;
}

void ImGuiWindow::end_frame() {
  ImGui::Render();
  ImDrawData* const data = ImGui::GetDrawData();
  const VkExtent2D extent{static_cast<uint32_t>(std::max(width(), 0)),
                          static_cast<uint32_t>(std::max(height(), 0))};
  if (minimized() || extent.width == 0 || extent.height == 0) return;
  presenter_->frame(extent, [&](VkCommandBuffer cmd) { ImGui_ImplVulkan_RenderDrawData(data, cmd); });
}

Array ImGuiWindow::screenshot() {
  const std::vector<std::byte> rgba = presenter_->read_back();
  const VkExtent2D extent = presenter_->extent();
  Array picture(DType::u8, {extent.height, extent.width, 3});
  for (size_t i = 0; i < picture.bytes.size() / 3; ++i) std::copy_n(&rgba[4 * i], 3, &picture.bytes[3 * i]);
  return picture;
}

TextureId ImGuiWindow::make_texture(const Array& picture) {
  if (textures_.size() >= most_textures)
    throw_user_error("the viewer shows at most {} pictures at once", most_textures);
  const gpu::PresentTextureId texture = presenter_->make_texture(extent_of(picture));
  const TextureId id = ImGui_ImplVulkan_AddTexture(presenter_->sampler(), presenter_->view_of(texture),
                                                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  textures_[id] = texture;
  presenter_->update(texture, rgba_of(picture));
  return id;
}

void ImGuiWindow::update_texture(TextureId texture, const Array& picture) {
  presenter_->update(textures_.at(texture), rgba_of(picture));
}

void ImGuiWindow::drop_texture(TextureId texture) {
  const auto found = textures_.find(texture);
  GREATX_CHECK(found != textures_.end(), "a texture that is not there");
  VkDescriptorSet set = static_cast<VkDescriptorSet>(texture);
  presenter_->drop(found->second, [device = device_->handle(), pool = presenter_->descriptor_pool(), set] {
    vkFreeDescriptorSets(device, pool, 1, &set);
  });
  textures_.erase(found);
}

std::unique_ptr<Window> Window::open(const WindowOptions& options) {
  return options.offscreen ? open_offscreen_window(options) : open_glfw_window(options);
}

}  // namespace greatx::view
