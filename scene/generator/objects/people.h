// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes people of limbs that turn about their joints, and riders of two-wheelers.
#pragma once

#include <cstdint>
#include <string>

#include "scene/generator/mesh/scene_writer.h"
#include "scene/generator/objects/shapes.h"
#include "scene/generator/objects/smooth_mesh.h"

namespace greatx::scene::generator {

/// Materials and build of one person.
struct PersonLook {
  int skin = 0, face = 0, hair = 0, jacket = 0, trousers = 0, shoes = 0;
  double girth = 1.0;      ///< widths of trunk and limbs
  bool long_hair = false;  ///< down to the shoulders
  bool dress = false;      ///< a coat or a skirt down to the knees instead of trousers below the waist
  bool coarse = false;     ///< fewer triangles, for riders
};

/// Draws clothes, skin and hair from the seed.
PersonLook person_look(const std::string& variant, uint64_t seed);

/// Adds a limb from one joint to the next: a closed body over circles. `radii` holds pairs of the share of
/// the way (below 0 and above 1: beyond the joints) and the radius in metres. It has `count` sides.
void add_limb(SmoothMesh& mesh, int material, const dvec3& from, const dvec3& to,
              const std::vector<dvec2>& radii, int count);
/// Adds trunk, neck and head over the hip joints at `hip`, leaning forward by `lean` rad.
void add_trunk(SmoothMesh& mesh, const PersonShape& shape, const PersonLook& look, const dvec3& hip,
               double lean);
/// Make a thigh about its hip joint, and a shank with its shoe about its knee; both hang down.
MeshBuilder make_thigh(const PersonShape& shape, const PersonLook& look);
MeshBuilder make_shank(const PersonShape& shape, const PersonLook& look);
/// Adds everything of a figure to `mesh` with smooth normals and the mapping of the face.
void finish_figure(MeshBuilder& mesh, const SmoothMesh& figure, const PersonShape& shape, const dvec3& hip,
                   double lean);

/// Returns the distance of the hip joints and of the shoulder joints from the middle, m.
double hip_y(const PersonShape& shape);
double shoulder_y(const PersonShape& shape, const PersonLook& look);

/// Writes a person who stands upright: the root called `variant` with trunk and head, and the nodes of the
/// limbs. Throws UserError for an unknown variant.
void write_person(SceneWriter& writer, const std::string& variant, uint64_t seed);

}  // namespace greatx::scene::generator
