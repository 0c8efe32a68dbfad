// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/traffic.h"

#include <algorithm>

#include "scene/generator/objects/shapes.h"
#include "sim/traffic/course.h"

namespace greatx::sim {
namespace {

/// People take the room of a step.
constexpr Extent person_extent{0.45, 0.45, 0.55};

TrafficBody body_of(const TrafficMember& member) {
  if (member.kind == TrafficMember::Kind::pedestrian) return {member.kind, person_extent, 0.0};
  const scene::VehicleShape& shape = scene::vehicle_shape(member.variant);
  const double half = 0.5 * shape.length_m;
  // The width of four-wheelers is without their mirrors.
  const double width = shape.two_wheeler ? shape.width_m : shape.width_m + 0.2;
  return {member.kind, {half - shape.rear_axle_x_m, half + shape.rear_axle_x_m, width}, -shape.rear_axle_x_m};
}

std::vector<TrafficBody> bodies_of(const TrafficConfig& traffic) {
  std::vector<TrafficBody> bodies;
  for (const TrafficMember& member : traffic.members) bodies.push_back(body_of(member));
  return bodies;
}

LargestVehicles largest_of(const TrafficConfig& traffic) {
  LargestVehicles all(Extent{0.0, 0.0, 0.0});
  for (const TrafficBody& body : bodies_of(traffic)) {
    if (body.kind == TrafficMember::Kind::pedestrian) continue;
    const bool is_longer = size_of(body.extent) == VehicleSize::longer;
    if (is_longer && !all.longer) all.longer = Extent{0.0, 0.0, 0.0};
    Extent& largest = is_longer ? *all.longer : all.ordinary;
    largest = {std::max(largest.front_m, body.extent.front_m), std::max(largest.rear_m, body.extent.rear_m),
               std::max(largest.width_m, body.extent.width_m)};
  }
  return all;
}

std::shared_ptr<Simulation> simulation_of(const Scenario& scenario, const World& world, uint32_t sequence) {
  return std::make_shared<Simulation>(world.streets, bodies_of(*scenario.traffic), *scenario.traffic,
                                      sequence);
}

}  // namespace

std::shared_ptr<const Streets> streets_of(const Scenario& scenario, const scene::Model& model,
                                          const StaticObject& object) {
  if (!model.streets || !scenario.traffic || scenario.traffic->members.empty()) return nullptr;
  if (object.scale != dvec3(1.0))
    throw_user_error_at(object.model.where,
                        "scale of a scene with streets: expected 1 beside 'traffic', found "
                        "[{}, {}, {}]",
                        object.scale.x, object.scale.y, object.scale.z);
  const Pose pose{object.position_m,
                  orientation_from_yaw_pitch_roll(object.rotation.x, object.rotation.y, object.rotation.z)};
  return std::make_shared<const Streets>(scene::placed(*model.streets, pose), largest_of(*scenario.traffic),
                                         model.file.string());
}

void check_traffic(const Scenario& scenario, const World& world) {
  if (!scenario.traffic || scenario.traffic->members.empty()) return;
  if (!world.streets)
    throw_user_error_at(scenario.traffic->where,
                        "traffic: expected a scene with streets (generate: {{kind: city}}, a place whose map "
                        "has ways, or greatx_streets in a glTF file), found none");
  simulation_of(scenario, world, 0);
}

std::vector<std::unique_ptr<Course>> WorldTraffic::courses(uint32_t sequence) const {
  const std::shared_ptr<Simulation> simulation = simulation_of(scenario_, world_, sequence);
  std::vector<std::unique_ptr<Course>> courses;
  for (uint32_t member = 0; member < scenario_.traffic->members.size(); ++member)
    courses.push_back(make_traffic_course(simulation, member));
  return courses;
}

}  // namespace greatx::sim
