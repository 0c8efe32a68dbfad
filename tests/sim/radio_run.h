// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of one channel, "csi", in scenes that a test makes by hand.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "scene/description/scene_hash.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim::testing {

struct RadioRun : test::KeptRun {
  using KeptRun::array;
  /// Returns an array of the channel in `packet`.
  const Array& array(size_t packet, const std::string& name) const { return array(packet, "csi", name); }
  template <typename T>
  std::vector<T> values(size_t packet, const std::string& name) const {
    const auto view = array(packet, name).as<T>();
    return {view.begin(), view.end()};
  }
  uint64_t counter(const std::string& name) const { return KeptRun::counter("csi." + name); }
};

/// Returns an experiment in which no node of the scenario moves a body of `scene`. `points` is passed to
/// make_experiment().
inline Experiment experiment_in(const std::string& yaml, const scene::Scene& scene,
                                const scene::Bounds& points = {}) {
  Scenario scenario = parse_scenario(yaml, "test.yaml", ".");
  World world{scene, std::vector<uint32_t>(scenario.nodes.size(), 0)};
  world.scene.hash = scene::hash_of(scene);
  return make_experiment(std::move(scenario), std::make_shared<const World>(std::move(world)), points);
}

/// Runs the scenario from tick `first` on. Earlier ticks are left out, as by a resume.
inline RadioRun run(const std::string& yaml, const scene::Scene& scene, int64_t first = 0) {
  return {test::keep_run(experiment_in(yaml, scene), 0, first)};
}

using test::expect_same_bytes;

/// Returns a material with an ITU medium: a half-space if the thickness is 0, else a slab.
inline scene::Material radio_material(const std::string& itu, double thickness_m = 0.0) {
  scene::Material material;
  material.name = itu + (thickness_m > 0.0 ? " wall" : "");
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium(itu), thickness_m});
  material.radio = radio;
  return material;
}

}  // namespace greatx::sim::testing
