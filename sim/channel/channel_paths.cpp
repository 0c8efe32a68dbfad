// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel/channel_paths.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>

#include <spdlog/spdlog.h>

#include "core/activity.h"
#include "core/parallel.h"
#include "sim/plan/plan_options.h"
#include "sim/plan/radio_plan.h"

namespace greatx::sim {

namespace {

bool same_bits(const Motion& a, const Motion& b) {
  static_assert(sizeof(Motion) == 16 * sizeof(double));  // no padding
  return std::memcmp(&a, &b, sizeof(Motion)) == 0;
}

}  // namespace

rf::RadioEffects radio_effects(const Experiment& experiment) {
  const Scenario& scenario = experiment.scenario;
  rf::RadioEffects effects = radio_switches(experiment.plan);
  effects.field.seed = scenario.seed;
  effects.weather = weather_of(scenario.environment);
  for (const ChannelConfig& channel : scenario.channels)
    if (effects.lowest_carrier_hz == 0.0 || channel.carrier_hz < effects.lowest_carrier_hz)
      effects.lowest_carrier_hz = channel.carrier_hz;
  return effects;
}

RadioWorld::RadioWorld(const Experiment& experiment, uint32_t channel, const scene::EdgeSurvey* survey)
    : model_(experiment.scene(), experiment.scenario.channels[channel].carrier_hz, radio_effects(experiment),
             survey),
      surroundings_(experiment.scene(), model_.kinds) {}

void RadioWorld::move_on(const TickContext& context) {
  for (uint32_t body = 1; body < context.body_poses.size(); ++body) {
    const Motion motion = context.body_motion_at(body, context.time_s);
    if (same_bits(motion, model_.facets.motion(body))) continue;
    model_.facets.move(body, motion);
    current_ = nullptr;
  }
}

std::shared_ptr<const rf::FacetWorld> RadioWorld::snapshot() {
  if (current_) return current_;
  const auto is_free = [](const std::shared_ptr<rf::FacetWorld>& one) { return one.use_count() == 1; };
  const auto spare = std::find_if(snapshots_.begin(), snapshots_.end(), is_free);
  if (spare != snapshots_.end()) {
    // The last holder may have released the snapshot on another thread.
    std::atomic_thread_fence(std::memory_order_acquire);
    (*spare)->take_poses(model_.facets);
    current_ = *spare;
  } else {
    current_ = snapshots_.emplace_back(std::make_shared<rf::FacetWorld>(model_.facets));
  }
  std::erase_if(snapshots_, is_free);  // further free snapshots are not needed
  return current_;
}

ChannelPaths::ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                           const Experiment& experiment, std::shared_ptr<RadioWorld> radio, uint32_t channel,
                           ChannelEnds ends)
    : ChannelPaths(gpu_scene, crossings, experiment, std::move(radio), experiment.scenario.channels[channel],
                   std::move(ends)) {}

ChannelPaths::ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                           const Experiment& experiment, std::shared_ptr<RadioWorld> radio,
                           const ChannelConfig& config, ChannelEnds ends)
    : world_(*experiment.world),
      config_(config),
      ends_(std::move(ends)),
      radio_(std::move(radio)),
      crossings_(crossings) {
  search_.emplace(&gpu_scene, radio_->model(), experiment.plan, config_, ends_, &radio_->searches());
}

ChannelPaths::ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings,
                           const Experiment& experiment, uint32_t channel)
    : ChannelPaths(gpu_scene, crossings, experiment, std::make_shared<RadioWorld>(experiment, channel),
                   channel, channel_ends(experiment, channel, 0)) {}

void ChannelPaths::set_points(std::span<const dvec3> points, size_t first) {
  ends_.receivers.clear();
  for (size_t i = 0; i < points.size(); ++i) ends_.receivers.push_back(point_end(points[i], first + i));
  search_->set_points();
  ids_known_ = false;
  if (!placed_.empty()) placed_.resize(1);  // keeps the transmitter's
}

std::vector<dvec3> ChannelPaths::receiver_positions(const TickContext& context) const {
  std::vector<dvec3> positions;
  for (const ChannelEnd& end : ends_.receivers) positions.push_back(state(end, context).position);
  return positions;
}

void ChannelPaths::start(const TickContext& context) {
  const Activity activity("searching paths");
  ids_known_ = false;
  placed_.clear();
  placements_told_ = 0;
  radio_->move_on(context);
  search_->start(state(ends_.transmitter, context).position, receiver_positions(context), context.body_poses);
}

void ChannelPaths::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  if (!looks_ahead()) return;
  search_->record_ahead(slot, state(ends_.transmitter, next).position, receiver_positions(next));
}

