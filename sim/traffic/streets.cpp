// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/streets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/convex_hull.h"
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
/// Stops are moved back, out of the way of others' turns, in such steps and so far at most.
constexpr double back_step_m = 0.5, furthest_back_m = 10.0;

/// Returns the direction of travel at an end of a lane.
dvec2 direction_at(const scene::StreetLane& lane, bool end) {
  const size_t n = lane.line.size();
  const dvec2 step =
      end ? dvec2(lane.line[n - 1]) - dvec2(lane.line[n - 2]) : dvec2(lane.line[1]) - dvec2(lane.line[0]);
  return glm::normalize(step);
}

/// A turn with what leads to it and away from it, as far as bodies count there.
struct WholeTurn {
  const Curve &turn, &before, &after;
  double before_m = 0.0, after_m = 0.0;  ///< fronts begin, and rears end, so far outside the turn
  GroundBox box(double s, const Extent& extent) const {
    if (s < 0.0 && before_m > 0.0) return box_at(before, before.length() + s, extent);
    if (s > turn.length() && after_m > 0.0) return box_at(after, s - turn.length(), extent);
    return box_at(turn, s, extent);
  }
};

/// The places of a body on a turn, one behind the other.
class Sweep {
 public:
  Sweep(const Curve& turn, const Extent& extent) : Sweep(WholeTurn{turn, turn, turn}, extent) {}
  Sweep(const WholeTurn& whole, const Extent& extent) {
    const double begin = -whole.before_m - extent.front_m,
                 end = whole.turn.length() + whole.after_m + extent.rear_m;
    const int count = std::max(1, static_cast<int>(std::ceil((end - begin) / sample_m)));
    for (int i = 0; i <= count; ++i) {
      places_.push_back(begin + (end - begin) * i / count);
      boxes_.push_back(whole.box(places_.back(), extent));
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

bool stays_on_lanes(const Curve& turn, double width_m, double beside_m, const Extent& extent,
                    const std::vector<LaneMouth>& at_junction) {
  std::vector<dvec2> corners;
  for (const LaneMouth& mouth : at_junction)
    for (const double side : {-0.5, 0.5})
      corners.push_back(mouth.place + side * mouth.width_m * dvec2(-mouth.inwards.y, mouth.inwards.x));
  const std::vector<dvec2> hull = convex_hull(corners);
  const auto in_hull = [&](const dvec2& point) {
    for (size_t i = 0; i < hull.size(); ++i)
      if (cross_product(hull[(i + 1) % hull.size()] - hull[i], point - hull[i]) < 0.0) return false;
    return true;
  };
  const auto on_a_lane = [&](const dvec2& point) {
    return std::ranges::any_of(at_junction, [&](const LaneMouth& mouth) {
      const dvec2 to = point - mouth.place;
      const double x = glm::dot(to, mouth.inwards);
      return std::abs(cross_product(mouth.inwards, to)) <= 0.5 * mouth.width_m + beside_lane_m &&
             (x > 0.0 ? in_hull(point) : x > -mouth.length_m);
    });
  };
  constexpr double step_m = 0.25;
  std::vector<CurvePlace> places;
  for (double s = -extent.front_m; s < turn.length() + extent.front_m; s += step_m)
    places.push_back(turn.at(s));
  const auto beside_turn = [&](const dvec2& point) {
    return std::ranges::any_of(places, [&](const CurvePlace& place) {
      return glm::distance(place.position, point) <= 0.5 * width_m + beside_m;
    });
  };
  for (double s = 0.0; s <= turn.length() + extent.rear_m; s += step_m) {
    const CurvePlace place = turn.at(s);
    for (const double along : {extent.front_m, -extent.rear_m})
      for (const double side : {-0.5, 0.5}) {
        const dvec2 corner = place.position + along * place.tangent + side * extent.width_m * place.left();
        if (!beside_turn(corner) && !on_a_lane(corner)) return false;
      }
  }
  return true;
}

Streets::Streets(const scene::StreetNetwork& network, const LargestVehicles& largest, const std::string& name)
    : name_(name), junctions_(network.junctions), crossings_(network.crossings) {
  make_ways(network);
  find_crossings(network);
  make_gates(network);
  find_endless(largest);
  keep_stops_clear(largest);
  find_swept(largest);
  find_exclusions(largest);
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

/// Whether a longer vehicle may take a turn on which it reaches beyond its lane.
bool Streets::longer_may(const DriveWay& turn, const Extent& longer) const {
  if (turn.curve.most_curvature() > 1.0 / tightest_longer_m) return false;
  std::vector<LaneMouth> mouths;
  std::vector<bool> known(ways_.size(), false);
  const Sweep sweep(turn.curve, longer);
  const auto can_wait = [&](const DriveWay& lane) {
    // Those who wait before the junction must not stand in the way, nor too near the junction before theirs.
    const double stop_m = lane.gates.back().stop_m - furthest_back_m;
    const double crossing_m =
        lane.gates.size() > 1 ? lane.gates[lane.gates.size() - 2].crossings.back().to_m : 0.0;
    const double length_m = longer.front_m + longer.rear_m;
    return stop_m > std::max(0.5 * lane.curve.length(), crossing_m + length_m) &&
           !sweep.meets(box_at(lane.curve, stop_m - longer.front_m, longer));
  };
  const auto add = [&](uint32_t lane, bool leads_here) {
    if (known[lane]) return;
    known[lane] = true;
    const DriveWay& way = ways_[lane];
    const CurvePlace end = way.curve.at(leads_here ? way.curve.length() : 0.0);
    mouths.push_back(
        {end.position, leads_here ? end.tangent : -end.tangent, way.width_m, way.curve.length()});
  };
  for (const DriveWay& other : ways_)
    if (other.turn() && other.junction == turn.junction && other.endless) {
      add(other.from, true), add(other.next[0], false);
      if (other.from != turn.from && !can_wait(ways_[other.from])) return false;
    }
  return stays_on_lanes(turn.curve, turn.width_m, beside_turn_m, longer, mouths);
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
  const Extent roomy = sizes_of(largest, room_m, room_m).back().second;
  for (DriveWay& way : ways_) {
    const double beside_m = 0.5 * way.width_m + (way.turn() ? beside_turn_m : beside_lane_m);
    const bool stays = way.endless && !way.right && reach_beside(way.curve, *largest.longer) <= beside_m;
    way.swings = !stays && way.endless && way.turn() && longer_may(way, roomy);
    way.endless_longer = stays || way.swings;
    way.next_longer = way.next;
  }
  prune(&DriveWay::next_longer, &DriveWay::endless_longer);
  for (DriveWay& way : ways_)  // a turn that no longer vehicle comes to takes no room
    if (way.swings && !ways_[way.from].endless_longer) way.endless_longer = false;
}

/// Finds how far into the lanes behind a junction longer vehicles sweep that turn into other lanes. Nobody
/// stops there.
void Streets::find_swept(const LargestVehicles& largest) {
  constexpr double step_m = 0.5, longest_m = 30.0;
  if (!largest.longer) return;
  const auto roomy = sizes_of(largest, room_m, room_m);
  for (uint32_t t = 0; t < ways_.size(); ++t) {
    const DriveWay& turn = ways_[t];
    if (!turn.swings || !turn.endless_longer) continue;
    // From where it begins to turn. Before that it is on its own lane, as on any other way.
    const Extent& longer = roomy.back().second;
    const Sweep sweep(WholeTurn{turn.curve, turn.curve, turn.curve, -longer.front_m, 0.0}, longer);
    for (const DriveWay& other : ways_) {
      if (other.junction != turn.junction || !other.endless || other.next[0] == turn.next[0]) continue;
      DriveWay& lane = ways_[other.next[0]];
      for (double s = lane.swept_m; s < std::min(longest_m, lane.curve.length()); s += step_m)
        if (sweep.meets(box_at(lane.curve, s, {step_m, 0.0, roomy.back().second.width_m})))
          lane.swept_m = s + step_m;
    }
  }
  for (DriveWay& way : ways_) way.clear_m = std::max(way.clear_m, way.swept_m);
}

void Streets::find_exclusions(const LargestVehicles& largest) {
  struct Taken {
    uint32_t turn = 0;
    VehicleSize size = VehicleSize::ordinary;
    Sweep sweep;
  };
  excludes_.resize(ways_.size());
  std::vector<std::vector<Taken>> of_junctions(junctions_.size());
  std::vector<bool> swept(junctions_.size(), false);
  for (const DriveWay& way : ways_)
    if (way.swings && way.endless_longer) swept[*way.junction] = true;
  // Where longer vehicles swing over other lanes, others count from their stops on, and until they have left
  // what is swept.
  const auto sweep_of = [&](const DriveWay& turn, const Extent& extent) {
    const DriveWay &from = ways_[turn.from], &to = ways_[turn.endless ? turn.next[0] : turn.from];
    WholeTurn whole{turn.curve, from.curve, to.curve};
    if (turn.endless && swept[*turn.junction]) {
      whole.before_m = std::max(from.curve.length() - from.gates.back().stop_m, 0.0);
      whole.after_m = to.swept_m;
    }
    return Sweep(whole, extent);
  };
  for (const auto& [size, extent] : sizes_of(largest, room_m, room_m))
    for (uint32_t w = 0; w < ways_.size(); ++w)
      if (ways_[w].turn() && (size == VehicleSize::ordinary || ways_[w].endless_longer))
        of_junctions[*ways_[w].junction].push_back({w, size, sweep_of(ways_[w], extent)});
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
        for (double back_m = 0.0; back_m < furthest_back_m && gate.stop_m > 2.0 && in_the_way(extent);
             back_m += back_step_m)
          gate.stop_m -= back_step_m;
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
