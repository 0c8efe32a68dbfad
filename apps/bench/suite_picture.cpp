// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_picture.h"

#include "apps/bench/event_row.h"
#include "core/units.h"
#include "renderer/camera/camera.h"
#include "renderer/event/event_pass.h"
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

Pose view_of(const SuiteScene& scene, double yaw) {
  return {scene.mast, orientation_from_yaw_pitch_roll(yaw, radians(15.0), 0.0)};
}

class SuitePicture : public SuitePass {
 public:
  SuitePicture(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work, bool night)
      : lighting_(gpu_scene, suite_light(night), suite_effects(night)),
        camera_(lighting_, suite_camera(work)),
        pose_(view_of(scene, 0.3)) {}
  void record(gpu::TickSlot& slot, const std::vector<Pose>& bodies) override {
    lighting_.record(slot, bodies);
    camera_.record(slot, pose_);
  }

 private:
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  Pose pose_;
};

class SuiteEvents : public SuitePass {
 public:
  SuiteEvents(scene::GpuScene& gpu_scene, const SuiteScene& scene, const SuiteWork& work)
      : gpu_(gpu_scene),
        scene_(scene),
        lighting_(gpu_scene, suite_light(false), suite_effects(false)),
        camera_(lighting_, luminance_camera(suite_camera(work))),
        events_(gpu_scene, event_camera("events", camera_.desc(), suite_event_pictures)) {}

  void record(gpu::TickSlot& slot, const std::vector<Pose>& bodies) override {
    const bool first = events_.first();
    const int64_t begin_ns = first ? 0 : interval_ns * sample_;
    if (!first) ++sample_;
    events_.begin(slot, {begin_ns, interval_ns * sample_, sample_, 0});
    for (uint32_t i = first ? 0 : 1; i <= (first ? 0 : suite_event_pictures); ++i) {
      gpu_.record_poses(slot, bodies);
      lighting_.record(slot, bodies);
      // 0.8 degrees in an interval: 2.2 pixels in the middle of the picture.
      const double turns = double(sample_) - 1.0 + double(i) / suite_event_pictures;
      camera_.record(slot, view_of(scene_, 0.3 + radians(0.8) * turns));
      events_.step(slot, i, camera_.luminance(), nullptr, {});
    }
    events_.end(slot, camera_.luminance());
  }
  void collect(const gpu::TickSlot& slot) override { events_.collect(slot); }

 private:
  static constexpr int64_t interval_ns = 100'000'000;
  scene::GpuScene& gpu_;
  const SuiteScene& scene_;
  render::SceneLighting lighting_;
  render::CameraPass camera_;
  render::EventPass events_;
  int64_t sample_ = 0;
};

}  // namespace

std::unique_ptr<SuitePass> make_suite_events(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                             const SuiteWork& work) {
  return std::make_unique<SuiteEvents>(gpu_scene, scene, work);
}

std::unique_ptr<SuitePass> make_suite_picture(scene::GpuScene& gpu_scene, const SuiteScene& scene,
                                              const SuiteWork& work, bool night) {
  return std::make_unique<SuitePicture>(gpu_scene, scene, work, night);
}

}  // namespace greatx::apps
