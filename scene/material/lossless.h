// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells which surfaces radio does not see.
#pragma once

#include "scene/material/material.h"

namespace greatx::scene {

/// Returns whether the material is foliage that attenuates by 0 dB/m and has no clutter. Foliage neither
/// reflects nor blocks, so such meshes have no effect on radio, and they need no inside: single leaves around
/// a crown may be open sheets.
inline bool is_lossless(const RadioMaterial& radio) {
  return radio.foliage && radio.foliage->attenuation_db_per_m == 0.0 && !radio.clutter;
}
inline bool is_lossless(const Material& material) { return material.radio && is_lossless(*material.radio); }

}  // namespace greatx::scene
