// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/build/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

#include "core/activity.h"
#include "core/budget.h"
#include "core/error.h"
#include "scene/build/build_geometry.h"
#include "scene/build/build_materials.h"
#include "scene/build/facets.h"
#include "scene/description/scene_hash.h"

namespace greatx::scene {
namespace {

dmat4 linear_of(const dmat4& affine) {
  dmat4 linear = affine;
  linear[3] = dvec4(0, 0, 0, 1);
  return linear;
}

/// Returns the linear part of a placement.
dmat4 scaled_axes(const ModelPlacement& placement) {
  dmat4 scaled = glm::mat4_cast(placement.pose.orientation);
  for (int axis = 0; axis < 3; ++axis) scaled[axis] *= placement.scale[axis];
  return scaled;
}

/// Turns the model_from_... transforms of a placement into body_from_... transforms for one body.
class Frame {
 public:
  /// Makes world_from_model relative to `reference`, a point of the world, or body_from_model for a moving
  /// body. The large numbers of a UTM position cancel here, in fp64, before any product with them.
  Frame(const ModelPlacement& placement, const dvec3& reference)
      : scaled_(scaled_axes(placement)),
        offset_(placement.moving ? placement.pose.position : placement.pose.position - reference) {}
  /// Makes part_from_model: the axes remain, and the origin moves to that of `node`.
  Frame(const ModelPlacement& placement, const ModelNode& node)
      : scaled_(scaled_axes(placement)), model_origin_(node.model_from_node[3]) {}

  dmat4 place(const dmat4& model_from_mesh) const {
    dmat4 placed = scaled_ * linear_of(model_from_mesh);
    placed[3] = dvec4(offset_ + glm::dmat3(scaled_) * (dvec3(model_from_mesh[3]) - model_origin_), 1.0);
    return placed;
  }

