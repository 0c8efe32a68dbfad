// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Small scenes by hand: facets and radio materials only, nothing to look at.
#pragma once

#include <complex>
#include <string>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::rf::testing {

class HandScene {
 public:
  HandScene() {
    scene.bodies.push_back({.name = "static", .first_primitive = 0, .primitive_count = 0, .bounds = {}});
  }
  /// eta = relative - j sigma/(omega epsilon_0), thickness 0: half-space.
  uint32_t material(const std::string& name, double relative, double sigma = 0.0, double thickness_m = 0.0);
  /// A wall of P.2040's list.
  uint32_t itu_material(const std::string& name, double thickness_m = 0.0);
  uint32_t body();
  /// Corners counter-clockwise as seen from the front.
  uint32_t triangle(const dvec3& a, const dvec3& b, const dvec3& c, uint32_t material = 0, uint32_t body = 0);
  /// Two triangles (a, b, c) and (a, c, d), one facet.
  uint32_t quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, uint32_t material = 0,
                uint32_t body = 0);
  /// Six facets with normals inwards: x = low, x = high, y = low, ...; the room [0, size].
  void room(const dvec3& size, const dvec3& corner = dvec3(0.0));
  /// A square of 2 * half metres around (0, 0, height), facing up.
  uint32_t ground(double half, double height = 0.0, uint32_t material = 0);

  /// Triangles in one plane.
  uint32_t facet(const std::vector<scene::FacetTriangle>& triangles, uint32_t material, uint32_t body);

  scene::Scene scene;
};

}  // namespace greatx::rf::testing
