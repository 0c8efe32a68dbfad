// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/ranges.h>

#include "core/error.h"
#include "core/text.h"
#include "core/units.h"
#include "scene/description/semantic.h"

namespace greatx::scene {
namespace {

using nlohmann::json;

/// Returns the rotation from glTF's axes (y up) to z up: x_east = x, y_north = -z, z_up = y.
dmat4 z_up_from_y_up() {
  return dmat4(dvec4(1, 0, 0, 0), dvec4(0, 0, 1, 0), dvec4(0, -1, 0, 0), dvec4(0, 0, 0, 1));
}

/// A node that is still to be visited.
struct Visit {
  int node = -1;
  dmat4 model_from_parent{1.0};
  std::optional<SemanticClass> inherited;
  int parent = -1;  ///< into Model::nodes
};

class NodeReader {
 public:
  NodeReader(const GltfFile& file, Model& model) : file_(file), model_(model) {}

  void run() {
    visited_.assign(file_.model.nodes.size(), false);
    std::vector<Visit> stack;
    const std::vector<int> roots = root_nodes();
    for (auto root = roots.rbegin(); root != roots.rend(); ++root)
      stack.push_back({*root, z_up_from_y_up(), {}, -1});
    while (!stack.empty()) {
      const Visit visit = stack.back();
      stack.pop_back();
      this->visit(visit, stack);
    }
    // A node without descendants ends at itself. Going backwards, the end of each node also extends its
    // parent.
    for (size_t i = model_.nodes.size(); i-- > 0;) {
      model_.nodes[i].end = std::max(model_.nodes[i].end, static_cast<uint32_t>(i + 1));
      if (parents_[i] >= 0) {
        uint32_t& end = model_.nodes[static_cast<size_t>(parents_[i])].end;
        end = std::max(end, model_.nodes[i].end);
      }
    }
    note_unlabeled();
  }

 private:
  std::string node_name(size_t index) const {
    const tinygltf::Node& node = file_.model.nodes[index];
    if (!node.name.empty()) return node.name;
    const auto meshes = file_.model.meshes.size();
    if (node.mesh >= 0 && static_cast<size_t>(node.mesh) < meshes) {
      const std::string& mesh = file_.model.meshes[static_cast<size_t>(node.mesh)].name;
      if (!mesh.empty()) return mesh;
    }
    return fmt::format("node_{}", index);
  }

  /// Returns the roots of the default scene. Without scenes these are all nodes that are not a child (glTF
  /// 2.0, section 3.5.1).
  std::vector<int> root_nodes() {
    const auto& scenes = file_.model.scenes;
    if (!scenes.empty()) {
      const int chosen = std::max(file_.model.defaultScene, 0);
      if (static_cast<size_t>(chosen) >= scenes.size()) {
        throw_user_error("{}: scene {} does not exist (the file has {})", file_.name, chosen, scenes.size());
      }
      if (scenes.size() > 1) {
        model_.notes.push_back(
            fmt::format("{}: {} scenes, of which number {} is loaded", file_.name, scenes.size(), chosen));
      }
      return scenes[static_cast<size_t>(chosen)].nodes;
    }
    std::vector<bool> is_child(file_.model.nodes.size(), false);
    for (const tinygltf::Node& node : file_.model.nodes) {
      for (const int child : node.children) {
        if (child >= 0 && static_cast<size_t>(child) < is_child.size())
          is_child[static_cast<size_t>(child)] = true;
      }
    }
    std::vector<int> roots;
    for (size_t index = 0; index < is_child.size(); ++index) {
      if (!is_child[index]) roots.push_back(static_cast<int>(index));
    }
    if (roots.empty() && !is_child.empty()) throw_user_error("{}: its nodes form a cycle", file_.name);
    return roots;
  }

  void visit(const Visit& visit, std::vector<Visit>& stack) {
    if (visit.node < 0 || static_cast<size_t>(visit.node) >= visited_.size()) {
      throw_user_error("{}: node {} does not exist (the file has {})", file_.name, visit.node,
                       visited_.size());
    }
    const auto index = static_cast<size_t>(visit.node);
    const std::string what = fmt::format("{}: node '{}'", file_.name, printable(node_name(index)));
    if (visited_[index])
      throw_user_error("{} is reached twice: the nodes form a cycle or share a child", what);
    visited_[index] = true;
    const tinygltf::Node& node = file_.model.nodes[index];
    const dmat4 model_from_node = visit.model_from_parent * local_transform(node, what);
    const auto semantic_class = class_of(index, visit.inherited, what);
    const int here = static_cast<int>(model_.nodes.size());
    model_.nodes.push_back({node_name(index), model_from_node, 0});
    parents_.push_back(visit.parent);
    if (node.mesh >= 0) add_instance(index, model_from_node, semantic_class, what);
    add_light(index, model_from_node, what);
    note_ignored(node, what);
    for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) {
      stack.push_back({*child, model_from_node, semantic_class, here});
    }
  }

