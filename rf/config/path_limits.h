// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the limits of a channel's paths. Scenario, search, solver and notes read the same limits. Plain data.
#pragma once

#include <cstdint>

namespace greatx::rf {

struct PathLimits {
  uint32_t max_depth = 3;          ///< interactions on a path, of all types
  uint32_t max_transmissions = 3;  ///< walls passed, as a part of max_depth
  /// Reflections on each side of a diffraction, as a part of max_depth.
  uint32_t max_reflections_beside_diffraction = 2;
  uint32_t max_diffractions = 1;  ///< edges of a path, 1 or 2, as a part of max_depth
  /// A path over two edges is left out if it is certain to be weaker than free space over its length by this.
  double two_edge_floor_db = 60.0;
  /// With corner diffraction: the largest step that may be left where the field of an edge ends with the
  /// edge, in dB of that field. The waves of ends that are less are left out.
  double corner_step_db = 0.3;
  /// Reflections between a scattering and the target (the end that the search does not start from, whichever
  /// end transmits), as a part of max_depth.
  uint32_t max_reflections_after = 0;
  /// Reflections between the source (the end that the search starts from) and a scattering, as a part of
  /// max_depth.
  uint32_t max_reflections_before_scattering = ~0u;
  double patch_m = 10.0;  ///< longest side of the patches that scatter as a whole, metres
  /// Scatterings of a link that are traced. If there are more, seeded draws stand for the others, so that the
  /// expected power is theirs (rf/paths/scatter_draw.h). 0: every one is traced.
  uint32_t scattering_budget = 0;
  /// Scatterings of a path, 1 or 2, one right after the other, as a part of max_depth. Pairs are only drawn:
  /// 2 needs a budget.
  uint32_t max_scatterings = 1;
  /// Whether a path may have a diffraction right before or right behind its scattering. Such paths are only
  /// drawn, too (rf/paths/indirect_light.h, rf/paths/edge_behind_patch.h).
  bool scattering_beside_diffraction = false;
  uint64_t max_paths = 1'000'000;  ///< geometric paths of a link; paths beyond it are counted, not traced
};

}  // namespace greatx::rf
