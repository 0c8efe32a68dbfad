// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/window/style.h"

#include <cmath>
#include <filesystem>
#include <imgui.h>

namespace greatx::view {

namespace {

/// Where distributions keep a font that is easy to read; ImGui's own is the last resort.
constexpr const char* fonts[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/dejavu/DejaVuSans.ttf", "/usr/share/fonts/TTF/DejaVuSans.ttf"};

void load_font(float scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  std::error_code error;
  for (const char* const file : fonts)
    if (std::filesystem::is_regular_file(file, error) &&
        atlas.AddFontFromFileTTF(file, std::round(font_px * scale)) != nullptr)
      return;
  ImFontConfig config;
  config.SizePixels = std::round(13.0f * scale);
  atlas.AddFontDefault(&config);
}

}  // namespace

void set_style(float scale) {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();  // ScaleAllSizes() below multiplies what is there
  ImGui::StyleColorsDark();
  style.WindowRounding = style.ChildRounding = 0.0f;
  style.FrameRounding = style.GrabRounding = style.TabRounding = 3.0f;
  style.WindowBorderSize = 1.0f;
  style.WindowPadding = {6.0f, 6.0f};
  style.FramePadding = {6.0f, 3.0f};
  style.ItemSpacing = {6.0f, 4.0f};
  ImVec4* const colors = style.Colors;
  colors[ImGuiCol_WindowBg] = {0.09f, 0.10f, 0.12f, 1.0f};
  colors[ImGuiCol_ChildBg] = {0.09f, 0.10f, 0.12f, 1.0f};
  colors[ImGuiCol_PopupBg] = {0.12f, 0.13f, 0.16f, 0.98f};
  colors[ImGuiCol_MenuBarBg] = {0.13f, 0.14f, 0.17f, 1.0f};
  colors[ImGuiCol_Border] = {0.22f, 0.24f, 0.28f, 1.0f};
  colors[ImGuiCol_FrameBg] = {0.17f, 0.19f, 0.23f, 1.0f};
  colors[ImGuiCol_Text] = {0.92f, 0.93f, 0.95f, 1.0f};
  colors[ImGuiCol_TextDisabled] = {0.60f, 0.63f, 0.68f, 1.0f};
  colors[ImGuiCol_Header] = {0.20f, 0.36f, 0.55f, 0.8f};
  colors[ImGuiCol_Button] = {0.20f, 0.30f, 0.44f, 1.0f};
  style.ScaleAllSizes(scale);
  load_font(scale);
}

}  // namespace greatx::view
