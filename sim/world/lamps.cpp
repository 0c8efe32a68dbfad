// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/lamps.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/hash.h"
#include "sim/scenario/trajectory.h"
#include "sim/world/moment.h"

namespace greatx::sim {
namespace {

using scene::LampRole;
using scene::Light;

bool flash(double time_s, double rate_hz, double phase) {
  const double turns = rate_hz * time_s + phase;
  return turns - std::floor(turns) < 0.5;
}

/// What a head shows at a time; without a head, a signal of no junction. People see no amber.
float factor_of_signal(const SignalHeads& signals, const scene::StreetSignal* head, LampRole role,
                       double time_s) {
  if (head == nullptr || signals.junctions[head->junction].phases.empty())
    return role == LampRole::amber && flash(time_s, idle_hz, 0.0) ? 1.0f : 0.0f;
  const scene::StreetJunction& junction = signals.junctions[head->junction];
  const Light light = head->walk ? scene::walk_light_of(junction, head->group, time_s)
                                 : scene::light_of(junction, head->group, time_s);
  const LampRole lit = light == Light::green   ? LampRole::green
                       : light == Light::amber ? LampRole::amber
                                               : LampRole::red;
  return role == lit ? 1.0f : 0.0f;
}

/// What the lamps of a vehicle show.
struct VehicleLamps {
  bool stop = false;
  int side = 0;
};

}  // namespace

void add_signals(SignalHeads& signals, const std::string& object, const scene::StreetNetwork& streets) {
  const auto first = static_cast<uint32_t>(signals.junctions.size());
  signals.junctions.insert(signals.junctions.end(), streets.junctions.begin(), streets.junctions.end());
  for (scene::StreetSignal head : streets.signals) {
    head.junction += first;
    if (!object.empty()) head.node = object + "/" + head.node;
    signals.heads.push_back(std::move(head));
  }
}

bool stop_lamps_lit(const Course& course, double time_s) {
  if (course.is_static()) return false;
  constexpr int looks = 3;
  constexpr double standing_mps = 0.05;
  for (int i = 0; i <= looks; ++i) {
    const Motion motion = course.at(time_s - stop_hold_s * i / looks);
    const dvec3 forward = motion.pose.rotate({1.0, 0.0, 0.0});
    if (i == 0 && glm::length(motion.velocity) < standing_mps) return true;
    const double along = glm::dot(motion.velocity, forward) < 0.0 ? -1.0 : 1.0;  // of one who reverses
    if (along * glm::dot(motion.acceleration, forward) < -stop_mps2) return true;
  }
  return false;
}

bool indicator_lit(const std::string& name, double time_s) {
  return flash(time_s, indicator_hz, fnv1a32(name) / 4294967296.0);
}

Lamps::Lamps(const scene::Scene& scene, const std::vector<uint32_t>& node_of_body, const SignalHeads& signals)
    : signals_(signals) {
  std::map<std::string, uint32_t> heads;
  for (uint32_t i = 0; i < signals.heads.size(); ++i) heads.emplace(signals.heads[i].node, i);
  for (const scene::SwitchedLamp& lamp : scene::switched_lamps(scene).lamps) {
    const scene::Instance& instance = scene.instances[lamp.instance];
    Lamp made{lamp.role};
    if (instance.body != 0) made.node = node_of_body[instance.body];
    if (const auto found = heads.find(instance.name); found != heads.end()) made.head = found->second;
    lamps_.push_back(made);
    names_.push_back(instance.body != 0 ? scene.bodies[scene.owner_of(instance.body)].name : instance.name);
  }
}

std::vector<float> Lamps::factors(const Courses& courses, double time_s) const {
  std::map<uint32_t, VehicleLamps> vehicles;
  std::vector<float> factors;
  for (size_t i = 0; i < lamps_.size(); ++i) {
    const Lamp& lamp = lamps_[i];
    if (lamp.role <= LampRole::green) {
      const scene::StreetSignal* head = lamp.head != none ? &signals_.heads[lamp.head] : nullptr;
      factors.push_back(factor_of_signal(signals_, head, lamp.role, time_s));
      continue;
    }
    VehicleLamps state;
    if (lamp.node != none) {
      const auto [entry, is_new] = vehicles.try_emplace(lamp.node);
      const Course& course = *courses.nodes[lamp.node];
      if (is_new) entry->second = {stop_lamps_lit(course, time_s), course.indicated_side(time_s)};
      state = entry->second;
    }
    const int side = lamp.role == LampRole::left ? 1 : -1;
    if (lamp.role == LampRole::stop)
      factors.push_back(state.stop ? 1.0f : tail_share);
    else
      factors.push_back(state.side == side && indicator_lit(names_[i], time_s) ? 1.0f : 0.0f);
  }
  return factors;
}

}  // namespace greatx::sim