void ChannelPaths::record(gpu::TickSlot& slot, const TickContext& context) {
  InFlight& flight = in_flight_[slot.index];
  flight.transmitter = state(ends_.transmitter, context);
  radio_->move_on(context);
  flight.world = radio_->snapshot();
  check_placements(context);
  search_->renew(context.tick, flight.transmitter.position, receiver_positions(context), context.body_poses);

  flight.links.assign(ends_.receivers.size(), {});
  const uint32_t threads = threads_of_each(ends_.receivers.size());
  parallel_for(ends_.receivers.size(), 0, [&](size_t r) {
    LinkInFlight& link = flight.links[r];
    link.receiver = state(ends_.receivers[r], context);
    link.distance_m = glm::distance(world_position(ends_.transmitter, context),
                                    world_position(ends_.receivers[r], context));
    rf::LinkGeometry geometry = search_->geometry(r, flight.transmitter, link.receiver, threads);
    link.paths = std::move(geometry.paths);
    // An antenna that hears itself has no line of sight to itself.
    if (ends_.receivers[r].name == ends_.transmitter.name)
      std::erase_if(link.paths, [](const rf::GeometricPath& path) { return path.interactions.empty(); });
    link.left_out = {geometry.searched, geometry.overflow};
  });
  flight.segments.clear();
  for (size_t r = 0; r < ends_.receivers.size(); ++r) {
    LinkInFlight& link = flight.links[r];
    if (link.left_out.paths > 0 && left_out_.paths == 0)
      spdlog::warn(
          "channel '{}', {}: {} geometric paths beyond max_paths ({}) were left out; more in the counters",
          config_.name, ends_.receivers[r].name, link.left_out.paths, config_.limits.max_paths);
    left_out_.add(link.left_out);
    geometric_paths_ += link.paths.size();
    link.first_segment = flight.segments.size();
    search_->solver(r).add_segments(link.paths, flight.transmitter, link.receiver, flight.segments);
    link.segment_count = flight.segments.size() - link.first_segment;
  }
  flight.crossings = crossings_.record(slot, flight.segments);
}

ChannelPaths::Result ChannelPaths::collect(const gpu::TickSlot& slot) {
  InFlight& flight = in_flight_[slot.index];
  uint64_t settled = 0;
  const std::vector<rf::Crossing> crossings =
      crossings_.collect(flight.crossings, flight.segments, *flight.world, &settled);
  settled_segments_ += settled;
  Result result;
  result.world = std::move(flight.world);
  result.transmitter = flight.transmitter;
  result.links.resize(flight.links.size());
  const uint32_t threads = threads_of_each(flight.links.size());
  parallel_for(flight.links.size(), 0, [&](size_t r) {
    LinkInFlight& link = flight.links[r];
    result.links[r].receiver = link.receiver;
    result.links[r].distance_m = link.distance_m;
    result.links[r].left_out = link.left_out;
    result.links[r].paths = search_->solver(r).finish(
        link.paths, std::span(crossings).subspan(link.first_segment, link.segment_count), flight.transmitter,
        link.receiver, *result.world, threads);
  });
  if (!ids_known_) ids_.assign(result.links.size(), {});
  for (size_t r = 0; r < result.links.size(); ++r) {
    lit_paths_ += result.links[r].paths.size();
    note_births(r, result.links[r].paths);
  }
  ids_known_ = true;
  return result;
}

/// Counts births and deaths of paths. A path that did not exist at the tick before is born; a path that no
/// longer exists has died.
void ChannelPaths::note_births(size_t link, const std::vector<rf::Path>& paths) {
  std::vector<uint64_t> now;
  for (const rf::Path& path : paths) now.push_back(path.id());
  std::sort(now.begin(), now.end());
  if (ids_known_) {
    std::vector<uint64_t> stayed;
    std::set_intersection(now.begin(), now.end(), ids_[link].begin(), ids_[link].end(),
                          std::back_inserter(stayed));
    births_ += now.size() - stayed.size();
    deaths_ += ids_[link].size() - stayed.size();
  }
  ids_[link] = std::move(now);
}

/// Reports each end that is inside, beneath or on something once per sequence, and counts ends inside solids
/// at every tick. An end at rest is checked once.
void ChannelPaths::check_placements(const TickContext& context) {
  constexpr size_t most_told = 5;
  placed_.resize(1 + ends_.receivers.size());
  const bool said = placements_told_ > most_told;
  for (size_t i = 0; i < placed_.size(); ++i) {
    const ChannelEnd& end = i == 0 ? ends_.transmitter : ends_.receivers[i - 1];
    Placed& placed = placed_[i];
    if (i == 0 ? !ends_.check_transmitter : !ends_.check_receivers) continue;
    if (!placed.checked || !end.rests) {
      const rf::EndState at = state(end, context);
      const rf::Placement placement = radio_->surroundings().of(at.position, context.body_poses, at.body);
      placed.checked = true;
      placed.inside = placement.solid != rf::Placement::none;
      if (!placement.free() && !placed.told) {
        placed.told = true;
        const bool wrong = placed.inside || placement.beneath != rf::Placement::none ||
                           placement.surface != rf::Placement::none;
        if (++placements_told_ <= most_told)
          spdlog::log(wrong ? spdlog::level::warn : spdlog::level::info, "channel '{}', tick {}: {} {}",
                      config_.name, context.tick, end.name,
                      rf::describe(placement, world_.scene, radio_->model().kinds));
      }
    }
    ends_inside_ += placed.inside;
  }
  if (placements_told_ > most_told && !said)
    spdlog::warn("channel '{}', tick {}: more ends lie inside or on something; the counters have them all",
                 config_.name, context.tick);
}

std::vector<std::pair<std::string, std::string>> ChannelPaths::notes(const LinkLeftOut& left_out) const {
  auto notes = search_->notes(left_out.searched);
  if (left_out.paths > 0)
    for (auto& [name, text] : notes)
      if (name == "guarantee")
        text += fmt::format("; {} geometric paths are left out, beyond the {} of a link (max_paths)",
                            left_out.paths, config_.limits.max_paths);
  return notes;
}

void ChannelPaths::count(std::map<std::string, uint64_t>& counters) const {
  search_->count(counters);
  counters["geometric_paths"] = geometric_paths_;
  counters["segments_settled_in_fp64"] = settled_segments_;
  counters["path_overflow"] = left_out_.paths;
  counters["paths"] = lit_paths_;
  counters["path_births"] = births_;
  counters["path_deaths"] = deaths_;
  counters["ends_inside_solids"] = ends_inside_;
}

}  // namespace greatx::sim
