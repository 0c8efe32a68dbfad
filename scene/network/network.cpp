// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/network/network.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/budget.h"
#include "io/files/untrusted_json.h"

namespace greatx::scene {
namespace {

using Json = nlohmann::ordered_json;

constexpr double most_m = 1e7, most_width_m = 100.0, most_speed_mps = 150.0, most_phase_s = 1000.0;
constexpr size_t most_items = size_t{1} << 20, most_points = size_t{1} << 16, most_next = 64;
constexpr uint32_t most_groups = 16;
/// Between the end of a lane and the start of the one that continues it.
constexpr double most_gap_m = 0.25;

double rounded(double value) { return std::round(value * 1e4) / 1e4 + 0.0; }
Json json_of(const dvec3& point) { return {rounded(point.x), rounded(point.y), rounded(point.z)}; }
Json json_of(const std::vector<dvec3>& line) {
  Json json = Json::array();
  for (const dvec3& point : line) json.push_back(json_of(point));
  return json;
}

Json json_of(const StreetLane& lane) {
  Json json;
  if (lane.turn()) {
    json["turn"] = true;
    json["junction"] = *lane.junction;
    json["group"] = lane.group;
  }
  json["line"] = json_of(lane.line);
  json["width_m"] = rounded(lane.width_m);
  json["speed_mps"] = rounded(lane.speed_mps);
  json["next"] = lane.next;
  if (lane.left) json["left"] = *lane.left;
  if (lane.right) json["right"] = *lane.right;
  if (lane.stop_m > 0.0) json["stop_m"] = rounded(lane.stop_m);
  return json;
}

Json json_of(const StreetJunction& junction) {
  Json phases = Json::array();
  for (const StreetPhase& phase : junction.phases)
    phases.push_back({{"groups", phase.groups},
                      {"green_s", phase.green_s},
                      {"amber_s", phase.amber_s},
                      {"clear_s", phase.clear_s}});
  Json json = Json::object();
  json["phases"] = std::move(phases);
  return json;
}

Json json_of(const StreetCrossing& crossing) {
  Json json{{"from", json_of(crossing.from)},
            {"to", json_of(crossing.to)},
            {"width_m", rounded(crossing.width_m)},
            {"walks", {crossing.walks[0], crossing.walks[1]}}};
  if (crossing.junction) {
    json["junction"] = *crossing.junction;
    json["group"] = crossing.group;
  }
  return json;
}

Json json_of(const StreetSignal& signal) {
  Json json{{"node", signal.node}, {"junction", signal.junction}, {"group", signal.group}};
  if (signal.walk) json["walk"] = true;
  return json;
}

bool has_green(const StreetPhase& phase, uint32_t group) {
  return std::ranges::find(phase.groups, group) != phase.groups.end();
}

/// Checks that an object has no other members than these.
void check_members(const io::JsonValue& value, std::initializer_list<std::string_view> names) {
  if (!value.is_object()) value.fail("an object");
  for (const auto& [name, member] : value.json().items())
    if (std::ranges::find(names, name) == names.end())
      value.at(name).fail("nothing: there is no such member");
}

dvec3 point_of(const io::JsonValue& value) {
  const auto items = value.tuple(3);
  return {items[0].number(-most_m, most_m), items[1].number(-most_m, most_m),
          items[2].number(-most_m, most_m)};
}

std::vector<dvec3> line_of(const io::JsonValue& value, size_t least) {
  std::vector<dvec3> line;
  for (const io::JsonValue& item : value.list(most_points)) {
    line.push_back(point_of(item));
    if (line.size() > 1 && glm::distance(line[line.size() - 2], line.back()) < 1e-3)
      item.fail("a point 1 mm or more from the one before");
  }
  if (line.size() < least) value.fail(least == 2 ? "two points or more" : "three points or more");
  return line;
}

uint32_t index_of(const io::JsonValue& value, size_t count) {
  return static_cast<uint32_t>(value.integer(0, static_cast<int64_t>(count) - 1));
}

std::optional<uint32_t> find_index(const io::JsonValue& value, const char* name, size_t count) {
  return value.has(name) ? std::optional(index_of(value.at(name), count)) : std::nullopt;
}

StreetLane read_lane(const io::JsonValue& value, size_t lanes, size_t junctions) {
  check_members(value, {"turn", "junction", "group", "line", "width_m", "speed_mps", "next", "left", "right",
                        "stop_m"});
  StreetLane lane;
  lane.line = line_of(value.at("line"), 2);
  lane.width_m = value.at("width_m").number(0.5, most_width_m);
  lane.speed_mps = value.at("speed_mps").number(0.1, most_speed_mps);
  for (const io::JsonValue& next : value.at("next").list(most_next))
    lane.next.push_back(index_of(next, lanes));
  lane.left = find_index(value, "left", lanes);
  lane.right = find_index(value, "right", lanes);
  if (value.has("stop_m")) lane.stop_m = value.at("stop_m").number(0.0, 100.0);
  const bool turn = value.has("turn") && value.at("turn").boolean();
  if (turn) {
    lane.junction = index_of(value.at("junction"), junctions);
    if (value.has("group")) lane.group = index_of(value.at("group"), most_groups);
  } else if (value.has("junction")) {
    value.at("junction").fail("\"turn\": true beside it");
  }
  return lane;
}

StreetJunction read_junction(const io::JsonValue& value) {
  check_members(value, {"phases"});
  StreetJunction junction;
  if (!value.has("phases")) return junction;
  for (const io::JsonValue& item : value.at("phases").list(most_groups)) {
    check_members(item, {"groups", "green_s", "amber_s", "clear_s"});
    StreetPhase phase;
    for (const io::JsonValue& group : item.at("groups").list(most_groups))
      phase.groups.push_back(index_of(group, most_groups));
    phase.green_s = item.at("green_s").number(1.0, most_phase_s);
    phase.amber_s = item.at("amber_s").number(0.0, most_phase_s);
    phase.clear_s = item.at("clear_s").number(0.0, most_phase_s);
    junction.phases.push_back(std::move(phase));
  }
  return junction;
}

StreetCrossing read_crossing(const io::JsonValue& value, size_t walks, size_t junctions) {
  check_members(value, {"from", "to", "width_m", "walks", "junction", "group"});
  StreetCrossing crossing;
  crossing.from = point_of(value.at("from"));
  crossing.to = point_of(value.at("to"));
  if (glm::distance(crossing.from, crossing.to) < 1.0) value.at("to").fail("a point 1 m or more from 'from'");
  crossing.width_m = value.at("width_m").number(1.0, most_width_m);
  const auto ends = value.at("walks").tuple(2);
  for (size_t end = 0; end < 2; ++end) crossing.walks[end] = index_of(ends[end], walks);
  crossing.junction = find_index(value, "junction", junctions);
  if (value.has("group")) crossing.group = index_of(value.at("group"), most_groups);
  return crossing;
}

StreetSignal read_signal(const io::JsonValue& value, size_t junctions) {
  check_members(value, {"node", "junction", "group", "walk"});
  StreetSignal signal;
  signal.node = value.at("node").text();
  signal.junction = index_of(value.at("junction"), junctions);
  signal.group = index_of(value.at("group"), most_groups);
  signal.walk = value.has("walk") && value.at("walk").boolean();
  return signal;
}

/// Checks that lanes follow each other, and that turns lead from lanes to lanes.
void check_lanes(const io::JsonValue& lanes, const StreetNetwork& network) {
  const std::vector<io::JsonValue> values = lanes.list(most_items);
  for (size_t i = 0; i < network.lanes.size(); ++i) {
    const StreetLane& lane = network.lanes[i];
    const std::vector<io::JsonValue> next = values[i].at("next").list(most_next);
    for (size_t k = 0; k < lane.next.size(); ++k) {
      const StreetLane& other = network.lanes[lane.next[k]];
      if (glm::distance(lane.line.back(), other.line.front()) > most_gap_m)
        next[k].fail("a lane that begins where this one ends (within 0.25 m)");
      if (lane.turn() && other.turn()) next[k].fail("a lane of a street after a turn");
    }
    if (lane.turn() && lane.next.size() != 1) values[i].at("next").fail("one lane after a turn");
  }
}

StreetNetwork read(const io::JsonValue& value) {
  check_members(value, {"lanes", "junctions", "walks", "crossings", "signals"});
  const auto items = [&](const char* name) {
    return value.has(name) ? value.at(name).list(most_items) : std::vector<io::JsonValue>();
  };
  const auto lanes = items("lanes"), junctions = items("junctions"), walks = items("walks"),
             crossings = items("crossings"), signals = items("signals");
  StreetNetwork network;
  for (const io::JsonValue& item : lanes)
    network.lanes.push_back(read_lane(item, lanes.size(), junctions.size()));
  for (const io::JsonValue& item : junctions) network.junctions.push_back(read_junction(item));
  for (const io::JsonValue& item : walks) {
    check_members(item, {"line"});
    network.walks.push_back({line_of(item.at("line"), 3)});
  }
  for (const io::JsonValue& item : crossings)
    network.crossings.push_back(read_crossing(item, walks.size(), junctions.size()));
  for (const io::JsonValue& item : signals) network.signals.push_back(read_signal(item, junctions.size()));
  if (!lanes.empty()) check_lanes(value.at("lanes"), network);
  return network;
}

}  // namespace

PhaseNow phase_of(const StreetJunction& junction, double time_s) {
  const std::vector<StreetPhase>& phases = junction.phases;
  double cycle = 0.0;
  for (const StreetPhase& phase : phases) cycle += phase.green_s + phase.amber_s + phase.clear_s;
  double at = std::fmod(time_s, cycle);
  if (at < 0.0) at += cycle;
  for (size_t i = 0;; ++i) {
    const double length = phases[i].green_s + phases[i].amber_s + phases[i].clear_s;
    if (at < length || i + 1 == phases.size()) return {i, at};
    at -= length;
  }
}

Light light_of(const StreetJunction& junction, uint32_t group, double time_s) {
  if (junction.phases.empty()) return Light::green;
  const PhaseNow now = phase_of(junction, time_s);
  const StreetPhase& phase = junction.phases[now.index];
  if (!has_green(phase, group)) return Light::red;
  if (now.since_s < phase.green_s) return Light::green;
  return now.since_s < phase.green_s + phase.amber_s ? Light::amber : Light::red;
}

Light walk_light_of(const StreetJunction& junction, uint32_t group, double time_s) {
  if (junction.phases.empty()) return Light::green;
  const PhaseNow now = phase_of(junction, time_s);
  const StreetPhase& phase = junction.phases[now.index];
  return has_green(phase, group) || now.since_s > phase.green_s ? Light::red : Light::green;
}

std::string street_network_json(const StreetNetwork& network) {
  Json json;
  const auto list = [&](const char* name, const auto& items) {
    json[name] = Json::array();
    for (const auto& item : items) json[name].push_back(json_of(item));
  };
  list("lanes", network.lanes);
  list("junctions", network.junctions);
  json["walks"] = Json::array();
  for (const StreetWalk& walk : network.walks) json["walks"].push_back({{"line", json_of(walk.line)}});
  list("crossings", network.crossings);
  if (!network.signals.empty()) list("signals", network.signals);
  return json.dump();
}

std::optional<StreetNetwork> street_network_of_document(std::string json, const SourceLocation& where) {
  if (json.find(street_network_key) == std::string::npos) return std::nullopt;
  constexpr int most_depth = 128;  // as the loader's
  const io::JsonDocument document(std::move(json), where,
                                  {budget::model_json.most, budget::model_json.most, most_depth});
  const io::JsonValue root = document.root();
  if (!root.has("scenes")) return std::nullopt;
  const std::vector<io::JsonValue> scenes = root.at("scenes").list(most_items);
  const int64_t chosen = root.has("scene") ? root.at("scene").integer(0, most_items) : 0;
  if (chosen >= static_cast<int64_t>(scenes.size())) return std::nullopt;  // the loader refuses it
  const io::JsonValue& scene = scenes[static_cast<size_t>(chosen)];
  if (!scene.has("extras") || !scene.at("extras").has(street_network_key)) return std::nullopt;
  return read(scene.at("extras").at(street_network_key));
}

StreetNetwork placed(StreetNetwork network, const Pose& pose) {
  for (StreetLane& lane : network.lanes)
    for (dvec3& point : lane.line) point = pose.apply(point);
  for (StreetWalk& walk : network.walks)
    for (dvec3& point : walk.line) point = pose.apply(point);
  for (StreetCrossing& crossing : network.crossings) {
    crossing.from = pose.apply(crossing.from);
    crossing.to = pose.apply(crossing.to);
  }
  return network;
}

}  // namespace greatx::scene
