// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/world.h"

#include <algorithm>
#include <exception>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "core/expected.h"
#include "core/parallel.h"
#include "rf/surface/surfaces.h"
#include "scene/build/build.h"
#include "scene/generator/generate.h"
#include "sim/world/parts.h"
#include "sim/world/solids.h"
#include "sim/world/traffic.h"

namespace greatx::sim {

namespace {

scene::Model load(const ModelSource& source, const SceneConfig& config) {
  const scene::LoadOptions options{config.radio_materials, config.optical_only};
  if (const auto* file = std::get_if<std::filesystem::path>(&source.source))
    return scene::load_model(*file, options);
  const Generated& made = std::get<Generated>(source.source);
  try {
    const std::vector<std::byte> glb = scene::generate_glb({.kind = made.kind,
                                                            .seed = made.seed,
                                                            .size_m = made.size_m,
                                                            .variant = made.variant,
                                                            .quick = true});
    return scene::load_model(made.kind + ".glb", glb, options);
  } catch (const UserError& error) {
    throw_user_error_at(source.where, "{}", error.what());
  }
}

/// Loads models on all cores. With `shared`, a generated one that is asked for several times is made once.
class LoadedModels {
 public:
  LoadedModels(std::span<const ModelSource* const> sources, const SceneConfig& config, bool shared) {
    for (const ModelSource* source : sources) {
      const auto known = std::ranges::find_if(
          loads_, [&](const Load& load) { return shared && made_alike(*load.source, *source); });
      load_of_[source] = static_cast<size_t>(known - loads_.begin());
      if (known == loads_.end()) loads_.push_back({source, std::nullopt, nullptr});
    }
    parallel_for(loads_.size(), 0, [&](size_t i) {
      try {
        loads_[i].model = load(*loads_[i].source, config);
      } catch (const Interrupted&) {
        throw;
      } catch (...) {
        loads_[i].failure = std::current_exception();
      }
    });
  }
  /// Returns the model of a source. Throws what its loading has thrown: the first fault in the order in which
  /// models are asked for is then the one that is reported.
  scene::Model& of(const ModelSource& source) {
    Load& load = loads_[load_of_.at(&source)];
    if (load.failure) std::rethrow_exception(load.failure);
    return *load.model;
  }

 private:
  struct Load {
    const ModelSource* source;
    std::optional<scene::Model> model;
    std::exception_ptr failure;
  };
  static bool made_alike(const ModelSource& a, const ModelSource& b) {
    return std::holds_alternative<Generated>(a.source) && a.source == b.source;
  }

