// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tells which glowing triangles are the glass of a lamp. A lamp is in a scene twice: its light is that of
// KHR_lights_punctual, and its glass glows so that a camera sees where the light comes from. Only one of them
// may light what is near, or the lamp is counted twice: the glass does not.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::render {

/// A triangle that lies wholly within this distance of a light of its body is the glass of that lamp, m.
inline constexpr double lamp_glass_reach_m = 1.0;

class LampGlass {
 public:
  explicit LampGlass(const scene::Scene& scene);
  /// Returns whether a triangle of a body, in the frame of the body, is the glass of a lamp. Lights without a
  /// place (`directional`) have none.
  bool is_glass(uint32_t body, const std::array<dvec3, 3>& corners) const;

 private:
  struct Place {
    uint32_t body;
    dvec3 position;
  };
  std::vector<Place> places_;  ///< by body, then by x
};

}  // namespace greatx::render
