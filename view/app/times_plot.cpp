// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/times_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/format.h>

#include "core/text.h"

namespace greatx::view {

namespace {

constexpr float plot_lines = 8.0f;     ///< height in lines of text
constexpr size_t fewest_slots = 40;    ///< so that the first ticks are no walls
constexpr double least_percent = 0.5;  ///< of the work, of a part in the legend
constexpr ImU32 wall_color = IM_COL32(240, 240, 240, 255), real_color = IM_COL32(255, 205, 70, 255);
constexpr ImU32 grid_color = IM_COL32(255, 255, 255, 28), label_color = IM_COL32(235, 238, 243, 255);

double work_of(const TimedTick& tick) {
  return std::accumulate(tick.part_ms.begin(), tick.part_ms.end(), 0.0);
}

/// Returns the time at the upper end. A few ticks, the first one above all, take much longer than the rest.
/// They may stand out of the plot.
double top_of(const std::vector<TimedTick>& ticks) {
  std::vector<double> highest;
  for (const TimedTick& tick : ticks)
    highest.push_back(std::max({work_of(tick), tick.wall_ms, tick.real_ms}));
  const auto most =
      highest.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(highest.size() - 1));
  std::ranges::nth_element(highest, most);
  return std::max(1.2 * *most, 1e-3);
}

/// Returns 1, 2 or 5 times a power of ten, about a third of `top`.
double grid_step(double top) {
  const double wanted = top / 3.0, decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= wanted * 0.999) return factor * decade;
  return 10.0 * decade;
}

class Plot {
 public:
  Plot(const TimeHistory& history, const ImVec2& at, const ImVec2& size)
      : history_(history),
        list_(*ImGui::GetWindowDrawList()),
        at_(at),
        size_(size),
        top_(top_of(history.ticks())),
        slot_(size.x / static_cast<float>(std::max(fewest_slots, history.ticks().size()))) {}

  void draw() {
    list_.PushClipRect(at_, {at_.x + size_.x, at_.y + size_.y}, true);
    list_.AddRectFilled(at_, {at_.x + size_.x, at_.y + size_.y}, IM_COL32(255, 255, 255, 10));
    grid();
    for (size_t i = 0; i < history_.ticks().size(); ++i) bar(i);
    labels();
    list_.PopClipRect();
  }
  /// Returns the tick under the cursor; ticks().size(): none.
  size_t tick_at(const ImVec2& mouse) const {
    const float slot = (mouse.x - at_.x) / slot_;
    return slot < 0.0f ? history_.ticks().size()
                       : std::min(static_cast<size_t>(slot), history_.ticks().size());
  }

 private:
  float y(double ms) const { return at_.y + size_.y * static_cast<float>(1.0 - ms / top_); }

  void grid() {
    for (double ms = grid_step(top_); ms < top_; ms += grid_step(top_))
      list_.AddLine({at_.x, y(ms)}, {at_.x + size_.x, y(ms)}, grid_color);
  }

  /// Draws the labels of the grid over the bars, each with a shadow.
  void labels() {
    for (double ms = grid_step(top_); ms < top_; ms += grid_step(top_)) {
      const float top = y(ms) - ImGui::GetTextLineHeight();
      if (top < at_.y) continue;
      const std::string text = fmt::format("{:g} ms", ms);
      list_.AddText({at_.x + 4.0f, top + 1.0f}, IM_COL32(0, 0, 0, 255), text.c_str());
      list_.AddText({at_.x + 3.0f, top}, label_color, text.c_str());
    }
  }