 private:
  dmat4 scaled_;
  dvec3 offset_{0.0}, model_origin_{0.0};
};

/// Returns the joint of a part in its owner's frame. Throws UserError if the transforms of the part leave its
/// axis without a direction.
/// `carrier` is the node of the part that carries this one; none: the body carries it.
Joint joint_of(const ModelPlacement& placement, const PartPlacement& part, const ModelNode* carrier,
               uint32_t owner) {
  const ModelNode& node = placement.model->nodes[part.node];
  const Frame frame = carrier != nullptr ? Frame(placement, *carrier) : Frame(placement, dvec3(0.0));
  const dmat4 body_from_node = frame.place(node.model_from_node);
  const dvec3 axis_y_up(part.axis.x, part.axis.z, -part.axis.y);
  const dvec3 axis = glm::dmat3(body_from_node) * axis_y_up;
  const double length = glm::length(axis);
  if (!(length > 0.0 && std::isfinite(length)))
    throw_user_error("object '{}' ({}): part '{}': its axis [{}, {}, {}] has no direction left",
                     placement.name, placement.model->file.string(), part.name, part.axis.x, part.axis.y,
                     part.axis.z);
  return {owner, dvec3(body_from_node[3]), axis / length, part.least_angle, part.most_angle};
}

void check_placement(const ModelPlacement& placement) {
  GREATX_CHECK(placement.model != nullptr, "placement '{}' has no model", placement.name);
  const auto finite = [](const dvec3& vector) {
    return std::isfinite(vector.x) && std::isfinite(vector.y) && std::isfinite(vector.z);
  };
  const dvec3& scale = placement.scale;
  if (!finite(scale) || scale.x == 0.0 || scale.y == 0.0 || scale.z == 0.0) {
    throw_user_error("object '{}' ({}): scale [{}, {}, {}]: expected finite numbers other than 0",
                     placement.name, placement.model->file.string(), scale.x, scale.y, scale.z);
  }
  GREATX_CHECK(placement.moving || placement.parts.empty(), "parts of '{}', which never moves",
               placement.name);
  for (size_t i = 0; i < placement.parts.size(); ++i) {
    const PartPlacement& part = placement.parts[i];
    GREATX_CHECK(part.node < placement.model->nodes.size(), "part '{}': node {} of {}", part.name, part.node,
                 placement.model->nodes.size());
    GREATX_CHECK(i == 0 || placement.parts[i - 1].node < part.node, "part '{}': nodes are not ascending",
                 part.name);
  }
  const dquat& turn = placement.pose.orientation;
  if (!finite(placement.pose.position) || !(std::abs(glm::length(turn) - 1.0) < 1e-6)) {
    throw_user_error("object '{}' ({}): its pose is not finite or its quaternion not of length 1",
                     placement.name, placement.model->file.string());
  }
}

/// Returns the centre of the static bounds, rounded to whole metres. Halves are shifted by 1e-6 before
/// rounding, so that a scene and its copy some 1e5 m away, whose centres differ in the last digit, round
/// alike.
dvec3 default_origin(const std::vector<ModelPlacement>& placements) {
  Bounds bounds;
  for (const ModelPlacement& placement : placements) {
    if (placement.moving) continue;
    const Frame world(placement, dvec3(0.0));
    for (const ModelInstance& instance : placement.model->instances) {
      const dmat4 world_from_mesh = world.place(instance.model_from_mesh);
      for (const ModelPrimitive& primitive : placement.model->meshes[instance.mesh].primitives) {
        for (const uint32_t index : primitive.indices) {
          bounds.add(dvec3(world_from_mesh * dvec4(dvec3(primitive.positions[index]), 1.0)));
        }
      }
    }
  }
  if (bounds.empty()) return dvec3(0.0);
  return glm::floor(bounds.center() + 0.5 + 1e-6);
}

/// The size of the scene, computed before the scene is built, since a small file may place one mesh many
/// times.
struct Planned {
  uint64_t triangles = 0, vertices = 0;
};

Planned planned_of(const ModelMesh& mesh) {
  Planned planned;
  for (const ModelPrimitive& primitive : mesh.primitives) {
    planned.triangles += primitive.indices.size() / 3;
    // Flat normals take three vertices for each triangle.
    planned.vertices += primitive.normals.empty() ? primitive.indices.size() : primitive.positions.size();
  }
  return planned;
}

Planned planned_of(const std::vector<ModelPlacement>& placements) {
  Planned planned;
  for (const ModelPlacement& placement : placements) {
    const Model& model = *placement.model;
    std::vector<Planned> of_mesh;
    for (const ModelMesh& mesh : model.meshes) of_mesh.push_back(planned_of(mesh));
    for (const ModelInstance& instance : model.instances) {
      planned.triangles += of_mesh[instance.mesh].triangles;
      planned.vertices += of_mesh[instance.mesh].vertices;
    }
    const std::string where = fmt::format("object '{}' ({}): {} places of {} meshes", placement.name,
                                          model.file.string(), model.instances.size(), model.meshes.size());
    require_within(where, planned.triangles, budget::scene_triangles);
    require_within(where, planned.vertices, budget::scene_vertices);
  }
  return planned;
}

class Builder {
 public:
  Builder(Scene& scene, const BuildOptions& options) : scene_(scene), options_(options), materials_(scene) {}

  void add_body(const std::string& name) {
    Body body;
    body.name = name;
    body.first_primitive = static_cast<uint32_t>(scene_.primitives.size());
    scene_.bodies.push_back(body);
  }

  /// Adds the placement to the last body, without the nodes that belong to its parts.
  void add(const ModelPlacement& placement) {
    add(placement, Frame(placement, scene_.origin),
        [&](uint32_t node) { return part_of(placement, node, placement.parts.size()) == no_part; });
  }

  /// Adds the parts of the placement whose own body is `owner`, each as a body of its own.
  void add_parts(const ModelPlacement& placement, uint32_t owner) {
    const std::vector<ModelNode>& nodes = placement.model->nodes;
    for (size_t i = 0; i < placement.parts.size(); ++i) {
      const PartPlacement& part = placement.parts[i];
      const size_t carrier = part_of(placement, part.node, i);
      add_body(placement.name + "/" + part.name);
      scene_.bodies.back().joint = carrier == no_part
                                       ? joint_of(placement, part, nullptr, owner)
                                       : joint_of(placement, part, &nodes[placement.parts[carrier].node],
                                                  owner + 1 + static_cast<uint32_t>(carrier));
      add(placement, Frame(placement, nodes[part.node]),
          [&](uint32_t node) { return part_of(placement, node, placement.parts.size()) == i; });
    }
    if (placement.parts.empty()) return;
    Bounds reach = scene_.bodies[owner].bounds;
    for (uint32_t body = owner + 1; body < scene_.bodies.size(); ++body)
      if (scene_.bodies[body].joint->owner == owner) reach.add(reach_of(body));
    scene_.bodies[owner].reach = reach;
  }

