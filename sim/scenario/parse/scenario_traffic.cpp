// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses `traffic`, and makes a node of everyone who takes part.
#include <algorithm>
#include <limits>
#include <set>

#include "core/expected.h"
#include "core/random.h"
#include "core/text.h"
#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/parse/traffic_fcd.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_members = 5000;
constexpr uint32_t mix_stream = 0x6d697874;  // apart from the streams of nodes' names
constexpr uint32_t looks = 12;               // of each variant

using Kind = TrafficMember::Kind;

/// Parses the shares of variants: {saloon: 3, van: 1}.
std::vector<std::pair<std::string, double>> parse_mix(const Field& field) {
  std::vector<std::string> names;
  for (const TrafficVariant& variant : traffic_variants()) names.emplace_back(variant.name);
  std::vector<std::pair<std::string, double>> mix;
  for (const auto& [name, value] : field.entries()) {
    if (std::ranges::find(names, name) == names.end()) value.refuse(expected_one_of(names, name));
    mix.emplace_back(name, value.non_negative(1e6));
  }
  return mix;
}

/// Returns the shares of the variants of one kind: those of the mix if it names one of them, else those of
/// the variants that are not longer than most_m.
std::vector<std::pair<std::string, double>> shares_of(Kind kind,
                                                      const std::vector<std::pair<std::string, double>>& mix,
                                                      double most_m) {
  std::vector<std::pair<std::string, double>> shares, standard;
  double sum = 0.0;
  for (const TrafficVariant& variant : traffic_variants()) {
    if (variant.kind != kind) continue;
    if (variant.length_m <= most_m) standard.emplace_back(variant.name, variant.share);
    for (const auto& [name, share] : mix)
      if (name == variant.name) {
        shares.emplace_back(name, share);
        sum += share;
      }
  }
  return sum > 0.0 ? shares : standard;
}

std::string drawn(const std::vector<std::pair<std::string, double>>& shares, RandomStream& random) {
  double sum = 0.0;
  for (const auto& [name, share] : shares) sum += share;
  double at = random.uniform() * sum;
  for (const auto& [name, share] : shares) {
    if (at < share) return name;
    at -= share;
  }
  return shares.back().first;
}

NodeConfig node_of(const std::string& name, Kind kind, const std::string& variant, uint64_t look,
                   const SourceLocation& where, Trajectory trajectory) {
  NodeConfig node;
  node.name = name;
  node.trajectory = std::move(trajectory);
  node.model = ModelSource{Generated{generator_kind(kind), look, 300.0, variant}, where};
  node.where = where;
  return node;
}

std::vector<NodeConfig> simulated(const FieldMap& map, bool wide_streets, TrafficConfig& traffic) {
  std::vector<NodeConfig> nodes;
  const auto mix =
      map.has("mix") ? parse_mix(*map.find("mix")) : std::vector<std::pair<std::string, double>>();
  RandomStream random(traffic.seed, mix_stream);
  const auto add = [&](const char* key, const char* name, Kind kind) {
    const auto field = map.find(key);
    if (!field) return;
    const uint32_t count = field->integer32(0, most_members);
    const auto shares =
        shares_of(kind, mix, wide_streets ? std::numeric_limits<double>::infinity() : longer_than_m);
    for (uint32_t i = 0; i < count; ++i) {
      const auto number = static_cast<uint32_t>(traffic.members.size());
      traffic.members.push_back({kind, drawn(shares, random), number});
      const uint64_t look = 1 + random.below(looks);
      nodes.push_back(node_of(fmt::format("{}_{:03}", name, i), kind, traffic.members.back().variant, look,
                              traffic.where, TrafficTrajectory{number}));
    }
  };
  add("vehicles", "vehicle", Kind::vehicle);
  add("cyclists", "cyclist", Kind::cyclist);
  add("pedestrians", "pedestrian", Kind::pedestrian);
  return nodes;
}

/// Returns a name that may be a folder's.
std::string track_name(const std::string& prefix, const std::string& id, std::set<std::string>& names) {
  std::string name = prefix + "_";
  for (const char c : id) {
    const bool plain =
        (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '.';
    name += plain ? c : '_';
  }
  const std::string wanted = name;
  for (int number = 2; !names.insert(name).second;) name = fmt::format("{}_{}", wanted, number++);
  return name;
}

std::vector<NodeConfig> recorded(const FieldMap& map, TrafficConfig& traffic) {
  TrackOptions options;
  if (const auto f = map.find("offset_m")) options.offset_m = position_of(*f);
  if (const auto f = map.find("start_s")) options.start_s = f->number(most_time_s);
  if (const auto f = map.find("types")) {
    std::vector<std::string> names;
    for (const TrafficVariant& variant : traffic_variants()) names.emplace_back(variant.name);
    for (const auto& [type, value] : f->entries()) {
      const std::string variant = value.text();
      if (std::ranges::find(names, variant) == names.end()) value.refuse(expected_one_of(names, variant));
      options.types[type] = variant;
    }
  }
  const bool fcd = map.has("fcd");
  const Field file = *map.find(fcd ? "fcd" : "xosc");
  const std::string text = read_csv_file(file.file(), fcd ? "floating-car data" : "an OpenSCENARIO file");
  const std::string name = file.file().string();
  std::vector<NodeConfig> nodes;
  std::set<std::string> names;
  RandomStream random(traffic.seed, mix_stream);
  for (RecordedTrack& track : fcd ? parse_fcd(text, name, options) : parse_xosc(text, name, options)) {
    const char* prefix = track.kind == Kind::vehicle   ? "vehicle"
                         : track.kind == Kind::cyclist ? "cyclist"
                                                       : "pedestrian";
    const uint64_t look = 1 + random.below(looks);
    auto stretches = std::make_shared<const std::vector<WayPointTrajectory>>(std::move(track.stretches));
    nodes.push_back(node_of(track_name(prefix, track.id, names), track.kind, track.variant, look, track.where,
                            TrackTrajectory{std::move(stretches)}));
    if (nodes.size() > most_members) file.fail(fmt::format("at most {} vehicles and people", most_members));
  }
  return nodes;
}

}  // namespace

std::vector<NodeConfig> parse_traffic(const Field& field, uint64_t seed, bool wide_streets,
                                      TrafficConfig& traffic) {
  const FieldMap map(field, {"vehicles", "cyclists", "pedestrians", "seed", "warm_up_s", "limbs", "mix",
                             "fcd", "xosc", "offset_m", "start_s", "types"});
  traffic.where = field.where();
  traffic.seed = seed;
  if (const auto f = map.find("seed")) traffic.seed = f->integer(0);
  if (const auto f = map.find("warm_up_s")) traffic.warm_up_s = f->between(0.0, 3600.0);
  if (const auto f = map.find("limbs")) traffic.limbs = f->boolean();
  map.exclude("fcd", "xosc");
  for (const char* file : {"fcd", "xosc"})
    for (const char* key : {"vehicles", "cyclists", "pedestrians", "mix", "warm_up_s"})
      map.exclude(file, key);
  if (map.has("fcd") || map.has("xosc")) return recorded(map, traffic);
  for (const char* key : {"offset_m", "start_s", "types"})
    if (const auto f = map.find(key)) f->fail("a 'fcd' or 'xosc' beside it", "none");
  return simulated(map, wide_streets, traffic);
}

}  // namespace greatx::sim
