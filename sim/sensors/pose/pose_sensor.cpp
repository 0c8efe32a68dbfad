// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/pose/pose_sensor.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <nlohmann/json.hpp>

#include "scene/description/lamps.h"

namespace greatx::sim {

PoseSensor::PoseSensor(const Scenario& scenario, const scene::Scene& scene) {
  const auto nodes = static_cast<int64_t>(scenario.nodes.size());
  spec_.name = "poses";
  spec_.kind = "pose";
  spec_.rate = "";  // it fires whenever another sensor does
  const auto add = [&](const char* name, int64_t width, const char* unit, const char* description) {
    spec_.arrays.push_back({name, DType::f64, {nodes, width}, unit, description});
    spec_.outputs.push_back({name, FileFormat::npy_stack, {name}});
  };
  add("position", 3, "m", "[node, xyz] world: x east, y north, z up");
  add("orientation", 4, "1", "[node, wxyz] world_from_body; body: x forward, y left, z up");
  add("velocity", 3, "m/s", "[node, xyz] derivative of the trajectory");
  add("acceleration", 3, "m/s^2", "[node, xyz] second derivative of the trajectory");
  add("angular_velocity", 3, "rad/s", "[node, xyz] world axes");
  add("mean_velocity", 3, "m/s",
      "[node, xyz] (p_k - p_(k-1)) / (t_k - t_(k-1)); NaN in the first record of a sequence");
  if (scene.georeference) {
    frame_.emplace(*scene.georeference);
    add("geodetic", 3, "deg, deg, m",
        "[node, latitude longitude height] position on the Earth: WGS 84, height above the ellipsoid");
  }
  nlohmann::json metadata;
  for (const scene::SwitchedLamp& lamp : scene::switched_lamps(scene).lamps)
    metadata["lamps"].push_back(scene::name_of(scene, lamp));
  if (metadata.contains("lamps")) {
    lamps_ = metadata["lamps"].size();
    spec_.arrays.push_back({"lamps",
                            DType::f32,
                            {static_cast<int64_t>(lamps_)},
                            "1",
                            "[lamp] the share of its light with which each lamp that switches shines"});
    spec_.outputs.push_back({"lamps", FileFormat::npy_stack, {"lamps"}});
  }
  for (const NodeConfig& node : scenario.nodes) metadata["nodes"].push_back(node.name);
  metadata["non_finite"] = {"mean_velocity"};
  metadata["local_origin_m"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  if (scene.georeference) {  // a height above the datum is that of the array less the undulation
    metadata["undulation_m"] = scene.georeference->undulation_m;
    metadata["vertical_datum"] = scene.georeference->vertical_datum;
  }
  spec_.metadata_json = metadata.dump();
}

void PoseSensor::record(gpu::TickSlot& slot, const TickContext& context) {
  const std::span<const Motion> motions = context.nodes;
  std::vector<Array>& arrays = arrays_[slot.index];
  arrays.clear();
  const auto add = [&](int width, auto&& row_of) {
    Array array(DType::f64, {static_cast<int64_t>(motions.size()), width});
    double* value = array.as<double>().data();
    for (uint32_t node = 0; node < motions.size(); ++node) {
      const auto row = row_of(node);
      for (int i = 0; i < width; ++i) *value++ = row[i];
    }
    arrays.push_back(std::move(array));
  };
  add(3, [&](uint32_t node) { return motions[node].pose.position; });
  add(4, [&](uint32_t node) {
    const dquat& q = motions[node].pose.orientation;
    return dvec4(q.w, q.x, q.y, q.z);
  });
  add(3, [&](uint32_t node) { return motions[node].velocity; });
  add(3, [&](uint32_t node) { return motions[node].acceleration; });
  add(3, [&](uint32_t node) { return motions[node].angular_velocity; });
  add(3, [&](uint32_t node) {
    if (std::isnan(context.previous_time_s)) return dvec3(std::numeric_limits<double>::quiet_NaN());
    const dvec3 before = context.motion_at(node, context.previous_time_s).pose.position;
    return (motions[node].pose.position - before) / (context.time_s - context.previous_time_s);
  });
  if (frame_)
    add(3, [&](uint32_t node) {
      const Geodetic place = frame_->place(motions[node].pose.position);
      return dvec3(place.latitude_deg, place.longitude_deg, place.height_m);
    });
  if (lamps_ == 0) return;
  const std::vector<float> lamps =
      context.lamps_at ? context.lamps_at(context.time_s) : std::vector<float>(lamps_, 1.0f);
  arrays.emplace_back(DType::f32, std::vector<int64_t>{static_cast<int64_t>(lamps.size())});
  std::ranges::copy(lamps, arrays.back().as<float>().begin());
}

std::vector<Array> PoseSensor::collect(const gpu::TickSlot& slot) { return std::move(arrays_[slot.index]); }

Evidence PoseSensor::evidence() const {
  Evidence evidence;
  evidence.poses = true;
  return evidence;
}

}  // namespace greatx::sim
