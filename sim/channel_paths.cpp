// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel_paths.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <spdlog/spdlog.h>

#include "core/parallel.h"
#include "core/units.h"
#include "rf/search/search_cache.h"
#include "sim/radio_plan.h"

namespace greatx::sim {

namespace {

bool is_static(const Scenario& scenario, uint32_t node) {
  return std::holds_alternative<StaticTrajectory>(scenario.nodes[node].trajectory);
}

rf::BeamSearchOptions beam_options(const ChannelConfig& config, const EffectPlan& plan, bool moving_bodies,
                                   uint32_t source_body) {
  rf::BeamSearchOptions options;
  options.source_body = source_body;
  options.max_depth = config.max_depth;
  options.max_transmissions = plan.transmission.on ? config.walls() : 0;
  options.moving_bodies = moving_bodies;
  return options;
}

rf::CandidateSearchOptions ray_options(const ChannelConfig& config, const EffectPlan& plan,
                                       bool moving_bodies) {
  rf::CandidateSearchOptions options;
  options.rays = config.rays;
  options.max_depth = config.max_depth;
  options.max_transmissions = plan.transmission.on ? config.walls() : 0;
  options.moving_bodies = moving_bodies;
  return options;
}

rf::PathOptions path_options(const ChannelConfig& config, bool moving_bodies) {
  rf::PathOptions options;
  options.max_depth = config.max_depth;
  options.max_transmissions = config.walls();
  options.max_reflections_after = config.max_reflections_after;
  options.patch_m = config.scattering_patch_m;
  options.max_paths = config.max_paths;
  options.moving_bodies = moving_bodies;
  return options;
}

/// Straight from the nodes' poses: what the paths' own lengths are checked against.
dvec3 world_position(const ChannelEnd& end, const TickContext& context) {
  return end.node ? (context.nodes[*end.node].pose * end.mount).position : end.mount.position;
}

}  // namespace

rf::RadioEffects radio_effects(const EffectPlan& plan, const Scenario& scenario) {
  rf::RadioEffects effects;
  effects.line_of_sight = plan.line_of_sight.on;
  effects.reflection = plan.reflection.on;
  effects.transmission = plan.transmission.on;
  effects.diffraction = plan.diffraction.on;
  effects.scattering = plan.scattering.on;
  effects.lit_region = plan.diffraction_lit_region.on;
  effects.free_edges = plan.free_edges.on;
  effects.field.roughness = plan.roughness.on;
  effects.field.scattering = plan.scattering.on;
  effects.field.gas = plan.gas.on;
  effects.field.rain = plan.rain.on;
  effects.field.fog = plan.fog.on;
  effects.field.foliage = plan.foliage.on;
  effects.field.seed = scenario.seed;
  effects.weather = weather_of(scenario.environment);
  return effects;
}

ChannelPaths::ChannelPaths(scene::GpuScene& gpu_scene, rf::CrossingPass& crossings, const EffectPlan& plan,
                           const Scenario& scenario, const World& world, uint32_t channel)
    : scenario_(scenario),
      world_(world),
      config_(scenario.channels[channel]),
      move_facets_(plan.moving_reflectors.on),
      transmitter_(end_of(config_.transmitter)),
      model_(world.scene, config_.carrier_hz, radio_effects(plan, scenario)),
      surroundings_(world.scene, model_.kinds),
      crossings_(crossings) {
  for (const std::string& name : config_.receivers) receivers_.push_back(end_of(name));
  choose_search(plan);
  const bool wedges = plan.diffraction.on;
  if (wedges && config_.candidates == "rays")
    throw_user_error_at(
        config_.where,
        "channel '{}': candidates: expected beams, since diffraction is on and rays meet no edges; "
        "found rays",
        config_.name);
  if (search_ == Search::none) return;
  if (config_.candidates == "rays")
    rays_.emplace(gpu_scene, ray_options(config_, plan, move_facets_), model_.kinds);
  else
    beams_.emplace(model_.facets, model_.kinds, model_.wedges,
                   beam_options(config_, plan, move_facets_, transmitter_.body));
}

ChannelEnd ChannelPaths::end_of(const std::string& name) const {
  for (uint32_t node = 0; node < scenario_.nodes.size(); ++node)
    for (const SensorConfig& sensor : scenario_.nodes[node].sensors)
      if (scenario_.nodes[node].name + "/" + sensor.name == name)
        return {name, node, mount_pose(sensor.mount), world_.body_of_node[node]};
  throw ContractError(
      fmt::format("channel '{}' refers to '{}', which the parser let pass", config_.name, name));
}

void ChannelPaths::choose_search(const EffectPlan& plan) {
  const bool bounces = plan.reflection.on || plan.diffraction.on || plan.scattering.on;
  if (!bounces || config_.max_depth == 0) return;
  const bool receivers_static = std::all_of(receivers_.begin(), receivers_.end(), [&](const ChannelEnd& end) {
    return !end.node || is_static(scenario_, *end.node);
  });
  if (config_.search == "every_tick" || plan.moving_reflectors.on)
    search_ = Search::every_tick;
  else if (is_static(scenario_, *transmitter_.node))
    search_ = Search::once_from_transmitter;
  else if (receivers_static)
    search_ = Search::once_from_receivers;
  else if (config_.search == "once")
    throw_user_error_at(config_.where,
                        "channel '{}': search: expected auto or every_tick, since both ends move; found once",
                        config_.name);
  else
    search_ = Search::every_tick;
}

void ChannelPaths::set_points(std::span<const dvec3> points, size_t first) {
  receivers_.clear();
  for (size_t i = 0; i < points.size(); ++i)
    receivers_.push_back(
        {fmt::format("point {}", first + i), std::nullopt, Pose{points[i], dquat(1.0, 0.0, 0.0, 0.0)}, 0});
  // Points come by the thousand: one search from the transmitter serves them all.
  if (search_ == Search::once_from_receivers) search_ = Search::every_tick;
  ids_known_ = false;
  if (!placed_.empty()) placed_.resize(1);  // the transmitter's
}

rf::EndState ChannelPaths::state_of(const ChannelEnd& end, const TickContext& context) const {
  rf::EndState state;
  if (!end.node) {
    const Pose pose = world_.scene.to_local(end.mount);
    state.position = pose.position;
    state.orientation = pose.orientation;
    return state;
  }
  const Motion& node = context.nodes[*end.node];
  const Pose pose = world_.scene.to_local(node.pose) * end.mount;
  state.position = pose.position;
  state.velocity = node.velocity + glm::cross(node.angular_velocity, node.pose.rotate(end.mount.position));
  state.orientation = pose.orientation;
  state.body = end.body;
  return state;
}

rf::CandidateList ChannelPaths::found(rf::CandidateList list, uint64_t overflow) {
  candidate_count_ = std::max<uint64_t>(candidate_count_, list.size());
  if (overflow > 0)
    spdlog::warn("channel '{}': {} candidates beyond the bound were left out", config_.name, overflow);
  candidate_overflow_ += overflow;
  if (list.size() == 0 || !list.sequence(0).empty()) {  // rays do not list the line of sight
    list.add({});
    list.make_canonical();
  }
  return list;
}

rf::CandidateList ChannelPaths::search(const dvec3& source, const TickContext& context) {
  if (rays_) {
    rf::CandidateSearchResult result = rays_->search(context.body_poses, source);
    const uint64_t overflow = result.overflow();
    return found(std::move(result.list), overflow);
  }
  if (!beams_) return found({}, 0);
  const rf::SearchCache cache = rf::SearchCache::standard();
  // What moves stands elsewhere in the next run.
  const std::string key = move_facets_ || search_ == Search::every_tick
                              ? std::string()
                              : rf::search_key(world_.scene.hash, model_.kinds, model_.wedges, source,
                                               beams_->options());
  if (!key.empty()) {
    if (auto known = cache.load(key)) {
      ++cache_hits_;
      const uint64_t overflow = known->overflow();
      return found(std::move(known->list), overflow);
    }
    if (world_.scene.facets.size() > 1000)
      spdlog::info("channel '{}': searching {} facets to depth {}; kept for the next run", config_.name,
                   world_.scene.facets.size(), config_.max_depth);
  }
  rf::BeamSearchResult result = beams_->search(source);
  if (!key.empty()) cache.store(key, result);
  const uint64_t overflow = result.overflow();
  return found(std::move(result.list), overflow);
}

rf::PathSolver& ChannelPaths::solver(size_t index) {
  while (solvers_.size() <= index) solvers_.emplace_back(model_, path_options(config_, move_facets_));
  return solvers_[index];
}

void ChannelPaths::start(const TickContext& context) {
  searching_.reset();
  ids_known_ = false;
  searched_tick_ = -1;
  placed_.clear();
  placements_told_ = 0;
  const bool once = search_ == Search::once_from_transmitter || search_ == Search::once_from_receivers;
  if (once && !solvers_.empty()) return;
  solvers_.clear();
  move_bodies(context);
  if (search_ == Search::once_from_receivers) {
    for (size_t r = 0; r < receivers_.size(); ++r) {
      const dvec3 source = state_of(receivers_[r], context).position;
      solver(r).set_candidates(search(source, context), source, rf::Source::receiver);
    }
    return;
  }
  // Every tick by beams is done in record().
  if (search_ == Search::every_tick && beams_) return;
  const dvec3 source = state_of(transmitter_, context).position;
  solver(0).set_candidates(search(source, context), source, rf::Source::transmitter);
}

void ChannelPaths::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  searching_ = rays_->record(slot, state_of(transmitter_, next).position);
}

