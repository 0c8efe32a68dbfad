// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
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

/// The plan of an experiment whose scenario has a camera of RGB and depth as well: it has all that a picture
/// of the scene needs.
sim::EffectPlan picture_plan(const sim::Experiment& experiment);

/// Pictures of the scene at one moment, from anywhere.
class PictureRenderer {
 public:
  /// `gpu_scene` has the options of `plan`, a picture_plan(). All arguments outlive the renderer.
  PictureRenderer(scene::GpuScene& gpu_scene, gpu::TickRing& ring, const sim::EffectPlan& plan,
                  const sim::Environment& environment, const sim::Moment& moment);

  /// Planar depth alone, one sample a pixel: for looking around. Views of one size share their pipelines.
  std::vector<float> depth(const PictureView& view);
  render::CameraImages picture(const PictureView& view, std::optional<uint32_t> excluded_body);

 private:
  render::CameraImages render(render::CameraPass& pass, const PictureView& view);

  gpu::TickRing& ring_;
  scene::GpuScene& gpu_scene_;
  const sim::Moment& moment_;
  render::SceneLighting lighting_;
  std::unique_ptr<render::CameraPass> depth_pass_;
};

/// A scenario's own camera or event camera, "node/sensor". Throws UserError naming the scenario's cameras if
/// there is none of that name.
struct CameraName {
  uint32_t node = 0, sensor = 0;
};
CameraName find_camera(const std::string& name, const sim::Scenario& scenario);

/// What it sees, `width` pixels wide; and the body that it does not see.
struct ScenarioView {
  PictureView view;
  std::optional<uint32_t> excluded_body;
};
ScenarioView scenario_view(const CameraName& camera, const sim::Experiment& experiment,
                           const sim::Moment& moment, uint32_t width);

}  // namespace greatx::apps
