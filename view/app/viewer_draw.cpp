// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <imgui.h>

#include <fmt/format.h>

#include "core/text.h"
#include "view/app/viewer_window.h"
#include "view/overlay/tube_shapes.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

constexpr ImGuiWindowFlags fixed_window =
    ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

void place(const ImVec2& at, const ImVec2& size) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
}

}  // namespace

void Viewer::draw_main(const ImVec2& at, const ImVec2& size) {
  place(at, size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0f, 0.0f});
  ImGui::Begin("scene", nullptr, fixed_window | ImGuiWindowFlags_NoScrollWithMouse);
  ImGui::PopStyleVar();
  const std::shared_ptr<const ShownTick> tick = drawn_ = shown().run().shown();
  recording_.before_tick(tick);
  static const Shapes none;
  Overlays* const overlays = shown().overlays();
  // Overlays follow with the picture of their tick: both fit, and the scene is drawn once for each tick.
  if (tick == nullptr || main_.has_picture_of(*tick)) overlaid_ = tick;
  if (overlays != nullptr) overlays->look_through(camera_name());
  const Shapes& shapes = overlays != nullptr ? overlays->shapes(overlaid_) : none;
  static const ShownTick start;  // so that the scene is there before its first tick
  if (main_.has_scene())
    main_.draw(tick != nullptr ? *tick : start, shapes, overlays != nullptr ? overlays->made() : 0,
               overlaid_ != nullptr ? world_shapes(*overlaid_) : none, world_.paint(),
               shown().run().status().playing);
  if (tick == nullptr) draw_progress();
  draw_errors();
  ImGui::End();
}

const Shapes& Viewer::world_shapes(const ShownTick& tick) {
  const Shapes& world = world_.shapes(tick, main_.focus(), chosen_channel());
  if (!world_.settings().tubes) return world;
  const std::optional<PathStory> story = pinned_story(tick);
  if (!story) return world;
  with_tube_ = world;
  with_tube_.append(fresnel_shapes(*story));
  return with_tube_;
}

std::string Viewer::camera_name() {
  if (!main_.camera() || shown().experiment() == nullptr) return {};
  const sim::NodeConfig& node = shown().experiment()->scenario.nodes[main_.camera()->node];
  return node.name + "/" + node.sensors[main_.camera()->sensor].name;
}

std::optional<PathStory> Viewer::pinned_story(const ShownTick& tick) {
  if (main_.pinned_id() == 0 || shown().overlays() == nullptr) return {};
  std::optional<PathStory> story = shown().overlays()->story(tick, main_.pinned_id());
  if (story) world_.explain(*story, tick, chosen_channel());
  return story;
}

void Viewer::draw_progress() {
  const RunStatus status = shown().run().status();
  ImGui::SetCursorPos({scaled(20.0f), scaled(20.0f)});
  if (status.phase == RunStatus::Phase::failed) return;
  ImGui::BeginGroup();
  ImGui::TextUnformatted(status.activity.empty() ? "loading" : printable(status.activity).c_str());
  if (status.progress >= 0.0)
    ImGui::ProgressBar(static_cast<float>(status.progress), {scaled(300.0f), 0.0f});
  else
    ImGui::TextDisabled("%s", std::string(1 + static_cast<size_t>(ImGui::GetTime() * 3.0) % 3, '.').c_str());
  ImGui::EndGroup();
}

void Viewer::draw_errors() {
  std::vector<std::string> errors{shown().run().status().error, shown().scene_error(), main_.error()};
  if (const Overlays* const overlays = shown().overlays()) errors.push_back(overlays->error());
  errors.push_back(world_.error());
  errors.push_back(command_error_);
  errors.push_back(edit_.error());
  errors.push_back(gizmo_.error());
  errors.push_back(recording_.error());
  std::string text;
  for (const std::string& error : errors)
    if (!error.empty()) text += (text.empty() ? "" : "\n") + printable_lines(error);
  if (text.empty()) return;
  // At the bottom, where no legend is, on a ground of its own.
  const float margin = 12.0f, width = ImGui::GetWindowWidth() - 2.0f * margin;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, width);
  const ImVec2 window = ImGui::GetWindowPos();
  const ImVec2 at(window.x + margin, window.y + ImGui::GetWindowHeight() - size.y - margin);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x - 6.0f, at.y - 5.0f}, {at.x + size.x + 6.0f, at.y + size.y + 5.0f},
                     IM_COL32(30, 10, 10, 225), 4.0f);
  list.AddText(nullptr, 0.0f, at, IM_COL32(255, 130, 115, 255), text.c_str(), nullptr, width);
}

void Viewer::draw_side(const ImVec2& at, const ImVec2& size) {
  place(at, size);
  ImGui::Begin("side", nullptr, fixed_window);
  std::vector<ShownRun*> runs;
  for (const std::unique_ptr<ShownRun>& run : runs_) runs.push_back(run.get());
  side_.draw(runs, shown(), main_, edit_, world_);
  ImGui::End();
}

void Viewer::draw_status() {
  const std::string text = fmt::format("{}   {:.0f} frames/s   picture {:.0f} ms", recording_.status_text(),
                                       ImGui::GetIO().Framerate, main_.picture_ms());
  ImGui::SameLine(ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x - scaled(12.0f));
  ImGui::TextDisabled("%s", text.c_str());
}

void Viewer::draw_help() {
  ImGui::SetNextWindowPos({80.0f, 60.0f}, ImGuiCond_Appearing);
  if (ImGui::Begin("Keys and mouse", &help_open_, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted(
        "In the scene: drag left to orbit, right to look around, middle (or shift and left) to move;\n"
        "the wheel comes nearer; W A S D fly, E and Q rise and sink, shift is four times as fast;\n"
        "a click says what is there; the cursor over a path shows its row.");
    ImGui::Separator();
    commands_.draw_help();
  }
  ImGui::End();
}

}  // namespace greatx::view
