// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides a rig for a camera with its ground truth. The expected values come from independent fp64 methods:
// rays cast against all triangles, and points moved with their bodies and projected again.
#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/camera/truth.h"
#include "tests/renderer/camera_rig.h"

namespace greatx::test {

using render::CameraDesc;
using render::TruthImages;

struct Moment {
  Pose camera;
  std::vector<Pose> bodies{Pose{}};
};

struct Picture {
  render::CameraImages images;
  TruthImages truth;
};

class TruthRig {
 public:
  TruthRig(scene::Scene scene, CameraDesc desc, const render::TruthOutputs& outputs = {true, true, true})
      : scene_(std::move(scene)),
        gpu_(device(), scene_, {.acceleration_structure = false, .textures = true}),
        lighting_(gpu_, plain_light(), {}),
        camera_(lighting_, desc),
        truth_(lighting_, desc, outputs),
        ring_(device(), 2, 1 << 16, 1 << 20) {}

  gpu::TickSlot& record(Moment now, Moment next) {
    now.bodies.resize(scene_.bodies.size());
    next.bodies.resize(scene_.bodies.size());
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, now.bodies);
    lighting_.record(slot, now.bodies);
    camera_.record(slot, now.camera);
    truth_.record(slot, camera_.seen(), {now.camera, now.bodies}, {next.camera, next.bodies});
    ring_.submit(slot);
    return slot;
  }
  Picture collect(const gpu::TickSlot& slot) {
    ring_.wait(slot);
    return {camera_.collect(slot), truth_.collect(slot)};
  }
  Picture shoot(const Moment& now, const Moment& next) { return collect(record(now, next)); }
  const scene::Scene& scene() const { return scene_; }

 private:
  scene::Scene scene_;
  scene::GpuScene gpu_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  render::TruthPass truth_;
  gpu::TickRing ring_;
};

inline CameraDesc truth_camera(uint32_t size = 64, uint32_t msaa = 1) {
  CameraDesc desc = plain_camera(size, msaa);
  desc.outputs.hdr = desc.outputs.rgb = false;
  desc.outputs.seen = true;
  desc.cx += 3.25;  // keeps the camera general
  desc.fy *= 1.125;
  return desc;
}

/// Describes the first intersection of a ray with the scene, in fp64.
struct Hit {
  uint32_t triangle = 0, primitive = 0;
  double distance = 0.0;
  dvec3 point{0.0};  ///< local coordinates, m
  dvec2 barycentrics{0.0};
};

inline std::optional<Hit> cast(const scene::Scene& scene, const std::vector<Pose>& bodies, const dvec3& eye,
                               const dvec3& ray) {
  std::optional<Hit> nearest;
  for (uint32_t p = 0; p < scene.primitives.size(); ++p) {
    const scene::Primitive& primitive = scene.primitives[p];
    const uint32_t body = scene.instances[primitive.instance].body;
    const Pose pose = body == 0 ? Pose{} : bodies[body];
    for (uint32_t i = 0; i < primitive.index_count; i += 3) {
      dvec3 corner[3];
      for (int c = 0; c < 3; ++c)
        corner[c] = pose.apply(dvec3(scene.positions[scene.indices[primitive.first_index + i + c]])) - eye;
      const dvec3 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0], across = glm::cross(ray, e2);
      const double det = glm::dot(e1, across);
      if (std::abs(det) < 1e-14) continue;
      const double u = -glm::dot(corner[0], across) / det;
      const dvec3 q = glm::cross(-corner[0], e1);
      const double v = glm::dot(ray, q) / det, t = glm::dot(e2, q) / det;
      if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || (nearest && nearest->distance <= t)) continue;
      nearest = {(primitive.first_index + i) / 3, p, t, eye + t * ray, {u, v}};
    }
  }
  return nearest;
}

/// Returns the pixel coordinates of a local point and its depth. The point is not visible if z <= 0.
inline dvec3 project(const CameraDesc& desc, const Pose& camera, const dvec3& point) {
  const dvec3 in_sensor = glm::conjugate(camera.orientation) * (point - camera.position);
  return {desc.cx - desc.fx * in_sensor.y / in_sensor.x, desc.cy - desc.fy * in_sensor.z / in_sensor.x,
          in_sensor.x};
}

/// Returns the point to which its body carries the surface point `hit` from `now` to `next`.
inline dvec3 carried(const scene::Scene& scene, const Hit& hit, const Moment& now, const Moment& next) {
  const uint32_t body = scene.instances[scene.primitives[hit.primitive].instance].body;
  return body == 0 ? hit.point : next.bodies[body].apply(now.bodies[body].inverse().apply(hit.point));
}

/// Returns a scene of ground, a wall at a distance of a kilometre and a tilted board near by, all relative to
/// `center`.
inline TinyScene street(const dvec3& center = dvec3(0.0)) {
  TinyScene scene;
  const auto at = [&](double x, double y, double z) { return center + dvec3(x, y, z); };
  scene.object("ground").quad(at(-50, -800, -2), at(1500, -800, -2), at(1500, 800, -2), at(-50, 800, -2));
  scene.object("far wall")
      .quad(at(1000, -300, -2), at(1000, 200, -2), at(1000, 200, 150), at(1000, -300, 150));
  scene.object("board").quad(at(6, 1, -1), at(9, 3, -1.5), at(8.5, 3.5, 2), at(5.5, 1.5, 2));
  return scene;
}

}  // namespace greatx::test
