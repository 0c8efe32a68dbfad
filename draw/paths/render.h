// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Renders the pictures over which paths and radio maps are drawn.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "draw/paths/view.h"
#include "gpu/tick_ring.h"
#include "renderer/camera/camera.h"
#include "renderer/light/lighting.h"
#include "sim/experiment/experiment.h"
#include "sim/world/moment.h"

namespace greatx::apps {

/// Returns the plan of the experiment with one more camera (RGB and depth) in its scenario. This plan
/// contains everything that a picture of the scene needs.
sim::EffectPlan picture_plan(const sim::Experiment& experiment);

/// Renders pictures of the scene at one moment, from any viewpoint.
class PictureRenderer {
 public:
  /// `plan` is a picture_plan(), and `gpu_scene` was made with its options. `gpu_scene`, `ring` and `moment`
  /// outlive the renderer.
  PictureRenderer(scene::GpuScene& gpu_scene, gpu::TickRing& ring, const sim::EffectPlan& plan,
                  const sim::Environment& environment, const sim::Moment& moment);

  /// Renders only the planar depth, [height, width] metres, with one sample per pixel, to try out views. The
  /// view has no lens distortion. Successive views of the same size and intrinsics share their pipelines.
  std::vector<float> depth(const PictureView& view);
  /// Renders RGB with automatic exposure, and depth, without `excluded_body`.
  render::CameraImages picture(const PictureView& view, std::optional<uint32_t> excluded_body);

 private:
  render::CameraImages render(render::CameraPass& pass, const PictureView& view);

  gpu::TickRing& ring_;
  scene::GpuScene& gpu_scene_;
  const sim::Moment& moment_;
  render::SceneLighting lighting_;
  std::unique_ptr<render::CameraPass> depth_pass_;
};

/// Identifies a camera or event camera of a scenario by its indices.
struct CameraName {
  uint32_t node = 0, sensor = 0;
};
/// Returns whether a sensor is a camera whose view is that of a pinhole camera, with or without distortion.
bool can_look_through(const sim::SensorConfig& sensor);
/// Returns the camera "node/sensor". Throws UserError, which names the cameras of the scenario, if there is
/// no such camera, or if one cannot look through it.
CameraName find_camera(const std::string& name, const sim::Scenario& scenario);

/// Holds the view of a camera of the scenario.
struct ScenarioView {
  PictureView view;
  std::optional<uint32_t> excluded_body;  ///< the camera's own body, if the camera does not see it
};
/// Returns the view of the camera, scaled to a picture of `width` pixels. Throws UserError if the distorted
/// picture folds.
ScenarioView scenario_view(const CameraName& camera, const sim::Experiment& experiment,
                           const sim::Moment& moment, uint32_t width);

}  // namespace greatx::apps