  static void check_numbers(const std::vector<double>& numbers, size_t count, const char* field,
                            const std::string& what) {
    const bool finite =
        std::all_of(numbers.begin(), numbers.end(), [](double value) { return std::isfinite(value); });
    if ((!numbers.empty() && numbers.size() != count) || !finite) {
      throw_user_error("{}: {}: expected {} finite numbers, found [{}]", what, field, count,
                       fmt::join(numbers, ", "));
    }
  }

  static dmat4 local_transform(const tinygltf::Node& node, const std::string& what) {
    check_numbers(node.matrix, 16, "matrix", what);
    check_numbers(node.translation, 3, "translation", what);
    check_numbers(node.rotation, 4, "rotation", what);
    check_numbers(node.scale, 3, "scale", what);
    dmat4 transform(1.0);
    if (!node.matrix.empty()) {
      for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row)
          transform[column][row] = node.matrix[static_cast<size_t>(column * 4 + row)];
      }
      const bool affine = transform[0][3] == 0.0 && transform[1][3] == 0.0 && transform[2][3] == 0.0 &&
                          transform[3][3] == 1.0;
      if (!affine) throw_user_error("{}: its matrix is not affine (last row 0, 0, 0, 1)", what);
      return transform;
    }
    dquat rotation(1.0, 0.0, 0.0, 0.0);
    if (!node.rotation.empty()) {
      rotation = dquat(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);  // w first
      if (std::abs(glm::length(rotation) - 1.0) > 1e-2) {
        throw_user_error("{}: rotation: expected a unit quaternion, found length {}", what,
                         glm::length(rotation));
      }
      rotation = glm::normalize(rotation);
    }
    const dvec3 scale = node.scale.empty() ? dvec3(1.0) : dvec3(node.scale[0], node.scale[1], node.scale[2]);
    transform = glm::mat4_cast(rotation);
    for (int axis = 0; axis < 3; ++axis) transform[axis] *= scale[axis];
    if (!node.translation.empty()) {
      transform[3] = dvec4(node.translation[0], node.translation[1], node.translation[2], 1.0);
    }
    return transform;
  }

  /// Returns the class by "greatx_class" of the extras, else by the name of the node or of its mesh, else the
  /// class of the parent.
  std::optional<SemanticClass> class_of(size_t index, std::optional<SemanticClass> inherited,
                                        const std::string& what) const {
    const json& document = file_.element("nodes", index);
    const auto extras = document.find("extras");
    if (extras != document.end() && extras->is_object() && extras->contains("greatx_class")) {
      const json& value = (*extras)["greatx_class"];
      const auto found = value.is_string() ? semantic_class_called(value.get<std::string>()) : std::nullopt;
      if (!found) {
        throw_user_error("{}: greatx_class {}: expected one of {}", what, value.dump(),
                         fmt::join(semantic_class_names(), ", "));
      }
      return found;
    }
    if (const auto found = semantic_class_from_name(node_name(index))) return found;
    const int mesh = file_.model.nodes[index].mesh;
    if (mesh >= 0 && static_cast<size_t>(mesh) < file_.model.meshes.size()) {
      if (const auto found = semantic_class_from_name(file_.model.meshes[static_cast<size_t>(mesh)].name))
        return found;
    }
    return inherited;
  }

  void add_instance(size_t index, const dmat4& model_from_node, std::optional<SemanticClass> semantic_class,
                    const std::string& what) {
    const int mesh = file_.model.nodes[index].mesh;
    if (static_cast<size_t>(mesh) >= file_.model.meshes.size()) {
      throw_user_error("{}: mesh {} does not exist (the file has {})", what, mesh, file_.model.meshes.size());
    }
    const double determinant = glm::determinant(glm::dmat3(model_from_node));
    if (!std::isfinite(determinant) || determinant == 0.0) {
      throw_user_error("{}: its transform is singular (determinant {}): a scale is 0", what, determinant);
    }
    if (!semantic_class) unlabeled_.push_back(printable(node_name(index)));
    model_.instances.push_back({node_name(index), static_cast<uint32_t>(mesh), model_from_node,
                                semantic_class.value_or(SemanticClass::unlabeled),
                                static_cast<uint32_t>(model_.nodes.size() - 1)});
  }

  /// Adds the light of a node (KHR_lights_punctual). It shines along the node's -z.
  void add_light(size_t index, const dmat4& model_from_node, const std::string& what) {
    const json& document = file_.element("nodes", index);
    const auto pointer = json::json_pointer("/extensions/KHR_lights_punctual/light");
    if (!document.contains(pointer)) return;
    const json& light_index = document.at(pointer);
    const auto& lights = file_.model.lights;
    if (!light_index.is_number_unsigned() || light_index.get<uint64_t>() >= lights.size()) {
      throw_user_error("{}: light {} does not exist (the file has {})", what, light_index.dump(),
                       lights.size());
    }
    const tinygltf::Light& source = lights[light_index.get<size_t>()];
    PunctualLight light;
    light.name = source.name.empty() ? node_name(index) : source.name;
    light.position = dvec3(model_from_node[3]);
    const dvec3 direction = glm::dmat3(model_from_node) * dvec3(0.0, 0.0, -1.0);
    if (!(glm::length(direction) > 0.0)) throw_user_error("{}: a light's transform is singular", what);
    light.direction = glm::normalize(direction);
    set_light(source, light, what + ", light '" + light.name + "'");
    set_beam(source, light, what + ", light '" + light.name + "'");
    model_.lights.push_back(light);
    model_.nodes_of_lights.push_back(static_cast<uint32_t>(model_.nodes.size() - 1));
  }

  /// Reads extras.greatx_beam of a spot.
  static void set_beam(const tinygltf::Light& source, PunctualLight& light, const std::string& what) {
    if (!source.extras.IsObject() || !source.extras.Has("greatx_beam")) return;
    const tinygltf::Value& beam = source.extras.Get("greatx_beam");
    if (light.type != PunctualLight::Type::spot || !beam.IsString() || beam.Get<std::string>() != "passing")
      throw_user_error("{}: extras.greatx_beam: expected \"passing\" of a spot, found {}", what,
                       beam.IsString() ? "'" + beam.Get<std::string>() + "' of a " + source.type
                                       : std::string("no string"));
    light.beam = PunctualLight::Beam::passing;
  }

  static void set_light(const tinygltf::Light& source, PunctualLight& light, const std::string& what) {
    using Type = PunctualLight::Type;
    if (source.type == "point")
      light.type = Type::point;
    else if (source.type == "spot")
      light.type = Type::spot;
    else if (source.type == "directional")
      light.type = Type::directional;
    else
      throw_user_error("{}: type '{}', expected point, spot or directional", what, source.type);
    check_numbers(source.color, 3, "color", what);
    if (!source.color.empty()) light.color = vec3(dvec3(source.color[0], source.color[1], source.color[2]));
    light.intensity = static_cast<float>(source.intensity);
    light.range_m = static_cast<float>(source.range);
    const bool good = std::isfinite(light.intensity) && light.intensity >= 0.0f &&
                      std::isfinite(light.range_m) && light.range_m >= 0.0f &&
                      glm::all(glm::greaterThanEqual(light.color, vec3(0.0f)));
    if (!good) {
      throw_user_error("{}: expected intensity, range and colour of 0 or more, found {}, {}, [{}]", what,
                       source.intensity, source.range, fmt::join(source.color, ", "));
    }
    if (light.type != Type::spot) return;
    light.inner_cone = static_cast<float>(source.spot.innerConeAngle);
    light.outer_cone = static_cast<float>(source.spot.outerConeAngle);
    const bool ordered = light.inner_cone >= 0.0f && light.inner_cone < light.outer_cone &&
                         light.outer_cone <= static_cast<float>(pi / 2.0);
    if (!ordered) {
      throw_user_error("{}: expected 0 <= innerConeAngle < outerConeAngle <= pi/2, found {} and {}", what,
                       source.spot.innerConeAngle, source.spot.outerConeAngle);
    }
  }

  void note_ignored(const tinygltf::Node& node, const std::string& what) {
    if (node.skin >= 0) model_.notes.push_back(what + ": its skin is ignored");
    if (node.extensions.count("EXT_mesh_gpu_instancing") > 0) {
      model_.notes.push_back(what + ": EXT_mesh_gpu_instancing is ignored");
    }
  }

  void note_unlabeled() {
    if (unlabeled_.empty()) return;
    constexpr size_t shown = 5;
    const std::vector<std::string> first(
        unlabeled_.begin(),
        unlabeled_.begin() + static_cast<std::ptrdiff_t>(std::min(shown, unlabeled_.size())));
    model_.notes.push_back(fmt::format(
        "{}: {} objects have no semantic class (extras \"greatx_class\" or a name of "
        "docs/materials.md): {}{}",
        file_.name, unlabeled_.size(), fmt::join(first, ", "), unlabeled_.size() > shown ? ", …" : ""));
  }

  const GltfFile& file_;
  Model& model_;
  std::vector<bool> visited_;
  std::vector<int> parents_;  ///< [Model::nodes]
  std::vector<std::string> unlabeled_;
};

}  // namespace

void read_nodes(const GltfFile& file, Model& model) { NodeReader(file, model).run(); }

}  // namespace greatx::scene