  std::vector<Load> loads_;  ///< placements point at the models
  std::map<const ModelSource*, size_t> load_of_;
};

std::optional<scene::SemanticClass> semantic_class(const std::optional<std::string>& name,
                                                   const SourceLocation& where) {
  if (!name) return std::nullopt;
  const std::vector<std::string>& names = scene::semantic_class_names();
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == *name) return static_cast<scene::SemanticClass>(i);
  throw_user_error_at(where, "class: {}", expected_one_of(names, *name));
}

dquat orientation_of(const dvec3& yaw_pitch_roll) {
  return orientation_from_yaw_pitch_roll(yaw_pitch_roll.x, yaw_pitch_roll.y, yaw_pitch_roll.z);
}

bool stands_still(const NodeConfig& node) {
  return std::holds_alternative<StaticTrajectory>(node.trajectory) && node.parts.empty();
}

bool is_target(const Scenario& scenario, size_t node) {
  return std::ranges::any_of(scenario.channels, [&](const ChannelConfig& channel) {
    return std::ranges::any_of(channel.targets, [&](const TargetConfig& t) { return t.node == node; });
  });
}

/// Returns whether the node's mesh is part of the static world. The mesh of a target is a body of its own,
/// since it must not hide the target's centre.
bool never_moves(const Scenario& scenario, size_t node) {
  return stands_still(scenario.nodes[node]) && !is_target(scenario, node);
}

/// Checks materials before anything runs: one without a row at a carrier is an error of the scenario.
void check_radio(const Scenario& scenario, const scene::Scene& scene) {
  const auto check = [&](double carrier_hz, const SourceLocation& where, const std::string& field,
                         const std::string& what) {
    try {
      const rf::RadioSurfaces surfaces(scene, carrier_hz);
    } catch (const UserError& error) {
      throw_user_error_at(where, "{}: {}: {}", field, what, error.what());
    }
  };
  for (size_t i = 0; i < scenario.channels.size(); ++i) {
    const ChannelConfig& channel = scenario.channels[i];
    check(channel.carrier_hz, channel.where, fmt::format("channels[{}].carrier_hz", i),
          fmt::format("channel '{}'", channel.name));
  }
  for (size_t n = 0; n < scenario.nodes.size(); ++n)
    for (size_t s = 0; s < scenario.nodes[n].sensors.size(); ++s) {
      const SensorConfig& sensor = scenario.nodes[n].sensors[s];
      if (const auto* radar = std::get_if<RadarConfig>(&sensor.config))
        check(radar->signal.waveform.carrier_hz, sensor.where,
              fmt::format("nodes[{}].sensors[{}].waveform.carrier_hz", n, s),
              fmt::format("radar '{}'", sensor.name));
    }
}

void check_optical_only(const Scenario& scenario) {
  if (scenario.scene.optical_only && !scenario.channels.empty())
    throw_user_error_at(scenario.channels[0].where,
                        "channel '{}': scene.optical_only says that materials may lack radio properties; "
                        "expected false in a scenario with channels",
                        scenario.channels[0].name);
  if (scenario.scene.optical_only)
    for (const NodeConfig& node : scenario.nodes)
      for (const SensorConfig& sensor : node.sensors)
        if (std::holds_alternative<RadarConfig>(sensor.config))
          throw_user_error_at(sensor.where,
                              "radar '{}': scene.optical_only says that materials may lack radio properties; "
                              "expected false in a scenario with radars",
                              sensor.name);
}

/// Checks that a file still says of its place what it said when the scenario was parsed.
void check_georeference(const scene::Model& model, const StaticObject& object, const SceneConfig& config) {
  if (model.georeference && model.georeference != config.georeference)
    throw_user_error_at(object.model.where,
                        "scene: expected the georeference that '{}' had when the scenario was read, found "
                        "another one",
                        model.file.string());
}

bool same_source(const ModelSource& a, const ModelSource& b) { return a.source == b.source; }

bool same_object(const StaticObject& a, const StaticObject& b) {
  return same_source(a.model, b.model) &&
         std::tie(a.name, a.position_m, a.rotation, a.scale, a.semantic_class) ==
             std::tie(b.name, b.position_m, b.rotation, b.scale, b.semantic_class);
}

bool same_part(const PartConfig& a, const PartConfig& b) {
  return std::tie(a.nodes, a.axis, a.motion, a.phase) == std::tie(b.nodes, b.axis, b.motion, b.phase);
}

/// Whether the node puts the same model into the world, at the same place if it never moves.
bool same_body(const NodeConfig& a, const NodeConfig& b) {
  if (a.name != b.name || a.model.has_value() != b.model.has_value()) return false;
  if (!a.model) return true;
  if (stands_still(a) != stands_still(b)) return false;
  if (stands_still(a)) {
    const auto &x = std::get<StaticTrajectory>(a.trajectory), &y = std::get<StaticTrajectory>(b.trajectory);
    if (x.position_m != y.position_m || x.rotation != y.rotation) return false;
  }
  return same_source(*a.model, *b.model) && std::ranges::equal(a.parts, b.parts, same_part) &&
         std::tie(a.model_mount.position_m, a.model_mount.rotation, a.model_scale, a.semantic_class) ==
             std::tie(b.model_mount.position_m, b.model_mount.rotation, b.model_scale, b.semantic_class);
}

/// Whether the same nodes have bodies of their own.
bool same_bodies(const Scenario& a, const Scenario& b) {
  for (size_t node = 0; node < std::min(a.nodes.size(), b.nodes.size()); ++node)
    if (never_moves(a, node) != never_moves(b, node)) return false;
  return true;
}

/// Finds the carrier and the part of each body. `parts` have their names, and nodes their bodies.
void find_bodies(World& world) {
  const scene::Scene& scene = world.scene;
  world.node_of_body.resize(scene.bodies.size());
  world.part_of_body.resize(scene.bodies.size(), World::no_part);
  for (uint32_t node = 0; node < world.body_of_node.size(); ++node)
    if (const uint32_t body = world.body_of_node[node]; body != 0) world.node_of_body[body] = node;
  for (uint32_t i = 0; i < world.parts.size(); ++i) {
    Part& part = world.parts[i];
    part.body = scene.body_index(part.name);
    world.part_of_body[part.body] = i;
    world.node_of_body[part.body] = world.node_of_body[scene.owner_of(part.body)];
  }
}

}  // namespace

