// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the one scene that every modality sees. It is immutable after loading and uploaded to the GPU once.
//
//   Model  = one glTF file, as parsed (model.h)
//   Scene  = models placed in the world (build.h): flat arrays, ready for upload
//     body 0          everything that never moves, already in local coordinates (world - origin)
//     body 1, 2, ...  one per moving object, in its own frame; a pose per tick places it; behind it one for
//                     each of its parts that turn, whose owner it or an earlier part is
//     instance        one object with a name, a semantic class and an id on every pixel and return
//     primitive       a range of triangles of one instance with one material; one geometry of the body's BLAS
//     facet           coplanar, connected triangles of one body with one material, merged (rf works on these)
//
// All static triangles share one acceleration structure, so that a ray cannot slip between two objects that
// share an edge (Vulkan promises watertightness only within one).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geodesy.h"
#include "core/vec.h"
#include "scene/material/material.h"

namespace greatx::scene {

/// Names the kind of an object. The values are stable, since they go to disk.
enum class SemanticClass : uint32_t {
  unlabeled = 0,
  ground = 1,
  road = 2,
  pavement = 3,
  lane_marking = 4,
  building = 5,
  roof = 6,
  window = 7,
  vegetation = 8,
  pole = 9,
  street_lamp = 10,
  mast = 11,
  vehicle = 12,
  uav = 13,
  water = 14,
  furniture = 15,
  person = 16,
};
const char* name_of(SemanticClass semantic_class);
/// Returns the name of every class; the index is the value.
const std::vector<std::string>& semantic_class_names();

struct Bounds {
  dvec3 min{1e300}, max{-1e300};
  void add(const dvec3& point) {
    min = glm::min(min, point);
    max = glm::max(max, point);
  }
  void add(const Bounds& other) {
    min = glm::min(min, other.min);
    max = glm::max(max, other.max);
  }
  bool empty() const { return min.x > max.x; }
  dvec3 center() const { return 0.5 * (min + max); }
  dvec3 size() const { return empty() ? dvec3(0.0) : max - min; }
};

/// Describes an RGBA8 image, top row first.
struct Texture {
  std::string name;
  uint32_t width = 0, height = 0;
  bool srgb = true;
  bool repeat_u = true, repeat_v = true;
  std::vector<uint8_t> rgba;
};

struct Primitive {
  uint32_t first_index = 0;  ///< into Scene::indices; a multiple of 3
  uint32_t index_count = 0;
  uint32_t material = 0;
  uint32_t instance = 0;
};

struct Instance {
  std::string name;  ///< unique in the scene
  SemanticClass semantic_class = SemanticClass::unlabeled;
  uint32_t body = 0;
  Bounds bounds;  ///< in the body's frame
};

/// Describes the joint of a part on the body that carries it. The part's frame has the carrier's axes until
/// it turns about `axis`.
struct Joint {
  uint32_t owner = 0;   ///< the carrier: an earlier body, which may be a part itself (a shank on a thigh)
  dvec3 position{0.0};  ///< origin of the part in its owner's frame, metres
  dvec3 axis{0.0, 0.0, 1.0};                    ///< unit, in both frames
  double least_angle = -1e9, most_angle = 1e9;  ///< rad; the part never turns beyond them
  /// Returns owner_from_part when the part has turned by `angle`, rad, right-handed about the axis.
  Pose pose(double angle) const { return {position, glm::angleAxis(angle, axis)}; }
  bool limited() const { return most_angle - least_angle < 6.283185307179586; }
  /// Adds to `bounds`, in the owner's frame, all places that a point of the part reaches.
  void add_reach(const dvec3& point, Bounds& bounds) const;
  /// Returns the bounds of all places that the corners of a box of the part reach. A box that is empty stays
  /// so.
  Bounds reach(const Bounds& box) const;
};

struct Body {
  std::string name;  ///< "static", or the node's name; for a part: NODE/PART
  uint32_t first_primitive = 0, primitive_count = 0;
  Bounds bounds;               ///< in the body's frame
  std::optional<Joint> joint;  ///< set for a part
  /// For a body with parts, the bounds of the body and of all parts, and of their parts, in any turn. They
  /// are empty for other bodies, and for parts.
  Bounds reach;
};

/// Describes a light of KHR_lights_punctual, in the body's frame.
struct PunctualLight {
  enum class Type : uint32_t { point, spot, directional } type = Type::point;
  std::string name;
  dvec3 position{0.0}, direction{0.0, 0.0, -1.0};
  vec3 color{1.0f};
  float intensity = 1.0f;                            ///< cd; lux for directional
  float range_m = 0.0f;                              ///< 0: unlimited
  float inner_cone = 0.0f, outer_cone = 0.7853982f;  ///< rad
  uint32_t body = 0;
  /// `passing` gives a spot the distribution of a vehicle's low beam (shaders/shared/beam.h) within its cone.
  /// Its elbow lies on `direction`, and its cut-off is level in the frame of the body.
  enum class Beam : uint32_t { cone, passing } beam = Beam::cone;
};

/// A plane n . x = offset in the body's frame (body 0: local coordinates), computed in fp64 from the numbers
/// of the file.
struct Facet {
  dvec3 normal{0.0, 0.0, 1.0};  ///< unit; on the side that the winding of the triangles faces
  double offset = 0.0;
  uint32_t body = 0;
  uint32_t material = 0;
  uint32_t instance = 0;
  uint32_t first_triangle = 0, triangle_count = 0;  ///< into Scene::facet_triangles
};

/// Describes a triangle of a facet, with exact corners in fp64.
struct FacetTriangle {
  dvec3 corners[3];
};

struct Scene {
  std::string name;
  std::string hash;                          ///< SHA-256 over everything below that reaches a sensor
  dvec3 origin{0.0};                         ///< world position of the local origin: local = world - origin
  std::optional<Georeference> georeference;  ///< of the world's x, y, z; none: the scene is nowhere on Earth

