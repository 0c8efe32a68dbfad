// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/parts.h"

#include <algorithm>
#include <cmath>
#include <fnmatch.h>
#include <span>

#include <fmt/format.h>

#include "scene/generator/objects/shapes.h"

namespace greatx::sim {

namespace {

void check_apart(const NodeConfig& node, const scene::Model& model, const std::vector<FoundPart>& parts) {
  for (size_t i = 0; i < parts.size(); ++i)
    for (size_t j = 0; j < parts.size(); ++j) {
      if (i == j || parts[i].placement.node != parts[j].placement.node) continue;
      throw_user_error_at(parts[j].config->where,
                          "model.parts of node '{}': expected every node once, found '{}' twice", node.name,
                          model.nodes[parts[j].placement.node].name);
    }
}

scene::PartPlacement placement_of(const std::string& name, uint32_t node, const PartConfig& config) {
  scene::PartPlacement part{name, node, config.axis};
  if (const auto* limb = std::get_if<LimbConfig>(&config.motion)) {
    const Gait::Range range = Gait::range(limb->walker, limb->limb);
    part.least_angle = range.least;
    part.most_angle = range.most;
  }
  if (const auto* pedal = std::get_if<PedalConfig>(&config.motion); pedal != nullptr && pedal->limb) {
    const Gait::Range range = Pedalling::range(pedal->cyclist, *pedal->limb);
    part.least_angle = range.least;
    part.most_angle = range.most;
  }
  return part;
}

Cyclist cyclist_of(const scene::BicycleShape& shape) {
  Cyclist cyclist;
  cyclist.thigh_m = shape.thigh_m;
  cyclist.shank_m = shape.shank_m;
  cyclist.forward_m = shape.bracket_m.x - shape.hip_m.x;
  cyclist.down_m = shape.hip_m.z - shape.bracket_m.z;
  cyclist.crank_m = shape.crank_m;
  cyclist.ball_m = shape.ball_m;
  cyclist.pedal_m = shape.pedal_m;
  cyclist.rest = shape.rest;
  cyclist.development_m = shape.development_m();
  return cyclist;
}

std::string unique_name(const std::string& wanted, std::span<const FoundPart> parts) {
  std::string name = wanted;
  for (size_t number = 2;
       std::ranges::any_of(parts, [&](const FoundPart& part) { return part.placement.name == name; });)
    name = fmt::format("{}_{}", wanted, number++);
  return name;
}

}  // namespace

std::vector<PartConfig> parts_of(const Scenario& scenario, const NodeConfig& node) {
  const bool in_traffic = std::holds_alternative<TrafficTrajectory>(node.trajectory) ||
                          std::holds_alternative<TrackTrajectory>(node.trajectory);
  if (!in_traffic || !scenario.traffic || !scenario.traffic->limbs) return node.parts;
  const auto& made = std::get<Generated>(node.model->source);
  std::vector<PartConfig> parts;
  const auto add = [&](const std::string& name, const PartMotion& motion) {
    parts.push_back({{name}, {0.0, 1.0, 0.0}, motion, std::nullopt, node.where});
  };
  if (made.kind == "vehicle") {
    for (const scene::VehicleShape::Wheel& wheel : scene::vehicle_shape(made.variant).wheels)
      add(wheel.node, RollConfig{wheel.radius_m});
    if (const std::optional<scene::BicycleShape> bicycle = scene::bicycle_shape(made.variant)) {
      const Cyclist cyclist = cyclist_of(*bicycle);
      add("crank", PedalConfig{std::nullopt, true, cyclist});
      for (const bool left : {true, false})
        for (const auto& [limb, name] : {std::pair{Limb::thigh, "thigh"}, std::pair{Limb::shank, "shank"}})
          add(fmt::format("{}_{}", name, left ? "left" : "right"), PedalConfig{limb, left, cyclist});
    }
  }
  if (made.kind == "person") {
    const scene::PersonShape& shape = scene::person_shape(made.variant);
    // Short legs walk as fast as they can at the same effort (Froude number).
    const Walker walker{shape.thigh_m, shape.shank_m, 1.34 * std::sqrt(shape.hip_m / 0.94)};
    for (const bool left : {true, false}) {
      const std::string side = left ? "left" : "right";
      add(fmt::format("thigh_{}", side), LimbConfig{Limb::thigh, left, walker});
      add(fmt::format("shank_{}", side), LimbConfig{Limb::shank, left, walker});
      add(fmt::format("upper_arm_{}", side), LimbConfig{Limb::upper_arm, left, walker});
      add(fmt::format("forearm_{}", side), LimbConfig{Limb::forearm, left, walker});
    }
  }
  return parts;
}

std::vector<FoundPart> find_parts(const NodeConfig& node, const std::vector<PartConfig>& configs,
                                  const scene::Model& model) {
  std::vector<FoundPart> parts;
  for (const PartConfig& config : configs)
    for (const std::string& pattern : config.nodes) {
      const size_t before = parts.size();
      for (uint32_t i = 0; i < model.nodes.size(); ++i)
        if (const std::string& name = model.nodes[i].name; fnmatch(pattern.c_str(), name.c_str(), 0) == 0)
          parts.push_back({placement_of(name, i, config), &config});
      if (parts.size() == before)
        throw_user_error_at(config.where, "model.parts of node '{}': expected a node of {} ({}), found '{}'",
                            node.name, model.file.filename().string(), scene::node_names(model), pattern);
    }
  check_apart(node, model, parts);
  std::ranges::sort(parts, {}, [](const FoundPart& part) { return part.placement.node; });
  for (size_t i = 0; i < parts.size(); ++i)
    parts[i].placement.name =
        unique_name(model.nodes[parts[i].placement.node].name, std::span(parts).first(i));
  return parts;
}

}  // namespace greatx::sim
