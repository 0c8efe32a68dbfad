// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the paths of one transmitter of a channel at a tick, from the poses of the ends to the fields,
// without antennas and files. The channel sensor and `greatx paths` are built on it. The host computes the
// exact geometry of all candidates while the GPU works on the tick before. The command buffer of the tick
// finds the obstacles on the segments, and collecting the tick computes the fields of the paths that are not
// blocked.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "rf/facets/placement.h"
#include "rf/paths/path_solver.h"
#include "sim/channel/channel_search.h"
#include "sim/channel/ends.h"
#include "sim/experiment/experiment.h"
#include "sim/sensors/sensor.h"

namespace greatx::sim {

/// Returns the radio effects of the plan, with the values that belong to them, as rf/ takes them.
rf::RadioEffects radio_effects(const Experiment& experiment);

/// Holds the scene as the waves of one channel meet it. All links of the channel share it. Its bodies stand
/// at the tick that was recorded last. A tick in flight holds a snapshot, which does not change while it is
/// held.
class RadioWorld {
 public:
  /// `survey`: null, or one of the scene's edges, which spares work.
  RadioWorld(const Experiment& experiment, uint32_t channel, const scene::EdgeSurvey* survey = nullptr);
  /// Returns the model. Its facets are in the poses that move_on() set last.
  const rf::RadioModel& model() const { return model_; }
  const rf::Surroundings& surroundings() const { return surroundings_; }
  /// Moves the bodies to their poses in `context`.
  void move_on(const TickContext& context);
  /// Returns the facets in the poses that move_on() set last.
  std::shared_ptr<const rf::FacetWorld> snapshot();
  /// Returns what the searches of all transmitters share.
  SharedSearches& searches() { return searches_; }

 private:
  rf::RadioModel model_;
  rf::Surroundings surroundings_;
  std::vector<std::shared_ptr<rf::FacetWorld>> snapshots_;  ///< those that are not held are reused
  SharedSearches searches_{model_};
  std::shared_ptr<const rf::FacetWorld> current_;  ///< null: bodies have moved since the last snapshot
};

/// Counts the candidates that searches left out, and the paths that links left out beyond max_paths. If both
/// are 0, the guarantee of the search holds.
struct LinkLeftOut {
  rf::LeftOut searched;
  uint64_t paths = 0;
  void add(const LinkLeftOut& other) {
    searched.add(other.searched);
    paths += other.paths;
  }
};

/// Computes the paths from one transmitter of a channel to its receivers, tick by tick.
class ChannelPaths {
 public:
  /// Describes one link at a tick.
  struct Link {
    rf::EndState receiver;
    double distance_m = 0.0;
    LinkLeftOut left_out;
    std::vector<rf::Path> paths;  ///< canonical order (rf::interactions_less)
  };
  struct Result {
    rf::EndState transmitter;
    std::vector<Link> links;                      ///< [receivers]
    std::shared_ptr<const rf::FacetWorld> world;  ///< the facets for which the paths were solved
  };

  /// All channels share `crossings`. Throws UserError if `search: once` is asked for and no end of the
  /// channel stands still, or if diffraction is on and candidates come from rays.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               std::shared_ptr<RadioWorld> radio, uint32_t channel, ChannelEnds ends);
  /// The same with other settings than those of the channel, such as the limits of a target's legs. `config`
  /// outlives this.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               std::shared_ptr<RadioWorld> radio, const ChannelConfig& config, ChannelEnds ends);

  /// Computes the paths from the first transmitter of the channel to its receivers alone.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               uint32_t channel);

  /// Replaces the receivers by points at rest, world coordinates. The names of the points count from `first`.
  /// Called before start(), and again with other points at the same tick or between ticks; the candidates
  /// found from the transmitter are kept.
  void set_points(std::span<const dvec3> points, size_t first = 0);
  /// Sets whether receivers inside a solid are reported and counted.
  void check_receivers(bool check) { ends_.check_receivers = check; }
  /// Called before the first tick of a sequence. Searches candidates from an end that stands still, or takes
  /// them from the cache.
  void start(const TickContext& context);
  bool looks_ahead() const { return search_->looks_ahead(); }
  void record_ahead(gpu::TickSlot& slot, const TickContext& next);
  void record(gpu::TickSlot& slot, const TickContext& context);
  Result collect(const gpu::TickSlot& slot);

  const ChannelEnd& transmitter() const { return ends_.transmitter; }
  const std::vector<ChannelEnd>& receivers() const { return ends_.receivers; }
  const rf::RadioModel& model() const { return radio_->model(); }
  /// Adds the counts of candidates, overflows and paths, under names without that of the channel.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// Returns (name, text) pairs that say how candidates are found, and which guarantee holds for links with
  /// these omissions.
  std::vector<std::pair<std::string, std::string>> notes(const LinkLeftOut& left_out) const;
  /// Returns the omissions of all links so far.
  const LinkLeftOut& left_out() const { return left_out_; }

 private:
  struct LinkInFlight {
    rf::EndState receiver;
    double distance_m = 0.0;
    LinkLeftOut left_out;
    size_t first_segment = 0, segment_count = 0;
    std::vector<rf::GeometricPath> paths;
  };
  struct InFlight {
    std::shared_ptr<const rf::FacetWorld> world;
    rf::EndState transmitter;
    std::vector<LinkInFlight> links;
    std::vector<rf::Segment> segments;
    rf::CrossingPass::Pending crossings;
  };

  std::vector<dvec3> receiver_positions(const TickContext& context) const;
  void note_births(size_t link, const std::vector<rf::Path>& paths);
  void check_placements(const TickContext& context);

  rf::EndState state(const ChannelEnd& end, const TickContext& context) const {
    return state_of(end, world_, context);
  }

  const World& world_;
  const ChannelConfig& config_;
  ChannelEnds ends_;
  std::shared_ptr<RadioWorld> radio_;
  rf::CrossingPass& crossings_;
  std::optional<ChannelSearch> search_;
  std::array<InFlight, slots_in_flight> in_flight_;
  std::vector<std::vector<uint64_t>> ids_;  ///< [receivers] path ids at the tick before, ascending
  bool ids_known_ = false;
  /// Records what check_placements() has found for an end in this sequence.
  struct Placed {
    bool checked = false, inside = false, told = false;
  };
  std::vector<Placed> placed_;  ///< [1 + receivers] transmitter, receivers; empty: nothing checked yet
  size_t placements_told_ = 0;  ///< messages in this sequence
  LinkLeftOut left_out_;
  uint64_t geometric_paths_ = 0, settled_segments_ = 0, lit_paths_ = 0, births_ = 0, deaths_ = 0,
           ends_inside_ = 0;
};

}  // namespace greatx::sim
