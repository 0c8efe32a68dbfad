// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses nodes[] and channels[], and the references between them.
#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/text.h"
#include "rf/config/subcarriers.h"
#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/sensor_kinds.h"

namespace greatx::sim {
namespace {

/// Parses `rate_hz` or `rpm`. Its ratio to the tick rate may be any that integers can hold.
TurnRate parse_turn_rate(const FieldMap& map, const Rational& tick_rate_hz) {
  map.exclude("rate_hz", "rpm");
  const bool per_minute = map.has("rpm");
  const Field field = per_minute ? *map.find("rpm") : map.require("rate_hz", "turns a second (or 'rpm')");
  TurnRate rate = turn_rate_of(field, "a rate other than 0 such as 90, -87.5 or 1000/7");
  const auto hz = per_minute ? quotient(rate.hz, {60, 1}) : rate.hz;
  if (!hz || !quotient(*hz, tick_rate_hz))
    field.fail(
        fmt::format("a rate whose ratio to the tick rate, {} Hz, fits 64-bit integers", tick_rate_hz.str()));
  return {*hz, rate.negative};
}

constexpr double least_radius_m = 0.01, most_radius_m = 1000.0;

/// Parses `roll`: the turn of a wheel.
RollConfig parse_roll(const Field& field) {
  const FieldMap map(field, {"radius_m"});
  RollConfig roll;
  roll.radius_m = map.require("radius_m", "the radius of the wheel").between(least_radius_m, most_radius_m);
  return roll;
}

/// Parses `gait`: the swing of a limb.
LimbConfig parse_limb(const Field& field) {
  const FieldMap map(field, {"limb", "side", "thigh_m", "shank_m", "speed_mps"});
  LimbConfig limb;
  limb.limb =
      static_cast<Limb>(map.require("limb", "a limb").choice({"thigh", "shank", "upper_arm", "forearm"}));
  limb.left = map.require("side", "left or right").choice({"left", "right"}) == 0;
  if (const auto f = map.find("thigh_m")) limb.walker.thigh_m = f->between(0.05, 5.0);
  if (const auto f = map.find("shank_m")) limb.walker.shank_m = f->between(0.05, 5.0);
  const double ratio = limb.walker.shank_m / limb.walker.thigh_m;
  if (ratio < 0.5 || ratio > 2.0)
    field.fail("a thigh and a shank of which neither is more than twice as long as the other",
               fmt::format("{} m and {} m", limb.walker.thigh_m, limb.walker.shank_m));
  if (const auto f = map.find("speed_mps")) limb.walker.speed_mps = f->between(0.1, 5.0);
  return limb;
}

PartMotion parse_part_motion(const FieldMap& map, const Rational& tick_rate_hz) {
  for (const char* key : {"rate_hz", "rpm"}) {
    map.exclude("roll", key);
    map.exclude("gait", key);
  }
  map.exclude("roll", "gait");
  if (const auto f = map.find("roll")) return parse_roll(*f);
  if (const auto f = map.find("gait")) return parse_limb(*f);
  return parse_turn_rate(map, tick_rate_hz);
}

PartConfig parse_part(const Field& field, const Rational& tick_rate_hz) {
  const FieldMap map(field, {"nodes", "axis", "rate_hz", "rpm", "roll", "gait", "phase_deg"});
  PartConfig part;
  part.where = field.where();
  const Field nodes = map.require("nodes", "the name of a node of the model, or a list of such");
  if (nodes.is_list())
    for (const Field& item : nodes.list("names", 1)) part.nodes.push_back(item.text());
  else
    part.nodes.push_back(nodes.text());
  if (const auto f = map.find("axis")) {
    constexpr double least = 1e-6, most = 1e6;
    part.axis = f->vector3(most);
    if (part.axis == dvec3(0.0)) f->fail("an axis other than [0, 0, 0]");
    if (glm::length(part.axis) < least) f->fail(fmt::format("an axis of a length of {:g} or more", least));
  }
  part.motion = parse_part_motion(map, tick_rate_hz);
  // Wheels and limbs turn about an axis to the left if none is given.
  if (!std::holds_alternative<TurnRate>(part.motion) && !map.has("axis")) part.axis = {0.0, 1.0, 0.0};
  if (const auto f = map.find("phase_deg")) part.phase = radians(f->number(most_angle_deg));
  return part;
}

/// Returns a name that becomes a folder in each sequence of a data set, beside the files that are there
/// already (docs/dataset.md).
std::string folder_name(const Field& field) {
  for (const char* taken : {"poses", "index.csv", "index.npy", "index.csv.part", "index.npy.part"})
    if (field.name() == taken)
      field.fail("a name that no file or folder of a sequence has", fmt::format("'{}'", taken));
  return field.name();
}

NodeConfig parse_node(const Field& field, size_t index, const Rational& tick_rate_hz,
                      const EarthPositions& earth, std::vector<NodeReference>& references,
                      PatternFiles& patterns) {
  const FieldMap map(field, {"name", "trajectory", "model", "class", "sensors"});
  NodeConfig node;
  node.where = field.where();
  const Field name = map.require("name", "a name");
  node.name = folder_name(name);
  if (node.name == "static") name.fail("a name other than 'static', which is the world that never moves");
  node.trajectory = parse_trajectory(map.require("trajectory", "a trajectory"), index, earth, references);
  if (const auto f = map.find("model")) {
    const FieldMap model(*f, {"file", "generate", "position_m", "rotation_deg", "scale", "parts"});
    node.model = parse_model_source(model);
    if (const auto g = model.find("position_m")) node.model_mount.position_m = position_of(*g);
    if (const auto g = model.find("rotation_deg")) node.model_mount.rotation = angles_of(*g);
    if (const auto g = model.find("scale")) node.model_scale = parse_scale(*g);
    if (const auto g = model.find("parts"))
      for (const Field& item : g->list("parts")) node.parts.push_back(parse_part(item, tick_rate_hz));
  }
  if (const auto f = map.find("class")) {
    node.semantic_class = parse_semantic_class(*f);
    if (!node.model) f->fail("a 'model' beside 'class'", "none");
  }
  if (const auto sensors = map.find("sensors")) {
    std::set<std::string> names;
    for (const Field& item : sensors->list("sensors")) {
      node.sensors.push_back(parse_sensor(item, tick_rate_hz, patterns));
      const std::string& sensor = node.sensors.back().name;
      if (!names.insert(sensor).second)
        item.fail("every sensor's name once", fmt::format("a second '{}'", sensor));
    }
  }
  return node;
}

std::vector<std::string> names_of(const std::vector<NodeConfig>& nodes) {
  std::vector<std::string> names;
  for (const NodeConfig& node : nodes) names.push_back(node.name);
  return names;
}

/// Checks that every reference names another node, and that none leads back to its start.
void check_references(const std::vector<NodeReference>& references, const std::vector<NodeConfig>& nodes) {
  const std::vector<std::string> names = names_of(nodes);
  std::vector<size_t> target(nodes.size(), nodes.size());
  for (const NodeReference& reference : references) {
    const std::string name = reference.field.text();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end())
      reference.field.fail("a node's name", fmt::format("unknown '{}'{}", name, suggestion(name, names)));
    target[reference.node] = static_cast<size_t>(found - names.begin());
  }
  for (const NodeReference& reference : references) {
    std::string chain = names[reference.node];
    size_t node = reference.node;
    for (size_t steps = 0; steps < nodes.size() && target[node] < nodes.size(); ++steps) {
      node = target[node];
      chain += " -> " + names[node];
      if (node == reference.node)
        reference.field.fail("a node whose path does not depend on this one", chain);
    }
  }
}

/// Returns the name, "node/sensor", of an antenna.
std::string parse_antenna_name(const Field& field, const std::vector<NodeConfig>& nodes) {
  const std::string name = field.text();
  const std::string expected = "an antenna as node/sensor";
  const std::optional<SensorPlace> place = find_sensor(nodes, name);
  if (!place) {
    std::vector<std::string> antennas;
    for (const NodeConfig& node : nodes)
      for (const SensorConfig& candidate : node.sensors)
        if (std::holds_alternative<AntennaConfig>(candidate.config))
          antennas.push_back(node.name + "/" + candidate.name);
    field.fail(expected, fmt::format("unknown '{}'{}", name, suggestion(name, antennas)));
  }
  const SensorConfig& sensor = nodes[place->node].sensors[place->sensor];
  if (!std::holds_alternative<AntennaConfig>(sensor.config))
    field.fail(expected, fmt::format("'{}', {}", name, with_article(sensor_kind(sensor))));
  return name;
}

/// Parses one antenna, or a list of antennas, each once.
std::vector<std::string> parse_antenna_names(const Field& field, const std::vector<NodeConfig>& nodes) {
  if (field.is_scalar()) return {parse_antenna_name(field, nodes)};
  std::vector<std::string> names;
  for (const Field& item : field.list("antennas", 1)) {
    names.push_back(parse_antenna_name(item, nodes));
    if (std::find(names.begin(), names.end() - 1, names.back()) != names.end() - 1)
      item.fail("every antenna once", fmt::format("a second '{}'", names.back()));
  }
  return names;
}

/// Parses the band from carrier, subcarriers, spacing and bandwidth: spacing x subcarriers = bandwidth, and
/// any two of the three are enough.
void parse_band(const FieldMap& map, ChannelConfig& channel) {
  if (const auto f = map.find("carrier_hz"))
    channel.carrier_hz = f->positive(least_carrier_hz, most_carrier_hz);
  const auto count = map.find("subcarriers"), spacing = map.find("subcarrier_spacing_hz"),
             bandwidth = map.find("bandwidth_hz");
  constexpr uint32_t most = 1u << 20;
  if (count) channel.subcarriers = count->integer32(1, most);
  if (spacing) channel.subcarrier_spacing_hz = spacing->positive(1e-3, most_carrier_hz);
  if (bandwidth) {
    const double band_hz = bandwidth->positive(1e-3, most_carrier_hz);
    if (spacing && count)
      bandwidth->fail("two of bandwidth_hz, subcarrier_spacing_hz and subcarriers", "all three");
    if (spacing) {
      if (band_hz < channel.subcarrier_spacing_hz)
        bandwidth->fail(fmt::format("at least one subcarrier, {} Hz", channel.subcarrier_spacing_hz));
      if (band_hz / channel.subcarrier_spacing_hz >= most + 1.0)
        bandwidth->fail(fmt::format("at most {} subcarriers", most));
      channel.subcarriers = rf::subcarrier_count(band_hz, channel.subcarrier_spacing_hz);
    } else {
      channel.subcarrier_spacing_hz = band_hz / channel.subcarriers;
    }
  }
  const double lowest_hz = channel.carrier_hz - (channel.subcarriers / 2) * channel.subcarrier_spacing_hz;
  if (!(lowest_hz > 0.0))
    map.field().fail("every subcarrier above 0 Hz", fmt::format("the lowest at {} Hz", lowest_hz));
}

/// Parses the outputs of the channel; its band is known.
void parse_outputs(const FieldMap& map, ChannelConfig& channel) {
  if (const auto f = map.find("outputs")) {
    channel.outputs = {false, false, false, false};
    bool* const outputs[] = {&channel.outputs.cfr, &channel.outputs.paths, &channel.outputs.cfr_parts,
                             &channel.outputs.coherence};
    for (const Field& item : f->list("outputs")) {
      bool& output = *outputs[item.choice({"cfr", "paths", "cfr_parts", "coherence"})];
      if (output) item.fail("every output once", fmt::format("a second '{}'", item.text()));
      output = true;
    }
  }
  if (const auto f = map.find("taps")) {
    const FieldMap of(*f, {"count", "first", "bandwidth_hz"});
    ChannelConfig::Taps taps;
    taps.bandwidth_hz = channel.subcarriers * channel.subcarrier_spacing_hz;
    if (const auto g = of.find("count")) taps.count = g->integer32(1, 1u << 20);
    if (const auto g = of.find("first")) {
      const double first = g->between(-1e6, 1e6);
      if (first != std::floor(first)) g->fail("an integer from -1000000 to 1000000");
      taps.first = static_cast<int32_t>(first);
    }
    if (const auto g = of.find("bandwidth_hz")) taps.bandwidth_hz = g->between(1e-3, 1e12);
    channel.taps = taps;
  }
  if (const auto f = map.find("power_dbm")) channel.power_dbm = f->between(-200.0, 200.0);
  if (const auto f = map.find("resistance_ohm")) {
    channel.resistance_ohm = f->positive(1e-6, 1e12);
    if (!channel.power_dbm) f->fail("a 'power_dbm' beside it", "none");
  }
}

ChannelConfig parse_channel(const Field& field, const Rational& tick_rate_hz,
                            const std::vector<NodeConfig>& nodes, RcsFiles& tables) {
  const FieldMap map(field, {"name",
                             "tx",
                             "rx",
                             "rate_hz",
                             "carrier_hz",
                             "subcarrier_spacing_hz",
                             "bandwidth_hz",
                             "subcarriers",
                             "time_samples",
                             "time_spacing_s",
                             "max_depth",
                             "max_transmissions",
                             "max_diffractions",
                             "two_edge_floor_db",
                             "corner_step_db",
                             "max_reflections_beside_diffraction",
                             "max_reflections_after",
                             "max_reflections_before_scattering",
                             "scattering_patch_m",
                             "scattering_budget",
                             "max_scatterings",
                             "scattering_beside_diffraction",
                             "max_paths",
                             "candidates",
                             "rays",
                             "search",
                             "outputs",
                             "taps",
                             "power_dbm",
                             "resistance_ohm",
                             "targets",
                             "legs",
                             "sensing"});
  ChannelConfig channel;
  channel.where = field.where();
  channel.name = folder_name(map.require("name", "a name"));
  channel.transmitters =
      parse_antenna_names(map.require("tx", "an antenna as node/sensor, or a list"), nodes);
  channel.receivers = parse_antenna_names(map.require("rx", "a list of antennas"), nodes);
  channel.rate_hz =
      rate_of(map.require("rate_hz", "a rate greater than 0 such as 10, 29.97 or 30000/1001"), tick_rate_hz);
  parse_band(map, channel);
  parse_outputs(map, channel);
  if (const auto f = map.find("time_samples")) channel.time_samples = f->integer32(1, 1u << 20);
  if (const auto f = map.find("time_spacing_s")) channel.time_spacing_s = f->positive(1e-12, 1e6);
  if (const auto f = map.find("max_depth")) channel.limits.max_depth = f->integer32(0, 16);
  if (const auto f = map.find("max_transmissions"))
    channel.limits.max_transmissions = f->integer32(0, ChannelConfig::most_walls);
  if (const auto f = map.find("max_diffractions")) channel.limits.max_diffractions = f->integer32(1, 2);
  if (const auto f = map.find("two_edge_floor_db"))
    channel.limits.two_edge_floor_db = f->positive(1.0, 1000.0);
  if (const auto f = map.find("corner_step_db")) channel.limits.corner_step_db = f->positive(0.01, 6.0);
  if (const auto f = map.find("max_reflections_beside_diffraction"))
    channel.limits.max_reflections_beside_diffraction = f->integer32(0, 4);
  if (const auto f = map.find("max_reflections_after"))
    channel.limits.max_reflections_after = f->integer32(0, 8);
  if (const auto f = map.find("max_reflections_before_scattering"))
    channel.limits.max_reflections_before_scattering = f->integer32(0, 16);
  if (const auto f = map.find("scattering_patch_m")) channel.limits.patch_m = f->positive(1e-3, 1e8);
  if (const auto f = map.find("scattering_budget"))
    channel.limits.scattering_budget = f->integer32(0, 1u << 30);
  const bool drawn = channel.limits.scattering_budget > 0;
  if (const auto f = map.find("max_scatterings")) {
    channel.limits.max_scatterings = f->integer32(1, 2);
    if (channel.limits.max_scatterings > 1 && !drawn) f->fail("1 with scattering_budget: 0", "2");
  }
  if (const auto f = map.find("scattering_beside_diffraction")) {
    channel.limits.scattering_beside_diffraction = f->boolean();
    if (channel.limits.scattering_beside_diffraction && !drawn)
      f->fail("false with scattering_budget: 0", "true");
  }
  if (const auto f = map.find("max_paths")) channel.limits.max_paths = f->integer32(1, 1u << 30);
  if (const auto f = map.find("candidates"))
    channel.candidates = std::array{ChannelConfig::Candidates::beams,
                                    ChannelConfig::Candidates::rays}[f->choice({"beams", "rays"})];
  if (const auto f = map.find("rays")) {
    channel.rays = f->integer32(1, 1u << 28);
    if (map.find("candidates") && channel.candidates != ChannelConfig::Candidates::rays)
      f->fail("no rays with candidates: beams", "both");
    channel.candidates = ChannelConfig::Candidates::rays;
  }
  if (const auto f = map.find("search"))
    channel.search = std::array{ChannelConfig::Search::automatic, ChannelConfig::Search::once,
                                ChannelConfig::Search::every_tick}[f->choice({"auto", "once", "every_tick"})];
  parse_targets(map, nodes, tables, channel);
  parse_sensing(map, channel);
  return channel;
}

}  // namespace

