// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/camera_view.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace greatx::render {

PinholeView pinhole_of(const CameraDesc& desc) {
  if (!desc.distortion.any()) return {desc.width, desc.height, desc.fx, desc.fy, desc.cx, desc.cy};
  const Lens lens(lens_geometry(desc));
  const LensBounds& bounds = lens.bounds();
  constexpr double margin = 1.0;  // pixels
  const double width = std::ceil(desc.fx * (bounds.most.x - bounds.least.x) + 2.0 * margin);
  const double height = std::ceil(desc.fy * (bounds.most.y - bounds.least.y) + 2.0 * margin);
  constexpr double most = 8.0;  // largest size, relative to the picture
  if (!(width <= most * desc.width && height <= most * desc.height))
    throw_user_error(
        "camera {}: distortion: expected a pinhole picture of what the lens sees within {} times {} x {}, "
        "found {} x {}",
        desc.name, most, desc.width, desc.height, width, height);
  return {static_cast<uint32_t>(width),      static_cast<uint32_t>(height),    desc.fx, desc.fy,
          margin - bounds.least.x * desc.fx, margin - bounds.least.y * desc.fy};
}

CameraView::CameraView(const PinholeView& pinhole_view, double near_m, const Pose& local_from_sensor,
                       const SunFrame& sun, double exposure)
    : pinhole(pinhole_view),
      eye(local_from_sensor.position),
      forward(local_from_sensor.rotate({1.0, 0.0, 0.0})),
      // Optical axes: right = -left, down = -up.
      right(local_from_sensor.rotate({0.0, -1.0, 0.0})),
      down(local_from_sensor.rotate({0.0, 0.0, -1.0})) {
  // In Vulkan's clip space u = cx + fx x / z, with y down and -w to w over the width.
  const double width = pinhole.width, height = pinhole.height;
  clip_x = right * (2.0 * pinhole.fx / width) + forward * (2.0 * pinhole.cx / width - 1.0);
  clip_y = down * (2.0 * pinhole.fy / height) + forward * (2.0 * pinhole.cy / height - 1.0);
  constants.eye_high = vec3(eye);
  constants.eye_low = vec3(eye - dvec3(constants.eye_high));
  constants.clip_x = vec3(clip_x);
  constants.clip_y = vec3(clip_y);
  constants.forward = vec3(forward);
  constants.ray_x = vec3(right / pinhole.fx);
  constants.ray_y = vec3(down / pinhole.fy);
  constants.ray_0 = vec3(forward - right * (pinhole.cx / pinhole.fx) - down * (pinhole.cy / pinhole.fy));
  constants.light_eye = vec3(sun.from_local(eye));
  constants.near_m = float(near_m);
  constants.exposure = float(exposure);
  constants.weight = 1.0f;
  constants.first = 1;

  const auto plane = [](const dvec3& inwards, double offset) {
    return Plane{glm::normalize(inwards), offset / glm::length(inwards)};
  };
  planes_ = {plane(forward + clip_x, 0.0), plane(forward - clip_x, 0.0), plane(forward + clip_y, 0.0),
             plane(forward - clip_y, 0.0), plane(forward, near_m)};
}

shared::BodyView CameraView::of_body(const Pose& local_from_body) const {
  const dmat3 turn = glm::mat3_cast(local_from_body.orientation);
  const dvec3 from_eye = local_from_body.position - eye;
  const auto row = [&](const dvec3& axis) { return vec4(dvec4(axis * turn, glm::dot(axis, from_eye))); };
  return {row(clip_x), row(clip_y), row(forward), constants.near_m};
}

bool CameraView::outside(const dvec3& center, double radius) const { return outside(center, center, radius); }

bool CameraView::outside(const dvec3& from, const dvec3& to, double radius) const {
  // The sphere is taken a little larger, since vertices are rounded to floats.
  const double reach = radius + 1e-3 + 1e-6 * std::max(glm::length(from), glm::length(to));
  return std::ranges::any_of(planes_, [&](const Plane& plane) {
    return std::max(glm::dot(plane.normal, from), glm::dot(plane.normal, to)) < plane.offset - reach;
  });
}

double CameraView::share(const dvec3& center, double radius) const {
  double share = 1.0;
  for (const Plane& plane : planes_)
    share = std::min(share, 0.5 + 0.5 * (glm::dot(plane.normal, center - eye) - plane.offset) / radius);
  return std::max(share, 0.0);
}

}  // namespace greatx::render