  void finish() {
    scene_.bounds = scene_.bodies.front().bounds;
    note_faults();
    scene_.hash = hash_of(scene_);
  }

 private:
  uint32_t current_body() const { return static_cast<uint32_t>(scene_.bodies.size() - 1); }

  /// Adds the instances and lights of a placement's model on the nodes for which belongs(node) is true.
  template <typename Belongs>
  void add(const ModelPlacement& placement, const Frame& frame, const Belongs& belongs) {
    const Model& model = *placement.model;
    for (const ModelInstance& instance : model.instances)
      if (belongs(instance.node)) add_instance(placement, frame, instance);
    for (size_t i = 0; i < model.lights.size(); ++i) {
      if (!belongs(model.nodes_of_lights[i])) continue;
      PunctualLight light = model.lights[i];
      dmat4 carrier(1.0);
      carrier[3] = dvec4(light.position, 1.0);
      const dmat4 placed = frame.place(carrier);
      light.position = dvec3(placed[3]);
      light.direction = glm::normalize(glm::dmat3(placed) * light.direction);
      light.body = current_body();
      if (!placement.name.empty()) light.name = placement.name + "/" + light.name;
      scene_.lights.push_back(light);
    }
    if (noted_.insert(&model).second) {
      scene_.notes.insert(scene_.notes.end(), model.notes.begin(), model.notes.end());
    }
  }

  static constexpr size_t no_part = ~size_t{0};

  /// Returns the last of the first `count` parts to which a node belongs, or no_part. A later part hangs on
  /// an earlier one if both hold the node.
  static size_t part_of(const ModelPlacement& placement, uint32_t node, size_t count) {
    for (size_t i = count; i-- > 0;) {
      const uint32_t first = placement.parts[i].node;
      if (node >= first && node < placement.model->nodes[first].end) return i;
    }
    return no_part;
  }

  /// Returns the bounds, in its owner's frame, of all places that a part reaches: its corners, and those of
  /// the boxes of its own parts.
  Bounds reach_of(uint32_t index) const {
    const Body& body = scene_.bodies[index];
    Bounds reach;
    for (uint32_t p = body.first_primitive; p < body.first_primitive + body.primitive_count; ++p) {
      const Primitive& primitive = scene_.primitives[p];
      for (uint32_t i = 0; i < primitive.index_count; ++i)
        body.joint->add_reach(dvec3(scene_.positions[scene_.indices[primitive.first_index + i]]), reach);
    }
    for (uint32_t part = index + 1; part < scene_.bodies.size(); ++part)
      if (scene_.bodies[part].joint->owner == index) reach.add(body.joint->reach(reach_of(part)));
    return reach;
  }

  void note_faults() {
    if (collapsed_ > 0) {
      scene_.notes.push_back(fmt::format(
          "{} triangles are too small for fp32 at their distance from the local origin: rays and pictures "
          "cannot see them",
          collapsed_));
    }
    if (flat_ > 0) scene_.notes.push_back(fmt::format("{} primitives without normals got flat ones", flat_));
    if (unmapped_ > 0) {
      scene_.notes.push_back(
          fmt::format("{} primitives with a normal map have no texture coordinates", unmapped_));
    }
  }

  std::string unique_name(const ModelPlacement& placement, const ModelInstance& instance) {
    const std::string wanted = placement.name.empty() ? instance.name : placement.name + "/" + instance.name;
    std::string name = wanted;
    // The search continues where the last one of this name ended, so that n copies take n steps.
    uint32_t& number = next_number_[wanted];
    while (!names_.insert(name).second)
      name = fmt::format("{}_{}", wanted, number = std::max(number, 1u) + 1);
    return name;
  }

