// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/panel_grid.h"

#include <chrono>

#include "core/text.h"

namespace greatx::view {

PanelGrid::~PanelGrid() {
  for (const auto& [name, tile] : tiles_)
    if (tile.texture != nullptr) window_.drop_texture(tile.texture);
}

void PanelGrid::draw_picture(Tile& tile, const std::shared_ptr<const Record>& record, const Array& picture,
                             float width) {
  const int64_t h = picture.shape[0], w = picture.shape[1];
  if (tile.texture != nullptr && (tile.width != w || tile.height != h)) {
    window_.drop_texture(tile.texture);
    tile.texture = nullptr;
  }
  if (tile.texture == nullptr)
    tile.texture = window_.make_texture(picture);
  else if (tile.shown != record)
    window_.update_texture(tile.texture, picture);
  tile.width = w;
  tile.height = h;
  tile.shown = record;
  ImGui::Image(tile.texture, {width, width * static_cast<float>(h) / static_cast<float>(w)});
}

void PanelGrid::draw(std::span<ShownRun* const> runs) {
  const auto begin = std::chrono::steady_clock::now();
  const float width = ImGui::GetContentRegionAvail().x / static_cast<float>(runs.size()) - 8.0f;
  for (ShownRun* const run : runs) {
    const std::shared_ptr<const ShownTick> tick = run->run().shown();
    if (run->info() == nullptr || tick == nullptr) continue;
    ImGui::BeginGroup();
    for (size_t s = 0; s < run->info()->sensors.size(); ++s) {
      const SensorSpec& spec = run->info()->sensors[s];
      const std::shared_ptr<const Record>& record = tick->newest[s];
      if (record == nullptr) continue;
      for (size_t a = 0; a < spec.arrays.size(); ++a) {
        if (spec.arrays[a].name != "rgb") continue;
        ImGui::TextUnformatted(printable(spec.name).c_str());
        draw_picture(tiles_[run->name() + spec.name], record, record->arrays[a], width);
      }
    }
    ImGui::EndGroup();
    ImGui::SameLine();
  }
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace greatx::view
