// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/recall_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/random.h"
#include "sim/scenario/trajectory.h"
#include "sim/sensors/sensor.h"

namespace greatx::apps {

namespace {

/// Returns yaw, pitch and roll of R = R_z R_y R_x, rad.
dvec3 angles_of(const dquat& orientation) {
  const dmat3 r = glm::mat3_cast(orientation);  // r[column][row]
  return {std::atan2(r[0][1], r[0][0]), std::atan2(-r[0][2], std::hypot(r[0][0], r[0][1])),
          std::atan2(r[1][2], r[2][2])};
}

/// Describes a surface on a vertical line.
struct Level {
  double z = 0.0;
  bool up = false;  ///< whether the surface faces up
};

/// Returns the surfaces on the vertical line through `at`, from the lowest to the highest.
std::vector<Level> levels_at(const scene::Scene& scene, const dvec2& at) {
  std::vector<Level> levels;
  for (const scene::FacetTriangle& triangle : scene.facet_triangles) {
    const dvec3 &a = triangle.corners[0], &b = triangle.corners[1], &c = triangle.corners[2];
    const auto area = [](const dvec2& p, const dvec2& q, const dvec2& r) {
      return (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
    };
    const double whole = area(dvec2(a), dvec2(b), dvec2(c));
    if (whole == 0.0) continue;
    const double of_a = area(at, dvec2(b), dvec2(c)) / whole, of_b = area(dvec2(a), at, dvec2(c)) / whole;
    if (of_a < 0.0 || of_b < 0.0 || of_a + of_b > 1.0) continue;
    levels.push_back({of_a * a.z + of_b * b.z + (1.0 - of_a - of_b) * c.z, whole > 0.0});
  }
  std::sort(levels.begin(), levels.end(), [](const Level& p, const Level& q) { return p.z < q.z; });
  return levels;
}

/// Returns the point at the fraction `share` of the way from 1.5 m above the ground to the top of the scene.
/// It returns none if there is no ground below the point or the point is inside a solid.
std::optional<dvec3> place(const scene::Scene& scene, const dvec2& at, double share) {
  const std::vector<Level> levels = levels_at(scene, at);
  const auto ground = std::find_if(levels.begin(), levels.end(), [](const Level& level) { return level.up; });
  if (ground == levels.end()) return std::nullopt;
  const double low = ground->z + 1.5, z = low + share * std::max(0.0, scene.bounds.max.z - low);
  const auto above =
      std::find_if(levels.begin(), levels.end(), [&](const Level& level) { return level.z >= z; });
  if (above != levels.end() && above->up) return std::nullopt;  // below a solid's top, hence inside it
  return dvec3(at, z);
}

}  // namespace

sim::Scenario frozen_for_recall(sim::Scenario scenario, const RecallPaths& sought) {
  if (scenario.channels.empty())
    throw_user_error(
        "{}: channels: expected one at least, whose transmitter the paths start from; found none",
        scenario.name);
  scenario.channels.resize(1);
  sim::ChannelConfig& channel = scenario.channels[0];
  channel.limits.max_depth = sought.max_depth;
  channel.limits.max_transmissions = sought.max_transmissions;
  channel.limits.max_reflections_beside_diffraction = rf::PathLimits{}.max_reflections_beside_diffraction;
  channel.limits.max_diffractions = std::max(1u, sought.edges);
  channel.limits.two_edge_floor_db = 1000.0;  // the reference has no floor
  channel.search = sim::ChannelConfig::Search::automatic;
  const sim::World world = sim::load_world(scenario);
  const auto paths = sim::make_courses(scenario, world, 0).nodes;
  for (size_t i = 0; i < scenario.nodes.size(); ++i) {
    sim::NodeConfig& node = scenario.nodes[i];
    node.parts.clear();
    if (std::holds_alternative<sim::StaticTrajectory>(node.trajectory)) continue;
    const Pose pose = paths[i]->at(0.0).pose;
    node.trajectory = sim::StaticTrajectory{pose.position, angles_of(pose.orientation)};
    if (channel.transmitters[0].starts_with(node.name + "/")) node.model.reset();
  }
  scenario.effects.clear();
  scenario.effects["moving_reflectors"] = sim::Switch::off;
  const auto only_if = [](bool on) { return on ? sim::Switch::on : sim::Switch::off; };
  scenario.effects["transmission"] = only_if(sought.max_transmissions > 0);
  scenario.effects["diffraction"] = only_if(sought.edges > 0);
  scenario.effects["scattering"] = only_if(sought.scattering > 0);
  channel.limits.max_scatterings = std::max(1u, sought.scattering);
  channel.limits.scattering_beside_diffraction = sought.scattering > 1;
  return scenario;
}

dvec3 transmitter_position(const sim::Scenario& scenario, const sim::World& world,
                           const sim::Moment& moment) {
  const auto [node, sensor] = sim::sensor_place(scenario, scenario.channels[0].transmitters[0]);
  const Pose mount = sim::mount_pose(scenario.nodes[node].sensors[sensor].mount);
  return world.scene.to_local((moment.motions[node].pose * mount).position);
}

std::vector<dvec3> draw_receivers(const scene::Scene& scene, uint64_t seed, uint32_t count) {
  constexpr uint32_t tries = 10000;
  std::vector<dvec3> receivers;
  for (uint32_t i = 0; i < count; ++i) {
    RandomStream random(seed, 0x72656376u, i);
    std::optional<dvec3> found;
    for (uint32_t t = 0; t < tries && !found; ++t) {
      const double x = random.uniform(scene.bounds.min.x, scene.bounds.max.x);
      const double y = random.uniform(scene.bounds.min.y, scene.bounds.max.y);
      const double share = random.uniform(0.0, 1.0);
      found = place(scene, {x, y}, i % 2 == 0 ? 0.0 : share);
    }
    if (!found)
      throw_user_error("{}: no place for a receiver: expected ground with room above, found none in {} draws",
                       scene.name, tries);
    receivers.push_back(*found + scene.origin);
  }
  return receivers;
}

}  // namespace greatx::apps
