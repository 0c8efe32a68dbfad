// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes the small scenes of the catalogue from triangles, through the same builder as scenes from files.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/description/scene.h"
#include "scene/gltf/model.h"

namespace greatx::apps::selftest {

using Triangle = std::array<dvec3, 3>;

/// Collects objects. Each object is one mesh and one instance; coplanar triangles of it that meet become one
/// facet. Corners are counter-clockwise as seen from the side of the normal, metres, z up, and are rounded to
/// fp32 as in a file.
class Stage {
 public:
  /// If `hole`, build() leaves out the first triangle of each object.
  explicit Stage(bool hole);

  /// Adds a half-space (thickness 0) or a wall with the permittivity `relative` - j sigma / (omega epsilon_0)
  /// and returns its index. Material 0 is a half-space of concrete-like permittivity 5.24.
  uint32_t material(double relative, double sigma, double thickness_m);
  /// Begins an object, to which the next triangles belong.
  Stage& object(const std::string& name, uint32_t material = 0);
  Stage& triangle(const dvec3& a, const dvec3& b, const dvec3& c);
  /// Adds a quadrilateral, split along a-c.
  Stage& quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
  /// Adds a closed box whose normals point outwards.
  Stage& box(const dvec3& low, const dvec3& high);

  /// Gives all corners of the present object this normal, as files with smooth normals do.
  Stage& normal(const dvec3& normal);

  /// Builds the scene, scaled and then moved by `shift` in the world. `origin` is the world position of the
  /// local origin.
  scene::Scene build(const dvec3& shift = dvec3(0.0), const dvec3& origin = dvec3(0.0),
                     const dvec3& scale = dvec3(1.0)) const;

 private:
  bool hole_;
  scene::Model model_;
  std::vector<std::vector<Triangle>> triangles_;  ///< [objects]
  std::vector<uint32_t> materials_;               ///< [objects]
  std::vector<std::optional<dvec3>> normals_;     ///< [objects] of all corners; none: computed
};

}  // namespace greatx::apps::selftest
