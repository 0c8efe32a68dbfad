// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/random.h"
#include "scene/place/input/place_input.h"

namespace greatx::scene::place {

/// Returns random numbers for one choice about an object. They depend on the seed, the object's id and the
/// number of the choice alone, so that an object looks the same in every cut of a map.
inline RandomStream random_of(const Feature& feature, uint64_t seed, uint32_t choice) {
  uint32_t hash = 2166136261u;  // FNV-1a
  for (const char c : feature.id) hash = (hash ^ static_cast<unsigned char>(c)) * 16777619u;
  return RandomStream(seed, hash, choice);
}

}  // namespace greatx::scene::place