Rational rate_of(const Field& field, const Rational& tick_rate_hz) {
  const Rational rate = rational_of(field, "a rate greater than 0 such as 10, 29.97 or 30000/1001");
  if (less(tick_rate_hz, rate)) field.fail(fmt::format("at most the tick rate, {} Hz", tick_rate_hz.str()));
  if (!quotient(tick_rate_hz, rate))
    field.fail(
        fmt::format("a rate whose ratio to the tick rate, {} Hz, fits 64-bit integers", tick_rate_hz.str()));
  return rate;
}

std::vector<NodeConfig> parse_nodes(const Field& field, const Rational& tick_rate_hz,
                                    const EarthPositions& earth, const std::vector<NodeConfig>& traffic) {
  std::vector<NodeConfig> nodes;
  std::vector<NodeReference> references;
  PatternFiles patterns;
  std::set<std::string> names;
  for (const Field& item : field.list("nodes")) {
    nodes.push_back(parse_node(item, nodes.size(), tick_rate_hz, earth, references, patterns));
    if (!names.insert(nodes.back().name).second)
      item.fail("every node's name once", fmt::format("a second '{}'", nodes.back().name));
    if (std::ranges::any_of(traffic, [&](const NodeConfig& node) { return node.name == nodes.back().name; }))
      item.fail("a name that nothing of the traffic has", fmt::format("'{}'", nodes.back().name));
  }
  nodes.insert(nodes.end(), traffic.begin(), traffic.end());
  check_references(references, nodes);
  resolve_illuminators(nodes);
  resolve_interferers(nodes);
  resolve_event_cameras(nodes);
  return nodes;
}

std::vector<ChannelConfig> parse_channels(const Field& field, const Rational& tick_rate_hz,
                                          const std::vector<NodeConfig>& nodes) {
  std::vector<ChannelConfig> channels;
  RcsFiles tables;
  for (const Field& item : field.list("channels")) {
    channels.push_back(parse_channel(item, tick_rate_hz, nodes, tables));
    const std::string name = channels.back().name;
    for (size_t i = 0; i + 1 < channels.size(); ++i)
      if (channels[i].name == name)
        item.fail("every channel's name once", fmt::format("a second '{}'", name));
  }
  return channels;
}

}  // namespace greatx::sim
