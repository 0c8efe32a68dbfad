// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/camera_desc.h"

#include "core/hash.h"

namespace greatx::sim {

const PinholeConfig* pinhole_config(const SensorConfig& sensor) {
  if (const auto* camera = std::get_if<CameraConfig>(&sensor.config)) return camera;
  return std::get_if<EventCameraConfig>(&sensor.config);
}

void set_pinhole(render::CameraDesc& desc, const PinholeConfig& config) {
  set_intrinsics(desc, config);
  desc.near_m = config.near_m;
  desc.msaa = config.msaa;
  desc.smooth_edges = config.smooth_edges;
  desc.distortion = config.distortion;
  desc.wide = config.wide;
}

bool needs_seen(const EventCameraConfig& config) {
  using Steps = EventCameraConfig::Steps;
  return config.events &&
         (config.steps == Steps::by_flow || (config.instance && config.steps != Steps::by_pixel));
}

bool needs_cells(const EventCameraConfig& config) {
  return config.events && config.steps == EventCameraConfig::Steps::by_pixel;
}

render::TruthOutputs truth_outputs(const CameraConfig& config) {
  return {config.normals, config.depth_ray, config.flow};
}

render::CameraDesc camera_desc(const Scenario& scenario, const NodeConfig& node, const SensorConfig& sensor,
                               uint32_t body) {
  const auto& config = std::get<CameraConfig>(sensor.config);
  render::CameraDesc desc;
  desc.name = node.name + "/" + sensor.name;
  set_pinhole(desc, config);
  desc.parts = config.motion_blur_samples > 0 && (config.rgb || config.hdr);
  desc.exposure_ev100 = config.exposure.ev100;
  desc.automatic_exposure = config.exposure.automatic;
  desc.compensation_ev = config.exposure.compensation_ev;
  desc.vignetting = config.vignetting;
  desc.bands = config.rolling.any() ? config.rolling.bands : 0;
  desc.chromatic = config.chromatic;
  if (config.noise)
    desc.noise = {config.noise->full_well_e, config.noise->read_noise_e, config.noise->bits, scenario.seed,
                  fnv1a32(desc.name)};
  desc.glare = config.glare;
  desc.drops = config.drops;
  desc.drop_seconds_per_tick = 1.0 / scenario.tick_rate_hz.value();
  desc.rain = {config.exposure.shutter_s.value_or(render::RainView{}.shutter_s), scenario.seed,
               fnv1a32(desc.name)};
  desc.outputs.rgb = config.rgb;
  desc.outputs.hdr = config.hdr;
  desc.outputs.depth = config.depth || config.depth_png24 || config.depth_log;
  // Boxes count the pixels that show an instance.
  desc.outputs.instance = config.ids || config.boxes;
  desc.outputs.semantic = desc.outputs.material = config.ids;
  desc.outputs.seen = truth_outputs(config).any();
  for (const SensorConfig& other : node.sensors) {
    const auto* events = std::get_if<EventCameraConfig>(&other.config);
    if (events == nullptr || events->camera != sensor.name) continue;
    desc.outputs.luminance = true;
    desc.outputs.seen |= needs_seen(*events);
    desc.outputs.cells |= needs_cells(*events);
  }
  if (body != 0 && !config.see_own_body) desc.excluded_body = body;
  return desc;
}

}  // namespace greatx::sim
