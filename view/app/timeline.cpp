// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/timeline.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "view/window/style.h"

namespace greatx::view {

namespace {

struct Speed {
  const char* name;
  double value;
};
constexpr Speed speeds[] = {
    {"x 0.1", 0.1}, {"x 0.25", 0.25},          {"x 0.5", 0.5}, {"real time", 1.0}, {"x 2", 2.0},
    {"x 5", 5.0},   {"as fast as it can", 0.0}};

void draw_speed(std::span<Run* const> runs, const RunStatus& status) {
  const auto* const now = std::ranges::find(speeds, status.speed, &Speed::value);
  ImGui::SetNextItemWidth(scaled(150.0f));
  if (!ImGui::BeginCombo("##speed", now == std::end(speeds) ? "other" : now->name)) return;
  for (const Speed& speed : speeds)
    if (ImGui::Selectable(speed.name, speed.value == status.speed))
      for (Run* const run : runs) run->set_speed(speed.value);
  ImGui::EndCombo();
}

void draw_sequence(std::span<Run* const> runs, const RunStatus& status, const io::DatasetInfo& info) {
  if (info.sequences < 2) return;
  int sequence = static_cast<int>(status.sequence);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(scaled(110.0f));
  if (ImGui::InputInt("##sequence", &sequence, 1, 10, ImGuiInputTextFlags_EnterReturnsTrue))
    for (Run* const run : runs)
      run->jump(static_cast<uint32_t>(std::clamp(sequence, 0, static_cast<int>(info.sequences) - 1)), 0);
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("sequence, of %u", info.sequences);
}

std::string time_text(const Run& run, const RunStatus& status) {
  const std::shared_ptr<const ShownTick> shown = run.shown();
  std::string text = fmt::format("tick {}", status.tick);
  if (shown != nullptr)
    text += fmt::format("   {:.3f} s   {:.0f} ms", 1e-9 * static_cast<double>(shown->packet.time_ns),
                        shown->simulated_ms);
  if (status.playing && status.reached > 0.0) text += fmt::format("   {:.2f} x real time", status.reached);
  return text;
}

}  // namespace

float timeline_height() { return 2.0f * ImGui::GetFrameHeightWithSpacing() + scaled(10.0f); }

void draw_timeline(const ImVec2& at, const ImVec2& size, std::span<Run* const> runs, SteadyText& activity) {
  ImGui::SetNextWindowPos(at);
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("time", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoScrollbar);
  const RunStatus status = runs.front()->status();
  const std::shared_ptr<const io::DatasetInfo> info = runs.front()->info();
  if (info != nullptr) {
    int64_t tick = std::max<int64_t>(status.tick, 0);
    const int64_t first = 0, last = std::max<int64_t>(info->ticks_per_sequence - 1, 0);
    ImGui::SetNextItemWidth(-1.0f);
    if (ImGui::SliderScalar("##tick", ImGuiDataType_S64, &tick, &first, &last))
      for (Run* const run : runs) run->jump(status.sequence, tick);
    const auto button = [&](const char* name, auto act) {
      if (ImGui::Button(name))
        for (Run* const run : runs) act(*run);
      ImGui::SameLine();
    };
    button("|<", [&](Run& run) { run.jump(status.sequence, 0); });
    button("<", [](Run& run) { run.step(-1); });
    button(status.playing ? "pause" : "play", [&](Run& run) { run.play(!status.playing); });
    button(">", [](Run& run) { run.step(1); });
    draw_speed(runs, status);
    draw_sequence(runs, status, *info);
    ImGui::SameLine();
    ImGui::TextUnformatted(time_text(*runs.front(), status).c_str());
    if (const std::string& doing = activity.at(status.activity, ImGui::GetTime()); !doing.empty()) {
      ImGui::SameLine();
      ImGui::TextDisabled("%s", doing.c_str());
    }
  }
  ImGui::End();
}

}  // namespace greatx::view
