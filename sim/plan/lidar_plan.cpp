// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/lidar_plan.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/units.h"
#include "renderer/lidar/pane.h"
#include "sim/plan/light_plan.h"

namespace greatx::sim {

namespace {

/// Summarizes the requests of all LiDARs of the scenario.
struct LidarAsks {
  size_t lidars = 0;
  double sweep_s = 0.0;  ///< the longest
  uint32_t rings = 0;    ///< the most
  /// The greatest width of a beam with rings at its maximum range.
  double widest_m = 0.0;
  double farthest_m = 0.0;  ///< the greatest maximum range
  double gate_m = 0.0;      ///< the coarsest range resolution of LiDARs with detection
  bool detection = false;
  double range_std_m = 0.0, rise_m = 0.0;
  std::set<uint32_t> wavelengths_nm;
};

LidarAsks lidar_asks(const Scenario& scenario) {
  LidarAsks asks;
  for (const NodeConfig& node : scenario.nodes) {
    for (const SensorConfig& sensor : node.sensors) {
      const auto* lidar = std::get_if<LidarConfig>(&sensor.config);
      if (lidar == nullptr) continue;
      ++asks.lidars;
      asks.sweep_s = std::max(asks.sweep_s, render::duration_s(lidar->scan));
      asks.rings = std::max(asks.rings, lidar->rings);
      asks.farthest_m = std::max(asks.farthest_m, lidar->max_range_m);
      if (lidar->rings > 0) asks.widest_m = std::max(asks.widest_m, lidar->divergence * lidar->max_range_m);
      asks.detection |= lidar->receiver.detection.has_value();
      if (lidar->receiver.detection) asks.gate_m = std::max(asks.gate_m, lidar->returns.resolution_m);
      asks.range_std_m = std::max(asks.range_std_m, lidar->receiver.range_std_m);
      asks.rise_m = std::max(asks.rise_m, lidar->receiver.rise_m);
      asks.wavelengths_nm.insert(static_cast<uint32_t>(lidar->wavelength_nm));
    }
  }
  return asks;
}

/// Returns the first material that is a pane; empty: there is none.
std::string first_pane(const scene::Scene& scene, const LidarAsks& asks) {
  for (const scene::Primitive& primitive : scene.primitives)
    for (const uint32_t wavelength : asks.wavelengths_nm)
      if (const scene::Material& material = scene.materials[primitive.material];
          render::pane_of(material, wavelength))
        return material.name;
  return {};
}

class LidarPlanner {
 public:
  LidarPlanner(const Planner& planner, bool lidar) : planner_(planner), lidar_(lidar) {}
  void decide(Effect& effect, bool needed, const std::string& yes, const std::string& no,
              const std::string& bound = "") const {
    planner_.decide(effect, lidar_ && needed, !lidar_ ? "no LiDAR" : needed ? yes : no, bound);
  }

 private:
  const Planner& planner_;
  bool lidar_;
};

void plan_motion(EffectPlan& plan, const LidarPlanner& planner, const LidarAsks& asks, const Offers& offers) {
  const bool sweep = asks.sweep_s > 0.0;
  const std::string stale =
      fmt::format("off: poses are up to {:g} s old, {:g} m for every m/s", asks.sweep_s, asks.sweep_s);
  planner.decide(plan.lidar_sweep_motion, sweep,
                 "shots are spread over a sweep: each from the pose at its own time",
                 "every shot at the tick", sweep ? stale : "");
  planner.decide(plan.lidar_target_motion, sweep && offers.moving_triangles,
                 "meshes move during a sweep: each shot meets them where they are at its own time",
                 !sweep ? "every shot at the tick" : "no mesh moves",
                 sweep && offers.moving_triangles ? stale : "");
}

void plan_air(EffectPlan& plan, const LidarPlanner& planner, const LidarAsks& asks,
              const Environment& environment) {
  const double extinction = haze_extinction(environment);
  const bool haze = extinction > 0.0;
  const std::string reason = haze ? haze_reason(environment) : "";
  planner.decide(
      plan.lidar_haze, haze, reason, "neither fog nor rain",
      haze ? fmt::format("{:.3g} dB there and back at {:g} m",
                         2.0 * extinction * asks.farthest_m * 10.0 / std::log(10.0), asks.farthest_m)
           : "");
  planner.decide(plan.lidar_backscatter, haze && asks.detection,
                 reason + ": drops give light back where it exceeds the threshold",
                 !haze ? "neither fog nor rain"
                       : "no LiDAR has a detection threshold, without which the air would answer every shot",
                 haze && asks.detection
                     ? fmt::format("a gate of {:g} m gives as much as a surface of reflectance {:.2g}",
                                   asks.gate_m, pi * extinction / render::lidar_ratio_sr * asks.gate_m)
                     : "");
}

}  // namespace

void plan_lidar(EffectPlan& plan, const Planner& planner, const Scenario& scenario, const scene::Scene& scene,
                const Offers& offers) {
  const LidarAsks asks = lidar_asks(scenario);
  const bool lidar = asks.lidars > 0;
  const LidarPlanner effects(planner, lidar);
  planner.decide(plan.lidar, lidar, lidar ? fmt::format("{} of them", asks.lidars) : "no LiDAR");
  effects.decide(plan.lidar_alpha_mask, offers.alpha_mask, "materials have holes", "no material has holes");
  effects.decide(plan.lidar_textures, offers.reflectance_textures,
                 "textures shade reflectances that come from the base colour",
                 "every textured material states its reflectance, or none has a texture");
  plan_motion(plan, effects, asks, offers);
  effects.decide(
      plan.lidar_divergence, asks.rings > 0, fmt::format("beams have up to {} rings of sub-rays", asks.rings),
      "no beam has rings of sub-rays: one ray a shot",
      asks.rings > 0 ? fmt::format("a beam is up to {:.2g} m wide at its greatest range", asks.widest_m)
                     : "");
  const std::string pane = lidar ? first_pane(scene, asks) : "";
  effects.decide(plan.lidar_glass, !pane.empty(), fmt::format("'{}' lets light through", pane), "no glass",
                 !pane.empty() ? "a clear pane lets 85 % through there and back" : "");
  plan_air(plan, effects, asks, scenario.environment);
  effects.decide(plan.lidar_detection, asks.detection, "returns must exceed a detection threshold",
                 "no detection threshold: every return is detected");
  effects.decide(
      plan.lidar_range_noise, asks.range_std_m > 0.0 || asks.rise_m > 0.0, "ranges have noise",
      "no noise of ranges",
      asks.range_std_m > 0.0 || asks.rise_m > 0.0
          ? fmt::format("standard deviation of {:g} m{}", asks.range_std_m,
                        asks.rise_m > 0.0
                            ? fmt::format(" and {:g} m over the signal-to-noise ratio", asks.rise_m)
                            : "")
          : "");
}

}  // namespace greatx::sim
