// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Channel state information of one transmitter and its receivers. Per tick: exact geometry and fields of all candidates
// on the host, while the GPU is busy with the tick before; the segments' visibility in the tick's command buffer; the
// sum over the visible paths when the tick is collected.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "rf/candidate_search.h"
#include "rf/channel.h"
#include "rf/facet_world.h"
#include "rf/field.h"
#include "rf/geometry.h"
#include "rf/visibility.h"
#include "scene/gpu_scene.h"
#include "sim/effect_plan.h"
#include "sim/sensor.h"
#include "sim/world.h"

namespace greatx::sim {

class ChannelSensor : public Sensor {
 public:
  /// `visibility` is shared by all channels. Throws UserError if receivers differ in their number of ports, or
  /// `search: once` is asked for and no end of the channel stands still.
  ChannelSensor(scene::GpuScene& gpu_scene, rf::VisibilityPass& visibility, const EffectPlan& plan,
                const Scenario& scenario, const World& world, uint32_t channel);

  const SensorSpec& spec() const override { return spec_; }
  void start(const TickContext& context) override;
  void record(gpu::TickSlot& slot, const TickContext& context) override;
  bool looks_ahead() const override { return search_ == Search::every_tick; }
  void record_ahead(gpu::TickSlot& slot, const TickContext& next) override;
  std::vector<Array> collect(const gpu::TickSlot& slot) override;
  void report(Consistency& consistency) const override;
  void count(std::map<std::string, uint64_t>& counters) const override;

 private:
  /// Where candidates come from.
  enum class Search { none, once_from_transmitter, once_from_receivers, every_tick };
  /// One end of the channel.
  struct End {
    uint32_t node = 0;
    uint32_t body = 0;
    Pose mount;
    rf::AntennaArray array;
  };
  /// An end at a tick: local coordinates.
  struct EndState {
    dvec3 position{0.0}, velocity{0.0};
    dquat orientation{1.0, 0.0, 0.0, 0.0};
  };
  /// What one link had at a tick; `visible_first` is its first segment in the batch.
  struct Link {
    EndState receiver;
    double distance_m = 0.0;
    std::vector<rf::Path> paths;
  };
  struct Pending {
    EndState transmitter;
    std::vector<Link> links;
    rf::VisibilityPass::Pending visibility;
  };

  End end_of(const Scenario& scenario, const std::string& name) const;
  void choose_search(const Scenario& scenario, const EffectPlan& plan);
  void describe();
  EndState state_of(const End& end, const TickContext& context) const;
  rf::CandidateList with_line_of_sight(rf::CandidateSearchResult result);
  void search_from_static_ends(const TickContext& context);
  void add_segments(const std::vector<rf::Path>& paths, const End& receiver,
                    std::vector<rf::Segment>& segments) const;
  void drop_blocked(Pending& pending);
  std::vector<Array> arrays_of(const Pending& pending) const;

  const World& world_;
  const ChannelConfig& config_;
  bool line_of_sight_, doppler_;
  bool move_facets_;
  End transmitter_;
  std::vector<End> receivers_;
  rf::FacetWorld facets_;
  rf::RadioSurfaces surfaces_;
  rf::VisibilityPass& visibility_;
  Search search_ = Search::none;
  std::optional<rf::CandidateSearch> candidates_;
  std::optional<rf::CandidateSearch::Pending> searching_;  ///< recorded with the tick before
  std::vector<std::unique_ptr<rf::ImageTree>> trees_;      ///< [1], or [receivers] when they are the source
  std::array<Pending, slots_in_flight> pending_;
  SensorSpec spec_;
  uint64_t candidate_count_ = 0, overflow_ = 0, geometric_paths_ = 0, visible_paths_ = 0;
  ErrorStatistics line_of_sight_errors_;
};

}  // namespace greatx::sim
