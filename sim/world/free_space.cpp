// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/free_space.h"

#include <algorithm>
#include <utility>

namespace greatx::sim {
namespace {

/// Follows a distance over time. `distance` returns it, m; it changes by at most `speed`, m/s. Returns the
/// first time at which it is below `least_m`, or nothing.
template <typename Distance>
std::optional<double> first_below(double least_m, double speed, double end_s, const Distance& distance) {
  const double asked = least_m + WorldFreeSpace::slack_m;
  for (double time_s = 0.0;;) {
    const double room = distance(time_s) - asked;
    if (room < 0.0) return time_s;
    if (time_s >= end_s || speed <= 0.0) return std::nullopt;
    time_s = std::min(end_s, time_s + std::max(room, 0.5 * WorldFreeSpace::slack_m) / speed);
  }
}

/// Returns the distance from the origin to the farthest corner of a box.
double reach_of(const scene::Bounds& box) {
  return box.empty() ? 0.0 : glm::length(glm::max(glm::abs(box.min), glm::abs(box.max)));
}

}  // namespace

WorldFreeSpace::WorldFreeSpace(const Scenario& scenario, const World& world) : world_(world) {
  for (size_t index = 0; index < scenario.nodes.size(); ++index) {
    const NodeConfig& node = scenario.nodes[index];
    const uint32_t body = world.body_of_node[index];
    double radius = body == 0 ? 0.0 : reach_of(world.scene.reach_of(body));
    for (const SensorConfig& sensor : node.sensors)
      radius = std::max(radius, glm::length(sensor.mount.position_m));
    radii_.push_back(radius);
    is_static_.push_back(body == 0 && std::holds_alternative<StaticTrajectory>(node.trajectory));
  }
}

std::optional<FreeSpace::Obstacle> WorldFreeSpace::too_near(uint32_t node, double clearance_m,
                                                            const Course& course,
                                                            std::span<const Neighbour> neighbours,
                                                            double end_s) const {
  const double radius = radii_[node], speed = course.most_speed();
  if (clearance_m > 0.0) {
    const rf::Surroundings& surfaces = world_.solids().surfaces();
    const auto place = [&](double time_s) { return world_.scene.to_local(course.at(time_s).pose.position); };
    const double least = radius + clearance_m;
    // Far from everything one look per second of flight, or per 50 m, is enough.
    const double look_m = least + std::max(50.0, speed);
    if (first_below(least, speed, end_s, [&](double t) { return surfaces.distance(place(t), look_m); }))
      return Obstacle{};
    // A course that keeps clear of surfaces is inside a solid either always or never.
    const rf::Placement begin = surfaces.in_static_world(place(0.0));
    if (begin.solid != rf::Placement::none || begin.beneath != rf::Placement::none) return Obstacle{};
  }
  for (const Neighbour& other : neighbours) {
    const double clearance = std::max(clearance_m, other.clearance_m);
    if (clearance <= 0.0 || is_static_[other.node]) continue;
    const auto distance = [&](double t) {
      return glm::distance(course.at(t).pose.position, other.course->at(t).pose.position);
    };
    if (first_below(radius + radii_[other.node] + clearance, speed + other.course->most_speed(), end_s,
                    distance))
      return Obstacle{other.node};
  }
  return std::nullopt;
}

}  // namespace greatx::sim
