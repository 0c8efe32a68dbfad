// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "engine/session/session.h"

#include <cmath>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "core/expected.h"
#include "engine/session/environment.h"
#include "engine/session/map_result.h"
#include "engine/session/path_set.h"
#include "engine/session/stream.h"
#include "sim/channel/notes.h"
#include "sim/plan/antennas.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/override.h"
#include "sim/scenario/sensor_kinds.h"

namespace greatx::engine {

namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> antennas_of(const sim::Scenario& scenario) {
  std::vector<std::string> names;
  for (const sim::NodeConfig& node : scenario.nodes)
    for (const sim::SensorConfig& sensor : node.sensors)
      if (std::holds_alternative<sim::AntennaConfig>(sensor.config))
        names.push_back(node.name + "/" + sensor.name);
  return names;
}

void check_name_is_free(const sim::Scenario& scenario, const std::string& name, const SourceLocation& where) {
  const auto taken = [&](const auto& list, const char* what) {
    for (const auto& item : list)
      if (item.name == name)
        throw_user_error_at(where, "name: expected one that is free, found that of a {}, '{}'", what, name);
  };
  taken(scenario.nodes, "node");
  taken(scenario.channels, "channel");
  taken(scenario.scene.objects, "scene's object");
}

void check_finite(std::span<const dvec3> points) {
  for (size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(points[i][c]))
        throw_user_error("receivers[{}, {}]: expected a finite position in metres, found {}", i, c,
                         points[i][c]);
}

}  // namespace

void Gpu::check_validation() {
  const std::vector<std::string> messages = device.validation_log()->take();
  if (messages.empty()) return;
  throw std::runtime_error(
      fmt::format("{} validation messages:\n{}", messages.size(), fmt::join(messages, "\n")));
}

/// Holds a snapshot and the request for which it was made.
struct Session::Kept {
  std::shared_ptr<const sim::Experiment> session;  ///< experiment of the session at that time
  std::shared_ptr<Gpu> gpu;
  std::shared_ptr<const sim::Experiment>
      experiment;  ///< the same experiment, or one with a plan for the points
  uint32_t channel = 0, sequence = 0;
  int64_t tick = 0;
  bool points = false;
  std::unique_ptr<sim::ChannelSnapshot> snapshot;  ///< refers to the members above, so it comes last
};

Session::Session(sim::Scenario scenario, std::string assets, gpu::DeviceOptions device)
    : scenario_(std::move(scenario)), assets_(std::move(assets)), device_options_(std::move(device)) {}

Session::~Session() { drop_snapshot(); }

void Session::drop_snapshot() {
  if (kept_ == nullptr) return;
  const std::lock_guard device(gpu_->mutex);
  kept_.reset();
}

void Session::changed() {
  drop_snapshot();
  experiment_.reset();
}

sim::Scenario Session::parse(const std::string& text, const std::string& where) const {
  return sim::parse_scenario(text, where, ".", assets_);
}

sim::MapReceiver Session::antenna_at_points(const std::string& text, double carrier_hz) const {
  const sim::Scenario scenario = parse(text, "receivers");
  const std::string name = antennas_of(scenario).at(0);
  const sim::SensorPlace place = sim::sensor_place(scenario, name);
  return {sim::antenna_array(scenario, name, carrier_hz),
          sim::mount_pose(scenario.nodes[place.node].sensors[place.sensor].mount).orientation};
}

void Session::add_nodes(const std::string& text, const std::string& where) {
  const std::lock_guard lock(mutex_);
  const sim::Scenario more = parse(text, where);
  for (const sim::NodeConfig& node : more.nodes) check_name_is_free(scenario_, node.name, node.where);
  scenario_.nodes.insert(scenario_.nodes.end(), more.nodes.begin(), more.nodes.end());
  changed();
}

