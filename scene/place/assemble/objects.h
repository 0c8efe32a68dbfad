// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Trees, woods, hedges, lamps, signals, masts and benches: objects of the generator at the places that the
// tags say.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "scene/place/assemble/place_mesh.h"
#include "scene/place/config/place_config.h"
#include "scene/place/ground/cover_map.h"

namespace greatx::scene::place {

enum class ObjectKind { tree, conifer, lamp, signal, mast, bench, bin };
inline constexpr size_t object_kinds = 7;
const char* name_of(ObjectKind kind);

struct PlacedObject {
  ObjectKind kind = ObjectKind::tree;
  int variant = 0;        ///< of a tree: its species
  int shape = 0;          ///< of a tree
  dvec3 foot{0.0};        ///< m
  double yaw = 0.0;       ///< rad
  double height_m = 0.0;  ///< 0: the object's own
  std::string source, id;
};

/// A hedge: a band with a height.
struct Hedge {
  std::vector<dvec2> line;
  double width_m = 0.8, height_m = 1.5;
  std::string source, id;
};

struct ObjectPlan {
  std::vector<PlacedObject> objects;
  std::vector<Hedge> hedges;
};

/// Finds all objects. Trees of woods stand at random, one in each cell of a square lattice of the stated
/// density, where the wood is and `blocked` is false. `ground` gives the height of the ground's mesh.
ObjectPlan find_objects(const PlaceInput& input, const VegetationConfig& config, const GroundPlan& plan,
                        const CoverMap& covers, const Box& rectangle,
                        const std::function<bool(const dvec2&)>& blocked,
                        const std::function<double(const dvec2&)>& ground, std::vector<Finding>& findings);

}  // namespace greatx::scene::place