  // The geometry is indexed by Primitive. Body 0 is in local coordinates.
  std::vector<vec3> positions;
  std::vector<vec3> normals;   ///< unit
  std::vector<vec4> tangents;  ///< glTF: w = +-1; zero where no material of the primitive has a normal map
  std::vector<vec2> uvs;
  std::vector<uint32_t> indices;
  std::vector<Primitive> primitives;  ///< grouped by body, ascending
  std::vector<Instance> instances;
  std::vector<Body> bodies;  ///< [0] is the static world, present even if empty

  std::vector<Facet> facets;  ///< grouped by body, ascending
  std::vector<FacetTriangle> facet_triangles;
  std::vector<uint32_t> facet_of_triangle;  ///< [indices.size() / 3]

  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<PunctualLight> lights;
  Bounds bounds;                   ///< bounds of body 0
  std::vector<std::string> notes;  ///< the repairs and choices of the loader, for `greatx scene info`

  dvec3 to_local(const dvec3& world) const { return world - origin; }
  Pose to_local(const Pose& world) const { return {world.position - origin, world.orientation}; }
  size_t triangle_count() const { return indices.size() / 3; }
  /// Returns the body that `body` is a part of, at the root of its chain of joints, or `body` itself if it is
  /// not a part. A sensor that does not see its carrier sees no body of that owner.
  uint32_t owner_of(uint32_t body) const {
    while (bodies[body].joint) body = bodies[body].joint->owner;
    return body;
  }
  /// Returns whether the material of a primitive has an alpha mask, which may cut holes into it.
  bool has_holes(uint32_t primitive) const {
    return materials[primitives[primitive].material].pbr.alpha_mode == AlphaMode::mask;
  }
  /// Returns the bounds of a body with all its parts, however they are turned, in its frame.
  const Bounds& reach_of(uint32_t body) const {
    return bodies[body].reach.empty() ? bodies[body].bounds : bodies[body].reach;
  }
  /// Returns the body called `name`. Throws ContractError if there is none.
  uint32_t body_index(const std::string& name) const;
};

}  // namespace greatx::scene
