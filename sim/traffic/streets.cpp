// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/streets.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::sim {
namespace {

double cross_product(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Crossings that begin within this of a lane's start belong to the turn before it.
constexpr double exit_zone_m = 12.0;
/// Between the front of one who waits and a crossing.
constexpr double before_crossing_m = 1.0;
constexpr double sample_m = 0.4;
/// About each vehicle where turns are compared.
constexpr double room_m = 0.2;

/// Returns the direction of travel at an end of a lane.
dvec2 direction_at(const scene::StreetLane& lane, bool end) {
  const size_t n = lane.line.size();
  const dvec2 step =
      end ? dvec2(lane.line[n - 1]) - dvec2(lane.line[n - 2]) : dvec2(lane.line[1]) - dvec2(lane.line[0]);
  return glm::normalize(step);
}

std::vector<GroundBox> swept_boxes(const Curve& curve, const Extent& extent, std::vector<double>& places) {
  std::vector<GroundBox> boxes;
  const double begin = -extent.front_m, end = curve.length() + extent.rear_m;
  const int count = std::max(1, static_cast<int>(std::ceil((end - begin) / sample_m)));
  for (int i = 0; i <= count; ++i) {
    places.push_back(begin + (end - begin) * i / count);
    boxes.push_back(box_at(curve, places.back(), extent));
  }
  return boxes;
}

}  // namespace

bool overlap(const GroundBox& a, const GroundBox& b) {
  const dvec2 between = b.middle - a.middle;
  const double reach = a.half_length + a.half_width + b.half_length + b.half_width;  // more than enough
  if (glm::dot(between, between) > reach * reach) return false;
  const dvec2 a_left(-a.forward.y, a.forward.x), b_left(-b.forward.y, b.forward.x);
  for (const dvec2& axis : {a.forward, a_left, b.forward, b_left}) {
    const double extents = a.half_length * std::abs(glm::dot(axis, a.forward)) +
                           a.half_width * std::abs(glm::dot(axis, a_left)) +
                           b.half_length * std::abs(glm::dot(axis, b.forward)) +
                           b.half_width * std::abs(glm::dot(axis, b_left));
    if (std::abs(glm::dot(axis, between)) > extents) return false;
  }
  return true;
}

GroundBox box_at(const Curve& curve, double s, const Extent& extent) {
  const CurvePlace place = curve.at(s);
  return {place.position + 0.5 * (extent.front_m - extent.rear_m) * place.tangent, place.tangent,
          0.5 * (extent.front_m + extent.rear_m), 0.5 * extent.width_m};
}

Streets::Streets(const scene::StreetNetwork& network, const Extent& largest, const std::string& name)
    : name_(name), junctions_(network.junctions), crossings_(network.crossings) {
  make_ways(network);
  find_crossings(network);
  make_gates(network);
  find_endless();
  find_exclusions(largest);
  keep_stops_clear(largest);
  make_rings(network);
  make_paths(network);
}

void Streets::make_ways(const scene::StreetNetwork& network) {
  std::vector<const scene::StreetLane*> before(network.lanes.size(), nullptr);
  std::vector<uint32_t> from(network.lanes.size(), 0);
  for (uint32_t i = 0; i < network.lanes.size(); ++i)
    for (const uint32_t next : network.lanes[i].next) {
      before[next] = &network.lanes[i];
      from[next] = i;
    }
  for (uint32_t i = 0; i < network.lanes.size(); ++i) {
    const scene::StreetLane& lane = network.lanes[i];
    // A turn leaves and joins lanes in their directions.
    std::optional<dvec2> start, end;
    if (lane.turn() && before[i] != nullptr) start = direction_at(*before[i], true);
    if (lane.turn() && !lane.next.empty()) end = direction_at(network.lanes[lane.next[0]], false);
    Curve curve(lane.line, start, end);
    const double bend = curve.most_curvature();
    const double speed =
        bend > 0.0 ? std::min(lane.speed_mps, std::sqrt(most_lateral_mps2 / bend)) : lane.speed_mps;
    ways_.push_back({std::move(curve),
                     speed,
                     lane.next,
                     lane.left,
                     lane.right,
                     lane.junction,
                     lane.group,
                     from[i],
                     {},
                     {},
                     0.5,
                     false});
  }
}

/// Finds where crossings meet lanes: a lane's line, in short steps, passes through the crossing's strip.
void Streets::find_crossings(const scene::StreetNetwork& network) {
  crossings_of_.resize(ways_.size());
  for (uint32_t c = 0; c < network.crossings.size(); ++c) {
    const scene::StreetCrossing& crossing = network.crossings[c];
    const dvec2 from(crossing.from), along = dvec2(crossing.to) - from;
    const double length = glm::length(along);
    const dvec2 forward = along / length;
    for (uint32_t w = 0; w < ways_.size(); ++w) {
      const Curve& curve = ways_[w].curve;
      const dvec2 middle = 0.5 * (curve.at(0.0).position + curve.at(curve.length()).position);
      if (glm::distance(middle, from) > length + curve.length()) continue;
      double first = -1.0, last = -1.0;
      for (double s = 0.0; s <= curve.length(); s += 0.1) {
        const dvec2 to = curve.at(s).position - from;
        const double x = glm::dot(to, forward), y = cross_product(forward, to);
        if (x < -0.5 || x > length + 0.5 || std::abs(y) > 0.5 * crossing.width_m) continue;
        if (first < 0.0) first = s;
        last = s;
      }
      if (first >= 0.0 && !ways_[w].turn()) crossings_of_[w].push_back({c, first, last});
    }
  }
  for (auto& list : crossings_of_)
    std::ranges::sort(list, {}, [](const CrossingOnWay& on) { return on.from_m; });
}

void Streets::make_gates(const scene::StreetNetwork& network) {
  for (uint32_t w = 0; w < ways_.size(); ++w) {
    DriveWay& way = ways_[w];
    if (way.turn()) continue;
    const double length = way.curve.length();
    Gate last{std::max(length - network.lanes[w].stop_m, 0.5), {}, true};
    for (const CrossingOnWay& on : crossings_of_[w]) {
      if (on.from_m < std::min(exit_zone_m, 0.5 * length)) {
        way.exit.push_back(on);
        way.clear_m = std::max(way.clear_m, on.to_m + 0.5);
      } else if (on.from_m > length - exit_zone_m) {
        last.stop_m = std::min(last.stop_m, on.from_m - before_crossing_m);
        last.crossings.push_back(on);
      } else {
        way.gates.push_back({on.from_m - before_crossing_m, {on}, false});
      }
    }
    way.gates.push_back(std::move(last));
  }
}

/// Takes away, again and again, what ends where nothing follows.
void Streets::find_endless() {
  for (DriveWay& way : ways_) way.endless = true;
  for (bool changed = true; changed;) {
    changed = false;
    for (DriveWay& way : ways_) {
      std::erase_if(way.next, [&](uint32_t next) { return !ways_[next].endless; });
      if (way.endless && way.next.empty()) {
        way.endless = false;
        changed = true;
      }
    }
  }
}

void Streets::find_exclusions(const Extent& largest) {
  excludes_.resize(ways_.size());
  std::vector<std::vector<uint32_t>> turns(junctions_.size());
  for (uint32_t w = 0; w < ways_.size(); ++w)
    if (ways_[w].turn()) turns[*ways_[w].junction].push_back(w);
  Extent roomy = largest;
  roomy.front_m += room_m;
  roomy.rear_m += room_m;
  roomy.width_m += 2.0 * room_m;
  for (const std::vector<uint32_t>& of_junction : turns) {
    std::vector<std::vector<GroundBox>> boxes;
    std::vector<std::vector<double>> places(of_junction.size());
    for (size_t i = 0; i < of_junction.size(); ++i)
      boxes.push_back(swept_boxes(ways_[of_junction[i]].curve, roomy, places[i]));
    for (size_t i = 0; i < of_junction.size(); ++i)
      for (size_t j = 0; j < of_junction.size(); ++j) {
        if (i == j) continue;
        for (size_t k = boxes[i].size(); k-- > 0;)
          if (std::ranges::any_of(boxes[j], [&](const GroundBox& b) { return overlap(boxes[i][k], b); })) {
            excludes_[of_junction[i]].emplace_back(of_junction[j], places[i][k] + sample_m);
            break;
          }
      }
  }
}

/// Moves stops back until those who wait do not stand in the way of others' turns.
void Streets::keep_stops_clear(const Extent& largest) {
  std::vector<std::vector<uint32_t>> turns(junctions_.size());
  for (uint32_t w = 0; w < ways_.size(); ++w)
    if (ways_[w].turn()) turns[*ways_[w].junction].push_back(w);
  Extent roomy = largest;
  roomy.width_m += room_m;
  for (DriveWay& way : ways_) {
    if (way.turn() || way.next.empty() || !ways_[way.next[0]].turn()) continue;
    Gate& gate = way.gates.back();
    std::vector<GroundBox> boxes;
    std::vector<double> places;
    const auto own = static_cast<uint32_t>(&way - ways_.data());
    for (const uint32_t turn : turns[*ways_[way.next[0]].junction])
      if (ways_[turn].from != own)
        for (const GroundBox& box : swept_boxes(ways_[turn].curve, roomy, places)) boxes.push_back(box);
    for (int tries = 0; tries < 20 && gate.stop_m > 2.0; ++tries) {
      const GroundBox waiting = box_at(way.curve, gate.stop_m - largest.front_m, roomy);
      if (std::ranges::none_of(boxes, [&](const GroundBox& box) { return overlap(waiting, box); })) break;
      gate.stop_m -= 0.5;
    }
  }
}

std::optional<double> Streets::excludes(uint32_t turn, uint32_t other) const {
  for (const auto& [with, up_to] : excludes_[turn])
    if (with == other) return up_to;
  return std::nullopt;
}

// --------------------------------------------------------------------------------------------------- signals

Streets::Phase Streets::phase_of(uint32_t junction, double time_s) const {
  const std::vector<scene::StreetPhase>& phases = junctions_[junction].phases;
  double cycle = 0.0;
  for (const scene::StreetPhase& phase : phases) cycle += phase.green_s + phase.amber_s + phase.clear_s;
  double at = std::fmod(time_s, cycle);
  if (at < 0.0) at += cycle;
  for (size_t i = 0;; ++i) {
    const double length = phases[i].green_s + phases[i].amber_s + phases[i].clear_s;
    if (at < length || i + 1 == phases.size()) return {i, at};
    at -= length;
  }
}

Light Streets::light(const DriveWay& turn, double time_s) const {
  const std::vector<scene::StreetPhase>& phases = junctions_[*turn.junction].phases;
  if (phases.empty()) return Light::green;
  const Phase now = phase_of(*turn.junction, time_s);
  const scene::StreetPhase& phase = phases[now.index];
  if (std::ranges::find(phase.groups, turn.group) == phase.groups.end()) return Light::red;
  if (now.since_s < phase.green_s) return Light::green;
  return now.since_s < phase.green_s + phase.amber_s ? Light::amber : Light::red;
}

bool Streets::has_signals(uint32_t crossing) const {
  const auto& junction = crossings_[crossing].junction;
  return junction && !junctions_[*junction].phases.empty();
}

double Streets::walk_time(uint32_t crossing, double time_s) const {
  if (!has_signals(crossing)) return 1e9;
  const uint32_t junction = *crossings_[crossing].junction;
  const Phase now = phase_of(junction, time_s);
  const scene::StreetPhase& phase = junctions_[junction].phases[now.index];
  const bool vehicles_go = std::ranges::find(phase.groups, crossings_[crossing].group) != phase.groups.end();
  if (vehicles_go || now.since_s > phase.green_s) return 0.0;
  return phase.green_s + phase.amber_s + phase.clear_s - now.since_s;
}

double Streets::longest_walk_time(uint32_t crossing) const {
  if (!has_signals(crossing)) return 1e9;
  double longest = 0.0;
  for (const scene::StreetPhase& phase : junctions_[*crossings_[crossing].junction].phases)
    if (std::ranges::find(phase.groups, crossings_[crossing].group) == phase.groups.end())
      longest = std::max(longest, phase.green_s + phase.amber_s + phase.clear_s);
  return longest;
}

}  // namespace greatx::sim
