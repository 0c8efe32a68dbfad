// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The paths of one transmitter of a channel at a tick: from the poses of the ends to fields, without antennas
// and files. The channel sensor and `greatx paths` are built on it. Per tick: exact geometry of all
// candidates on the host, while the GPU is busy with the tick before; what stands in the segments' way in the
// tick's command buffer; fields of what is lit when the tick is collected.
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

/// The radio effects of the plan, for rf/.
rf::RadioEffects radio_effects(const Experiment& experiment);

/// The scene as the waves of one channel meet it; all links of the channel share it. Bodies only ever move on
/// to the next tick that is searched and recorded: a tick in flight has a snapshot, which stays as it is
/// while anybody holds it.
class RadioWorld {
 public:
  RadioWorld(const Experiment& experiment, uint32_t channel);
  /// Its facets stand where move_on() put them last.
  const rf::RadioModel& model() const { return model_; }
  const rf::Surroundings& surroundings() const { return surroundings_; }
  /// Puts the bodies where `context` has them.
  void move_on(const TickContext& context);
  /// The facets as move_on() put them last.
  std::shared_ptr<const rf::FacetWorld> snapshot();

 private:
  rf::RadioModel model_;
  rf::Surroundings surroundings_;
  std::vector<std::shared_ptr<rf::FacetWorld>> snapshots_;  ///< one held by nobody else is used again
  std::shared_ptr<const rf::FacetWorld> current_;           ///< null: bodies have moved since
};

/// What bounds kept out of links: of searches, and paths beyond max_paths. 0: the guarantee of the search
/// holds.
struct LinkLeftOut {
  rf::LeftOut searched;
  uint64_t paths = 0;
  void add(const LinkLeftOut& other) {
    searched.add(other.searched);
    paths += other.paths;
  }
};

class ChannelPaths {
 public:
  /// What one link had at a tick.
  struct Link {
    rf::EndState receiver;
    double distance_m = 0.0;
    LinkLeftOut left_out;
    std::vector<rf::Path> paths;  ///< canonical order (rf::interactions_less)
  };
  struct Result {
    rf::EndState transmitter;
    std::vector<Link> links;                      ///< [receivers]
    std::shared_ptr<const rf::FacetWorld> world;  ///< the facets that the paths were solved among
  };

  /// `crossings` is shared by all channels. Throws UserError if `search: once` is asked for and no end of the
  /// channel stands still, or diffraction is on and candidates come from rays.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               std::shared_ptr<RadioWorld> radio, uint32_t channel, ChannelEnds ends);

  /// The channel's first transmitter and its receivers, alone.
  ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const Experiment& experiment,
               uint32_t channel);

  /// Points at rest, in the world, in place of the receivers; before start(). May be called again between
  /// ticks with other points: what was found for the transmitter stays.
  /// `first`: the number of the first of them, for names. May also be called again at the same tick.
  void set_points(std::span<const dvec3> points, size_t first = 0);
  /// Whether it is said and counted if receivers stand inside something.
  void check_receivers(bool check) { ends_.check_receivers = check; }
  /// Before the first tick of a sequence: candidates from a static end (from the cache if it has them).
  void start(const TickContext& context);
  bool looks_ahead() const { return search_->looks_ahead(); }
  void record_ahead(gpu::TickSlot& slot, const TickContext& next);
  void record(gpu::TickSlot& slot, const TickContext& context);
  Result collect(const gpu::TickSlot& slot);

  const ChannelEnd& transmitter() const { return ends_.transmitter; }
  const std::vector<ChannelEnd>& receivers() const { return ends_.receivers; }
  const rf::RadioModel& model() const { return radio_->model(); }
  /// Candidates, overflows, paths; names without the channel's.
  void count(std::map<std::string, uint64_t>& counters) const;
  /// How candidates are found and what that guarantees of links that `left_out` is of: (name, text).
  std::vector<std::pair<std::string, std::string>> notes(const LinkLeftOut& left_out) const;
  /// Of all links so far.
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
  std::vector<std::vector<uint64_t>> ids_;  ///< [receivers] of the paths at the tick before, ascending
  bool ids_known_ = false;
  /// What check_placements() knows of an end in this sequence.
  struct Placed {
    bool checked = false, inside = false, told = false;
  };
  std::vector<Placed> placed_;  ///< [1 + receivers]: transmitter, receivers; empty: nothing yet
  size_t placements_told_ = 0;  ///< of this sequence
  LinkLeftOut left_out_;
  uint64_t geometric_paths_ = 0, lit_paths_ = 0, births_ = 0, deaths_ = 0, ends_inside_ = 0;
};

}  // namespace greatx::sim