  void bar(size_t i) {
    const TimedTick& tick = history_.ticks()[i];
    const float x0 = at_.x + slot_ * static_cast<float>(i), gap = slot_ > 4.0f ? 1.0f : 0.0f;
    const float x1 = x0 + slot_ - gap;
    if (i == history_.present())
      list_.AddRectFilled({x0, at_.y}, {x1, at_.y + size_.y}, IM_COL32(255, 255, 255, 40));
    double below = 0.0;
    for (size_t part = 0; part < tick.part_ms.size(); below += tick.part_ms[part++])
      list_.AddRectFilled({x0, y(below + tick.part_ms[part])}, {x1, y(below)}, part_color(part));
    list_.AddLine({x0, y(tick.wall_ms)}, {x0 + slot_, y(tick.wall_ms)}, wall_color, 1.5f);
    if (tick.real_ms > 0.0 && (slot_ < 4.0f || i % 2 == 0))
      list_.AddLine({x0, y(tick.real_ms)}, {x0 + slot_, y(tick.real_ms)}, real_color, 1.5f);
  }

  const TimeHistory& history_;
  ImDrawList& list_;
  ImVec2 at_, size_;
  double top_;
  float slot_;
};

void draw_tick_tooltip(const TimeHistory& history, const TimedTick& tick) {
  std::string text = fmt::format("tick {}: {} of wall time", tick.tick, milliseconds_text(tick.wall_ms));
  if (tick.real_ms > 0.0) text += fmt::format(" for {} of simulated time", milliseconds_text(tick.real_ms));
  if (tick.start_ms > 0.0)
    text += fmt::format("\nbefore it: {} to start the sequence", milliseconds_text(tick.start_ms));
  for (size_t part = 0; part < tick.part_ms.size(); ++part)
    if (tick.part_ms[part] > 0.0)
      text += fmt::format("\n{}: {}", printable(history.parts()[part].name),
                          milliseconds_text(tick.part_ms[part]));
  ImGui::SetTooltip("%s", text.c_str());
}

/// Draws one entry of the legend. The next one stands beside it if there is room.
void draw_entry(const std::string& text, ImU32 color, bool is_line, bool is_first = false) {
  const float line = ImGui::GetTextLineHeight(), width = line + ImGui::CalcTextSize(text.c_str()).x;
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  if (!is_first && ImGui::GetItemRectMax().x + 14.0f + width < right) ImGui::SameLine(0.0f, 14.0f);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float top = is_line ? 0.45f : 0.15f, bottom = is_line ? 0.6f : 0.85f;
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + top * line},
                                            {at.x + 0.7f * line, at.y + bottom * line}, color);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + line);
  ImGui::TextUnformatted(text.c_str());
}

void draw_plot_legend(const TimeHistory& history) {
  const double work = std::max(history.mean_work_ms(), 1e-9);
  draw_entry("wall time", wall_color, true, true);
  if (history.mean_real_ms() > 0.0) draw_entry("simulated time", real_color, true);
  for (size_t part = 0; part < history.parts().size(); ++part) {
    const double percent = 100.0 * history.parts()[part].mean_ms / work;
    if (percent >= least_percent)
      draw_entry(fmt::format("{} {:.0f} %", printable(history.parts()[part].name), percent), part_color(part),
                 false);
  }
}

}  // namespace

ImU32 part_color(size_t part, uint32_t alpha) {
  static constexpr uint8_t colors[][3] = {{86, 156, 224},  {240, 140, 60}, {96, 186, 110}, {214, 94, 110},
                                          {160, 122, 214}, {64, 190, 190}, {206, 186, 80}, {222, 130, 190},
                                          {140, 150, 165}, {150, 110, 80}};
  const uint8_t(&color)[3] = colors[part % std::size(colors)];
  return IM_COL32(color[0], color[1], color[2], alpha);
}

void draw_times_plot(const TimeHistory& history) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const ImVec2 size(std::max(ImGui::GetContentRegionAvail().x, 60.0f),
                    plot_lines * ImGui::GetTextLineHeight());
  ImGui::InvisibleButton("times of ticks", size);
  Plot plot(history, at, size);
  plot.draw();
  if (ImGui::IsItemHovered())
    if (const size_t tick = plot.tick_at(ImGui::GetMousePos()); tick < history.ticks().size())
      draw_tick_tooltip(history, history.ticks()[tick]);
  draw_plot_legend(history);
}

}  // namespace greatx::view
