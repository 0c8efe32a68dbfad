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
#include "sim/world/lamps.h"
#include "sim/world/traffic.h"

namespace greatx::sim {

Courses make_courses(const Scenario& scenario, const World& world, uint32_t sequence) {
  Courses courses;
  std::optional<WorldFreeSpace> space;
  if (std::ranges::any_of(scenario.nodes, [](const NodeConfig& node) { return clearance_of(node) > 0.0; }))
    space.emplace(scenario, world);
  std::optional<WorldTraffic> traffic;
  if (scenario.traffic && world.streets) traffic.emplace(scenario, world);
  NodeCourses made =
      make_node_courses(scenario, sequence, space ? &*space : nullptr, traffic ? &*traffic : nullptr);
  courses.nodes = std::move(made.courses);
  courses.draws = std::move(made.draws);
  std::vector<bool> walks(courses.nodes.size());
  for (const Part& part : world.parts) {
    const uint32_t node = world.node_of_body[part.body];
    const auto* limb = std::get_if<LimbConfig>(&part.motion);
    const bool steps = limb != nullptr || std::holds_alternative<PedalConfig>(part.motion);
    const uint32_t stream = fnv1a32(steps ? scenario.nodes[node].name + "/steps" : part.name);
    const double start =
        part.phase ? *part.phase / (2.0 * pi) : RandomStream(scenario.seed, stream, sequence).uniform();
    courses.turns.push_back(make_part_turn(part.motion, scenario.tick_rate_hz, start));
    if (limb == nullptr || limb->limb != Limb::thigh || walks[node]) continue;
    walks[node] = true;
    courses.nodes[node] = walking(std::move(courses.nodes[node]), Gait(limb->walker, start));
  }
  return courses;
}

namespace {

/// Returns the motion of a part from that of its carrier.
Motion turned(Motion motion, const scene::Joint& joint, const Turned& turn) {
  const dvec3 arm = motion.pose.rotate(joint.position), spin = motion.pose.rotate(joint.axis);
  const dvec3 turning = motion.angular_velocity;
  motion.pose = motion.pose * joint.pose(turn.value);
  motion.velocity += glm::cross(turning, arm);
  motion.acceleration += glm::cross(turning, glm::cross(turning, arm));
  motion.angular_velocity += turn.rate * spin;
  return motion;
}

/// How far nodes have travelled, found when it is first asked for.
class Travels {
 public:
  Travels(const Courses& courses, double time_s) : courses_(courses), time_s_(time_s) {}
  Turned turn(const PartTurn& turn, uint32_t node) {
    if (turn.pedals()) return turn.at(pedalled(node), time_s_);
    if (turn.travels() && node != node_) {
      node_ = node;
      travel_ = courses_.nodes[node]->travel(time_s_);
    }
    return turn.at(travel_, time_s_);
  }

 private:
  const Travel& pedalled(uint32_t node) {
    if (node == pedal_node_) return pedalled_;
    pedal_node_ = node;
    return pedalled_ = courses_.nodes[node]->pedalled(time_s_);
  }

  const Courses& courses_;
  double time_s_;
  uint32_t node_ = ~0u, pedal_node_ = ~0u;
  Travel travel_, pedalled_;
};

/// Returns the motions of all bodies from those of the nodes, world frame.
std::vector<Motion> body_motions(const World& world, const Courses& courses, std::span<const Motion> nodes,
                                 double time_s) {
  std::vector<Motion> motions(world.scene.bodies.size());
  Travels travels(courses, time_s);
  for (uint32_t body = 1; body < motions.size(); ++body) {
    const uint32_t node = world.node_of_body[body];
    if (const auto& joint = world.scene.bodies[body].joint) {
      const Turned turn = travels.turn(courses.turns[world.part_of_body[body]], node);
      motions[body] = turned(motions[joint->owner], *joint, turn);
    } else {
      motions[body] = nodes[node];
      motions[body].pose = world.scene.to_local(motions[body].pose);
    }
  }
  return motions;
}

/// Returns the motion of a body by going up the chain of joints that carry it.
Motion chain_motion(const World& world, const Courses& courses, uint32_t body, double time_s,
                    Travels& travels) {
  const uint32_t node = world.node_of_body[body];
  if (const auto& joint = world.scene.bodies[body].joint)
    return turned(chain_motion(world, courses, joint->owner, time_s, travels), *joint,
                  travels.turn(courses.turns[world.part_of_body[body]], node));
  Motion motion = courses.nodes[node]->at(time_s);
  motion.pose = world.scene.to_local(motion.pose);
  return motion;
}

std::vector<Pose> poses_of(std::span<const Motion> motions) {
  std::vector<Pose> poses;
  for (const Motion& motion : motions) poses.push_back(motion.pose);
  return poses;
}

std::vector<Motion> node_motions(const Courses& courses, double time_s) {
  std::vector<Motion> motions;
  for (const auto& node : courses.nodes) motions.push_back(node->at(time_s));
  return motions;
}

}  // namespace

Motion body_motion(const World& world, const Courses& courses, uint32_t body, double time_s) {
  if (body == 0) return {};
  GREATX_CHECK(body < world.node_of_body.size(), "body {} of {}", body, world.node_of_body.size());
  Travels travels(courses, time_s);
  return chain_motion(world, courses, body, time_s, travels);
}

std::vector<Pose> body_poses(const World& world, const Courses& courses, double time_s) {
  return poses_of(body_motions(world, courses, node_motions(courses, time_s), time_s));
}

Moment moment_at(const World& world, const Courses& courses, const Clock& clock, int64_t tick,
                 int64_t previous) {
  Moment moment;
  const double time_s = clock.seconds(tick);
  moment.motions = node_motions(courses, time_s);
  moment.bodies = poses_of(body_motions(world, courses, moment.motions, time_s));
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
  if (!world.lamps.empty())
    moment.context.lamps_at = [&world, &courses](double time) { return world.lamps.factors(courses, time); };
  moment.context.body_poses_of = [&world, &courses](double time) { return body_poses(world, courses, time); };
  return moment;
}

}  // namespace greatx::sim
