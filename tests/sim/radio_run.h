// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs of one channel, "csi", in scenes that the test makes by hand.
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "scene/scene_hash.h"
#include "sim/simulator.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tiny_scene.h"

namespace greatx::sim::testing {

struct RadioRun {
  std::vector<SensorSpec> sensors;
  std::vector<Packet> packets;
  RunStatistics statistics;
  EffectPlan plan;

  /// Of the channel, in a packet.
  const Array& array(size_t packet, const std::string& name) const {
    for (const Record& record : packets.at(packet).records) {
      const SensorSpec& spec = sensors[record.sensor];
      if (spec.kind != "csi") continue;
      for (size_t i = 0; i < spec.arrays.size(); ++i)
        if (spec.arrays[i].name == name) return record.arrays[i];
    }
    throw std::runtime_error("the channel has no " + name);
  }
  template <typename T>
  std::vector<T> values(size_t packet, const std::string& name) const {
    const auto view = array(packet, name).as<T>();
    return {view.begin(), view.end()};
  }
  uint64_t counter(const std::string& name) const { return statistics.counters.at("csi." + name); }
};

/// The scenario's nodes move nothing of the scene. Ticks before `first` are left out, as by a resume.
inline RadioRun run(const std::string& yaml, const scene::Scene& scene, int64_t first = 0) {
  const Scenario scenario = parse_scenario(yaml, "test.yaml", ".");
  World world{scene, std::vector<uint32_t>(scenario.nodes.size(), 0)};
  world.scene.hash = scene::hash_of(scene);
  struct Keep : RecordSink {
    std::vector<Packet> packets;
    void write(Packet packet) override { packets.push_back(std::move(packet)); }
  } keep;
  RadioRun result;
  result.plan = make_effect_plan(scenario, world.scene);
  Simulator simulator(test::device(), scenario, world, result.plan);
  result.sensors = simulator.sensors();
  simulator.start(0, first);
  while (simulator.step(keep)) {
  }
  result.statistics = simulator.statistics();
  result.packets = std::move(keep.packets);
  return result;
}

/// Every array of every packet.
inline void expect_same_bytes(const RadioRun& a, const RadioRun& b, const std::string& what) {
  ASSERT_EQ(a.packets.size(), b.packets.size()) << what;
  for (size_t p = 0; p < a.packets.size(); ++p) {
    ASSERT_EQ(a.packets[p].records.size(), b.packets[p].records.size()) << what;
    for (size_t r = 0; r < a.packets[p].records.size(); ++r) {
      const Record &x = a.packets[p].records[r], &y = b.packets[p].records[r];
      ASSERT_EQ(x.arrays.size(), y.arrays.size()) << what;
      for (size_t i = 0; i < x.arrays.size(); ++i) {
        EXPECT_EQ(x.arrays[i].shape, y.arrays[i].shape)
            << what << ", tick " << x.tick << ", " << a.sensors[x.sensor].arrays[i].name;
        EXPECT_TRUE(x.arrays[i].bytes == y.arrays[i].bytes)
            << what << ", tick " << x.tick << ", " << a.sensors[x.sensor].arrays[i].name;
      }
    }
  }
}

/// An ITU medium, half-space (thickness 0) or slab.
inline scene::Material radio_material(const std::string& itu, double thickness_m = 0.0) {
  scene::Material material;
  material.name = itu + (thickness_m > 0.0 ? " wall" : "");
  scene::RadioMaterial radio;
  radio.layers.push_back({*scene::itu_medium(itu), thickness_m});
  material.radio = radio;
  return material;
}

}  // namespace greatx::sim::testing