void Session::add_channels(const std::string& text, const std::string& where, bool no_receivers) {
  const std::lock_guard lock(mutex_);
  const sim::Scenario more = parse(text, where);
  for (const sim::ChannelConfig& channel : more.channels)
    check_name_is_free(scenario_, channel.name, channel.where);
  for (sim::ChannelConfig channel : more.channels) {
    if (no_receivers) channel.receivers.clear();
    scenario_.channels.push_back(std::move(channel));
  }
  changed();
}

void Session::change(const std::string& text, const std::string& where,
                     const std::vector<std::string>& keys) {
  const std::lock_guard lock(mutex_);
  const sim::Scenario with = parse(text, where);
  constexpr std::string_view environment = "environment.";
  for (const std::string& key : keys) {
    if (key == "seed") scenario_.seed = with.seed;
    if (key == "ticks") sim::override_ticks(scenario_, with.ticks);
    if (key == "sequences") scenario_.sequences = with.sequences;
    if (key == "tolerance_db") scenario_.tolerance_db = with.tolerance_db;
    if (key == "effects")
      for (const auto& [name, wish] : with.effects) scenario_.effects[name] = wish;
    if (key.starts_with(environment))
      change_environment(scenario_.environment, with.environment, key.substr(environment.size()));
  }
  changed();
}

std::string Session::facts() const {
  const std::lock_guard lock(mutex_);
  Json json{{"name", scenario_.name},
            {"seed", scenario_.seed},
            {"sequences", scenario_.sequences},
            {"ticks", scenario_.ticks},
            {"tick_rate_hz", scenario_.tick_rate_hz.str()},
            {"place", place_facts(scenario_.environment)},
            {"georeference", reference_facts(scenario_.scene)},
            {"nodes", Json::object()},
            {"antennas", antennas_of(scenario_)},
            {"channels", Json::object()}};
  for (const sim::NodeConfig& node : scenario_.nodes) {
    json["nodes"][node.name] = Json::object();
    for (const sim::SensorConfig& sensor : node.sensors)
      json["nodes"][node.name][sensor.name] = sim::sensor_kind(sensor).type;
  }
  for (const sim::ChannelConfig& channel : scenario_.channels)
    json["channels"][channel.name] = {{"transmitters", channel.transmitters},
                                      {"receivers", channel.receivers},
                                      {"rate_hz", channel.rate_hz.str()},
                                      {"carrier_hz", channel.carrier_hz},
                                      {"subcarrier_spacing_hz", channel.subcarrier_spacing_hz},
                                      {"subcarriers", channel.subcarriers},
                                      {"time_samples", channel.time_samples},
                                      {"time_spacing_s", channel.time_spacing_s},
                                      {"max_depth", channel.limits.max_depth},
                                      {"max_transmissions", channel.walls()},
                                      {"candidates", channel.candidates}};
  return json.dump();
}

std::string Session::scene_facts() {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const sim::Experiment> now = experiment();
  const scene::Scene& scene = now->scene();
  Json json{{"sha256", scene.hash},
            {"triangles", scene.triangle_count()},
            {"facets", scene.facets.size()},
            {"bodies", scene.bodies.size()},
            {"origin_m", {scene.origin.x, scene.origin.y, scene.origin.z}},
            {"bounds_m", nullptr},
            {"materials", Json::array()},
            {"instances", Json::array()}};
  if (!scene.bounds.empty()) {
    const dvec3 least = dvec3(scene.bounds.min) + scene.origin, most = dvec3(scene.bounds.max) + scene.origin;
    json["bounds_m"] = {{least.x, least.y, least.z}, {most.x, most.y, most.z}};
  }
  for (const scene::Material& material : scene.materials) json["materials"].push_back(material.name);
  for (const scene::Instance& instance : scene.instances)
    json["instances"].push_back(
        {{"name", instance.name}, {"class", scene::name_of(instance.semantic_class)}});
  return json.dump();
}

