// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes trees with the foot at the origin and z up. A crown is a closed body of leaves, which the foliage of
// radio fills, with sprays of leaves around it: single faces with holes, which radio does not see.
#pragma once

#include <array>
#include <vector>

#include "scene/generator/mesh/mesh_builder.h"
#include "scene/generator/mesh/seasons.h"

namespace greatx::scene::generator {

/// linden, maple, oak, plane, Lombardy poplar, copper beech, birch
inline constexpr int tree_species = 7;

/// Makes a broad-leaved tree 6 to 11 m high. `kind` is below tree_species. `shape` (any number) varies the
/// boughs. The crown stands higher on its trunk if it would otherwise reach below `clear_m`.
///
/// In winter the crown is bare: boughs and sprays of twigs, which radio does not see, and a closed body of
/// twigs that is smaller than the body of leaves by leafless_scale along each axis.
MeshBuilder make_tree(int kind, int shape, double clear_m = 0.0, Season season = Season::summer);

/// A path through the middle of a leafless crown takes this share of the loss in leaf, dB over dB: ITU-R
/// P.833-10 says that around 1 GHz the specific attenuation is some 20 % larger in leaf. All foliage of a
/// scene has one specific attenuation, so that the bare crown's volume is smaller in its place.
inline constexpr double leafless_scale = 1.0 / 1.2;

/// Adds leaves that have fallen from a tree of this kind onto the ground between four corners,
/// counter-clockwise from above: two open faces. `draw` picks their picture.
void add_fallen_leaves(MeshBuilder& mesh, int kind, const std::array<dvec3, 4>& corners, uint32_t draw);

enum class Conifer { spruce, pine };
/// Makes a conifer some 10 m high.
MeshBuilder make_conifer(Conifer kind = Conifer::spruce);

/// Describes a body of leaves as rings around the z axis from the bottom up, each of the same number of
/// points, counter-clockwise from above, between two poles.
struct LeafBody {
  std::vector<std::vector<dvec3>> rings;
  dvec3 bottom, top;
};
/// Describes the sprays around a body.
struct Sprays {
  int per_face =
      1;  ///< on each of the faces between two rings; every other face of the lowest band and of the top
  double size_m = 1.5;  ///< width and height of a spray
  double hang = 0.0;    ///< 0: turned at random, 1: upright, so that leaves hang or rise
};
/// Adds a closed body of leaves. Light falls on it as on a round crown.
void add_leaf_body(MeshBuilder& mesh, int material, const LeafBody& body);
/// Adds sprays around a body, which are open faces. Their normals are those of the round crown as well.
void add_sprays(MeshBuilder& mesh, int material, const LeafBody& body, const Sprays& sprays, uint32_t seed);

/// Returns a number from -1 to 1 that depends on (i, k, seed) alone.
double uneven(int i, int k, uint32_t seed);
/// The corners of a spray, counter-clockwise from its front, and their places in its picture.
struct SprayCorners {
  std::array<dvec3, 4> p;
  std::array<dvec2, 4> uv;
};
/// Returns the corners of a spray with its middle at `at`, in the plane of `across` and `up` (half its width
/// and height). `draw` picks one of the picture's four quarters.
SprayCorners spray_corners(const dvec3& at, const dvec3& across, const dvec3& up, uint32_t draw);
/// Adds one spray with its middle at `at`, in the plane of `across` and `up` (half its width and height).
/// `normal` lights it, as far as it is on the spray's outside. `draw` picks its picture.
void add_spray(MeshBuilder& mesh, int material, const dvec3& normal, const dvec3& at, const dvec3& across,
               const dvec3& up, uint32_t draw);

/// Makes a closed hedge over a chain of ground points, some 1.2 m wide and 1.7 m high, with an uneven top and
/// sprays on it.
MeshBuilder make_hedge(const std::vector<dvec3>& chain, uint32_t seed);
/// Makes tufts of grass at these ground points.
MeshBuilder make_grass(const std::vector<dvec3>& feet, uint32_t seed);

}  // namespace greatx::scene::generator
