// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A generated file as the ordinary loader sees it, flattened to triangles.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

#include "scene/generator/generate.h"
#include "scene/gltf/model.h"

namespace greatx::scene {

/// How a failed test names its case.
inline void PrintTo(const GenerateOptions& options, std::ostream* out) {
  *out << options.kind << " " << options.variant << " " << options.size_m << " m, seed " << options.seed;
}

struct SoupTriangle {
  std::array<dvec3, 3> corners;  ///< world, z up
  std::array<dvec3, 3> local;    ///< the mesh's own frame: exact millimetres
  std::array<dvec3, 3> normals;  ///< the file's, world
  uint32_t material = 0;
  uint32_t instance = 0;
  dvec3 normal() const;  ///< unit, by the winding
};

struct Soup {
  Model model;
  std::vector<SoupTriangle> triangles;
  std::vector<SoupTriangle> of_class(SemanticClass semantic_class) const;
  std::vector<SoupTriangle> of_instance(uint32_t instance) const;
  /// The instance called `name`; fails the test if there is none.
  uint32_t instance(const std::string& name) const;
};

Soup load_soup(const GenerateOptions& options);

/// Directed edges that are not met by exactly as many in the opposite direction: 0 for closed, consistently
/// wound surfaces. Corners are compared in whole millimetres of `local` (or of `corners` with `world`).
size_t open_edges(const std::vector<SoupTriangle>& triangles, bool world = false);

/// Volumes enclosed by each connected part, m^3; positive where the faces look outwards.
std::vector<double> part_volumes(const std::vector<SoupTriangle>& triangles);

/// Area shared by pairs of triangles in one plane, m^2, with a description of the first such pair.
double coplanar_overlap(const Soup& soup, std::string* first);

}  // namespace greatx::scene
