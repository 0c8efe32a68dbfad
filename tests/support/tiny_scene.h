// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes scenes of a few triangles in the test that needs them, without a loader or a file.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "scene/description/scene.h"

namespace greatx::test {

using Triangle = std::array<dvec3, 3>;

/// Builds objects from flat faces. Each object is one instance and one primitive; each face is one facet.
class TinyScene {
 public:
  TinyScene() {
    scene::Body world;
    world.name = "static";
    bodies_.push_back(world);
    material("default", 0.5f);
  }

  /// Adds a Lambertian material with the given reflectance at 905 nm and half of it at 1550 nm.
  uint32_t material(const std::string& name, float reflectance_905nm) {
    scene::Material material;
    material.name = name;
    material.reflectance_905nm = reflectance_905nm;
    material.reflectance_1550nm = 0.5f * reflectance_905nm;
    return material_as(material);
  }
  uint32_t material_as(const scene::Material& material) {
    materials_.push_back(material);
    return static_cast<uint32_t>(materials_.size() - 1);
  }
  uint32_t texture(const scene::Texture& texture) {
    textures_.push_back(texture);
    return static_cast<uint32_t>(textures_.size() - 1);
  }
  /// Adds a movable body. Body 0 is the static world.
  uint32_t body(const std::string& name) {
    scene::Body body;
    body.name = name;
    bodies_.push_back(body);
    return static_cast<uint32_t>(bodies_.size() - 1);
  }
  /// Begins an object, to which the next faces belong. Instances are numbered by body first and then in the
  /// order of the calls.
  TinyScene& object(const std::string& name, uint32_t body = 0, uint32_t material = 0) {
    objects_.push_back({name, body, material, {}});
    return *this;
  }
  /// Adds coplanar triangles as one facet. Their corners run counter-clockwise as seen from the side of the
  /// normal.
  TinyScene& face(const std::vector<Triangle>& triangles) {
    if (objects_.empty()) object("object");
    objects_.back().faces.push_back(triangles);
    return *this;
  }
  TinyScene& triangle(const dvec3& a, const dvec3& b, const dvec3& c) { return face({{a, b, c}}); }
  /// Adds a quad, split along a-c. Its corners run counter-clockwise, with uv (0,0), (1,0), (1,1), (0,1).
  TinyScene& quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
    return face({{a, b, c}, {a, c, d}});
  }
  /// Adds the faces of a box but for its top, with normals that point outwards.
  TinyScene& open_box(const dvec3& a, const dvec3& b) {
    return quad({a.x, a.y, a.z}, {a.x, b.y, a.z}, {b.x, b.y, a.z}, {b.x, a.y, a.z})
        .quad({a.x, a.y, a.z}, {b.x, a.y, a.z}, {b.x, a.y, b.z}, {a.x, a.y, b.z})
        .quad({a.x, b.y, a.z}, {a.x, b.y, b.z}, {b.x, b.y, b.z}, {b.x, b.y, a.z})
        .quad({a.x, a.y, a.z}, {a.x, a.y, b.z}, {a.x, b.y, b.z}, {a.x, b.y, a.z})
        .quad({b.x, a.y, a.z}, {b.x, b.y, a.z}, {b.x, b.y, b.z}, {b.x, a.y, b.z});
  }
  /// Adds a closed box of six quads with normals that point outwards.
  TinyScene& box(const dvec3& low, const dvec3& high) {
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

  /// Builds the scene. `origin` is the world position of the local origin. Faces of body 0 are given in world
  /// coordinates, all others in the coordinates of their body.
  scene::Scene build(const dvec3& origin = dvec3(0.0)) const {
    scene::Scene scene;
    scene.name = "tiny";
    scene.hash = std::string(64, '0');
    scene.origin = origin;
    scene.bodies = bodies_;
    scene.materials = materials_;
    scene.textures = textures_;
    for (uint32_t body = 0; body < bodies_.size(); ++body) {
      scene.bodies[body].first_primitive = static_cast<uint32_t>(scene.primitives.size());
      for (const Object& object : objects_)
        if (object.body == body) add(scene, object, body == 0 ? origin : dvec3(0.0));
      scene.bodies[body].primitive_count =
          static_cast<uint32_t>(scene.primitives.size()) - scene.bodies[body].first_primitive;
    }
    scene.bounds = scene.bodies[0].bounds;
    return scene;
  }

 private:
  struct Object {
    std::string name;
    uint32_t body = 0, material = 0;
    std::vector<std::vector<Triangle>> faces;
  };

  static void add(scene::Scene& scene, const Object& object, const dvec3& origin) {
    scene::Instance instance;
    instance.name = object.name;
    instance.body = object.body;
    const uint32_t first_index = static_cast<uint32_t>(scene.indices.size());
    for (const std::vector<Triangle>& face : object.faces) {
      scene::Facet facet;
      facet.body = object.body;
      facet.material = object.material;
      facet.instance = static_cast<uint32_t>(scene.instances.size());
      facet.first_triangle = static_cast<uint32_t>(scene.facet_triangles.size());
      facet.triangle_count = static_cast<uint32_t>(face.size());
      const dvec3 cross = glm::cross(face[0][1] - face[0][0], face[0][2] - face[0][0]);
      facet.normal = glm::dot(cross, cross) > 0.0 ? glm::normalize(cross) : dvec3(0, 0, 1);
      facet.offset = glm::dot(facet.normal, face[0][0] - origin);
      for (size_t i = 0; i < face.size(); ++i) {
        scene::FacetTriangle exact;
        for (int c = 0; c < 3; ++c) {
          exact.corners[c] = face[i][c] - origin;
          instance.bounds.add(exact.corners[c]);
          scene.indices.push_back(static_cast<uint32_t>(scene.positions.size()));
          scene.positions.push_back(vec3(exact.corners[c]));
          scene.normals.push_back(vec3(facet.normal));
          scene.tangents.push_back(vec4(0.0f));
          const vec2 first[] = {{0, 0}, {1, 0}, {1, 1}}, second[] = {{0, 0}, {1, 1}, {0, 1}};
          scene.uvs.push_back(i % 2 == 0 ? first[c] : second[c]);
        }
        scene.facet_triangles.push_back(exact);
        scene.facet_of_triangle.push_back(static_cast<uint32_t>(scene.facets.size()));
      }
      scene.facets.push_back(facet);
    }
    const uint32_t index_count = static_cast<uint32_t>(scene.indices.size()) - first_index;
    scene.primitives.push_back(
        {first_index, index_count, object.material, static_cast<uint32_t>(scene.instances.size())});
    scene.bodies[object.body].bounds.add(instance.bounds);
    scene.instances.push_back(instance);
  }

  std::vector<scene::Body> bodies_;
  std::vector<scene::Material> materials_;
  std::vector<scene::Texture> textures_;
  std::vector<Object> objects_;
};

}  // namespace greatx::test
