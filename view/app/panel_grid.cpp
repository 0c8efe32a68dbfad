// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/panel_grid.h"

#include <algorithm>
#include <chrono>
#include <imgui.h>
#include <set>

#include "core/error.h"
#include "core/text.h"
#include "view/window/style.h"

namespace greatx::view {

namespace {

constexpr float narrowest_tile_px = 230.0f, most_columns = 6.0f;

/// The panels that are open at first: the first of each kind of these.
const std::set<std::string, std::less<>> usual_kinds{
    "rgb", "depth", "events", "from above", "range-Doppler", "delay over time", "arrivals"};

}  // namespace

PanelGrid::~PanelGrid() {
  for (auto& [name, tiles] : runs_)
    for (Tile& tile : tiles.tiles) drop(tile);
}

void PanelGrid::drop(Tile& tile) {
  if (tile.texture != nullptr) window_.drop_texture(tile.texture);
  tile.texture = nullptr;
}

void PanelGrid::prepare(RunTiles& tiles, ShownRun& run) {
  tiles.history = std::make_shared<RecordHistory>(run.info(), run.name());
  tiles.choices = panels_of(run.info()->sensors);
  tiles.tiles.resize(tiles.choices.size());
  std::set<std::string> opened;
  for (size_t i = 0; i < tiles.choices.size(); ++i) {
    const PanelChoice& choice = tiles.choices[i];
    const auto before = tiles.open_before.find(choice.title);
    if (before != tiles.open_before.end()) {
      tiles.tiles[i].open = before->second;
      continue;
    }
    tiles.tiles[i].open = open_at_first_
                              ? std::ranges::find(*open_at_first_, choice.title) != open_at_first_->end()
                              : usual_kinds.contains(choice.kind) && opened.insert(choice.kind).second;
  }
}

std::vector<std::string> PanelGrid::open() const {
  std::vector<std::string> titles;
  for (const auto& [name, tiles] : runs_)
    for (size_t i = 0; i < tiles.choices.size(); ++i)
      if (tiles.tiles[i].open && std::ranges::find(titles, tiles.choices[i].title) == titles.end())
        titles.push_back(tiles.choices[i].title);
  return titles;
}

void PanelGrid::replaced(const std::string& name) {
  const auto found = runs_.find(name);
  if (found == runs_.end()) return;
  RunTiles fresh;
  for (size_t i = 0; i < found->second.choices.size(); ++i) {
    fresh.open_before[found->second.choices[i].title] = found->second.tiles[i].open;
    drop(found->second.tiles[i]);
  }
  found->second = std::move(fresh);
}

void PanelGrid::keep(std::span<ShownRun* const> runs) {
  for (ShownRun* const run : runs) {
    if (run->info() == nullptr) continue;
    RunTiles& tiles = runs_[run->name()];
    if (tiles.history == nullptr) prepare(tiles, *run);
    const std::shared_ptr<const ShownTick> tick = run->run().shown();
    if (tick == nullptr || tick == tiles.kept) continue;
    tiles.history->add(*tick);
    tiles.kept = tick;
  }
}

void PanelGrid::toggle(const std::string& title) {
  bool found = false;
  for (auto& [name, tiles] : runs_)
    for (size_t i = 0; i < tiles.choices.size(); ++i) {
      if (tiles.choices[i].title != title) continue;
      tiles.tiles[i].open = !tiles.tiles[i].open;
      found = true;
    }
  if (!found) throw_user_error("expected the title of a panel, found '{}'", printable(title));
}

void PanelGrid::close() {
  for (auto& [name, tiles] : runs_)
    for (Tile& tile : tiles.tiles) tile.open = false;
}

void PanelGrid::draw_choices() {
  if (ImGui::Button("choose panels")) ImGui::OpenPopup("panels");
  if (!ImGui::BeginPopup("panels")) return;
  std::vector<std::string> titles;
  for (const auto& [name, tiles] : runs_)
    for (const PanelChoice& choice : tiles.choices)
      if (std::ranges::find(titles, choice.title) == titles.end()) titles.push_back(choice.title);
  for (const std::string& title : titles) {
    bool open = false;
    for (const auto& [name, tiles] : runs_)
      for (size_t i = 0; i < tiles.choices.size(); ++i)
        open |= tiles.choices[i].title == title && tiles.tiles[i].open;
    if (ImGui::Checkbox(printable(title).c_str(), &open)) toggle(title);
  }
  ImGui::EndPopup();
}

void PanelGrid::draw_tile(Tile& tile, const ShownTick& tick, int shown_width) {
  const PanelSize wanted = tile.panel->wanted();
  // The texts of a panel have a fixed size in its pixels, so a picture for many pixels an inch is enlarged.
  const float enlarged = std::max(1.0f, scaled(1.0f));
  const auto drawn = [&](int shown) { return static_cast<int>(static_cast<float>(shown) / enlarged); };
  const int width = std::max(40, drawn(shown_width));
  const int height = std::max(60, width * wanted.height / std::max(wanted.width, 1));
  tile.panel->show(tick);
  const Array& picture = tile.panel->draw(width, height);
  if (tile.width != width || tile.height != height) drop(tile);
  tile.width = width;
  tile.height = height;
  if (tile.texture == nullptr)
    tile.texture = window_.make_texture(picture);
  else if (tile.version != tile.panel->version())
    window_.update_texture(tile.texture, picture);
  tile.version = tile.panel->version();
  ImGui::TextUnformatted(printable(tile.panel->title()).c_str());
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Image(tile.texture, {enlarged * static_cast<float>(width), enlarged * static_cast<float>(height)});
  if (ImGui::IsItemHovered()) {
    const ImVec2 mouse = ImGui::GetMousePos();
    const std::string value = tile.panel->value_at(static_cast<int>((mouse.x - corner.x) / enlarged),
                                                   static_cast<int>((mouse.y - corner.y) / enlarged));
    if (!value.empty()) ImGui::SetTooltip("%s", value.c_str());
  }
  for (const PanelKnob& knob : tile.panel->knobs()) {
    auto value = static_cast<float>(knob.value);
    ImGui::PushID(&tile);
    ImGui::SetNextItemWidth(0.5f * static_cast<float>(shown_width));
    const std::string name = knob.unit.empty() ? knob.name : knob.name + ", " + knob.unit;
    if (ImGui::SliderFloat(name.c_str(), &value, static_cast<float>(knob.least),
                           static_cast<float>(knob.most), knob.whole ? "%.0f" : "%.3g")) {
      const std::string changed = knob.name;  // set_knob changes the list
      tile.panel->set_knob(changed, value);
    }
    ImGui::PopID();
  }
}

void PanelGrid::draw(std::span<ShownRun* const> runs) {
  const auto begin = std::chrono::steady_clock::now();
  draw_choices();
  const float space = ImGui::GetStyle().ItemSpacing.x, room = ImGui::GetContentRegionAvail().x;
  const size_t columns =
      runs.size() > 1 ? runs.size()
                      : static_cast<size_t>(std::clamp(room / scaled(narrowest_tile_px), 1.0f, most_columns));
  const int width = std::max(
      40, static_cast<int>((room - space * static_cast<float>(columns - 1)) / static_cast<float>(columns)));
  if (!ImGui::BeginTable("tiles", static_cast<int>(columns))) return;
  size_t most = 0;
  for (const auto& [name, tiles] : runs_) most = std::max(most, tiles.choices.size());
  for (size_t i = 0; i < most; ++i)
    for (ShownRun* const run : runs) {
      RunTiles& tiles = runs_[run->name()];
      if (i >= tiles.tiles.size() || !tiles.tiles[i].open || tiles.kept == nullptr) continue;
      Tile& tile = tiles.tiles[i];
      if (tile.panel == nullptr) tile.panel = make_panel(tiles.choices[i], tiles.history);
      ImGui::TableNextColumn();
      draw_tile(tile, *tiles.kept, width);
    }
  ImGui::EndTable();
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace greatx::view