std::string Session::explain() {
  const std::lock_guard lock(mutex_);
  const std::shared_ptr<const sim::Experiment> now = experiment();
  Json json{{"effects", Json::array()}, {"channels", Json::object()}};
  for (const sim::Effect* effect : now->plan.all())
    json["effects"].push_back({{"name", effect->name},
                               {"on", effect->on},
                               {"switchable", effect->switchable},
                               {"reason", effect->reason},
                               {"bound", effect->bound}});
  for (uint32_t channel = 0; channel < now->scenario.channels.size(); ++channel) {
    Json& notes = json["channels"][now->scenario.channels[channel].name] = Json::object();
    for (const auto& [name, text] : sim::channel_notes(*now, channel)) notes[name] = text;
  }
  return json.dump();
}

std::string Session::device_facts() {
  const std::lock_guard lock(mutex_);
  const gpu::Device& device = gpu()->device;
  const gpu::DeviceInfo& info = device.info();
  return Json{{"name", info.name},
              {"type", info.type},
              {"driver", info.driver},
              {"vulkan", info.api_version},
              {"tracer", gpu::name_of(device.tracer())}}
      .dump();
}

std::shared_ptr<const sim::Experiment> Session::experiment() {
  if (experiment_ == nullptr)
    experiment_ = std::make_shared<const sim::Experiment>(sim::make_experiment(scenario_));
  return experiment_;
}

std::shared_ptr<Gpu> Session::gpu() {
  if (gpu_ == nullptr) gpu_ = std::make_shared<Gpu>(device_options_);
  return gpu_;
}

uint32_t Session::find_channel(const std::string& name) const {
  std::vector<std::string> names;
  for (uint32_t i = 0; i < scenario_.channels.size(); ++i) {
    if (scenario_.channels[i].name == name) return i;
    names.push_back(scenario_.channels[i].name);
  }
  throw_user_error("channel: {}", expected_one_of(names, name));
}

sim::ChannelSnapshot& Session::snapshot(const std::shared_ptr<const sim::Experiment>& experiment,
                                        const std::shared_ptr<Gpu>& gpu, uint32_t channel,
                                        const sim::ChannelSnapshot::Instant& instant,
                                        const std::optional<scene::Bounds>& points) {
  // A snapshot that was solved for points cannot return to the channel's receivers, so both cases have
  // snapshots of their own. The positions of the points may decide which effects are on.
  const std::shared_ptr<const sim::Experiment> with_points =
      points ? std::make_shared<const sim::Experiment>(
                   sim::make_experiment(experiment->scenario, experiment->world, *points))
             : experiment;
  const bool same = kept_ != nullptr && kept_->session == experiment && kept_->channel == channel &&
                    kept_->points == points.has_value() &&
                    sim::same_effects(kept_->experiment->plan, with_points->plan);
  const bool there = same && kept_->sequence == instant.sequence && kept_->tick == instant.tick;
  if (same && !there) {
    kept_->snapshot->move(instant.sequence, instant.tick);
  } else if (!there) {
    kept_.reset();
    auto kept = std::make_unique<Kept>(
        Kept{experiment, gpu, with_points, channel, 0, 0, points.has_value(), nullptr});
    kept->snapshot = std::make_unique<sim::ChannelSnapshot>(gpu->device, *kept->experiment, channel, instant);
    kept_ = std::move(kept);
  }
  kept_->sequence = instant.sequence;
  kept_->tick = instant.tick;
  return *kept_->snapshot;
}

