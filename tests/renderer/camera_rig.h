// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Provides a rig for camera tests: a scene, its lighting and one camera that takes pictures.
#pragma once

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "core/units.h"
#include "renderer/camera/camera.h"
#include "renderer/light/lighting.h"
#include "renderer/light/sky.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::test {

/// Returns a square pinhole camera with a field of view of 90 degrees. It delivers all its outputs.
inline render::CameraDesc plain_camera(uint32_t size = 64, uint32_t msaa = 1) {
  render::CameraDesc desc;
  desc.width = desc.height = size;
  desc.fx = desc.fy = 0.5 * size;
  desc.cx = desc.cy = 0.5 * size;
  desc.msaa = msaa;
  desc.outputs.hdr = true;
  return desc;
}

/// Returns the light of the sun. The shadow maps are small to keep the tests quick.
inline render::Lighting plain_light(double sun_azimuth_deg = 0.0, double sun_elevation_deg = 90.0) {
  render::Lighting lighting;
  lighting.sun_direction = render::Lighting::direction(radians(sun_azimuth_deg), radians(sun_elevation_deg));
  lighting.static_shadow_texels = 512;
  lighting.moving_shadow_texels = 128;
  return lighting;
}

/// Returns a white sky of the same radiance all around, ground included, and no sun.
inline render::Lighting white_world(double sky_illuminance_lux = 15000.0) {
  render::Lighting lighting = plain_light();
  lighting.sky_model = render::SkyModel::uniform;
  lighting.sun_illuminance_lux = 0.0;
  lighting.sky_illuminance_lux = sky_illuminance_lux;
  return lighting;
}

inline render::CameraEffects lambertian() {
  render::CameraEffects effects;
  effects.specular = false;
  return effects;
}

inline scene::Material optical_material(const std::string& name, float gray, float metallic = 0.0f,
                                        float roughness = 1.0f) {
  scene::Material material;
  material.name = name;
  material.pbr.base_color = vec4(vec3(gray), 1.0f);
  material.pbr.metallic = metallic;
  material.pbr.roughness = roughness;
  return material;
}

/// Returns a pose at `position`. A yaw of 0 looks along x; a positive pitch looks downwards.
inline Pose look(const dvec3& position, double yaw_deg = 0.0, double pitch_deg = 0.0, double roll_deg = 0.0) {
  return {position, orientation_from_yaw_pitch_roll(radians(yaw_deg), radians(pitch_deg), radians(roll_deg))};
}

class CameraRig {
 public:
  CameraRig(scene::Scene scene, const render::Lighting& lighting, const render::CameraDesc& desc,
            const render::CameraEffects& effects = {},
            const scene::GpuSceneOptions& options = {.acceleration_structure = false, .textures = true})
      : scene_(std::make_unique<scene::Scene>(std::move(scene))),
        gpu_(device(), *scene_, options),
        lighting_(gpu_, lighting, effects),
        camera_(lighting_, desc),
        desc_(desc),
        ring_(device(), 2, 1 << 16, 1 << 20) {}

  gpu::TickSlot& record(const Pose& sensor, std::vector<Pose> moving = {},
                        const render::FrameNumber& frame = {}) {
    moving.insert(moving.begin(), Pose{});
    moving.resize(scene_->bodies.size());
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, moving);
    lighting_.record(slot, moving);
    camera_.record(slot, sensor, frame);
    ring_.submit(slot);
    return slot;
  }
  render::CameraImages collect(const gpu::TickSlot& slot) {
    ring_.wait(slot);
    return camera_.collect(slot);
  }
  /// Takes one picture. `moving` holds the poses of bodies 1, 2, ...
  render::CameraImages shoot(const Pose& sensor, const std::vector<Pose>& moving = {}) {
    return collect(record(sensor, moving));
  }
  /// Takes one picture as the sum of equal parts of the exposure (CameraDesc::parts), of bodies that stand.
  render::CameraImages shoot_parts(const Pose& sensor, int parts) {
    std::vector<Pose> poses(scene_->bodies.size());
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, poses);
    lighting_.record(slot, poses);
    for (int i = 0; i < parts; ++i)
      camera_.record(slot, sensor, {},
                     {.weight = 1.0f / float(parts), .first = i == 0, .last = i + 1 == parts});
    ring_.submit(slot);
    return collect(slot);
  }
  /// Takes one picture between those of two other cameras in the same tick, which look from `others`.
  render::CameraImages shoot_among(const std::array<Pose, 2>& others, const Pose& sensor,
                                   std::vector<Pose> moving = {}) {
    render::CameraPass before(lighting_, desc_), after(lighting_, desc_);
    moving.insert(moving.begin(), Pose{});
    moving.resize(scene_->bodies.size());
    gpu::TickSlot& slot = ring_.begin();
    gpu_.record_update(slot, moving);
    lighting_.record(slot, moving);
    before.record(slot, others[0]);
    camera_.record(slot, sensor);
    after.record(slot, others[1]);
    ring_.submit(slot);
    return collect(slot);
  }
  const render::CameraPass& camera() const { return camera_; }
  const render::SceneLighting& lighting() const { return lighting_; }
  scene::GpuScene& gpu() { return gpu_; }
  const scene::Scene& scene() const { return *scene_; }

 private:
  std::unique_ptr<scene::Scene> scene_;
  scene::GpuScene gpu_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  render::CameraDesc desc_;
  gpu::TickRing ring_;
};

inline double luminance_at(const render::CameraImages& images, size_t pixel) {
  return render::luminance(
      dvec3(images.hdr[3 * pixel], images.hdr[3 * pixel + 1], images.hdr[3 * pixel + 2]));
}

/// Returns the ray through the centre of a pixel in the sensor's frame (x forward, y left, z up), with planar
/// depth 1.
inline dvec3 pixel_ray(const render::CameraDesc& desc, uint32_t column, uint32_t row) {
  return {1.0, -(column + 0.5 - desc.cx) / desc.fx, -(row + 0.5 - desc.cy) / desc.fy};
}

}  // namespace greatx::test
