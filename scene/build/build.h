// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/model.h"

namespace greatx::scene {

/// A node of a moving model that turns about an axis through the node's origin, with all its descendants but
/// those of other parts. It hangs on the next part among its ancestors, or on the body.
struct PartPlacement {
  std::string name;
  uint32_t node = 0;          ///< into Model::nodes; each node once, ascending
  dvec3 axis{0.0, 0.0, 1.0};  ///< in the node's own frame, but z up: glTF's (x, y, z) is (x, -z, y) here
  double least_angle = -1e9, most_angle = 1e9;  ///< rad; the part never turns beyond them
};

/// A model placed in the world.
struct ModelPlacement {
  std::string name;  ///< prefix of the names of its instances; may be empty
  const Model* model = nullptr;
  Pose pose;  ///< world_from_model; for a moving body: body_from_model
  dvec3 scale{1.0};
  bool moving = false;                          ///< true: the model becomes a body of its own, called `name`
  std::optional<SemanticClass> semantic_class;  ///< overrides the file's
  /// The parts of a moving body. Each becomes a body called NAME/PART after it. The model's transforms turn
  /// the direction of a part's axis. The part turns right-handed about the transformed axis, even under a
  /// mirroring scale.
  std::vector<PartPlacement> parts;
};

struct BuildOptions {
  std::string name;
  std::optional<dvec3> origin;  ///< default: the centre of the static bounds, rounded to whole metres
  std::optional<Georeference> georeference;  ///< of the world; those of models are not looked at
  /// Tolerances of facets: triangles merge if every corner lies this close to the plane, and their normals
  /// are this close.
  double coplanar_distance_m = 1e-4;
  double coplanar_angle_rad = 1e-4;
};

/// Places the models, computes missing normals and tangents, reverses the winding under negative scale, and
/// merges facets. Throws UserError, which names model and mesh, if a transformed vertex is not finite or a
/// triangle loses its area. Throws UserError for an invalid pose, scale or part axis, and for more triangles,
/// vertices or texture memory than the budgets allow.
Scene build_scene(const std::vector<ModelPlacement>& placements, const BuildOptions& options);

}  // namespace greatx::scene
