// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Decides which effects a run needs, before anything is built. The decision depends on the contents of the
// scene, on the requests of the scenario, and on the tolerance, below which an effect does not matter. An
// effect that is off is not compiled, not recorded and not run.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene.h"
#include "sim/plan/effect_list.h"
#include "sim/plan/indoors.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Describes one effect and the decision about it.
struct Effect {
  std::string name;        ///< as written under `effects:` in a scenario
  bool switchable = true;  ///< false: the effect follows from the sensors
  bool on = false;
  std::string reason;  ///< why it is on or off, one line
  /// The change that leaving the effect off can cause, or the cost of keeping it on; may be empty.
  std::string bound;
  explicit operator bool() const { return on; }
};

/// Holds one member for each row of sim/plan/effect_list.h.
struct EffectPlan {
#define GREATX_MEMBER(name, switchable, passed, documentation) Effect name{#name, switchable, false, {}, {}};
  GREATX_EFFECTS(GREATX_MEMBER)
#undef GREATX_MEMBER

  /// Set if all cameras stand in a closed room: neither sun nor sky, fog or rain reach them.
  std::optional<Indoors> indoors;

  /// Returns every effect in the order of the rows.
  std::vector<const Effect*> all() const;
};

/// Decides every effect. Bodies other than 0 count as moving. `points` is a box, world coordinates, around
/// receivers that the scenario does not contain (`--receivers`, the cells of a map, points given in Python);
/// empty: none. Throws UserError if a name under `effects:` is not an effect, or cannot be switched, and
/// if the program was built without an effect that is on (core/built_effects.h).
EffectPlan make_effect_plan(const Scenario& scenario, const scene::Scene& scene,
                            const scene::Bounds& points = {});

/// Returns whether both plans have the same effects on. Their reasons and bounds may differ.
bool same_effects(const EffectPlan& a, const EffectPlan& b);

}  // namespace greatx::sim
