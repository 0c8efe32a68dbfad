// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/instance_boxes.h"

#include <algorithm>

namespace greatx::sim {

namespace {

/// Returns the box that a part sweeps about the origin of its joint: that of a ball.
scene::Bounds swept(const scene::Bounds& bounds, const dvec3& origin) {
  const double radius = glm::length(glm::max(glm::abs(bounds.min), glm::abs(bounds.max)));
  scene::Bounds ball;
  ball.add(origin - dvec3(radius));
  ball.add(origin + dvec3(radius));
  return ball;
}

}  // namespace

std::vector<InstanceBox> instance_boxes(const World& world) {
  const scene::Scene& scene = world.scene;
  std::vector<InstanceBox> boxes;
  for (const scene::Instance& instance : scene.instances) {
    InstanceBox& result = boxes.emplace_back();
    result.box = instance.bounds;
    if (result.box.empty()) continue;
    if (instance.body == 0) {
      result.box.min += scene.origin;
      result.box.max += scene.origin;
      continue;
    }
    // From joint to joint up to the body that carries them all.
    for (uint32_t body = instance.body; scene.bodies[body].joint; body = scene.bodies[body].joint->owner) {
      const scene::Joint& joint = *scene.bodies[body].joint;
      result.box = joint.limited() ? joint.reach(result.box) : swept(result.box, joint.position);
    }
    result.node = world.node_of_body[scene.owner_of(instance.body)];
  }
  return boxes;
}

}  // namespace greatx::sim
