// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/selftest/stage.h"

#include "scene/build/build.h"

namespace greatx::apps::selftest {

Stage::Stage(bool hole) : hole_(hole) {
  model_.file = "selftest";
  material(5.24, 0.123, 0.0);
}

uint32_t Stage::material(double relative, double sigma, double thickness_m) {
  scene::RadioMedium medium;
  medium.source = "selftest";
  medium.rows.push_back({relative, 0.0, sigma, 0.0, 1e6, 1e15});
  scene::RadioMaterial radio;
  radio.layers.push_back({medium, thickness_m});
  scene::Material material;
  material.name = "material " + std::to_string(model_.materials.size());
  material.radio = radio;
  material.reflectance_905nm = material.reflectance_1550nm = 1.0f;
  model_.materials.push_back(material);
  return static_cast<uint32_t>(model_.materials.size() - 1);
}

Stage& Stage::object(const std::string& name, uint32_t material) {
  const auto index = static_cast<uint32_t>(model_.instances.size());
  model_.meshes.push_back({name, {}});
  scene::ModelNode node;
  node.name = name;
  node.end = index + 1;
  model_.nodes.push_back(node);
  scene::ModelInstance instance;
  instance.name = name;
  instance.mesh = instance.node = index;
  model_.instances.push_back(instance);
  triangles_.emplace_back();
  materials_.push_back(material);
  normals_.emplace_back();
  return *this;
}

Stage& Stage::normal(const dvec3& normal) {
  normals_.back() = normal;
  return *this;
}

Stage& Stage::triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
  if (triangles_.empty()) object("object");
  triangles_.back().push_back({a, b, c});
  return *this;
}

Stage& Stage::quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  return triangle(a, b, c).triangle(a, c, d);
}

Stage& Stage::box(const dvec3& low, const dvec3& high) {
  const auto p = [&](int x, int y, int z) {
    return dvec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
  };
  return quad(p(0, 0, 0), p(0, 1, 0), p(1, 1, 0), p(1, 0, 0))
      .quad(p(0, 0, 1), p(1, 0, 1), p(1, 1, 1), p(0, 1, 1))
      .quad(p(0, 0, 0), p(1, 0, 0), p(1, 0, 1), p(0, 0, 1))
      .quad(p(0, 1, 0), p(0, 1, 1), p(1, 1, 1), p(1, 1, 0))
      .quad(p(0, 0, 0), p(0, 0, 1), p(0, 1, 1), p(0, 1, 0))
      .quad(p(1, 0, 0), p(1, 1, 0), p(1, 1, 1), p(1, 0, 1));
}

scene::Scene Stage::build(const dvec3& shift, const dvec3& origin, const dvec3& scale) const {
  scene::Model model = model_;
  for (size_t object = 0; object < triangles_.size(); ++object) {
    scene::ModelPrimitive primitive;
    primitive.material = materials_[object];
    for (size_t i = hole_ ? 1 : 0; i < triangles_[object].size(); ++i)
      for (const dvec3& corner : triangles_[object][i]) {
        primitive.indices.push_back(static_cast<uint32_t>(primitive.positions.size()));
        primitive.positions.push_back(vec3(corner));
        if (normals_[object]) primitive.normals.emplace_back(*normals_[object]);
      }
    if (!primitive.indices.empty()) model.meshes[object].primitives.push_back(std::move(primitive));
  }
  scene::ModelPlacement placement;
  placement.model = &model;
  placement.pose.position = shift;
  placement.scale = scale;
  scene::BuildOptions options;
  options.name = "selftest";
  options.origin = origin;
  return scene::build_scene({placement}, options);
}

}  // namespace greatx::apps::selftest
