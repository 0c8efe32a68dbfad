// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The limits of a channel's paths: scenario, search, solver and notes read the same ones. Plain data.
#pragma once

#include <cstdint>

namespace greatx::rf {

struct PathLimits {
  uint32_t max_depth = 3;          ///< interactions on a path, of any type
  uint32_t max_transmissions = 3;  ///< of them walls passed
  /// Of them reflections between a diffraction or scattering and the target (the end that is not searched
  /// from).
  uint32_t max_reflections_after = 0;
  /// Of them reflections between the source (the end that is searched from) and a scattering.
  uint32_t max_reflections_before_scattering = ~0u;
  double patch_m = 10.0;           ///< longest side of the pieces that scatter as one
  uint64_t max_paths = 1'000'000;  ///< geometric paths of a link; those beyond are counted, not traced
};

}  // namespace greatx::rf
