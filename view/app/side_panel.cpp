// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/side_panel.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <imgui.h>
#include <ranges>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "core/expected.h"
#include "core/text.h"
#include "draw/paths/facts.h"
#include "view/app/fact_table.h"
#include "view/app/overlay_panel.h"

namespace greatx::view {

namespace {

constexpr double default_carrier_hz = 3.5e9;

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

void draw_facts(const Facts& facts) {
  if (!ImGui::BeginTable("facts", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const auto& [name, value] : facts) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", name.c_str());
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", value.c_str());
  }
  ImGui::EndTable();
}

double SidePanel::carrier_hz(ShownRun& run) const {
  if (run.experiment() != nullptr && !run.experiment()->scenario.channels.empty()) {
    const auto& channels = run.experiment()->scenario.channels;
    const size_t chosen = run.overlays() != nullptr ? run.overlays()->settings().channel : 0;
    return channels[std::min(chosen, channels.size() - 1)].carrier_hz;
  }
  return default_carrier_hz;
}

void SidePanel::draw(std::span<ShownRun* const> runs, ShownRun& main, MainView& view, EditSession& session,
                     WorldOverlays& world) {
  times_.keep(main);
  grid_.keep(runs);
  if (!ImGui::BeginTabBar("side tabs")) return;
  const auto tab = [this](const char* name, auto draw_tab) {
    const bool wanted = wanted_tab_ == name;
    if (wanted) wanted_tab_.clear();
    if (!ImGui::BeginTabItem(name, nullptr, wanted ? ImGuiTabItemFlags_SetSelected : 0)) return;
    ImGui::BeginChild(name);
    draw_tab();
    ImGui::EndChild();
    ImGui::EndTabItem();
  };
  tab("Sensors", [&] { grid_.draw(runs); });
  tab("Picked", [&] { draw_picked(main, view, session); });
  tab("Paths", [&] { draw_paths(main, view, world); });
  tab("Overlays", [&] { draw_overlay_settings(main.overlays(), world, main.run().shown().get()); });
  tab("Effects", [&] { draw_effects(main, session); });
  tab("Edit", [&] { draw_edit(main, session); });
  tab("Times", [&] { times_.draw(main, view, grid_.milliseconds(), world.milliseconds()); });
  ImGui::EndTabBar();
}

void SidePanel::open_tab(const std::string& name) {
  static constexpr std::string_view tabs[] = {"Sensors", "Picked", "Paths", "Overlays",
                                              "Effects", "Edit",   "Times"};
  const auto same = [&](std::string_view tab) {
    return std::ranges::equal(
        tab, name, {}, [](char c) { return std::tolower(static_cast<unsigned char>(c)); },
        [](char c) { return std::tolower(static_cast<unsigned char>(c)); });
  };
  const auto* const found = std::ranges::find_if(tabs, same);
  if (found == std::end(tabs)) throw_user_error("tab: {}", expected_one_of(tabs, name));
  wanted_tab_ = *found;
}

void SidePanel::draw_picked(ShownRun& run, MainView& view, EditSession& session) {
  if (!view.picked()) {
    ImGui::TextWrapped("Click at something in the scene to see what it is, for light and for radio.");
    return;
  }
  draw_facts(view.picked_facts(carrier_hz(run)));
  if (session.document() == nullptr || run.experiment() == nullptr) return;
  if (!ImGui::Button("change its radio material")) return;
  edit_.open_material(run.experiment()->scene().materials.at(view.picked()->material).name);
  wanted_tab_ = "Edit";
}

void SidePanel::draw_filter(ShownRun& run) {
  OverlaySettings& settings = run.overlays()->settings();
  PathFilter& filter = settings.path.filter;
  bool changed = false;
  for (size_t i = 0; i < apps::path_kinds.size(); ++i) {
    if (i % 3 != 0) ImGui::SameLine();
    changed |= ImGui::Checkbox(apps::kind_name(apps::path_kinds[i]), &filter.kinds[i]);
  }
  float within = std::isfinite(filter.within_db) ? static_cast<float>(filter.within_db) : 100.0f;
  if (ImGui::SliderFloat("weaker than the strongest by at most, dB", &within, 1.0f, 100.0f, "%.0f")) {
    filter.within_db = within >= 100.0f ? std::numeric_limits<double>::infinity() : within;
    changed = true;
  }
  int order = static_cast<int>(std::min<uint32_t>(filter.max_order, 10));
  if (ImGui::SliderInt("interactions at most", &order, 0, 10)) {
    filter.max_order = static_cast<uint32_t>(order);
    changed = true;
  }
  bool by_kind = settings.path.colors == PathColors::kind;
  if (ImGui::Checkbox("colours by kind instead of gain", &by_kind)) {
    settings.path.colors = by_kind ? PathColors::kind : PathColors::gain;
    changed = true;
  }
  if (changed) ++settings.version;
}

/// Why the pinned path is there.
void SidePanel::draw_pinned(ShownRun& run, MainView& view, WorldOverlays& world) {
  const std::shared_ptr<const ShownTick> tick = run.run().shown();
  if (view.pinned_id() == 0 || tick == nullptr) {
    ImGui::TextDisabled("Click at a path, or at its row, to see why it is there.");
    return;
  }
  std::optional<PathStory> story = run.overlays()->story(*tick, view.pinned_id());
  if (story) {
    world.explain(*story, *tick, run.overlays()->settings().channel);
    draw_story(*story);
  } else {
    ImGui::TextWrapped("The pinned path is not there at this tick.");
  }
  if (ImGui::SmallButton("unpin")) view.pin(0);
}

void SidePanel::draw_paths(ShownRun& run, MainView& view, WorldOverlays& world) {
  if (run.overlays() == nullptr || run.overlays()->sensors_of("csi").empty()) {
    ImGui::TextWrapped("This run has no channel.");
    return;
  }
  draw_pinned(run, view, world);
  ImGui::Separator();
  draw_filter(run);
  ImGui::Separator();
  const Shapes& shapes = run.overlays()->shapes();  // as the main view shows them
  std::vector<bool> listed(shapes.rows.size(), false);
  // The strongest path is drawn last, over the others, and is the first in the list.
  for (const LineShape& line : std::views::reverse(shapes.lines)) {
    if (line.row == ~0u || listed[line.row] || !shapes.rows[line.row].is_path) continue;
    listed[line.row] = true;
    const ShapeRow& row = shapes.rows[line.row];
    const bool chosen = view.hovered_id() == row.id || view.pinned_id() == row.id;
    ImGui::PushID(static_cast<int>(line.row));
    ImGui::PushStyleColor(ImGuiCol_Text, IM_COL32(line.color.r, line.color.g, line.color.b, 255));
    if (ImGui::Selectable(printable(first_line(row.text)).c_str(), chosen)) view.pin(row.id);
    ImGui::PopStyleColor();
    if (ImGui::IsItemHovered()) {
      view.highlight(row.id);
      ImGui::SetTooltip("%s", row.text.c_str());
    }
    ImGui::PopID();
  }
}

void SidePanel::draw_effects(ShownRun& run, EditSession& session) {
  if (run.experiment() == nullptr) {
    ImGui::TextUnformatted("The scenario is not there yet.");
    return;
  }
  const bool editable = session.document() != nullptr;
  if (editable && ImGui::CollapsingHeader("Knobs of accuracy and time")) edit_.draw_knobs(session);
  if (editable && ImGui::CollapsingHeader("Before and after the last change")) edit_.draw_comparison(session);
  if (!ImGui::BeginTable("effects", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
  for (const sim::Effect* const effect : run.experiment()->plan.all()) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    if (editable && edit_.is_switch(effect->name)) {
      edit_.draw_switch(session, effect->name);
      ImGui::SameLine();
    }
    if (effect->on)
      ImGui::TextColored({0.45f, 0.85f, 0.50f, 1.0f}, "on");
    else
      ImGui::TextDisabled("off");
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(effect->name.c_str());
    ImGui::TableNextColumn();
    const std::string why = effect->bound.empty() ? effect->reason : effect->reason + "; " + effect->bound;
    ImGui::TextWrapped("%s", printable(why).c_str());
  }
  ImGui::EndTable();
}

void SidePanel::draw_edit(ShownRun& run, EditSession& session) {
  std::vector<std::string> materials;
  if (run.experiment() != nullptr)
    for (const auto& material : run.experiment()->scene().materials) materials.push_back(material.name);
  std::ranges::sort(materials);
  edit_.draw(session, materials);
}

}  // namespace greatx::view
