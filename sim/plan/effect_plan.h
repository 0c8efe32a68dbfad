// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Only the effects that the scene calls for: what the scene offers, what the scenario asks, and what can
// matter within the tolerance decide each effect before anything is built. What is off is not compiled, not
// recorded and not run.
#pragma once

#include <string>
#include <vector>

#include "scene/description/scene.h"
#include "sim/plan/effect_list.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// One effect, and the decision about it.
struct Effect {
  std::string name;        ///< as written under `effects:` in a scenario
  bool switchable = true;  ///< false: it follows from the sensors
  bool on = false;
  std::string reason;  ///< why it is on or off, one line
  std::string bound;   ///< how much leaving it off can change, or how much keeping it on costs; may be empty
  explicit operator bool() const { return on; }
};

/// A member for each row of sim/plan/effect_list.h.
struct EffectPlan {
#define GREATX_MEMBER(name, switchable, passed, documentation) Effect name{#name, switchable, false, {}, {}};
  GREATX_EFFECTS(GREATX_MEMBER)
#undef GREATX_MEMBER

  /// Every effect, in the order of the rows.
  std::vector<const Effect*> all() const;
};

/// Decides every effect. Bodies other than 0 count as moving. `points`: a box, world coordinates, around
/// receivers that the scenario does not have (`--receivers`, the cells of a map, Python); empty: none. Throws
/// UserError for a name under `effects:` that is none, or one that cannot be switched.
EffectPlan make_effect_plan(const Scenario& scenario, const scene::Scene& scene,
                            const scene::Bounds& points = {});

/// Whether both have the same effects on, whatever their bounds.
bool same_effects(const EffectPlan& a, const EffectPlan& b);

}  // namespace greatx::sim
