// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes small scenes by hand that hold only facets and radio materials.
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
  /// Adds a material with eta = relative - j sigma/(omega epsilon_0). A thickness of 0 is a half-space.
  uint32_t material(const std::string& name, double relative, double sigma = 0.0, double thickness_m = 0.0);
  /// Adds a material of the list in ITU-R P.2040. A thickness of 0 is a half-space.
  uint32_t itu_material(const std::string& name, double thickness_m = 0.0);
  uint32_t body();
  /// Adds a triangle and returns its facet. Its corners run counter-clockwise as seen from the front.
  uint32_t triangle(const dvec3& a, const dvec3& b, const dvec3& c, uint32_t material = 0, uint32_t body = 0);
  /// Adds one facet of the two triangles (a, b, c) and (a, c, d).
  uint32_t quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, uint32_t material = 0,
                uint32_t body = 0);
  /// Adds the room [corner, corner + size] as six facets with normals inwards: x = low, x = high, y = low,
  /// ...
  void room(const dvec3& size, const dvec3& corner = dvec3(0.0));
  /// Adds a square with a side of 2 * half metres around (0, 0, height) that faces up.
  uint32_t ground(double half, double height = 0.0, uint32_t material = 0);

  /// Adds one facet of triangles that lie in one plane.
  uint32_t facet(const std::vector<scene::FacetTriangle>& triangles, uint32_t material, uint32_t body);

  scene::Scene scene;
};

}  // namespace greatx::rf::testing
