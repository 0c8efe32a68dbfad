// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/surface/lamp_glass.h"

#include <algorithm>
#include <tuple>

namespace greatx::render {

LampGlass::LampGlass(const scene::Scene& scene) {
  for (const scene::PunctualLight& light : scene.lights)
    if (light.type != scene::PunctualLight::Type::directional)
      places_.push_back({light.body, light.position});
  std::ranges::sort(places_, {}, [](const Place& place) { return std::tuple(place.body, place.position.x); });
}

bool LampGlass::is_glass(uint32_t body, const std::array<dvec3, 3>& corners) const {
  const auto first =
      std::ranges::lower_bound(places_, std::tuple(body, corners[0].x - lamp_glass_reach_m), {},
                               [](const Place& place) { return std::tuple(place.body, place.position.x); });
  for (auto place = first; place != places_.end() && place->body == body &&
                           place->position.x <= corners[0].x + lamp_glass_reach_m;
       ++place)
    if (std::ranges::all_of(corners, [&](const dvec3& corner) {
          return glm::distance(corner, place->position) <= lamp_glass_reach_m;
        }))
      return true;
  return false;
}

}  // namespace greatx::render
