// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/streets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
/// Longer vehicles take ways on which they reach beyond the lane by this at most. Lanes of opposite
/// directions lie further apart; on turns, exclusions see to the rest.
constexpr double beside_lane_m = 0.1, beside_turn_m = 0.35;

/// Returns the direction of travel at an end of a lane.
dvec2 direction_at(const scene::StreetLane& lane, bool end) {
  const size_t n = lane.line.size();
  const dvec2 step =
      end ? dvec2(lane.line[n - 1]) - dvec2(lane.line[n - 2]) : dvec2(lane.line[1]) - dvec2(lane.line[0]);
  return glm::normalize(step);
}

/// The places of a body on a way, one behind the other.
class Sweep {
 public:
  Sweep(const Curve& curve, const Extent& extent) {
    const double begin = -extent.front_m, end = curve.length() + extent.rear_m;
    const int count = std::max(1, static_cast<int>(std::ceil((end - begin) / sample_m)));
    for (int i = 0; i <= count; ++i) {
      places_.push_back(begin + (end - begin) * i / count);
      boxes_.push_back(box_at(curve, places_.back(), extent));
      if (i % group == 0) around_.push_back({boxes_.back().middle, 0.0});
      auto& [middle, radius] = around_.back();
      radius = std::max(radius, glm::distance(middle, boxes_.back().middle) + radius_of(boxes_.back()));
    }
  }
  bool meets(const GroundBox& box) const {
    for (size_t i = 0; i < around_.size(); ++i) {
      if (glm::distance(around_[i].first, box.middle) > around_[i].second + radius_of(box)) continue;
      for (size_t k = i * group; k < std::min(boxes_.size(), (i + 1) * group); ++k)
        if (overlap(boxes_[k], box)) return true;
    }
    return false;
  }
  /// Returns the last place at which the body meets another one's way.
  std::optional<double> last_meeting(const Sweep& other) const {
    for (size_t k = boxes_.size(); k-- > 0;)
      if (other.meets(boxes_[k])) return places_[k];
    return std::nullopt;
  }

 private:
  static constexpr size_t group = 8;
  static double radius_of(const GroundBox& box) { return std::hypot(box.half_length, box.half_width); }
  std::vector<GroundBox> boxes_;
  std::vector<double> places_;
  std::vector<std::pair<dvec2, double>> around_;  ///< circles about each group of boxes
};

