// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/splitter.h"

#include <algorithm>
#include <cmath>

#include "view/settings/viewer_settings.h"
#include "view/window/style.h"

namespace greatx::view {

float splitter_width() { return std::round(scaled(5.0f)); }

void draw_splitter(const ImVec2& at, float height, float usual, float& share) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize({splitter_width(), height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::Begin("splitter", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::PopStyleVar(3);
  ImGui::InvisibleButton("splitter", {splitter_width(), height});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  if (active || hovered) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (hovered && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
    share = usual;
  else if (active && ImGui::GetIO().MouseDelta.x != 0.0f)
    share = std::clamp(1.0f - ImGui::GetIO().MousePos.x / ImGui::GetIO().DisplaySize.x,
                       static_cast<float>(ViewerSettings::least_side_share),
                       static_cast<float>(ViewerSettings::most_side_share));
  const ImU32 color = ImGui::GetColorU32(active    ? ImGuiCol_SeparatorActive
                                         : hovered ? ImGuiCol_SeparatorHovered
                                                   : ImGuiCol_Border);
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + splitter_width(), at.y + height}, color);
  ImGui::End();
}

}  // namespace greatx::view
