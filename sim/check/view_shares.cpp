// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/check/view_shares.h"

#include <algorithm>
#include <optional>

#include "renderer/lens/lens_rays.h"
#include "sim/plan/camera_desc.h"
#include "sim/world/solids.h"

namespace greatx::sim {
namespace {

constexpr uint32_t columns = 24, rows = 18;

/// x forward, y left, z up. Pixels outside an image circle have none.
std::vector<dvec3> directions_of(const PinholeConfig& picture, const std::string& name) {
  std::vector<dvec3> directions;
  std::optional<render::LensRays> wide;
  if (picture.wide.any())
    wide.emplace(render::LensGeometry{name,
                                      picture.width,
                                      picture.height,
                                      picture.fx,
                                      picture.fy,
                                      picture.cx,
                                      picture.cy,
                                      {},
                                      picture.wide});
  for (uint32_t row = 0; row < rows; ++row)
    for (uint32_t column = 0; column < columns; ++column) {
      const double x = (column + 0.5) / columns * picture.width, y = (row + 0.5) / rows * picture.height;
      if (wide) {
        if (const dvec3 d = wide->ray({x, y}); d != dvec3(0.0)) directions.emplace_back(d.z, -d.x, -d.y);
        continue;
      }
      directions.push_back(
          glm::normalize(dvec3(1.0, -(x - picture.cx) / picture.fx, -(y - picture.cy) / picture.fy)));
    }
  return directions;
}

bool is_ground(const scene::Scene& scene, uint32_t facet) {
  using enum scene::SemanticClass;
  switch (scene.instances[scene.facets[facet].instance].semantic_class) {
    case ground:
    case road:
    case pavement:
    case lane_marking:
    case water:
      return true;
    case unlabeled:
      return scene.facets[facet].body == 0 && scene.facets[facet].normal.z > 0.9;
    default:
      return false;
  }
}

}  // namespace

std::vector<CameraView> camera_views(const Experiment& experiment) {
  std::vector<CameraView> views;
  for (uint32_t i = 0; i < experiment.scenario.nodes.size(); ++i)
    for (const SensorConfig& sensor : experiment.scenario.nodes[i].sensors)
      if (const PinholeConfig* picture = pinhole_config(sensor)) {
        const std::string name = experiment.scenario.nodes[i].name + "/" + sensor.name;
        views.push_back({name, i, experiment.world->body_of_node[i], mount_pose(sensor.mount),
                         directions_of(*picture, name)});
      }
  return views;
}

ViewShares view_shares(const World& world, const CameraView& view, const TickContext& context) {
  const Pose pose = world.scene.to_local(context.nodes[view.node].pose) * view.mount;
  size_t sky = 0, ground = 0;
  for (const dvec3& direction : view.directions) {
    const std::optional<uint32_t> facet = world.solids().surfaces().first_seen(
        pose.position, pose.rotate(direction), context.body_poses, view.body);
    if (!facet)
      ++sky;
    else
      ground += is_ground(world.scene, *facet);
  }
  const auto rays = static_cast<double>(std::max<size_t>(view.directions.size(), 1));
  return {static_cast<double>(sky) / rays, static_cast<double>(ground) / rays};
}

}  // namespace greatx::sim
