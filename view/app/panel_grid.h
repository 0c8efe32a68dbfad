// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The tiles of what the sensors measured, side by side for several runs.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "view/app/shown_run.h"
#include "view/panel/panel.h"
#include "view/panel/record_history.h"
#include "view/window/window.h"

namespace greatx::view {

class PanelGrid {
 public:
  explicit PanelGrid(Window& window) : window_(window) {}
  ~PanelGrid();
  PanelGrid(const PanelGrid&) = delete;
  PanelGrid& operator=(const PanelGrid&) = delete;

  /// Takes the newest tick of each run into its history. To be called in every frame, drawn or not, so that
  /// panels over time have no gaps.
  void keep(std::span<ShownRun* const> runs);
  /// To be called when another run has taken the place of the one of this name. Tiles that both have stay
  /// open or closed.
  void replaced(const std::string& name);
  /// Draws the tiles into the current ImGui window.
  void draw(std::span<ShownRun* const> runs);
  /// Opens or closes the tile of this title, e.g. "uav/front: depth". Throws UserError if there is none.
  void toggle(const std::string& title);
  /// Closes all tiles.
  void close();
  /// Says which tiles are open when a run is shown first, instead of the usual ones.
  void open_at_first(std::vector<std::string> titles) { open_at_first_ = std::move(titles); }
  /// Returns the titles of the tiles that are open, each once.
  std::vector<std::string> open() const;
  /// Wall time of drawing the tiles in the last frame, ms.
  double milliseconds() const { return milliseconds_; }

 private:
  struct Tile {
    std::unique_ptr<Panel> panel;
    TextureId texture = nullptr;
    int width = 0, height = 0;
    uint64_t version = 0;
    bool open = false;
  };
  struct RunTiles {
    std::shared_ptr<RecordHistory> history;
    std::vector<PanelChoice> choices;
    std::vector<Tile> tiles;  ///< [choices]
    std::shared_ptr<const ShownTick> kept;
    /// Of the run before: whether its tiles were open, by their titles.
    std::map<std::string, bool> open_before;
  };
  void prepare(RunTiles& tiles, ShownRun& run);
  void draw_choices();
  void draw_tile(Tile& tile, const ShownTick& tick, int shown_width);
  void drop(Tile& tile);

  Window& window_;
  std::map<std::string, RunTiles> runs_;  ///< by the run's name
  std::optional<std::vector<std::string>> open_at_first_;
  double milliseconds_ = 0.0;
};

}  // namespace greatx::view
