// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Records the window: it chooses the pictures and their times, and hands them to a Recorder.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "view/app/commands.h"
#include "view/record/recorder.h"
#include "view/run/run.h"
#include "view/window/window.h"

namespace greatx::view {

class Recording {
 public:
  /// `folder` is where names without a folder lead to. `scripted`: every picture is recorded, however long
  /// the encoder takes.
  Recording(Window& window, std::filesystem::path folder, bool scripted)
      : window_(window), folder_(std::move(folder)), scripted_(scripted) {}

  /// Completes the file.
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// Adds "record" and "record.frames".
  void add_commands(Commands& commands);
  /// To be called before the main view draws `tick`. While ticks are recorded and this is another tick, the
  /// last frame was the last one of the tick before, so it is recorded.
  void before_tick(const std::shared_ptr<const ShownTick>& tick);
  /// To be called after each frame that was drawn.
  void frame_drawn();
  /// Draws the dialog, if it is open.
  void draw();

  bool active() const { return recorder_ != nullptr; }
  /// What it does, for the status bar; empty: nothing.
  std::string status_text() const;
  const std::string& error() const { return error_; }

 private:
  enum class Each : uint8_t { tick, frame };
  void command(const std::string& argument, Each each);
  void start(const std::filesystem::path& path, Each each);
  void stop();
  void record_tick();
  void take_end();
  std::filesystem::path free_name() const;

  Window& window_;
  std::filesystem::path folder_;
  bool scripted_;
  std::unique_ptr<Recorder> recorder_;
  Each each_ = Each::tick;
  bool stopping_ = false;
  std::shared_ptr<const ShownTick> drawn_;     ///< in the last frame
  std::shared_ptr<const ShownTick> recorded_;  ///< last
  int64_t next_ms_ = 0;                        ///< the next picture's start, or the recording's end
  double began_s_ = 0.0, last_frame_s_ = 0.0;  ///< of ImGui's clock
  std::string error_, result_;
  double result_at_s_ = 0.0;
  bool dialog_open_ = false, dialog_ticks_ = true;
  char dialog_name_[512] = "";
};

}  // namespace greatx::view
