// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/paths/render.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "sim/plan/camera_desc.h"
#include "sim/plan/plan_options.h"

namespace greatx::apps {

namespace {

render::CameraDesc camera_desc(const PictureView& view, const std::string& name) {
  render::CameraDesc desc;
  desc.name = name;
  desc.width = view.width;
  desc.height = view.height;
  desc.fx = view.fx;
  desc.fy = view.fy;
  desc.cx = view.cx;
  desc.cy = view.cy;
  desc.near_m = view.near_m;
  desc.distortion = view.distortion;
  desc.outputs = {.rgb = false, .depth = true, .instance = false, .semantic = false, .material = false};
  return desc;
}

}  // namespace

sim::EffectPlan picture_plan(const sim::Experiment& experiment) {
  sim::Scenario with_camera = experiment.scenario;
  sim::SensorConfig sensor;
  sensor.name = "paths";
  sensor.rate_hz = with_camera.tick_rate_hz;
  sensor.config = sim::CameraConfig{};
  sim::NodeConfig node;
  node.name = "paths";
  node.trajectory = sim::StaticTrajectory{};
  node.sensors.push_back(std::move(sensor));
  with_camera.nodes.push_back(std::move(node));
  return sim::make_effect_plan(with_camera, experiment.scene());
}

PictureRenderer::PictureRenderer(scene::GpuScene& gpu_scene, gpu::TickRing& ring, const sim::EffectPlan& plan,
                                 const sim::Environment& environment, const sim::Moment& moment)
    : ring_(ring),
      gpu_scene_(gpu_scene),
      moment_(moment),
      lighting_(gpu_scene, sim::lighting_of(environment, plan), sim::camera_effects(plan)) {}

render::CameraImages PictureRenderer::render(render::CameraPass& pass, const PictureView& view) {
  gpu::TickSlot& slot = ring_.begin();
  gpu_scene_.record_update(slot, moment_.bodies);
  lighting_.record(slot, moment_.bodies);
  pass.record(slot, view.local_from_sensor);
  ring_.submit(slot);
  ring_.wait(slot);
  return pass.collect(slot);
}

std::vector<float> PictureRenderer::depth(const PictureView& view) {
  GREATX_CHECK(!view.distortion.any(), "views for looking around have no lens that distorts");
  const auto fits = [&](const render::CameraDesc& desc) {
    return desc.width == view.width && desc.height == view.height && desc.fx == view.fx &&
           desc.fy == view.fy && desc.cx == view.cx && desc.cy == view.cy && desc.near_m == view.near_m;
  };
  if (depth_pass_ == nullptr || !fits(depth_pass_->desc())) {
    render::CameraDesc desc = camera_desc(view, "paths depth");
    desc.msaa = 1;
    depth_pass_ = std::make_unique<render::CameraPass>(lighting_, desc);
  }
  return render(*depth_pass_, view).depth;
}

render::CameraImages PictureRenderer::picture(const PictureView& view,
                                              std::optional<uint32_t> excluded_body) {
  render::CameraDesc desc = camera_desc(view, "paths picture");
  desc.outputs.rgb = true;
  desc.automatic_exposure = true;  // for day and night
  desc.excluded_body = excluded_body;
  render::CameraPass pass(lighting_, desc);
  return render(pass, view);
}

namespace {

bool sees_own_body(const sim::SensorConfig& sensor) {
  if (const auto* camera = std::get_if<sim::CameraConfig>(&sensor.config)) return camera->see_own_body;
  return std::get<sim::EventCameraConfig>(sensor.config).see_own_body;
}

}  // namespace

bool can_look_through(const sim::SensorConfig& sensor) {
  const sim::PinholeConfig* const camera = sim::pinhole_config(sensor);
  return camera != nullptr && !camera->wide.any();
}

CameraName find_camera(const std::string& name, const sim::Scenario& scenario) {
  std::vector<std::string> cameras;
  for (uint32_t node = 0; node < scenario.nodes.size(); ++node)
    for (uint32_t sensor = 0; sensor < scenario.nodes[node].sensors.size(); ++sensor) {
      const sim::SensorConfig& config = scenario.nodes[node].sensors[sensor];
      if (sim::pinhole_config(config) == nullptr) continue;
      const std::string own = scenario.nodes[node].name + "/" + config.name;
      if (can_look_through(config))
        cameras.push_back(own);
      else if (own == name)
        throw_user_error(
            "--view: expected a pinhole camera, found '{}' with a fisheye or an equirectangular lens", name);
      if (own == name) return {node, sensor};
    }
  throw_user_error("--view: expected auto or a camera of the scenario ({}), found '{}'",
                   cameras.empty() ? "it has none" : fmt::format("{}", fmt::join(cameras, ", ")), name);
}

ScenarioView scenario_view(const CameraName& camera, const sim::Experiment& experiment,
                           const sim::Moment& moment, uint32_t width) {
  const sim::Scenario& scenario = experiment.scenario;
  const sim::SensorConfig& sensor = scenario.nodes[camera.node].sensors[camera.sensor];
  const sim::PinholeConfig& config = *sim::pinhole_config(sensor);
  const std::string name = scenario.nodes[camera.node].name + "/" + sensor.name;
  PictureView view;
  sim::set_intrinsics(view, config);
  view.near_m = config.near_m;
  view.local_from_sensor =
      experiment.scene().to_local(moment.motions[camera.node].pose) * sim::mount_pose(sensor.mount);
  ScenarioView result{view.scaled(width), {}};
  result.view.set_lens(config.distortion, name);
  const uint32_t body = experiment.world->body_of_node[camera.node];
  if (body != 0 && !sees_own_body(sensor)) result.excluded_body = body;
  return result;
}

}  // namespace greatx::apps
