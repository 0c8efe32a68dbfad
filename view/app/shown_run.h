// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One run as the viewer holds it: the run, and what was made of it as soon as it was loaded.
#pragma once

#include <future>
#include <memory>
#include <optional>
#include <string>

#include "sim/experiment/experiment.h"
#include "view/app/overlays.h"
#include "view/app/viewer.h"
#include "view/run/live.h"
#include "view/run/replay.h"

namespace greatx::view {

class ShownRun {
 public:
  static std::unique_ptr<ShownRun> live(const ViewerOptions& options);
  /// A live run of a scenario that was changed after `before` was made, which may be null. It waits at its
  /// first tick.
  static std::unique_ptr<ShownRun> changed(const std::string& name, const ViewerOptions& options,
                                           sim::Scenario scenario,
                                           std::shared_ptr<const sim::Experiment> before);
  static std::unique_ptr<ShownRun> replay(const ViewerOptions& options, const std::filesystem::path& dataset);

  /// Takes what the run has loaded since the last call. Returns an experiment once, when it is there.
  std::shared_ptr<const sim::Experiment> update();

  Run& run() { return *run_; }
  const std::string& name() const { return name_; }
  /// Null while the run loads.
  const std::shared_ptr<const io::DatasetInfo>& info() const { return info_; }
  const std::shared_ptr<const sim::Experiment>& experiment() const { return experiment_; }
  Overlays* overlays() { return overlays_ ? &*overlays_ : nullptr; }
  /// Why the scene cannot be shown; empty if it can, or is being loaded.
  const std::string& scene_error() const { return scene_error_; }

 private:
  ShownRun(std::string name, const ViewerOptions& options) : name_(std::move(name)), options_(options) {}
  void load_scene();

  std::string name_;
  const ViewerOptions& options_;
  std::filesystem::path dataset_;  ///< empty: live
  std::unique_ptr<Run> run_;
  LiveRun* live_ = nullptr;  ///< the same, if it is live
  std::shared_ptr<const io::DatasetInfo> info_;
  std::shared_ptr<const sim::Experiment> experiment_;
  std::future<std::shared_ptr<const sim::Experiment>> loading_;
  std::optional<Overlays> overlays_;
  std::string scene_error_;
};

}  // namespace greatx::view
