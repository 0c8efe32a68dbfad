// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/channel_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <spdlog/spdlog.h>

#include "core/units.h"

namespace greatx::sim {

namespace {

rf::AntennaArray array_of(const AntennaConfig& config, double carrier_hz) {
  const double wavelength = speed_of_light / carrier_hz;
  rf::AntennaArray array;
  array.pattern =
      config.pattern == AntennaPattern::isotropic ? rf::Pattern::isotropic : rf::Pattern::half_wave_dipole;
  switch (config.polarization) {
    case Polarization::v:
      array.polarization = rf::Polarization::v;
      break;
    case Polarization::h:
      array.polarization = rf::Polarization::h;
      break;
    case Polarization::vh:
      array.polarization = rf::Polarization::vh;
      break;
    case Polarization::slant:
      array.polarization = rf::Polarization::slant;
      break;
  }
  array.rows = config.rows;
  array.columns = config.columns;
  array.row_spacing_m = config.row_spacing_wl * wavelength;
  array.column_spacing_m = config.column_spacing_wl * wavelength;
  return array;
}

bool is_static(const Scenario& scenario, uint32_t node) {
  return std::holds_alternative<StaticTrajectory>(scenario.nodes[node].trajectory);
}

}  // namespace

ChannelSensor::ChannelSensor(scene::GpuScene& gpu_scene, rf::VisibilityPass& visibility,
                             const EffectPlan& plan, const Scenario& scenario, const World& world,
                             uint32_t channel)
    : world_(world),
      config_(scenario.channels[channel]),
      line_of_sight_(plan.line_of_sight.on),
      doppler_(plan.doppler.on),
      move_facets_(plan.moving_reflectors.on),
      transmitter_(end_of(scenario, config_.transmitter)),
      facets_(world.scene),
      surfaces_(world.scene, config_.carrier_hz),
      visibility_(visibility) {
  for (const std::string& name : config_.receivers) receivers_.push_back(end_of(scenario, name));
  for (const End& receiver : receivers_)
    if (receiver.array.port_count() != receivers_[0].array.port_count())
      throw_user_error_at(config_.where,
                          "channel '{}': rx: expected receivers with one number of ports, found {} and {}; "
                          "give each its own channel",
                          config_.name, receivers_[0].array.port_count(), receiver.array.port_count());
  choose_search(scenario, plan);
  if (search_ != Search::none)
    candidates_.emplace(
        gpu_scene, rf::CandidateSearchOptions{
                       .rays = config_.rays, .max_depth = config_.max_depth, .moving_bodies = move_facets_});
  describe();
}

ChannelSensor::End ChannelSensor::end_of(const Scenario& scenario, const std::string& name) const {
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (const SensorConfig& sensor : scenario.nodes[node].sensors)
      if (scenario.nodes[node].name + "/" + sensor.name == name)
        return {node, world_.body_of_node[node], mount_pose(sensor.mount),
                array_of(std::get<AntennaConfig>(sensor.config), config_.carrier_hz)};
  throw ContractError(
      fmt::format("channel '{}' refers to '{}', which the parser let pass", config_.name, name));
}

void ChannelSensor::choose_search(const Scenario& scenario, const EffectPlan& plan) {
  if (!plan.reflection.on || config_.max_depth == 0) return;
  const bool receivers_static = std::all_of(receivers_.begin(), receivers_.end(),
                                            [&](const End& end) { return is_static(scenario, end.node); });
  if (config_.search == "every_tick" || plan.moving_reflectors.on)
    search_ = Search::every_tick;
  else if (is_static(scenario, transmitter_.node))
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

ChannelSensor::EndState ChannelSensor::state_of(const End& end, const TickContext& context) const {
  const Motion& node = context.nodes[end.node];
  const Pose pose = world_.scene.to_local(node.pose) * end.mount;
  return {pose.position,
          node.velocity + glm::cross(node.angular_velocity, node.pose.rotate(end.mount.position)),
          pose.orientation};
}

rf::CandidateList ChannelSensor::with_line_of_sight(rf::CandidateSearchResult result) {
  candidate_count_ = std::max<uint64_t>(candidate_count_, result.list.size());
  if (result.overflow() > 0)
    spdlog::warn("channel '{}': {} candidates beyond the bound were left out", config_.name,
                 result.overflow());
  overflow_ += result.overflow();
  if (line_of_sight_) {
    result.list.add({});
    result.list.make_canonical();
  }
  return std::move(result.list);
}

void ChannelSensor::search_from_static_ends(const TickContext& context) {
  const auto search = [&](const End& end) {
    return with_line_of_sight(candidates_->search(context.body_poses, state_of(end, context).position));
  };
  if (search_ == Search::once_from_transmitter) {
    trees_.push_back(std::make_unique<rf::ImageTree>(facets_, state_of(transmitter_, context).position,
                                                     search(transmitter_)));
    return;
  }
  for (const End& receiver : receivers_)
    trees_.push_back(std::make_unique<rf::ImageTree>(facets_, state_of(receiver, context).position,
                                                     search(receiver), rf::Source::receiver));
}

void ChannelSensor::start(const TickContext& context) {
  searching_.reset();
  const bool once = search_ == Search::once_from_transmitter || search_ == Search::once_from_receivers;
  if (once && trees_.empty()) search_from_static_ends(context);
  if (once) return;
  trees_.clear();
  const dvec3 source = state_of(transmitter_, context).position;
  rf::CandidateSearchResult found;
  if (search_ == Search::every_tick) found = candidates_->search(context.body_poses, source);
  trees_.push_back(std::make_unique<rf::ImageTree>(facets_, source, with_line_of_sight(std::move(found))));
}

void ChannelSensor::record_ahead(gpu::TickSlot& slot, const TickContext& next) {
  searching_ = candidates_->record(slot, state_of(transmitter_, next).position);
}

void ChannelSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  Pending& pending = pending_[slot.index];
  pending.transmitter = state_of(transmitter_, context);
  if (move_facets_)
    for (uint32_t node = 0; node < context.nodes.size(); ++node)
      if (const uint32_t body = world_.body_of_node[node]; body != 0) {
        Motion motion = context.nodes[node];
        motion.pose = world_.scene.to_local(motion.pose);
        facets_.move(body, motion);
      }
  if (searching_) {
    trees_[0] = std::make_unique<rf::ImageTree>(facets_, pending.transmitter.position,
                                                with_line_of_sight(candidates_->collect(*searching_)));
    searching_.reset();
  } else if (search_ == Search::none || search_ == Search::every_tick) {
    trees_[0]->update(pending.transmitter.position);
  }

  pending.links.assign(receivers_.size(), {});
  std::vector<rf::Segment> segments;
  for (size_t r = 0; r < receivers_.size(); ++r) {
    Link& link = pending.links[r];
    link.receiver = state_of(receivers_[r], context);
    link.distance_m = glm::distance((context.nodes[transmitter_.node].pose * transmitter_.mount).position,
                                    (context.nodes[receivers_[r].node].pose * receivers_[r].mount).position);
    const std::vector<rf::GeometricPath> geometric = search_ == Search::once_from_receivers
                                                         ? trees_[r]->solve(pending.transmitter.position)
                                                         : trees_[0]->solve(link.receiver.position);
    for (const rf::GeometricPath& path : geometric)
      link.paths.push_back(
          rf::path_field(path, {&facets_, &surfaces_}, pending.transmitter.velocity, link.receiver.velocity));
    add_segments(link.paths, receivers_[r], segments);
    geometric_paths_ += geometric.size();
  }
  pending.visibility = visibility_.record(slot, segments);
}

void ChannelSensor::add_segments(const std::vector<rf::Path>& paths, const End& receiver,
                                 std::vector<rf::Segment>& segments) const {
  const auto body_or_none = [](uint32_t body) { return body == 0 ? shared::rf_none : body; };
  for (const rf::Path& path : paths) {
    const size_t count = path.interactions.size();
    for (size_t i = 0; i <= count; ++i) {
      rf::Segment segment{path.vertices[i], path.vertices[i + 1]};
      if (i > 0) segment.facet_a = path.interactions[i - 1].element;
      if (i < count) segment.facet_b = path.interactions[i].element;
      if (i == 0) segment.body_a = body_or_none(transmitter_.body);
      if (i == count) segment.body_b = body_or_none(receiver.body);
      segments.push_back(segment);
    }
  }
}

void ChannelSensor::drop_blocked(Pending& pending) {
  const std::vector<uint8_t> visible = visibility_.collect(pending.visibility);
  size_t segment = 0;
  for (Link& link : pending.links) {
    std::vector<rf::Path> kept;
    for (rf::Path& path : link.paths) {
      const size_t segments = path.interactions.size() + 1;
      const bool clear = std::all_of(visible.begin() + static_cast<std::ptrdiff_t>(segment),
                                     visible.begin() + static_cast<std::ptrdiff_t>(segment + segments),
                                     [](uint8_t free) { return free != 0; });
      segment += segments;
      if (clear) kept.push_back(std::move(path));
    }
    link.paths = std::move(kept);
  }
  GREATX_CHECK(segment == visible.size(), "{} segments, {} answers", segment, visible.size());
}

std::vector<Array> ChannelSensor::collect(const gpu::TickSlot& slot) {
  Pending& pending = pending_[slot.index];
  drop_blocked(pending);
  for (const Link& link : pending.links) {
    visible_paths_ += link.paths.size();
    for (const rf::Path& path : link.paths) {
      if (!path.interactions.empty()) continue;
      line_of_sight_errors_.add(std::abs(speed_of_light * path.delay_s - link.distance_m) / link.distance_m);
    }
  }
  return arrays_of(pending);
}

void ChannelSensor::report(Consistency& consistency) const {
  consistency.line_of_sight.add(line_of_sight_errors_);
}

void ChannelSensor::count(std::map<std::string, uint64_t>& counters) const {
  counters[config_.name + ".candidates"] = candidate_count_;
  counters[config_.name + ".candidate_overflow"] = overflow_;
  counters[config_.name + ".geometric_paths"] = geometric_paths_;
  counters[config_.name + ".visible_paths"] = visible_paths_;
}

}  // namespace greatx::sim
