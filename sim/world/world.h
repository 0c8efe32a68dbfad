// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the scenario's models, loaded and put together: the scene that every sequence shares.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scene/description/scene.h"
#include "sim/scenario/scenario.h"
#include "sim/world/lamps.h"

namespace greatx::sim {

/// Describes a body that turns on its node's body, or on another part: a rotor, a wheel, a limb.
struct Part {
  std::string name;  ///< the name of its body, NODE/PART, by which its start is drawn
  uint32_t body = 0;
  PartMotion motion;
  std::optional<double> phase;  ///< rad at tick 0, or of a limb's cycle at the start; none: drawn
};

class Streets;

class Solids;

/// Makes the Solids of a scene when they are first asked for. A copy makes its own, since its scene is
/// another object.
class MadeSolids {
 public:
  MadeSolids();
  ~MadeSolids();
  MadeSolids(const MadeSolids&) : MadeSolids() {}
  MadeSolids& operator=(const MadeSolids&) = delete;
  const Solids& of(const scene::Scene& scene) const;

 private:
  mutable std::once_flag once_;
  mutable std::unique_ptr<const Solids> solids_;
};

struct World {
  scene::Scene scene;
  /// The body that follows each node. 0: the node has no mesh of its own, or never moves (its mesh is then
  /// part of the static world). A node with parts has a body of its own even if it stands still.
  std::vector<uint32_t> body_of_node;
  /// The node that carries each body. [0] means nothing, since body 0 stands still.
  std::vector<uint32_t> node_of_body;
  std::vector<Part> parts;
  static constexpr uint32_t no_part = ~0u;
  std::vector<uint32_t> part_of_body;  ///< [bodies] into parts, or no_part

  /// Returns the surfaces of the scene for questions on the host. They are put in trees at the first call,
  /// since most runs ask nothing. Thread-safe.
  const Solids& solids() const { return made_solids.of(scene); }
  MadeSolids made_solids = {};
  /// The streets on which the scenario's traffic moves; none: it has no traffic.
  std::shared_ptr<const Streets> streets = {};
  Lamps lamps = {};  ///< those that switch
};

/// Loads and generates every model of the scenario. Throws UserError naming file, mesh or material. Parts
/// that a model does not have, and radio materials that are unknown at a channel's carrier, are found here
/// and not at the first tick.
World load_world(const Scenario& scenario);

/// Whether load_world() makes the same world of both scenarios, as long as the files that they name stay as
/// they are.
bool same_world(const Scenario& a, const Scenario& b);
/// Checks what load_world() would check of a scenario whose world is already there.
void check_world(const Scenario& scenario, const World& world);

}  // namespace greatx::sim
