// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/app/world_overlays.h"

#include <chrono>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/text.h"

namespace greatx::view {

namespace {

/// The focus of the nearest facets follows the view in steps, so that a flight does not make them anew in
/// every frame.
dvec3 stepped(const dvec3& focus) {
  constexpr double step_m = 5.0;
  return step_m * glm::round(focus / step_m);
}

template <typename T>
bool is_ready(const std::future<T>& future) {
  return future.valid() && future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void WorldOverlays::set(std::shared_ptr<const sim::Experiment> experiment) {
  forget_map();
  radio_.reset();
  courses_.reset();
  if (radio_coming_.valid()) dropped_radio_.push_back(std::move(radio_coming_));
  if (courses_coming_.valid()) dropped_courses_.push_back(std::move(courses_coming_));
  radio_channel_.reset();
  courses_sequence_.reset();
  error_.clear();
  made_of_ = {};
  experiment_ = std::move(experiment);
  moments_.reset();
  if (experiment_ != nullptr) moments_.emplace(experiment_);
}

const WorldOverlays::Radio* WorldOverlays::radio(size_t channel) {
  if (experiment_ == nullptr || channel >= experiment_->scenario.channels.size()) return nullptr;
  if (radio_channel_ != channel && !radio_coming_.valid()) {
    radio_.reset();
    radio_channel_ = channel;
    radio_coming_ = std::async(std::launch::async, [experiment = experiment_, channel] {
      return std::shared_ptr<const Radio>(new Radio{RadioFacts(experiment, static_cast<uint32_t>(channel)),
                                                    FacetOutlines(experiment->scene())});
    });
  }
  collect();
  return radio_channel_ == channel ? radio_.get() : nullptr;
}

/// Takes what has become ready, also if nobody asks for it any more.
void WorldOverlays::collect() {
  try {
    if (is_ready(radio_coming_)) radio_ = radio_coming_.get();
    if (is_ready(courses_coming_)) courses_ = courses_coming_.get();
  } catch (const std::exception& error) {
    error_ = error.what();
  }
}

const SampledCourses* WorldOverlays::courses(uint32_t sequence) {
  if (experiment_ == nullptr) return nullptr;
  if (courses_sequence_ != sequence && !courses_coming_.valid()) {
    courses_.reset();
    courses_sequence_ = sequence;
    courses_coming_ = std::async(std::launch::async, [experiment = experiment_, sequence] {
      return std::make_shared<const SampledCourses>(sample_courses(*experiment, sequence));
    });
  }
  collect();
  return courses_sequence_ == sequence ? courses_.get() : nullptr;
}

const Shapes& WorldOverlays::shapes(const ShownTick& tick, const dvec3& focus, size_t channel) {
  drop_finished();
  collect();
  const bool wants_radio = settings_.facets || settings_.wedges;
  const MadeOf wanted{tick.sequence,
                      tick.packet.tick,
                      wants_radio ? stepped(focus) : dvec3(0.0),
                      channel,
                      settings_.version,
                      wants_radio ? radio(channel) : nullptr,
                      settings_.courses ? courses(tick.sequence) : nullptr};
  if (wanted == made_of_) return shapes_;
  made_of_ = wanted;
  const auto begin = std::chrono::steady_clock::now();
  shapes_ = {};
  make(tick, wanted.focus, channel);
  milliseconds_ = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return shapes_;
}

void WorldOverlays::make(const ShownTick& tick, const dvec3& focus, size_t channel) {
  if (experiment_ == nullptr) return;
  const sim::Clock clock(experiment_->scenario.tick_rate_hz);
  if (settings_.courses)
    if (const SampledCourses* const known = courses(tick.sequence))
      shapes_.append(course_shapes(*known, clock.seconds(tick.packet.tick)));
  if (!settings_.facets && !settings_.wedges) return;
  if (experiment_->scenario.channels.empty()) {
    shapes_.note("facets and wedges: the scenario has no channel");
    return;
  }
  const Radio* const known = radio(channel);
  if (known == nullptr) {
    shapes_.note("facets and wedges: being found");
    return;
  }
  RadioShapeOptions options = settings_.radio;
  options.facets = settings_.facets;
  options.wedges = settings_.wedges;
  shapes_.append(radio_shapes(known->facts, known->outlines,
                              moments_->at(tick.sequence, tick.packet.tick).bodies, focus, options));
}

void WorldOverlays::explain(PathStory& story, const ShownTick& tick, size_t channel) {
  if (const Radio* const known = radio(channel))
    view::explain(story, known->facts, moments_->at(tick.sequence, tick.packet.tick).bodies);
}

void WorldOverlays::compute_map(const ShownTick& tick, size_t channel) {
  if (experiment_ == nullptr) throw_user_error("the scene is not there yet");
  if (channel >= experiment_->scenario.channels.size()) throw_user_error("map: the scenario has no channel");
  MapWish wish;
  wish.channel = static_cast<uint32_t>(channel);
  wish.sequence = tick.sequence;
  wish.tick = tick.packet.tick;
  wish.request = settings_.map_request;
  sim::check_map_request(wish.request, experiment_->scenario.channels[channel]);
  drop_job();
  job_ = std::make_unique<MapJob>(experiment_, std::move(wish), device_);
  settings_.map = true;
}

void WorldOverlays::cancel_map() {
  if (job_ != nullptr) job_->cancel();
}

/// A job ends when the cells that it computes are done.
void WorldOverlays::drop_job() {
  if (job_ == nullptr) return;
  job_->cancel();
  dropped_jobs_.push_back(std::move(job_));
}

void WorldOverlays::drop_finished() {
  std::erase_if(dropped_jobs_, [](const std::unique_ptr<MapJob>& job) { return job->finished(); });
  std::erase_if(dropped_radio_, [](const auto& future) { return is_ready(future); });
  std::erase_if(dropped_courses_, [](const auto& future) { return is_ready(future); });
}

void WorldOverlays::forget_map() {
  drop_job();
  map_.reset();
  paint_.reset();
}

std::shared_ptr<const MapLayerPaint> WorldOverlays::paint() {
  if (!settings_.map || job_ == nullptr) return nullptr;
  const std::shared_ptr<const ShownMap> newest = job_->map();
  if (newest == nullptr) return nullptr;
  if (newest != map_ || paint_version_ != settings_.version || paint_ == nullptr) {
    map_ = newest;
    paint_version_ = settings_.version;
    try {
      paint_ = std::make_shared<const MapLayerPaint>(map_, settings_.map_colors, experiment_->scene().origin);
    } catch (const UserError& error) {
      error_ = error.what();
      settings_.map_colors = {};
    }
  }
  return paint_;
}

bool WorldOverlays::idle() const {
  return (job_ == nullptr || job_->finished()) && !radio_coming_.valid() && !courses_coming_.valid();
}

std::string WorldOverlays::error() const {
  return job_ != nullptr && !job_->error().empty() ? job_->error() : error_;
}

}  // namespace greatx::view
