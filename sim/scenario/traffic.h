// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traffic as a scenario asks for it, and the trajectories that it gives to nodes. docs/traffic.md.
//
//   traffic: {vehicles: 20, ...} ─► TrafficConfig with its members, and one node for each member with a
//                                   TrafficTrajectory (sim/scenario/parse/scenario_traffic.cpp)
//   traffic: {fcd: file}         ─► one node with a TrackTrajectory for each vehicle and person of the file
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec.h"

namespace greatx::sim {

struct WayPointTrajectory;

/// One of those who move: a node of the scenario follows it.
struct TrafficMember {
  enum class Kind : uint8_t { vehicle, cyclist, pedestrian } kind = Kind::vehicle;
  std::string variant;  ///< of the generator's kinds "vehicle" and "person"
  uint32_t number = 0;  ///< among all members
  friend bool operator==(const TrafficMember&, const TrafficMember&) = default;
};

/// A variant of the generator that may take part, and how often it does if the scenario does not say it.
struct TrafficVariant {
  const char* name;
  TrafficMember::Kind kind;
  double share = 0.0;
  double length_m = 0.0;  ///< of scene::VehicleShape; 0: a person
};
/// Longer vehicles need streets on which their body stays in its lane (sim/traffic/streets.h).
inline constexpr double longer_than_m = 6.0;

/// Returns all variants of vehicles, two-wheelers and people. A test compares them with the generator's.
/// Trams and articulated lorries have share 0: the ways of the city have no room for them.
const std::vector<TrafficVariant>& traffic_variants();
/// The generator's kind of a variant and of its node's class: "vehicle" or "person".
inline const char* generator_kind(TrafficMember::Kind kind) {
  return kind == TrafficMember::Kind::pedestrian ? "person" : "vehicle";
}

struct TrafficConfig {
  uint64_t seed = 1;
  double warm_up_s = 60.0;  ///< simulated before tick 0
  bool limbs = true;        ///< wheels and limbs move
  std::vector<TrafficMember> members;
  SourceLocation where;
  friend bool operator==(const TrafficConfig& a, const TrafficConfig& b) {
    return a.seed == b.seed && a.warm_up_s == b.warm_up_s && a.limbs == b.limbs && a.members == b.members;
  }
};

/// The course of a member of Scenario::traffic. It comes from the simulation of the world's streets.
struct TrafficTrajectory {
  uint32_t member = 0;  ///< into TrafficConfig::members
};

/// Holds stretches of a course that were recorded elsewhere. Outside of them the node is absent: it rests
/// hidden_m below its first place, where no sensor sees it.
struct TrackTrajectory {
  /// In order of time, without overlap, with an attitude at each point.
  std::shared_ptr<const std::vector<WayPointTrajectory>> stretches;
  static constexpr double hidden_m = 5000.0;
};

/// The course of another node, with a fixed offset in its frame.
struct FollowTrajectory {
  std::string node;
  dvec3 position_m{0.0};
  dvec3 rotation{0.0};  ///< yaw, pitch, roll, rad
};

}  // namespace greatx::sim
