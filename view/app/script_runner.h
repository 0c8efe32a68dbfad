// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "view/run/run.h"
#include "view/scene/scene_view.h"
#include "view/script/script.h"

namespace greatx::view {

/// What the last frame drew, and what it asked for.
struct FrameContent {
  std::shared_ptr<const ShownTick> tick;        ///< of overlays and panels; null: none yet
  std::shared_ptr<const ScenePicture> picture;  ///< null: none yet
  SceneRequest wanted;                          ///< the picture that should be shown; empty without a tick
};

/// What a script, or a program, that drives the viewer can ask of it between two frames.
struct ScriptHost {
  std::function<bool()> ready;    ///< the run has loaded, or has failed
  std::function<bool()> settled;  ///< the main view shows what is wanted, at full quality
  std::function<int64_t()> tick;  ///< shown; -1: none
  std::function<void(const InputEvent&)> inject;
  std::function<void(const std::string& command, const std::string& argument)> act;
  std::function<void(const std::string& file)> screenshot;
  std::function<void(const std::string& fact)> print;
  std::function<FrameContent()> content;
  std::function<void()> finish;  ///< waits until the last frame is drawn
  std::function<Run&()> run;     ///< that the main view shows
};

/// Runs a script, a part in each frame.
class ScriptRunner {
 public:
  /// `steps` outlives the runner.
  explicit ScriptRunner(const std::vector<ScriptStep>& steps) : steps_(steps) {}
  /// Does what can be done after a frame. Returns false when the script has asked to quit or has ended.
  /// Throws UserError if a step waits for more than `most_frames` frames, or fails.
  bool advance(const ScriptHost& host);

 private:
  /// Returns whether the step is done.
  bool run(const ScriptStep& step, const ScriptHost& host);

  static constexpr int64_t most_frames = 200'000;
  const std::vector<ScriptStep>& steps_;
  size_t next_ = 0;
  int64_t frames_ = 0;  ///< since the step began
};

}  // namespace greatx::view
