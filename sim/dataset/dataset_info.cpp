// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/dataset/dataset_info.h"

#include <nlohmann/json.hpp>

#include "core/hash.h"
#include "core/version.h"
#include "scene/description/scene.h"
#include "scene/georeference/georeference.h"
#include "sim/dataset/packed_outputs.h"
#include "sim/world/instance_boxes.h"
#include "sim/world/instance_outlines.h"

namespace greatx::sim {

io::DatasetInfo dataset_info(const Experiment& experiment, const gpu::Device& device,
                             const std::vector<SensorSpec>& sensors) {
  const Scenario& scenario = experiment.scenario;
  const scene::Scene& scene = experiment.scene();
  nlohmann::json run;
  run["greatx"] = GREATX_VERSION;
  run["commit"] = commit();
  run["scenario"] = scenario.name;
  run["seed"] = scenario.seed;
  run["scene_sha256"] = scene.hash;
  run["scenario_sha256"] = Sha256().update(scenario.text).hex();
  run["device"] = device.info().name;
  run["driver"] = device.info().driver;
  run["vulkan"] = device.info().api_version;
  run["tracer"] = gpu::name_of(device.tracer());
  run["local_origin_m"] = {scene.origin.x, scene.origin.y, scene.origin.z};
  if (scene.georeference)
    run["georeference"] = nlohmann::json::parse(scene::georeference_json(*scene.georeference));
  run["semantic_classes"] = scene::semantic_class_names();
  run["instances"] = nlohmann::json::array();
  const std::vector<InstanceBox> boxes = instance_boxes(*experiment.world);
  const std::vector<std::optional<InstanceOutline>> outlines = instance_outlines(*experiment.world);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const scene::Instance& instance = scene.instances[i];
    run["instances"].push_back({{"name", instance.name}, {"class", scene::name_of(instance.semantic_class)}});
    nlohmann::json& entry = run["instances"].back();
    if (boxes[i].node) entry["node"] = scenario.nodes[*boxes[i].node].name;
    if (!boxes[i].box.empty())
      entry["box_m"] = {{boxes[i].box.min.x, boxes[i].box.min.y, boxes[i].box.min.z},
                        {boxes[i].box.max.x, boxes[i].box.max.y, boxes[i].box.max.z}};
    if (!outlines[i]) continue;
    entry["outline_height_m"] = outlines[i]->height_m;
    for (const InstanceOutline::Line& line : outlines[i]->lines)
      entry["outline_m"].push_back({line.from.x, line.from.y, line.to.x, line.to.y});
  }
  run["materials"] = nlohmann::json::array();
  for (const scene::Material& material : scene.materials) run["materials"].push_back(material.name);
  run["effects"] = nlohmann::json::object();
  for (const Effect* effect : experiment.plan.all()) run["effects"][effect->name] = effect->on;

  io::DatasetInfo info;
  info.run_json = run.dump();
  info.scenario_text = scenario.text;
  info.run_key = Sha256().update(info.run_json).hex();
  info.tick_rate = scenario.tick_rate_hz.str();
  info.sensors = sensors;
  info.compression = scenario.storage.compression;
  if (info.compression != Compression::none)
    for (SensorSpec& sensor : info.sensors) pack_outputs(sensor);
  info.sequences = scenario.sequences;
  info.ticks_per_sequence = scenario.ticks;
  return info;
}

io::DatasetInfo with_sequences(io::DatasetInfo info, const Scenario& scenario) {
  nlohmann::json run = nlohmann::json::parse(info.run_json);
  run["scenario_sha256"] = Sha256().update(scenario.text).hex();
  info.run_json = run.dump();
  info.scenario_text = scenario.text;
  info.run_key = Sha256().update(info.run_json).hex();
  info.sequences = scenario.sequences;
  return info;
}

}  // namespace greatx::sim
