// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/solids.h"

#include "scene/material/lossless.h"

namespace greatx::sim {
namespace {

rf::FacetKinds kinds_of(const scene::Scene& scene) {
  rf::FacetKinds kinds;
  for (const scene::Facet& facet : scene.facets) {
    const std::optional<scene::RadioMaterial>& radio = scene.materials[facet.material].radio;
    kinds.push_back(!radio || !radio->foliage    ? rf::FacetKind::opaque
                    : scene::is_lossless(*radio) ? rf::FacetKind::absent
                                                 : rf::FacetKind::foliage);
  }
  return kinds;
}

}  // namespace

Solids::Solids(const scene::Scene& scene) : scene_(scene), surfaces_(scene, kinds_of(scene)) {}

const std::string& Solids::object_of(uint32_t facet) const {
  return scene_.instances[scene_.facets[facet].instance].name;
}

}  // namespace greatx::sim
