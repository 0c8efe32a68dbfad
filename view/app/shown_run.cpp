// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/shown_run.h"

#include <chrono>

#include "core/error.h"

namespace greatx::view {

std::unique_ptr<ShownRun> ShownRun::live(const ViewerOptions& options) {
  auto shown = std::unique_ptr<ShownRun>(new ShownRun(options.title, options));
  LiveOptions live;
  live.scenario = options.scenario;
  live.device = options.device;
  live.paused = options.paused;
  std::unique_ptr<LiveRun> run = live_run(std::move(live));
  shown->live_ = run.get();
  shown->run_ = std::move(run);
  return shown;
}

std::unique_ptr<ShownRun> ShownRun::changed(const std::string& name, const ViewerOptions& options,
                                            sim::Scenario scenario,
                                            std::shared_ptr<const sim::Experiment> before) {
  auto shown = std::unique_ptr<ShownRun>(new ShownRun(name, options));
  LiveOptions live;
  live.scenario = [scenario = std::move(scenario)] { return scenario; };
  live.before = std::move(before);
  live.device = options.device;
  live.paused = true;
  std::unique_ptr<LiveRun> run = live_run(std::move(live));
  shown->live_ = run.get();
  shown->run_ = std::move(run);
  return shown;
}

std::unique_ptr<ShownRun> ShownRun::replay(const ViewerOptions& options,
                                           const std::filesystem::path& dataset) {
  auto shown = std::unique_ptr<ShownRun>(new ShownRun(dataset.string(), options));
  shown->dataset_ = dataset;
  shown->run_ = replay_run(dataset);
  return shown;
}

void ShownRun::load_scene() {
  loading_ = std::async(std::launch::async, [this, text = info_->scenario_text] {
    return std::make_shared<const sim::Experiment>(
        sim::make_experiment(options_.scenario_of(text, dataset_)));
  });
}

std::shared_ptr<const sim::Experiment> ShownRun::update() {
  if (info_ == nullptr) {
    info_ = run_->info();
    if (info_ != nullptr) {
      overlays_.emplace(info_);
      if (live_ == nullptr) load_scene();
    }
  }
  if (experiment_ != nullptr || !scene_error_.empty()) return nullptr;
  if (live_ != nullptr) {
    experiment_ = live_->experiment();
  } else if (loading_.valid() && loading_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
    try {
      experiment_ = loading_.get();
    } catch (const std::exception& error) {
      scene_error_ = error.what();
    }
  }
  return experiment_;
}

}  // namespace greatx::view
