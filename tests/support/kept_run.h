// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs a sequence of a scenario without files, and keeps all data that it delivers and its work on the GPU.
#pragma once

#include <algorithm>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sim/experiment/experiment.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::test {

struct KeptRun {
  std::vector<SensorSpec> sensors;
  std::vector<Packet> packets;
  sim::RunStatistics statistics;
  sim::EffectPlan plan;
  gpu::Counters counters;  ///< counters of this run alone, including its set-up
  std::vector<scene::Instance> instances;

  const SensorSpec& spec(const std::string& sensor) const {
    for (const SensorSpec& spec : sensors)
      if (spec.name == sensor) return spec;
    throw std::runtime_error("no sensor " + sensor);
  }
  /// Returns an array of a sensor in a packet, or null if the sensor did not fire.
  const Array* find(size_t packet, const std::string& sensor, const std::string& name) const {
    return find(packets.at(packet), sensor, name);
  }
  const Array& array(size_t packet, const std::string& sensor, const std::string& name) const {
    if (const Array* found = find(packet, sensor, name)) return *found;
    throw std::runtime_error(sensor + " has no " + name);
  }
  template <typename T>
  std::span<const T> array(size_t packet, const std::string& sensor, const std::string& name) const {
    return array(packet, sensor, name).as<T>();
  }
  /// Returns an array from every record of a sensor, in the order of ticks.
  std::vector<Array> arrays(const std::string& sensor, const std::string& name) const {
    std::vector<Array> all;
    for (const Packet& packet : packets)
      if (const Array* found = find(packet, sensor, name)) all.push_back(*found);
    return all;
  }
  /// Returns the concatenation of an array over all records, for ragged arrays.
  template <typename T>
  std::vector<T> joined(const std::string& sensor, const std::string& name) const {
    std::vector<T> all;
    for (const Array& array : arrays(sensor, name))
      all.insert(all.end(), array.as<T>().begin(), array.as<T>().end());
    return all;
  }
  uint64_t counter(const std::string& name) const { return statistics.counters.at(name); }
  /// Returns the text of a note, or an empty text if the note does not exist.
  std::string note(const std::string& name) const {
    for (const auto& [key, text] : statistics.notes)
      if (key == name) return text;
    return {};
  }
  /// Returns whether a pipeline was built with `part` in its name.
  bool built(const std::string& part) const {
    return std::ranges::any_of(counters.pipelines,
                               [&](const std::string& name) { return name.find(part) != std::string::npos; });
  }

 private:
  const Array* find(const Packet& packet, const std::string& sensor, const std::string& name) const {
    for (const Record& record : packet.records) {
      const SensorSpec& spec = sensors[record.sensor];
      if (spec.name != sensor) continue;
      for (size_t i = 0; i < spec.arrays.size(); ++i)
        if (spec.arrays[i].name == name) return &record.arrays[i];
      throw std::runtime_error(sensor + " has no " + name);
    }
    return nullptr;
  }
};

/// Returns the counts of `after` minus those of `before`.
inline gpu::Counters since(const gpu::Counters& before, gpu::Counters after) {
  after.pipelines.erase(after.pipelines.begin(),
                        after.pipelines.begin() + static_cast<std::ptrdiff_t>(before.pipelines.size()));
  after.pipelines_built -= before.pipelines_built;
  after.setup_submits -= before.setup_submits;
  after.submits -= before.submits;
  after.passes -= before.passes;
  after.dispatches -= before.dispatches;
  after.draws -= before.draws;
  after.tlas_builds -= before.tlas_builds;
  after.tlas_refits -= before.tlas_refits;
  return after;
}

/// Runs `sequence` and returns everything it delivers. The run leaves out ticks before `first_tick`, as a
/// resumed run does.
inline KeptRun keep_run(const sim::Experiment& experiment, uint32_t sequence = 0, int64_t first_tick = 0,
                        gpu::Tracer tracer = gpu::Tracer::automatic) {
  struct Keep : RecordSink {
    std::vector<Packet> packets;
    void write(Packet packet) override { packets.push_back(std::move(packet)); }
  } keep;
  KeptRun run;
  run.plan = experiment.plan;
  run.instances = experiment.scene().instances;
  const gpu::Counters before = device(tracer).counters();
  {
    sim::Simulator simulator(device(tracer), experiment);
    run.sensors = simulator.sensors();
    simulator.start(sequence, first_tick);
    while (simulator.step(keep)) {
    }
    run.statistics = simulator.statistics();
  }
  run.counters = since(before, device(tracer).counters());
  run.packets = std::move(keep.packets);
  return run;
}
inline KeptRun keep_run(const std::string& yaml, uint32_t sequence = 0, int64_t first_tick = 0,
                        gpu::Tracer tracer = gpu::Tracer::automatic) {
  return keep_run(sim::make_experiment(sim::parse_scenario(yaml, "test.yaml", ".")), sequence, first_tick,
                  tracer);
}

/// Expects equal bytes in all records of two packets from the same sensors.
inline void expect_same_bytes(const std::vector<SensorSpec>& sensors, const Packet& a, const Packet& b,
                              const std::string& what = {}) {
  ASSERT_EQ(a.tick, b.tick) << what;
  ASSERT_EQ(a.records.size(), b.records.size()) << what;
  for (size_t r = 0; r < a.records.size(); ++r) {
    const Record &x = a.records[r], &y = b.records[r];
    const SensorSpec& spec = sensors[x.sensor];
    EXPECT_EQ(x.sample, y.sample) << what << spec.name;
    ASSERT_EQ(x.arrays.size(), y.arrays.size()) << what << spec.name;
    for (size_t i = 0; i < x.arrays.size(); ++i) {
      EXPECT_EQ(x.arrays[i].shape, y.arrays[i].shape)
          << what << ", tick " << a.tick << ", " << spec.name << '.' << spec.arrays[i].name;
      EXPECT_TRUE(x.arrays[i].bytes == y.arrays[i].bytes)
          << what << ", tick " << a.tick << ", " << spec.name << '.' << spec.arrays[i].name;
    }
  }
}
/// Expects equal bytes in all arrays of all packets.
inline void expect_same_bytes(const KeptRun& a, const KeptRun& b, const std::string& what = {}) {
  ASSERT_EQ(a.packets.size(), b.packets.size()) << what;
  for (size_t p = 0; p < a.packets.size(); ++p)
    expect_same_bytes(a.sensors, a.packets[p], b.packets[p], what);
}

}  // namespace greatx::test