void ChannelPaths::move_bodies(const TickContext& context) {
  if (!move_facets_) return;
  for (uint32_t node = 0; node < context.nodes.size(); ++node)
    if (const uint32_t body = world_.body_of_node[node]; body != 0) {
      Motion motion = context.nodes[node];
      motion.pose = world_.scene.to_local(motion.pose);
      model_.facets.move(body, motion);
    }
}

void ChannelPaths::renew_candidates(const dvec3& transmitter, const TickContext& context) {
  if (search_ == Search::once_from_transmitter || search_ == Search::once_from_receivers) return;
  if (search_ == Search::every_tick && beams_) {
    if (context.tick == searched_tick_) return;  // more points at the same tick
    searched_tick_ = context.tick;
    solver(0).set_candidates(search(transmitter, context), transmitter, rf::Source::transmitter);
  } else if (searching_) {
    rf::CandidateSearchResult result = rays_->collect(*searching_);
    const uint64_t overflow = result.overflow();
    solver(0).set_candidates(found(std::move(result.list), overflow), transmitter, rf::Source::transmitter);
    searching_.reset();
  } else {
    solver(0).move_source(transmitter);
  }
}

void ChannelPaths::record(gpu::TickSlot& slot, const TickContext& context) {
  InFlight& flight = in_flight_[slot.index];
  flight.transmitter = state_of(transmitter_, context);
  move_bodies(context);
  check_placements(context);
  renew_candidates(flight.transmitter.position, context);

  flight.links.assign(receivers_.size(), {});
  std::vector<uint64_t> overflow(receivers_.size());
  parallel_for(receivers_.size(), 0, [&](size_t r) {
    LinkInFlight& link = flight.links[r];
    link.receiver = state_of(receivers_[r], context);
    link.distance_m =
        glm::distance(world_position(transmitter_, context), world_position(receivers_[r], context));
    rf::LinkGeometry geometry = search_ == Search::once_from_receivers
                                    ? solvers_[r].geometry(flight.transmitter)
                                    : solvers_[0].geometry(link.receiver);
    link.paths = std::move(geometry.paths);
    overflow[r] = geometry.overflow;
  });
  flight.segments.clear();
  for (size_t r = 0; r < receivers_.size(); ++r) {
    LinkInFlight& link = flight.links[r];
    if (overflow[r] > 0 && path_overflow_ == 0)
      spdlog::warn(
          "channel '{}', {}: {} geometric paths beyond max_paths ({}) were left out; more in the counters",
          config_.name, receivers_[r].name, overflow[r], config_.max_paths);
    path_overflow_ += overflow[r];
    geometric_paths_ += link.paths.size();
    link.first_segment = flight.segments.size();
    solvers_[0].add_segments(link.paths, flight.transmitter, link.receiver, flight.segments);
    link.segment_count = flight.segments.size() - link.first_segment;
  }
  flight.crossings = crossings_.record(slot, flight.segments);
}

