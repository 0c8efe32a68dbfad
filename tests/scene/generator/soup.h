// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Flattens a generated file to triangles, as the ordinary loader reads it.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

#include "scene/generator/generate.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// Prints the case in the message of a failed test.
inline void PrintTo(const GenerateOptions& options, std::ostream* out) {
  *out << options.kind << " " << options.variant << " " << options.size_m << " m, seed " << options.seed;
}

struct SoupTriangle {
  std::array<dvec3, 3> corners;  ///< world, z up
  std::array<dvec3, 3> local;    ///< in the mesh's own frame: exact millimetres
  std::array<dvec3, 3> normals;  ///< normals of the file, world
  uint32_t material = 0;
  uint32_t instance = 0;
  dvec3 normal() const;  ///< unit, from the winding
};

struct Soup {
  Model model;
  std::vector<SoupTriangle> triangles;
  std::vector<SoupTriangle> of_class(SemanticClass semantic_class) const;
  std::vector<SoupTriangle> of_instance(uint32_t instance) const;
  /// Returns the instance called `name`. Fails the test if there is none.
  uint32_t instance(const std::string& name) const;
};

Soup load_soup(const GenerateOptions& options);

/// Returns the number of directed edges without an equal number in the opposite direction: 0 for closed,
/// consistently wound surfaces. Corners are compared in whole millimetres of `local` (or of `corners` if
/// `world`).
size_t open_edges(const std::vector<SoupTriangle>& triangles, bool world = false);

/// Returns the volume that each connected part encloses, m^3. It is positive if the faces look outwards.
std::vector<double> part_volumes(const std::vector<SoupTriangle>& triangles);

/// Returns the area shared by pairs of triangles in one plane, m^2, with a description of the first such
/// pair.
double coplanar_overlap(const Soup& soup, std::string* first);

}  // namespace greatx::scene
