// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_picture.h"

#include "core/units.h"
#include "renderer/camera/camera.h"
#include "renderer/light/lighting.h"

namespace greatx::apps {

namespace {

render::Lighting suite_light(bool night) {
  render::Lighting light;
  light.sun_direction = render::Lighting::direction(radians(50.0), radians(night ? -20.0 : 40.0));
  if (night) light.sun_illuminance_lux = light.sky_illuminance_lux = 0.0;
  light.static_shadow_texels = 2048;
  return light;
}

render::CameraEffects suite_effects(bool night) {
  render::CameraEffects effects;
  effects.textures = effects.normal_maps = effects.alpha_mask = effects.emissive = false;
  effects.punctual_lights = night;
  effects.sun = effects.sky = effects.static_shadows = effects.moving_shadows = !night;
  return effects;
}

render::CameraDesc suite_camera(const SuiteWork& work) {
  render::CameraDesc desc;
  desc.width = work.width;
  desc.height = work.height;
  desc.fx = desc.fy = 0.5 * work.width;  // 90 degrees wide
  desc.cx = 0.5 * work.width;
  desc.cy = 0.5 * work.height;
  desc.msaa = 1;
  return desc;
}

class SuitePicture : public SuitePass {
 public:
  SuitePicture(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work, bool night)
      : lighting_(gpu_scene, suite_light(night), suite_effects(night)),
        camera_(lighting_, suite_camera(work)),
        pose_{scene.mast, orientation_from_yaw_pitch_roll(0.3, radians(15.0), 0.0)} {}
  void record(gpu::TickSlot& slot, const std::vector<Pose>& bodies) override {
    lighting_.record(slot, bodies);
    camera_.record(slot, pose_);
  }

 private:
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  Pose pose_;
};

}  // namespace

std::unique_ptr<SuitePass> make_suite_picture(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                              const SuiteWork& work, bool night) {
  return std::make_unique<SuitePicture>(gpu_scene, scene, work, night);
}

}  // namespace greatx::apps