  void add_instance(const ModelPlacement& placement, const Frame& frame, const ModelInstance& instance) {
    const Model& model = *placement.model;
    const ModelMesh& mesh = model.meshes[instance.mesh];
    // The indices are kept for the whole scene, since a mesh may be placed a thousand times.
    const std::vector<uint32_t>& materials = materials_.indices_of(model);
    Instance result;
    result.name = unique_name(placement, instance);
    result.semantic_class = placement.semantic_class.value_or(instance.semantic_class);
    result.body = current_body();
    const std::string what =
        fmt::format("{}: mesh '{}', placed as '{}'", model.file.string(), mesh.name, result.name);
    const dmat4 body_from_mesh = frame.place(instance.model_from_mesh);
    // Facets are merged by material: they may cross primitives, but not instances.
    std::map<uint32_t, FacetWork> work;
    std::map<uint32_t, size_t> corners;
    for (const ModelPrimitive& primitive : mesh.primitives)
      corners[materials[primitive.material]] += primitive.indices.size();
    for (const auto& [material, count] : corners) work[material].reserve(count);
    for (size_t index = 0; index < mesh.primitives.size(); ++index) {
      const uint32_t material = materials[mesh.primitives[index].material];
      add_primitive(mesh, index, body_from_mesh, material, what, result.bounds, work[material]);
    }
    scene_.bodies.back().bounds.add(result.bounds);
    for (auto& [material, facet_work] : work) add_facets(material, facet_work);
    scene_.instances.push_back(std::move(result));
  }

  /// Triangles of one instance and material that are to be merged.
  struct FacetWork {
    FacetInput input;
    std::vector<uint32_t> triangles;  ///< their indices in the scene
    void reserve(size_t corners) {
      input.corners.reserve(corners);
      input.vertices.reserve(corners);
      triangles.reserve(corners / 3);
    }
  };

  void add_primitive(const ModelMesh& mesh, size_t index, const dmat4& body_from_mesh, uint32_t material,
                     const std::string& what, Bounds& bounds, FacetWork& work) {
    const ModelPrimitive& source = mesh.primitives[index];
    const bool has_normal_map = scene_.materials[material].pbr.normal_texture >= 0;
    const VertexData vertices = place_primitive(source, body_from_mesh, has_normal_map, what);
    flat_ += source.normals.empty() ? 1u : 0u;
    unmapped_ += has_normal_map && source.uvs.empty() ? 1u : 0u;
    const std::vector<uint32_t>& welded = welded_of(mesh)[index];

    Primitive primitive;
    primitive.first_index = static_cast<uint32_t>(scene_.indices.size());
    primitive.index_count = static_cast<uint32_t>(vertices.indices.size());
    primitive.material = material;
    primitive.instance = static_cast<uint32_t>(scene_.instances.size());
    for (size_t corner = 0; corner < vertices.indices.size(); ++corner) {
      if (corner % 3 == 0)
        work.triangles.push_back(static_cast<uint32_t>((scene_.indices.size() + corner) / 3));
      const uint32_t vertex = vertices.indices[corner];
      work.input.corners.push_back(vertices.positions[vertex]);
      work.input.vertices.push_back(welded[vertices.source[vertex]]);
      bounds.add(vertices.positions[vertex]);
    }
    work.input.noise_m = std::max(work.input.noise_m, rounding_noise(source, body_from_mesh));
    collapsed_ += append(vertices);
    scene_.primitives.push_back(primitive);
    ++scene_.bodies.back().primitive_count;
  }

