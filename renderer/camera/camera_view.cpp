// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/camera/camera_view.h"

#include <algorithm>
#include <cmath>

namespace greatx::render {

CameraView::CameraView(const CameraDesc& desc, const Pose& local_from_sensor, const SunFrame& sun,
                       double exposure)
    : eye(local_from_sensor.position), forward(local_from_sensor.rotate({1.0, 0.0, 0.0})) {
  // Optical axes: right = -left, down = -up.
  const dvec3 right = local_from_sensor.rotate({0.0, -1.0, 0.0}),
              down = local_from_sensor.rotate({0.0, 0.0, -1.0});
  // u = cx + fx x / z: in Vulkan's clip space, y down, -w to w over the width.
  const double width = desc.width, height = desc.height;
  const dvec3 clip_x = right * (2.0 * desc.fx / width) + forward * (2.0 * desc.cx / width - 1.0);
  const dvec3 clip_y = down * (2.0 * desc.fy / height) + forward * (2.0 * desc.cy / height - 1.0);
  constants.eye_high = vec3(eye);
  constants.eye_low = vec3(eye - dvec3(constants.eye_high));
  constants.clip_x = vec3(clip_x);
  constants.clip_y = vec3(clip_y);
  constants.forward = vec3(forward);
  constants.ray_x = vec3(right / desc.fx);
  constants.ray_y = vec3(down / desc.fy);
  constants.ray_0 = vec3(forward - right * (desc.cx / desc.fx) - down * (desc.cy / desc.fy));
  constants.light_eye = vec3(sun.from_local(eye));
  constants.near_m = float(desc.near_m);
  constants.exposure = float(exposure);

  const auto plane = [](const dvec3& inwards, double offset) {
    return Plane{glm::normalize(inwards), offset / glm::length(inwards)};
  };
  planes_ = {plane(forward + clip_x, 0.0), plane(forward - clip_x, 0.0), plane(forward + clip_y, 0.0),
             plane(forward - clip_y, 0.0), plane(forward, desc.near_m)};
}

bool CameraView::outside(const dvec3& center, double radius) const {
  // A little more than the sphere: vertices are rounded to floats.
  const double reach = radius + 1e-3 + 1e-6 * glm::length(center);
  return std::ranges::any_of(
      planes_, [&](const Plane& plane) { return glm::dot(plane.normal, center) < plane.offset - reach; });
}

shared::GpuLight light_block(const scene::PunctualLight& light, const dvec3& position,
                             const dvec3& direction) {
  shared::GpuLight block{};
  block.position = vec3(position);
  block.direction = vec3(glm::normalize(direction));
  block.intensity = light.color * light.intensity;
  block.inverse_range_squared = light.range_m > 0.0f ? 1.0f / (light.range_m * light.range_m) : 0.0f;
  block.directional = light.type == scene::PunctualLight::Type::directional;
  block.cone_scale = 0.0f;
  block.cone_offset = 1.0f;
  if (light.type == scene::PunctualLight::Type::spot) {
    // KHR_lights_punctual, "Inner and Outer Cone Angles".
    const double inner = std::cos(double(light.inner_cone)), outer = std::cos(double(light.outer_cone));
    block.cone_scale = float(1.0 / std::max(0.001, inner - outer));
    block.cone_offset = float(-outer) * block.cone_scale;
  }
  return block;
}

}  // namespace greatx::render