MadeSolids::MadeSolids() = default;
MadeSolids::~MadeSolids() = default;

const Solids& MadeSolids::of(const scene::Scene& scene) const {
  std::call_once(once_, [&] { solids_ = std::make_unique<const Solids>(scene); });
  return *solids_;
}

bool same_world(const Scenario& a, const Scenario& b) {
  return a.name == b.name && a.scene.origin_m == b.scene.origin_m &&
         a.scene.georeference == b.scene.georeference && a.scene.radio_materials == b.scene.radio_materials &&
         a.scene.optical_only == b.scene.optical_only &&
         std::ranges::equal(a.scene.objects, b.scene.objects, same_object) &&
         std::ranges::equal(a.nodes, b.nodes, same_body) && same_bodies(a, b) && a.traffic == b.traffic;
}

void check_world(const Scenario& scenario, const World& world) {
  check_optical_only(scenario);
  check_radio(scenario, world.scene);
}

World load_world(const Scenario& scenario) {
  check_optical_only(scenario);
  World world;
  std::vector<const ModelSource*> sources;
  for (const StaticObject& object : scenario.scene.objects) sources.push_back(&object.model);
  LoadedModels objects(sources, scenario.scene, false);
  SignalHeads signals;
  std::vector<scene::ModelPlacement> placements;
  for (const StaticObject& object : scenario.scene.objects) {
    scene::Model& model = objects.of(object.model);
    check_georeference(model, object, scenario.scene);
    if (scenario.traffic && !world.streets) world.streets = streets_of(scenario, model, object);
    if (model.streets) add_signals(signals, object.name, *model.streets);
    placements.push_back({object.name,
                          &model,
                          {object.position_m, orientation_of(object.rotation)},
                          object.scale,
                          false,
                          semantic_class(object.semantic_class, object.model.where),
                          {}});
  }
  check_traffic(scenario, world);  // before as many models are loaded as the scenario asks for
  sources.clear();
  for (const NodeConfig& node : scenario.nodes)
    if (node.model) sources.push_back(&*node.model);
  LoadedModels bodies(sources, scenario.scene, true);
  for (size_t index = 0; index < scenario.nodes.size(); ++index) {
    const NodeConfig& node = scenario.nodes[index];
    const bool fixed_in_world = never_moves(scenario, index);
    if (!node.model) continue;
    scene::Model& model = bodies.of(*node.model);
    if (model.georeference)
      model.notes.push_back(fmt::format("{}: its georeference is not used, since node '{}' places it",
                                        model.file.string(), node.name));
    Pose pose{node.model_mount.position_m, orientation_of(node.model_mount.rotation)};
    if (fixed_in_world) {
      const auto& fixed = std::get<StaticTrajectory>(node.trajectory);
      pose = Pose{fixed.position_m, orientation_of(fixed.rotation)} * pose;
    }
    placements.push_back({node.name,
                          &model,
                          pose,
                          node.model_scale,
                          !fixed_in_world,
                          semantic_class(node.semantic_class, node.where),
                          {}});
    const std::vector<PartConfig> configs = parts_of(scenario, node);
    for (FoundPart& part : find_parts(node, configs, model)) {
      world.parts.push_back(
          {node.name + "/" + part.placement.name, 0, part.config->motion, part.config->phase});
      placements.back().parts.push_back(std::move(part.placement));
    }
  }
  world.scene = scene::build_scene(placements, {.name = scenario.name,
                                                .origin = scenario.scene.origin_m,
                                                .georeference = scenario.scene.georeference});
  for (size_t index = 0; index < scenario.nodes.size(); ++index) {
    const NodeConfig& node = scenario.nodes[index];
    const bool own_body = node.model && !never_moves(scenario, index);
    world.body_of_node.push_back(own_body ? world.scene.body_index(node.name) : 0);
  }
  find_bodies(world);
  world.lamps = Lamps(world.scene, world.node_of_body, signals);
  check_radio(scenario, world.scene);
  return world;
}

}  // namespace greatx::sim