/// Returns the largest ones of each size that there are, with room all round.
std::vector<std::pair<VehicleSize, Extent>> sizes_of(const LargestVehicles& largest, double along_m,
                                                     double across_m) {
  std::vector<std::pair<VehicleSize, Extent>> sizes{{VehicleSize::ordinary, largest.ordinary}};
  if (largest.longer) sizes.emplace_back(VehicleSize::longer, *largest.longer);
  for (auto& [size, extent] : sizes) {
    extent.front_m += along_m;
    extent.rear_m += along_m;
    extent.width_m += 2.0 * across_m;
  }
  return sizes;
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

double reach_beside(const Curve& curve, const Extent& extent) {
  constexpr double chord_m = 0.5;
  std::vector<CurvePlace> places;
  for (double s = -extent.front_m; s < curve.length() + extent.front_m; s += chord_m)
    places.push_back(curve.at(s));
  const auto beside = [&](const dvec2& corner) {
    double least = 1e18;
    for (size_t i = 1; i < places.size(); ++i) {
      const dvec2 a = places[i - 1].position, chord = places[i].position - a;
      const double share = std::clamp(glm::dot(corner - a, chord) / glm::dot(chord, chord), 0.0, 1.0);
      least = std::min(least, glm::distance(corner, a + share * chord));
    }
    return least;
  };
  double most = 0.5 * extent.width_m;
  for (size_t i = 0; (static_cast<double>(i) * chord_m) <= curve.length() + extent.front_m; ++i)
    for (const double side : {-0.5, 0.5}) {
      const dvec2 across = side * extent.width_m * places[i].left();
      most = std::max(most, beside(places[i].position + extent.front_m * places[i].tangent + across));
    }
  return most;
}

Streets::Streets(const scene::StreetNetwork& network, const LargestVehicles& largest, const std::string& name)
    : name_(name), junctions_(network.junctions), crossings_(network.crossings) {
  make_ways(network);
  find_crossings(network);
  make_gates(network);
  find_endless(largest);
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
    DriveWay way{.curve = std::move(curve),
                 .width_m = lane.width_m,
                 .speed_mps = speed,
                 .next = lane.next,
                 .next_longer = {},
                 .left = lane.left,
                 .right = lane.right,
                 .junction = lane.junction,
                 .group = lane.group,
                 .from = from[i],
                 .gates = {},
                 .exit = {}};
    const dvec2 first = way.curve.at(0.0).tangent, last = way.curve.at(way.curve.length()).tangent;
    way.straight_on = glm::dot(first, last) > std::numbers::sqrt2 / 2.0;
    if (lane.turn() && !way.straight_on) way.side = cross_product(first, last) > 0.0 ? 1 : -1;
    ways_.push_back(std::move(way));
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

/// Takes away, again and again, what ends where nothing follows: for all, then for longer vehicles.
void Streets::find_endless(const LargestVehicles& largest) {
  const auto prune = [&](std::vector<uint32_t> DriveWay::*next, bool DriveWay::*endless) {
    for (bool changed = true; changed;) {
      changed = false;
      for (DriveWay& way : ways_) {
        std::erase_if(way.*next, [&](uint32_t other) { return !(ways_[other].*endless); });
        if (way.*endless && (way.*next).empty()) {
          way.*endless = false;
          changed = true;
        }
      }
    }
  };
  for (DriveWay& way : ways_) way.endless = true;
  prune(&DriveWay::next, &DriveWay::endless);
  if (!largest.longer) return;
  for (DriveWay& way : ways_) {
    const double beside_m = 0.5 * way.width_m + (way.turn() ? beside_turn_m : beside_lane_m);
    way.endless_longer = way.endless && !way.right && reach_beside(way.curve, *largest.longer) <= beside_m;
    way.next_longer = way.next;
  }
  prune(&DriveWay::next_longer, &DriveWay::endless_longer);
}

void Streets::find_exclusions(const LargestVehicles& largest) {
  struct Taken {
    uint32_t turn = 0;
    VehicleSize size = VehicleSize::ordinary;
    Sweep sweep;
  };
  excludes_.resize(ways_.size());
  std::vector<std::vector<Taken>> of_junctions(junctions_.size());
  for (const auto& [size, extent] : sizes_of(largest, room_m, room_m))
    for (uint32_t w = 0; w < ways_.size(); ++w)
      if (ways_[w].turn() && (size == VehicleSize::ordinary || ways_[w].endless_longer))
        of_junctions[*ways_[w].junction].push_back({w, size, Sweep(ways_[w].curve, extent)});
  for (const std::vector<Taken>& taken : of_junctions)
    for (const Taken& a : taken)
      for (const Taken& b : taken)
        if (a.turn != b.turn)
          if (const auto last = a.sweep.last_meeting(b.sweep))
            excludes_[a.turn].push_back({a.size, b.turn, b.size, *last + sample_m});
}

/// Moves stops back until those who wait do not stand in the way of others' turns.
void Streets::keep_stops_clear(const LargestVehicles& largest) {
  std::vector<std::vector<std::pair<uint32_t, Sweep>>> turns(junctions_.size());
  const auto roomy = sizes_of(largest, 0.0, 0.5 * room_m);
  for (const auto& [size, extent] : roomy)
    for (uint32_t w = 0; w < ways_.size(); ++w)
      if (ways_[w].turn() && (size == VehicleSize::ordinary || ways_[w].endless_longer))
        turns[*ways_[w].junction].emplace_back(w, Sweep(ways_[w].curve, extent));
  for (DriveWay& way : ways_) {
    if (way.turn() || way.next.empty() || !ways_[way.next[0]].turn()) continue;
    Gate& gate = way.gates.back();
    const auto own = static_cast<uint32_t>(&way - ways_.data());
    const auto in_the_way = [&](const Extent& extent) {
      const GroundBox waiting = box_at(way.curve, gate.stop_m - extent.front_m, extent);
      return std::ranges::any_of(turns[*ways_[way.next[0]].junction], [&](const auto& turn) {
        return ways_[turn.first].from != own && turn.second.meets(waiting);
      });
    };
    for (const auto& [size, extent] : roomy)
      if (way.goes_on(size))
        for (int tries = 0; tries < 20 && gate.stop_m > 2.0 && in_the_way(extent); ++tries)
          gate.stop_m -= 0.5;
  }
}

std::optional<double> Streets::excludes(uint32_t turn, VehicleSize size, uint32_t other,
                                        VehicleSize other_size) const {
  for (const Exclusion& e : excludes_[turn])
    if (e.other == other && e.size == size && e.other_size == other_size) return e.up_to_m;
  return std::nullopt;
}

// --------------------------------------------------------------------------------------------------- signals

Light Streets::light(const DriveWay& turn, double time_s) const {
  return scene::light_of(junctions_[*turn.junction], turn.group, time_s);
}

bool Streets::has_signals(uint32_t crossing) const {
  const auto& junction = crossings_[crossing].junction;
  return junction && !junctions_[*junction].phases.empty();
}

double Streets::walk_time(uint32_t crossing, double time_s) const {
  if (!has_signals(crossing)) return 1e9;
  const scene::StreetJunction& signals = junctions_[*crossings_[crossing].junction];
  if (scene::walk_light_of(signals, crossings_[crossing].group, time_s) != Light::green) return 0.0;
  const scene::PhaseNow now = scene::phase_of(signals, time_s);
  const scene::StreetPhase& phase = signals.phases[now.index];
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