  /// Appends the vertices and returns the number of triangles that have no area left in fp32.
  size_t append(const VertexData& vertices) {
    const size_t base = scene_.positions.size();
    const size_t total = base + vertices.positions.size();
    if (total > std::numeric_limits<uint32_t>::max() / 2) {
      throw_user_error("scene '{}': {} vertices are more than the renderer can index", scene_.name, total);
    }
    for (const dvec3& position : vertices.positions) scene_.positions.emplace_back(position);
    scene_.normals.insert(scene_.normals.end(), vertices.normals.begin(), vertices.normals.end());
    scene_.uvs.insert(scene_.uvs.end(), vertices.uvs.begin(), vertices.uvs.end());
    scene_.tangents.insert(scene_.tangents.end(), vertices.tangents.begin(), vertices.tangents.end());
    scene_.tangents.resize(total, vec4(0.0f));
    for (const uint32_t index : vertices.indices)
      scene_.indices.push_back(static_cast<uint32_t>(base) + index);
    size_t collapsed = 0;
    for (size_t first = scene_.indices.size() - vertices.indices.size(); first < scene_.indices.size();
         first += 3) {
      const dvec3 a(scene_.positions[scene_.indices[first]]), b(scene_.positions[scene_.indices[first + 1]]),
          c(scene_.positions[scene_.indices[first + 2]]);
      if (glm::cross(b - a, c - a) == dvec3(0.0)) ++collapsed;
    }
    return collapsed;
  }

  const std::vector<std::vector<uint32_t>>& welded_of(const ModelMesh& mesh) {
    const auto [entry, is_new] = welded_.try_emplace(&mesh);
    if (is_new) entry->second = weld(mesh);
    return entry->second;
  }

  void add_facets(uint32_t material, const FacetWork& work) {
    const FacetGroups merged = merge_coplanar(work.input, options_);
    scene_.facet_of_triangle.resize(scene_.indices.size() / 3);
    for (const FacetGroup& group : merged.groups) {
      Facet facet;
      facet.normal = group.normal;
      facet.offset = group.offset;
      facet.body = current_body();
      facet.material = material;
      facet.instance = static_cast<uint32_t>(scene_.instances.size());
      facet.first_triangle = static_cast<uint32_t>(scene_.facet_triangles.size());
      facet.triangle_count = group.count;
      for (const uint32_t triangle : std::span(merged.triangles).subspan(group.first, group.count)) {
        const dvec3* corners = &work.input.corners[triangle * 3];
        scene_.facet_triangles.push_back({{corners[0], corners[1], corners[2]}});
        scene_.facet_of_triangle[work.triangles[triangle]] = static_cast<uint32_t>(scene_.facets.size());
      }
      scene_.facets.push_back(facet);
    }
  }

  Scene& scene_;
  const BuildOptions& options_;
  MaterialMerger materials_;
  std::set<std::string> names_;
  std::map<std::string, uint32_t> next_number_;
  std::set<const Model*> noted_;
  std::map<const ModelMesh*, std::vector<std::vector<uint32_t>>> welded_;
  size_t collapsed_ = 0, flat_ = 0, unmapped_ = 0;
};

}  // namespace

Scene build_scene(const std::vector<ModelPlacement>& placements, const BuildOptions& options) {
  const Activity activity("building the scene");
  for (const ModelPlacement& placement : placements) check_placement(placement);
  const Planned planned = planned_of(placements);
  Scene scene;
  scene.name = options.name;
  scene.origin = options.origin ? *options.origin : default_origin(placements);
  scene.georeference = options.georeference;
  scene.positions.reserve(planned.vertices);
  scene.normals.reserve(planned.vertices);
  scene.tangents.reserve(planned.vertices);
  scene.uvs.reserve(planned.vertices);
  scene.indices.reserve(3 * planned.triangles);
  scene.facet_triangles.reserve(planned.triangles);
  scene.facet_of_triangle.reserve(planned.triangles);
  Builder builder(scene, options);
  builder.add_body("static");
  for (const ModelPlacement& placement : placements) {
    if (!placement.moving) builder.add(placement);
  }
  for (const ModelPlacement& placement : placements) {
    if (!placement.moving) continue;
    const auto same = [&](const Body& body) { return body.name == placement.name; };
    if (placement.name.empty() || std::any_of(scene.bodies.begin(), scene.bodies.end(), same)) {
      throw_user_error("moving object '{}' ({}): expected a name that no other body has", placement.name,
                       placement.model->file.string());
    }
    builder.add_body(placement.name);
    builder.add(placement);
    builder.add_parts(placement, static_cast<uint32_t>(scene.bodies.size() - 1));
  }
  builder.finish();
  return scene;
}

}  // namespace greatx::scene