ChannelPaths::Result ChannelPaths::collect(const gpu::TickSlot& slot) {
  InFlight& flight = in_flight_[slot.index];
  const std::vector<rf::Crossing> crossings = crossings_.collect(flight.crossings, flight.segments);
  Result result;
  result.transmitter = flight.transmitter;
  result.links.resize(flight.links.size());
  parallel_for(flight.links.size(), 0, [&](size_t r) {
    LinkInFlight& link = flight.links[r];
    result.links[r].receiver = link.receiver;
    result.links[r].distance_m = link.distance_m;
    result.links[r].paths =
        solvers_[0].finish(link.paths, std::span(crossings).subspan(link.first_segment, link.segment_count),
                           flight.transmitter, link.receiver);
  });
  if (!ids_known_) ids_.assign(result.links.size(), {});
  for (size_t r = 0; r < result.links.size(); ++r) {
    lit_paths_ += result.links[r].paths.size();
    note_births(r, result.links[r].paths);
  }
  ids_known_ = true;
  return result;
}

/// A path that was not there at the tick before is born, one that is not there any more has died.
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

bool ChannelPaths::moves(const ChannelEnd& end) const { return end.node && !is_static(scenario_, *end.node); }

/// Says once per end and sequence where it should not be, and counts. Ends at rest are judged once.
void ChannelPaths::check_placements(const TickContext& context) {
  constexpr size_t most_told = 5;
  placed_.resize(1 + receivers_.size());
  const bool said = placements_told_ > most_told;
  for (size_t i = 0; i < placed_.size(); ++i) {
    const ChannelEnd& end = i == 0 ? transmitter_ : receivers_[i - 1];
    Placed& placed = placed_[i];
    if (!placed.checked || moves(end)) {
      const rf::EndState state = state_of(end, context);
      const rf::Placement placement = surroundings_.of(state.position, context.body_poses, state.body);
      placed.checked = true;
      placed.inside = placement.solid != rf::Placement::none;
      if (!placement.free() && !placed.told) {
        placed.told = true;
        const bool wrong = placed.inside || placement.surface != rf::Placement::none;
        if (++placements_told_ <= most_told)
          spdlog::log(wrong ? spdlog::level::warn : spdlog::level::info, "channel '{}', tick {}: {} {}",
                      config_.name, context.tick, end.name,
                      rf::describe(placement, world_.scene, model_.kinds));
      }
    }
    ends_inside_ += placed.inside;
  }
  if (placements_told_ > most_told && !said)
    spdlog::warn("channel '{}', tick {}: more ends lie inside or on something; the counters have them all",
                 config_.name, context.tick);
}

