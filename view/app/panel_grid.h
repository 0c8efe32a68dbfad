// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tiles of what the sensors measured.
#pragma once

#include <imgui.h>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "view/app/shown_run.h"
#include "view/window/window.h"

namespace greatx::view {

class PanelGrid {
 public:
  explicit PanelGrid(Window& window) : window_(window) {}
  ~PanelGrid();
  PanelGrid(const PanelGrid&) = delete;
  PanelGrid& operator=(const PanelGrid&) = delete;

  /// Draws the tiles of all runs into the current ImGui window, those of one sensor side by side.
  void draw(std::span<ShownRun* const> runs);
  bool settled() const { return true; }  // a tile is drawn in the frame in which its tick is shown
  double milliseconds() const { return milliseconds_; }

 private:
  /// A picture on the screen.
  struct Tile {
    TextureId texture = nullptr;
    int64_t width = 0, height = 0;
    std::shared_ptr<const Record> shown;
  };
  void draw_picture(Tile& tile, const std::shared_ptr<const Record>& record, const Array& picture,
                    float width);

  Window& window_;
  std::map<std::string, Tile> tiles_;
  double milliseconds_ = 0.0;
};

}  // namespace greatx::view
