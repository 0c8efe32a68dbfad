// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The overlays that come from the experiment and not from records: ways of the nodes, facets and wedges, and
// radio maps that are computed on request. What takes long is made on other threads, and shows when it is
// there.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gpu/device.h"
#include "view/overlay/path_story.h"
#include "view/run/run.h"
#include "view/scene/moment_cache.h"
#include "view/world/course_shapes.h"
#include "view/world/map_job.h"
#include "view/world/map_paint.h"
#include "view/world/radio_facts.h"
#include "view/world/radio_shapes.h"

namespace greatx::view {

struct WorldSettings {
  bool courses = true, facets = false, wedges = false, map = true;
  bool tubes = false;  ///< the Fresnel zone of the pinned path
  RadioShapeOptions radio;
  MapColors map_colors;
  /// Of the next map. The channel, the sequence and the tick are those that are shown.
  sim::MapRequest map_request;
  uint64_t version = 0;  ///< changes whenever a setting changes; whoever changes one counts it up
};

/// Reads what a script asks of a map into the settings: words such as "quantity=rss", "cell=2", "height=10",
/// "plane=30", "over=roofs", "min=-50,-50", "max=50,50", with spaces between them. What is not named stays.
/// Throws UserError.
void parse_map_words(const std::string& words, WorldSettings& settings);

class WorldOverlays {
 public:
  explicit WorldOverlays(gpu::DeviceOptions device) : device_(std::move(device)) {}

  /// Forgets what belongs to the experiment before. A map that is being computed is cancelled.
  void set(std::shared_ptr<const sim::Experiment> experiment);
  WorldSettings& settings() { return settings_; }
  /// The shapes of a tick around `focus` (world, m), for the place of a channel among the scenario's. They
  /// are made again only where something has changed.
  const Shapes& shapes(const ShownTick& tick, const dvec3& focus, size_t channel);
  /// Adds to a path what the scene knows of it, if it is known by now.
  void explain(PathStory& story, const ShownTick& tick, size_t channel);

  /// Begins to compute a map of the tick. Throws UserError if the wish cannot be granted.
  void compute_map(const ShownTick& tick, size_t channel);
  void cancel_map();
  const MapJob* job() const { return job_.get(); }
  /// The map to paint; null: none, or switched off. It changes when there is more of it.
  std::shared_ptr<const MapLayerPaint> paint();
  void forget_map();

  /// Whether nothing is being made.
  bool idle() const;
  std::string error() const;
  double milliseconds() const { return milliseconds_; }

 private:
  struct Radio {
    RadioFacts facts;
    FacetOutlines outlines;
  };
  const Radio* radio(size_t channel);
  void drop_job();
  void drop_finished();
  void collect();
  const SampledCourses* courses(uint32_t sequence);
  void make(const ShownTick& tick, const dvec3& focus, size_t channel);

  gpu::DeviceOptions device_;
  std::shared_ptr<const sim::Experiment> experiment_;
  WorldSettings settings_;
  std::optional<MomentCache> moments_;
  std::future<std::shared_ptr<const Radio>> radio_coming_;
  std::shared_ptr<const Radio> radio_;
  std::optional<size_t> radio_channel_;  ///< that radio_ is of, or will be
  std::future<std::shared_ptr<const SampledCourses>> courses_coming_;
  std::shared_ptr<const SampledCourses> courses_;
  std::optional<uint32_t> courses_sequence_;
  std::string error_;

  std::unique_ptr<MapJob> job_;
  /// What is no longer wanted, but still works: the window does not wait for it.
  std::vector<std::unique_ptr<MapJob>> dropped_jobs_;
  std::vector<std::future<std::shared_ptr<const Radio>>> dropped_radio_;
  std::vector<std::future<std::shared_ptr<const SampledCourses>>> dropped_courses_;
  std::shared_ptr<const ShownMap> map_;
  std::shared_ptr<const MapLayerPaint> paint_;
  uint64_t paint_version_ = ~uint64_t{0};

  /// What shapes_ was made of.
  struct MadeOf {
    uint32_t sequence = 0;
    int64_t tick = -1;
    dvec3 focus{0.0};
    size_t channel = 0;
    uint64_t version = ~uint64_t{0};
    const void *radio = nullptr, *courses = nullptr;
    friend bool operator==(const MadeOf&, const MadeOf&) = default;
  };
  MadeOf made_of_;
  Shapes shapes_;
  double milliseconds_ = 0.0;
};

}  // namespace greatx::view
