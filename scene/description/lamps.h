// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lamps that switch: lenses of signals, stop lamps and direction indicators of vehicles. A material whose
// name is "switched_" and a role makes the triangles that have it a switched lamp: those of one instance with
// one role are one lamp. Its emission is that of the material times a factor, which may change every tick
// (sim/world/lamps.h).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::scene {

/// The colours of a signal; of a vehicle: its stop lamps, and its direction indicators on each side.
enum class LampRole : uint8_t { red, amber, green, stop, left, right };
/// Returns the name of a role, as it stands in the name of a material.
const char* name_of(LampRole role);

struct SwitchedLamp {
  uint32_t instance = 0;
  LampRole role = LampRole::red;
};

/// Returns the role of a material's triangles, or nothing if their emission never changes.
std::optional<LampRole> lamp_role(const Material& material);

/// The switched lamps of a scene.
struct SwitchedLamps {
  std::vector<SwitchedLamp> lamps;     ///< in the order of their first primitives
  std::vector<uint32_t> of_primitive;  ///< [primitives] index into `lamps` + 1; 0: none
};
SwitchedLamps switched_lamps(const Scene& scene);
/// Returns "INSTANCE/ROLE".
std::string name_of(const Scene& scene, const SwitchedLamp& lamp);

}  // namespace greatx::scene
