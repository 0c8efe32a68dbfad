// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Notices that cameras stand in a closed room, which no light of sun and sky enters.
#pragma once

#include <optional>

#include "scene/description/scene.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {

/// Describes the light in a closed room.
struct Indoors {
  double lamps_lm = 0.0;      ///< luminous flux of its lamps
  double area_m2 = 0.0;       ///< of everything static
  double albedo = 0.0;        ///< mean by area
  double indirect_lux = 0.0;  ///< on every surface, from light that has been reflected
};

/// Returns the light of the room if every camera and event camera stands, at the begin, where no direction of
/// 512 leads out of the static scene; else none. The indirect light is that of a sphere of the same area
/// whose wall reflects evenly: E = F a / (A (1 - a)) (W. E. Sumpner, 1892; the interreflection in CIE
/// 52-1982). A pane counts as a wall, as pictures draw it.
std::optional<Indoors> indoors_of(const Scenario& scenario, const scene::Scene& scene);

}  // namespace greatx::sim
