// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/description/scene.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::scene {

void Joint::add_reach(const dvec3& point, Bounds& bounds) const {
  const dvec3 along = glm::dot(point, axis) * axis, arm = point - along;
  if (!limited()) {
    const dvec3 extent = glm::length(arm) * glm::sqrt(glm::max(1.0 - axis * axis, 0.0));
    bounds.add(position + along - extent);
    bounds.add(position + along + extent);
    return;
  }
  // The point moves on an arc, arm cos(a) + side sin(a). Each coordinate is extreme at the arc's ends or
  // where its derivative vanishes.
  const dvec3 side = glm::cross(axis, arm);
  const auto add = [&](double angle) {
    bounds.add(position + along + std::cos(angle) * arm + std::sin(angle) * side);
  };
  add(least_angle);
  add(most_angle);
  for (int i = 0; i < 3; ++i) {
    const double extreme = std::atan2(side[i], arm[i]);
    const double first = extreme + pi * std::ceil((least_angle - extreme) / pi);
    for (double angle = first; angle <= most_angle; angle += pi) add(angle);
  }
}

Bounds Joint::reach(const Bounds& box) const {
  Bounds bounds;
  for (int i = 0; i < 8 && !box.empty(); ++i)
    add_reach({i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z},
              bounds);
  return bounds;
}

uint32_t Scene::body_index(const std::string& body_name) const {
  for (uint32_t index = 0; index < bodies.size(); ++index) {
    if (bodies[index].name == body_name) return index;
  }
  GREATX_CHECK(false, "the scene has no body '{}'", body_name);
  return 0;
}

}  // namespace greatx::scene
