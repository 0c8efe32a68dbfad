// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the tests of boxes look at, and the rays in fp64 by which they check it.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "core/units.h"
#include "renderer/lens/lens_rays.h"
#include "sim/sensors/camera/boxes.h"
#include "tests/renderer/camera_rig.h"
#include "tests/sim/box_camera.h"

namespace greatx::sim {

using render::CameraDesc;
using test::box_camera;
using test::look;
using test::TinyScene;

inline scene::Scene labelled(const TinyScene& tiny,
                             scene::SemanticClass semantic_class = scene::SemanticClass::vehicle,
                             const dvec3& origin = dvec3(0.0)) {
  scene::Scene scene = tiny.build(origin);
  for (scene::Instance& instance : scene.instances) instance.semantic_class = semantic_class;
  return scene;
}

inline std::vector<uint32_t> nothing(const CameraDesc& desc) {
  return std::vector<uint32_t>(size_t{desc.width} * desc.height, 0);
}

inline dvec3 projected(const CameraDesc& desc, const Pose& camera, const dvec3& point) {
  const dvec3 p = camera.inverse().apply(point);
  return {desc.cx - desc.fx * p.y / p.x, desc.cy - desc.fy * p.z / p.x, p.x};
}

/// Returns whether a ray meets a triangle at `near` times the ray or beyond (Moeller and Trumbore), in fp64.
inline bool meets(const dvec3& eye, const dvec3& ray, const dvec3& a, const dvec3& b, const dvec3& c,
                  double near) {
  const dvec3 e1 = b - a, e2 = c - a, across = glm::cross(ray, e2);
  const double det = glm::dot(e1, across);
  if (det == 0.0) return false;
  const dvec3 from = eye - a, q = glm::cross(from, e1);
  const double u = glm::dot(from, across) / det, v = glm::dot(ray, q) / det, t = glm::dot(e2, q) / det;
  return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t >= near;
}

inline uint32_t rays_that_meet(const Boxes::Object& object, const Pose& local_from_body,
                               const CameraDesc& desc, const Pose& camera,
                               const render::Lens* lens = nullptr) {
  std::vector<dvec3> corners;
  for (const uint32_t i : object.indices) corners.push_back(local_from_body.apply(object.vertices[i]));
  uint32_t count = 0;
  for (uint32_t row = 0; row < desc.height; ++row)
    for (uint32_t column = 0; column < desc.width; ++column) {
      dvec3 in_sensor = test::pixel_ray(desc, column, row);
      if (lens != nullptr) {
        const dvec2 n = lens->undistorted({column + 0.5, row + 0.5});
        in_sensor = {1.0, -n.x, -n.y};
      }
      const dvec3 ray = camera.rotate(in_sensor);
      bool met = false;
      for (size_t i = 0; !met && i < corners.size(); i += 3)
        met = meets(camera.position, ray, corners[i], corners[i + 1], corners[i + 2], desc.near_m);
      count += met ? 1 : 0;
    }
  return count;
}

/// Holds boxes of all sizes and attitudes around the origin, one for each body, and the poses of the bodies.
struct Crowd {
  TinyScene tiny;
  std::vector<Pose> bodies{Pose{}};
};
inline Crowd crowd(int count, double nearest, double farthest) {
  Crowd crowd;
  std::mt19937 draw(7);
  const auto uniform = [&](double a, double b) {
    return a + (b - a) * static_cast<double>(draw()) / static_cast<double>(std::mt19937::max());
  };
  for (int i = 0; i < count; ++i) {
    const std::string name = "object " + std::to_string(i);
    const uint32_t body = crowd.tiny.body(name);
    const dvec3 half(uniform(0.05, 2), uniform(0.05, 2), uniform(0.05, 2));
    crowd.tiny.object(name, body).box(-half, half);
    const double range = uniform(nearest, farthest), bearing = uniform(-60, 60), turn = uniform(-180, 180);
    Pose pose = look({range * std::cos(radians(bearing)), range * std::sin(radians(bearing)), uniform(-4, 4)},
                     turn, uniform(-40, 40), uniform(-90, 90));
    crowd.bodies.push_back(pose);
  }
  return crowd;
}

}  // namespace greatx::sim
