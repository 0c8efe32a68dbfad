// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/window/imgui_window.h"

#include <algorithm>
#include <backends/imgui_impl_vulkan.h>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "core/error.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

std::vector<std::byte> rgba_of(const Array& picture) {
  GREATX_CHECK(picture.dtype == DType::u8 && picture.shape.size() == 3 &&
                   (picture.shape[2] == 3 || picture.shape[2] == 4),
               "a picture of {} axes", picture.shape.size());
  if (picture.shape[2] == 4) return picture.bytes;
  const size_t pixels = picture.bytes.size() / 3;
  std::vector<std::byte> rgba(4 * pixels);
  const std::byte* rgb = picture.bytes.data();
  for (std::byte *texel = rgba.data(), *const end = texel + rgba.size(); texel != end; texel += 4, rgb += 3) {
    texel[0] = rgb[0];
    texel[1] = rgb[1];
    texel[2] = rgb[2];
    texel[3] = std::byte{255};
  }
  return rgba;
}

VkExtent2D extent_of(const Array& picture) {
  return {static_cast<uint32_t>(picture.shape.at(1)), static_cast<uint32_t>(picture.shape.at(0))};
}

/// ImGui's ids are pointers, which stand for the numbers of textures here.
TextureId id_of(gpu::PresentTextureId texture) {
  return reinterpret_cast<TextureId>(static_cast<uintptr_t>(texture));
}
gpu::PresentTextureId texture_of(TextureId id) {
  return static_cast<gpu::PresentTextureId>(reinterpret_cast<uintptr_t>(id));
}

/// Returns the part of ImGui's rectangle (left, top, right, bottom) within the window.
VkRect2D clip_of(const ImVec4& rect, const ImDrawData& data, VkExtent2D extent) {
  const auto pixel = [](float value, uint32_t most) {
    return static_cast<int32_t>(std::clamp(value, 0.0f, static_cast<float>(most)));
  };
  const float sx = data.FramebufferScale.x, sy = data.FramebufferScale.y;
  const int32_t x0 = pixel((rect.x - data.DisplayPos.x) * sx, extent.width);
  const int32_t y0 = pixel((rect.y - data.DisplayPos.y) * sy, extent.height);
  const int32_t x1 = pixel((rect.z - data.DisplayPos.x) * sx, extent.width);
  const int32_t y1 = pixel((rect.w - data.DisplayPos.y) * sy, extent.height);
  return {{x0, y0},
          {static_cast<uint32_t>(std::max(x1 - x0, 0)), static_cast<uint32_t>(std::max(y1 - y0, 0))}};
}

static_assert(sizeof(ImDrawVert) == sizeof(gpu::UiVertex) && sizeof(ImDrawIdx) == sizeof(uint16_t));

gpu::UiDrawing drawing_of(const ImDrawData& data, VkExtent2D extent) {
  gpu::UiDrawing drawing;
  drawing.vertices.reserve(static_cast<size_t>(data.TotalVtxCount));
  drawing.indices.reserve(static_cast<size_t>(data.TotalIdxCount));
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    const auto first_vertex = static_cast<uint32_t>(drawing.vertices.size());
    const auto first_index = static_cast<uint32_t>(drawing.indices.size());
    for (const ImDrawVert& v : list.VtxBuffer)
      drawing.vertices.push_back({(v.pos.x - data.DisplayPos.x) * data.FramebufferScale.x,
                                  (v.pos.y - data.DisplayPos.y) * data.FramebufferScale.y, v.uv.x, v.uv.y,
                                  v.col});
    drawing.indices.insert(drawing.indices.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
    for (const ImDrawCmd& command : list.CmdBuffer) {
      if (command.UserCallback != nullptr || command.ElemCount == 0) continue;
      const VkRect2D clip = clip_of(command.ClipRect, data, extent);
      if (clip.extent.width == 0 || clip.extent.height == 0) continue;
      drawing.commands.push_back({clip, texture_of(command.GetTexID()), first_index + command.IdxOffset,
                                  command.ElemCount, first_vertex + command.VtxOffset});
    }
  }
  return drawing;
}

gpu::PresentFaults faults_of(const std::vector<WindowFault>& faults) {
  std::vector<gpu::PresentFaults::Fault> results;
  for (const WindowFault& fault : faults) {
    constexpr VkResult of_kind[] = {VK_ERROR_DEVICE_LOST, VK_ERROR_SURFACE_LOST_KHR,
                                    VK_ERROR_OUT_OF_DATE_KHR};
    results.push_back({fault.frame, of_kind[static_cast<size_t>(fault.kind)]});
  }
  return gpu::PresentFaults(std::move(results));
}

using Clock = std::chrono::steady_clock;
double seconds_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

constexpr double news_every_s = 0.002;  ///< they are asked for
/// So often in a row a device that is lost is opened anew.
constexpr int most_losses = 3;

}  // namespace

