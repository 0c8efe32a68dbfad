// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/moment.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "core/hash.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/world/free_space.h"

namespace greatx::sim {

Courses make_courses(const Scenario& scenario, const World& world, uint32_t sequence) {
  Courses courses;
  std::optional<WorldFreeSpace> space;
  if (std::ranges::any_of(scenario.nodes, [](const NodeConfig& node) { return clearance_of(node) > 0.0; }))
    space.emplace(scenario, world);
  NodeCourses made = make_node_courses(scenario, sequence, space ? &*space : nullptr);
  courses.nodes = std::move(made.courses);
  courses.draws = std::move(made.draws);
  for (const Part& part : world.parts) {
    const double start_turns = part.phase
                                   ? *part.phase / (2.0 * pi)
                                   : RandomStream(scenario.seed, fnv1a32(part.name), sequence).uniform();
    courses.rotations.emplace_back(scenario.tick_rate_hz, part.rate, start_turns);
  }
  return courses;
}

Motion body_motion(const World& world, const Courses& courses, uint32_t body, double time_s) {
  if (body == 0) return {};
  GREATX_CHECK(body < world.node_of_body.size(), "body {} of {}", body, world.node_of_body.size());
  Motion motion = courses.nodes[world.node_of_body[body]]->at(time_s);
  motion.pose = world.scene.to_local(motion.pose);
  if (!world.scene.bodies[body].joint) return motion;
  const scene::Joint& joint = *world.scene.bodies[body].joint;
  const Rotation& rotation = courses.rotations[world.part_of_body[body]];
  const dvec3 arm = motion.pose.rotate(joint.position), spin = motion.pose.rotate(joint.axis);
  const dvec3 turning = motion.angular_velocity;
  motion.pose = motion.pose * joint.pose(2.0 * pi * rotation.turns(time_s));
  motion.velocity += glm::cross(turning, arm);
  motion.acceleration += glm::cross(turning, glm::cross(turning, arm));
  motion.angular_velocity += 2.0 * pi * rotation.rate_hz() * spin;
  return motion;
}

std::vector<Pose> body_poses(const World& world, const Courses& courses, double time_s) {
  std::vector<Pose> poses;
  for (uint32_t body = 0; body < world.scene.bodies.size(); ++body)
    poses.push_back(body_motion(world, courses, body, time_s).pose);
  return poses;
}

Moment moment_at(const World& world, const Courses& courses, const Clock& clock, int64_t tick,
                 int64_t previous) {
  Moment moment;
  const double time_s = clock.seconds(tick);
  for (const auto& node : courses.nodes) moment.motions.push_back(node->at(time_s));
  moment.bodies = body_poses(world, courses, time_s);
  moment.context.tick = tick;
  moment.context.time_s = time_s;
  moment.context.previous_time_s =
      previous < 0 ? std::numeric_limits<double>::quiet_NaN() : clock.seconds(previous);
  moment.context.nodes = moment.motions;
  moment.context.body_poses = moment.bodies;
  moment.context.motion_at = [&courses](uint32_t node, double time) { return courses.nodes[node]->at(time); };
  moment.context.body_motion_at = [&world, &courses](uint32_t body, double time) {
    return body_motion(world, courses, body, time);
  };
  return moment;
}

}  // namespace greatx::sim
