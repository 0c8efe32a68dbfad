// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Answers geometric questions about a world on the host, in fp64: where a point stands, how far it is from
// the static world, and what a ray meets. Trajectories that keep clear of walls, warnings of sensors within
// walls, and `greatx check` ask them; nothing that a sensor measures depends on them.
#pragma once

#include <string>

#include "rf/facets/placement.h"
#include "scene/description/scene.h"

namespace greatx::sim {

/// The surfaces of a scene. Every surface counts, whatever the effects of a run; foliage is what a radio
/// material calls foliage.
class Solids {
 public:
  /// `scene` outlives this.
  explicit Solids(const scene::Scene& scene);
  const rf::Surroundings& surfaces() const { return surfaces_; }
  /// Returns the name of the object that a facet belongs to.
  const std::string& object_of(uint32_t facet) const;

 private:
  const scene::Scene& scene_;
  rf::Surroundings surfaces_;
};

}  // namespace greatx::sim