std::shared_ptr<PathSet> Session::solve(const std::string& name, uint32_t sequence, int64_t tick,
                                        const std::optional<PointReceivers>& points, const GoOn& go_on) {
  const std::lock_guard lock(mutex_);
  const uint32_t channel = find_channel(name);
  check_instant(scenario_, sequence, tick);
  const sim::ChannelConfig& config = scenario_.channels[channel];
  std::vector<rf::AntennaArray> arrays;
  dquat orientation{1.0, 0.0, 0.0, 0.0};
  if (points) {
    check_finite(points->points);
    sim::MapReceiver receiver = antenna_at_points(points->antenna, config.carrier_hz);
    arrays.push_back(std::move(receiver.array));
    orientation = receiver.orientation;
  } else {
    if (config.receivers.empty())
      throw_user_error("channel '{}': has no receivers: expected paths(receivers=points)", name);
    for (const std::string& end : config.receivers)
      arrays.push_back(sim::antenna_array(scenario_, end, config.carrier_hz));
  }

  const std::shared_ptr<const sim::Experiment> now = experiment();
  const std::shared_ptr<Gpu> gpu = this->gpu();
  const std::lock_guard device(gpu->mutex);
  auto set = std::make_shared<PathSet>(now, channel, std::move(arrays));
  bool stopped = false;
  size_t links = 0;
  std::map<std::string, uint64_t> before;
  const auto take = [&](sim::ChannelSnapshot::Link link) {
    if (points) link.receiver_state.orientation = orientation;
    set->add(std::move(link));
    stopped = !go_on(++links / set->transmitters());
    return !stopped;
  };
  std::optional<scene::Bounds> extent;
  if (points) {
    extent.emplace();
    for (const dvec3& point : points->points) extent->add(point);
  }
  try {
    sim::ChannelSnapshot& solver = snapshot(now, gpu, channel, {sequence, tick, std::nullopt}, extent);
    solver.count(before);
    if (points)
      solver.solve(points->points, 0, take);
    else
      solver.solve(take);
    if (!stopped) set->finish(solver, before);
    gpu->check_validation();
  } catch (...) {
    kept_.reset();
    throw;
  }
  return stopped ? nullptr : set;
}

std::optional<MapResult> Session::radio_map(const std::string& name, uint32_t sequence, int64_t tick,
                                            const sim::MapRequest& request, const std::string& antenna,
                                            const GoOn& go_on) {
  const std::lock_guard lock(mutex_);
  const uint32_t channel = find_channel(name);
  check_instant(scenario_, sequence, tick);
  const sim::ChannelConfig& config = scenario_.channels[channel];
  sim::check_map_request(request, config);
  sim::MapReceiver receiver = antenna_at_points(antenna, config.carrier_hz);

  const std::shared_ptr<const sim::Experiment> now = experiment();
  const scene::Bounds bounds = sim::map_bounds(request, config, now->scene());
  const std::shared_ptr<Gpu> gpu = this->gpu();
  const std::lock_guard device(gpu->mutex);
  try {
    sim::RadioMapRun run(snapshot(now, gpu, channel, {sequence, tick, std::nullopt}, bounds), request,
                         std::move(receiver));
    std::vector<sim::MapLink> links;
    bool stopped = false;
    run.solve(0, [&](std::span<const sim::MapLink> more) {
      links.insert(links.end(), more.begin(), more.end());
      stopped = !go_on(links.size() / run.transmitters().size());
      return !stopped;
    });
    gpu->check_validation();
    if (stopped) return std::nullopt;
    return map_result(run, links, config);
  } catch (...) {
    kept_.reset();
    throw;
  }
}

std::unique_ptr<Stream> Session::stream(uint32_t sequence, int64_t first_tick) {
  const std::lock_guard lock(mutex_);
  check_instant(scenario_, sequence, first_tick);
  for (const sim::ChannelConfig& channel : scenario_.channels)
    if (channel.receivers.empty())
      throw_user_error("channel '{}': has no receivers: expected some for a run", channel.name);
  const std::shared_ptr<const sim::Experiment> now = experiment();
  const std::shared_ptr<Gpu> gpu = this->gpu();
  const std::lock_guard device(gpu->mutex);
  return std::make_unique<Stream>(now, gpu, sequence, first_tick);
}

}  // namespace greatx::engine
