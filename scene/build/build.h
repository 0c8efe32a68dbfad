// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/gltf/model.h"

namespace greatx::scene {

/// A node of a moving model, with all that hangs on it, that turns about an axis through its origin.
struct PartPlacement {
  std::string name;
  uint32_t node = 0;          ///< into Model::nodes; not the descendant of another part's
  dvec3 axis{0.0, 0.0, 1.0};  ///< in the node's own frame, but z up: glTF's (x, y, z) is (x, -z, y) here
};

/// A model put into the world.
struct ModelPlacement {
  std::string name;  ///< prefix of its instances' names; may be empty
  const Model* model = nullptr;
  Pose pose;  ///< world_from_model; of a moving body: body_from_model
  dvec3 scale{1.0};
  bool moving = false;                          ///< true: becomes a body of its own, called `name`
  std::optional<SemanticClass> semantic_class;  ///< overrides the file's
  /// Of a moving body: each becomes a body called NAME/PART behind it. The axis of a part goes where the
  /// model's transforms take its direction; under a mirroring scale it turns right-handed about that still.
  std::vector<PartPlacement> parts;
};

struct BuildOptions {
  std::string name;
  std::optional<dvec3> origin;  ///< default: the centre of the static bounds, rounded to whole metres
  double coplanar_distance_m =
      1e-4;  ///< facets: triangles merge when every corner is this close to the plane
  double coplanar_angle_rad = 1e-4;
};

/// Places the models, makes what is missing (normals, tangents), mends winding under negative scale, merges
/// facets. Throws UserError naming model and mesh if a transformed vertex is not finite.
Scene build_scene(const std::vector<ModelPlacement>& placements, const BuildOptions& options);

}  // namespace greatx::scene