void ChannelPaths::count(std::map<std::string, uint64_t>& counters) const {
  counters["candidates"] = candidate_count_;
  counters["candidate_overflow"] = candidate_overflow_;
  counters["candidates_from_cache"] = cache_hits_;
  counters["geometric_paths"] = geometric_paths_;
  counters["path_overflow"] = path_overflow_;
  counters["paths"] = lit_paths_;
  counters["path_births"] = births_;
  counters["path_deaths"] = deaths_;
  counters["ends_inside_solids"] = ends_inside_;
}

std::vector<std::pair<std::string, std::string>> ChannelPaths::notes() const {
  constexpr const char* searches[] = {"none", "once, from the transmitter", "once, from each receiver",
                                      "every tick, from the transmitter"};
  std::vector<std::pair<std::string, std::string>> notes;
  notes.emplace_back("search", searches[static_cast<uint32_t>(search_)]);
  if (beams_) notes.emplace_back("guarantee", beams_->guarantee());
  if (rays_)
    notes.emplace_back(
        "guarantee",
        fmt::format(
            "{} rays: a sequence whose beam is narrower than their spacing, {:.2g} mrad, may be missed",
            config_.rays, 1e3 * std::sqrt(4.0 * pi / config_.rays)));
  return notes;
}

}  // namespace greatx::sim
