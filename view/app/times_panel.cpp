// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/times_panel.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <imgui.h>
#include <unistd.h>

#include <fmt/format.h>

#include "core/text.h"
#include "view/app/fact_table.h"
#include "view/app/times_plot.h"

namespace greatx::view {

namespace {

constexpr double short_share = 0.005;  ///< of the work, of steps that are hidden at first

/// Returns the bytes of the process that are in memory; 0 if the system does not say.
uint64_t resident_bytes() {
  std::ifstream file("/proc/self/statm");
  uint64_t all = 0, resident = 0;
  file >> all >> resident;
  return file ? resident * static_cast<uint64_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::string size_text(uint64_t bytes) {
  const double mib = static_cast<double>(bytes) / (1 << 20);
  if (mib >= 2048.0) return fmt::format("{:.1f} GiB", mib / 1024.0);
  return fmt::format("{:.{}f} MiB", mib, mib >= 10.0 ? 0 : 1);
}

std::string scene_text(const scene::Scene& scene) {
  uint64_t bytes = 0;
  for (const scene::Texture& texture : scene.textures) bytes += texture.rgba.size();
  return fmt::format("{} triangles, {} textures of {}", scene.triangle_count(), scene.textures.size(),
                     size_text(bytes));
}

/// Draws a bar behind the cell that follows: `share` of the width.
void draw_share_bar(double share, ImU32 color) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x * static_cast<float>(std::clamp(share, 0.0, 1.0));
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + width, at.y + ImGui::GetTextLineHeight()}, color,
                                            2.0f);
}

std::string line_tooltip(const TimeLine& line, const TimePart& part, size_t ticks) {
  return fmt::format(
      "{}: {}\non the {}\npresent tick: {}\nmedian of the ticks with it: {}\nmean of all ticks: {}\n"
      "in {} of the last {} ticks",
      printable(part.name), printable(line.name), line.on_device ? "device (GPU)" : "host (CPU)",
      line.count == 0   ? std::string("not in it")
      : line.count == 1 ? milliseconds_text(line.now_ms)
                        : fmt::format("{} in {} parts", milliseconds_text(line.now_ms), line.count),
      milliseconds_text(line.median_ms), milliseconds_text(line.mean_ms), line.ticks, ticks);
}

void number_cell(const std::string& text) {
  ImGui::TableNextColumn();
  const float room = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (room > 0.0f) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room);
  ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void TimesPanel::keep(ShownRun& run) {
  const std::shared_ptr<const ShownTick> shown = run.run().shown();
  if (shown == nullptr || shown == kept_ || run.info() == nullptr) return;
  if (info_ != run.info()) history_ = TimeHistory();  // an edit has made another run, with times of its own
  info_ = run.info();
  kept_ = shown;
  history_.add(*shown, run.info()->sensors);
}

void TimesPanel::draw(ShownRun& run, const MainView& view, double panels_ms, double world_ms) {
  history_.sum_up();
  ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(1.0f, 0.86f, 0.55f, 1.0f));
  ImGui::TextWrapped("%s", printable(history_.answer()).c_str());
  ImGui::PopStyleColor();
  if (history_.device_is_a_cpu())
    ImGui::TextDisabled("The device is a CPU, so its passes run on the cores of the host.");
  if (!history_.ticks().empty()) draw_times_plot(history_);
  if (!history_.lines().empty()) draw_lines();
  draw_run(run, view, panels_ms, world_ms);
  draw_memory(run);
}

void TimesPanel::draw_lines() {
  constexpr ImGuiTableFlags flags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerV;
  const double work = std::max(history_.mean_work_ms(), 1e-9);
  const auto is_short = [&](const TimeLine& line) { return line.mean_ms < short_share * work; };
  const std::ptrdiff_t short_lines = std::ranges::count_if(history_.lines(), is_short);
  if (ImGui::BeginTable("lines", 5, flags)) {
    ImGui::TableSetupColumn("step", ImGuiTableColumnFlags_WidthStretch, 6.0f);
    ImGui::TableSetupColumn("of", ImGuiTableColumnFlags_WidthStretch, 4.0f);
    for (const char* const name : {"now", "median", "share"})
      ImGui::TableSetupColumn(name, ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("0000 ms").x);
    ImGui::TableHeadersRow();
    for (const TimeLine& line : history_.lines())
      if (all_lines_ || !is_short(line)) draw_line(line);
    ImGui::EndTable();
  }
  if (short_lines > 0)
    ImGui::Checkbox(fmt::format("the {} steps that take less than 0.5 %, too", short_lines).c_str(),
                    &all_lines_);
}

void TimesPanel::draw_line(const TimeLine& line) {
  const TimePart& part = history_.parts()[line.part];
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  draw_share_bar(line.mean_ms / std::max(history_.lines().front().mean_ms, 1e-9),
                 part_color(line.part, line.on_device ? 120 : 60));
  const std::string name = printable(line.name) + (line.on_device ? "" : " (host)");
  ImGui::PushID(&line);
  ImGui::Selectable(name.c_str(), false, ImGuiSelectableFlags_SpanAllColumns);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s", line_tooltip(line, part, history_.ticks().size()).c_str());
  ImGui::PopID();
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", printable(part.name).c_str());
  number_cell(line.count == 0 ? "-" : milliseconds_text(line.now_ms));
  number_cell(milliseconds_text(line.median_ms));
  number_cell(fmt::format("{:.0f} %", 100.0 * line.mean_ms / std::max(history_.mean_work_ms(), 1e-9)));
}

void TimesPanel::draw_run(ShownRun& run, const MainView& view, double panels_ms, double world_ms) {
  const RunStatus status = run.run().status();
  ImGui::Separator();
  draw_facts(
      {{"wall time of a tick", fmt::format("mean {}, median {}", milliseconds_text(history_.mean_wall_ms()),
                                           milliseconds_text(history_.median_wall_ms()))},
       {"host waits for the device", milliseconds_text(history_.mean_wait_ms())},
       {"wanted speed", status.speed == 0.0 ? std::string("as fast as it can")
                                            : fmt::format("{:g} x real time", status.speed)},
       {"reached", fmt::format("{:.2f} x real time", status.reached)},
       {"picture of the scene", milliseconds_text(view.picture_ms())},
       {"overlays", milliseconds_text(run.overlays() ? run.overlays()->milliseconds() : 0.0)},
       {"facets, wedges, ways", milliseconds_text(world_ms)},
       {"overlays, drawn", milliseconds_text(view.overlay_ms())},
       {"map, painted", milliseconds_text(view.paint_ms())},
       {"panels", milliseconds_text(panels_ms)}});
}

void TimesPanel::draw_memory(ShownRun& run) {
  ImGui::Separator();
  Facts facts{{"memory of the process", size_text(resident_bytes())}};
  if (kept_ != nullptr && kept_->memory.device_bytes > 0) {
    const RunMemory& memory = kept_->memory;
    facts.emplace_back("of it, records kept", size_text(memory.kept_bytes));
    facts.emplace_back("buffers and images on devices", size_text(memory.device_bytes));
    if (memory.device_budget_bytes > 0 && !history_.device_is_a_cpu())
      facts.emplace_back("device", fmt::format("{} of {}", size_text(memory.device_used_bytes),
                                               size_text(memory.device_budget_bytes)));
  }
  if (run.experiment() != nullptr) facts.emplace_back("scene", scene_text(run.experiment()->scene()));
  draw_facts(facts);
}

}  // namespace greatx::view