ImGuiWindow::ImGuiWindow(const WindowOptions& options) : settings_file_(options.settings_file) {
  context_ = ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = settings_file_.empty() ? nullptr : settings_file_.c_str();
  io.BackendRendererName = "greatx gpu/present";
  // Lists of more than 65536 vertices are drawn in parts.
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
}
ImGuiWindow::~ImGuiWindow() { ImGui::DestroyContext(context_); }

void ImGuiWindow::start(const gpu::PresentInstance& instance, const gpu::Surface* surface,
                        const WindowOptions& options) {
  instance_ = &instance;
  device_name_ = options.device;
  faults_ = faults_of(options.faults);
  device_ = std::make_unique<gpu::PresentDevice>(instance, surface, device_name_);
  presenter_ = std::make_unique<gpu::Presenter>(*device_, surface, faults_);
  follow_scale();
}

void ImGuiWindow::follow_scale() {
  if (scale_ == pixel_scale()) return;
  scale_ = pixel_scale();
  ImGuiIO& io = ImGui::GetIO();
  if (io.Fonts->TexID != nullptr) drop_texture(io.Fonts->TexID);
  set_style(static_cast<float>(scale_));
  unsigned char* texels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsRGBA32(&texels, &width, &height);
  const std::span<const unsigned char> values(texels, size_t{4} * static_cast<size_t>(width * height));
  io.Fonts->SetTexID(make_texture(Array::of<uint8_t>({height, width, 4}, values)));
}

void ImGuiWindow::stop() {
  if (device_ != nullptr) device_->wait_idle();
  presenter_.reset();
  device_.reset();
}

/// Returns false if the window was closed.
bool ImGuiWindow::wait_for_frame(const FrameWait& wait) {
  const Clock::time_point begin = Clock::now();
  for (bool input = false;;) {
    const Clock::time_point now = Clock::now();
    const double left_s = wait.most_s - seconds_between(begin, now);
    const bool may_begin = seconds_between(frame_began_, now) >= wait.input_after_s;
    input |= !injected_.empty();
    if (left_s <= 0.0 || (input && may_begin) || (wait.news && wait.news())) return poll(0.0);
    const double slice_s = std::min(left_s, news_every_s);
    if (!poll(slice_s)) return false;
    // It returns early for nothing but an event.
    input |= seconds_between(now, Clock::now()) < 0.9 * slice_s;
  }
}

bool ImGuiWindow::begin_frame(const FrameWait& wait) {
  if (!wait_for_frame(wait)) return false;
  frame_began_ = Clock::now();
  take_injected();
  follow_scale();
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
    case Kind::scale:
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
  const VkExtent2D extent{static_cast<uint32_t>(std::max(width(), 0)),
                          static_cast<uint32_t>(std::max(height(), 0))};
  if (minimized() || extent.width == 0 || extent.height == 0) return;
  const gpu::UiDrawing drawing = drawing_of(*ImGui::GetDrawData(), extent);
  for (;;) try {
      presenter_->frame(extent, drawing);
      losses_ = 0;
      return;
    } catch (const gpu::VulkanError& error) {
      if (!gpu::Presenter::is_loss(error.result())) throw;
      if (++losses_ > most_losses)
        throw std::runtime_error(fmt::format(
            "the window is lost after {} attempts to open its device anew: {}", most_losses, error.what()));
      spdlog::warn("{}: the window's device is opened anew", error.what());
      rebuild();
    }
}

/// Makes everything anew that was on a device or a surface that is lost.
void ImGuiWindow::rebuild() {
  gpu::Presenter::AllTexels texels = presenter_->take_texels();
  stop();
  const gpu::Surface* const surface = remake_surface();
  device_ = std::make_unique<gpu::PresentDevice>(*instance_, surface, device_name_);
  presenter_ = std::make_unique<gpu::Presenter>(*device_, surface, faults_);
  presenter_->restore(std::move(texels));
}

Array ImGuiWindow::screenshot() {
  const std::vector<std::byte> rgba = presenter_->read_back();
  const VkExtent2D extent = presenter_->extent();
  Array picture(DType::u8, {extent.height, extent.width, 3});
  for (size_t i = 0; i < picture.bytes.size() / 3; ++i) std::copy_n(&rgba[4 * i], 3, &picture.bytes[3 * i]);
  return picture;
}

TextureId ImGuiWindow::make_texture(const Array& picture) {
  const gpu::PresentTextureId texture = presenter_->make_texture(extent_of(picture), picture.shape[2] == 3);
  presenter_->update(texture, rgba_of(picture));
  return id_of(texture);
}

void ImGuiWindow::update_texture(TextureId texture, const Array& picture) {
  presenter_->update(texture_of(texture), rgba_of(picture));
}

void ImGuiWindow::drop_texture(TextureId texture) { presenter_->drop(texture_of(texture)); }

std::unique_ptr<Window> Window::open(const WindowOptions& options) {
  return options.offscreen ? open_offscreen_window(options) : open_glfw_window(options);
}

}  // namespace greatx::view
