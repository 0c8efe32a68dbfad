// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "tests/rf/scenes.h"

#include "core/error.h"

namespace greatx::rf::testing {

uint32_t HandScene::material(const std::string& name, double relative, double sigma, double thickness_m) {
  scene::RadioMedium medium;
  medium.source = "test";
  medium.rows.push_back({relative, 0.0, sigma, 0.0, 1e3, 1e15});
  scene::RadioMaterial radio;
  radio.layers.push_back({medium, thickness_m});
  scene::Material made;
  made.name = name;
  made.radio = radio;
  scene.materials.push_back(made);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

uint32_t HandScene::itu_material(const std::string& name, double thickness_m) {
  const uint32_t index = material(name, 1.0, 0.0, thickness_m);
  const std::optional<scene::RadioMedium> medium = scene::itu_medium(name);
  GREATX_CHECK(medium.has_value(), "no ITU material '{}'", name);
  scene.materials[index].radio->layers[0].medium = *medium;
  return index;
}

uint32_t HandScene::body() {
  scene.bodies.push_back({.name = "body", .first_primitive = 0, .primitive_count = 0, .bounds = {}});
  return static_cast<uint32_t>(scene.bodies.size() - 1);
}

uint32_t HandScene::facet(const std::vector<scene::FacetTriangle>& triangles, uint32_t material,
                          uint32_t body) {
  scene::Facet made;
  const dvec3* corner = triangles[0].corners;
  made.normal = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  made.offset = glm::dot(made.normal, corner[0]);
  made.body = body;
  made.material = material;
  made.first_triangle = static_cast<uint32_t>(scene.facet_triangles.size());
  made.triangle_count = static_cast<uint32_t>(triangles.size());
  scene.facet_triangles.insert(scene.facet_triangles.end(), triangles.begin(), triangles.end());
  scene.facets.push_back(made);
  return static_cast<uint32_t>(scene.facets.size() - 1);
}

uint32_t HandScene::triangle(const dvec3& a, const dvec3& b, const dvec3& c, uint32_t material,
                             uint32_t body) {
  return facet({{{a, b, c}}}, material, body);
}

uint32_t HandScene::quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, uint32_t material,
                         uint32_t body) {
  return facet({{{a, b, c}}, {{a, c, d}}}, material, body);
}

void HandScene::room(const dvec3& size, const dvec3& o) {
  const dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  quad(o, o + y, o + y + z, o + z);                  // x = 0, facing +x
  quad(o + x, o + x + z, o + x + y + z, o + x + y);  // x = size, facing -x
  quad(o, o + z, o + x + z, o + x);                  // y = 0
  quad(o + y, o + x + y, o + x + y + z, o + y + z);  // y = size
  quad(o, o + x, o + x + y, o + y);                  // z = 0
  quad(o + z, o + y + z, o + x + y + z, o + x + z);  // z = size
}

uint32_t HandScene::ground(double half, double height, uint32_t material) {
  return quad({-half, -half, height}, {half, -half, height}, {half, half, height}, {-half, half, height},
              material);
}

}  // namespace greatx::rf::testing
