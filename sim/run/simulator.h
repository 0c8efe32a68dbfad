// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One tick: poses ─► scene update ─► the due sensors' passes ─► ONE submission; meanwhile the tick before is
// collected into a packet. Nothing but the simulator's own state changes in a tick.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/record.h"
#include "gpu/tick_ring.h"
#include "scene/device/gpu_scene.h"
#include "sim/compare/comparisons.h"
#include "sim/experiment/experiment.h"
#include "sim/run/schedule.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory.h"
#include "sim/sensors/registry/registry.h"
#include "sim/world/moment.h"

namespace greatx::sim {

/// GPU time of one pass, or the host's of one of its doings, over the run so far.
struct PassTotal {
  uint64_t count = 0;
  double milliseconds = 0.0;
  std::vector<double> samples;  ///< ms, kept only if asked for (benchmarks)
};

struct RunStatistics {
  int64_t ticks = 0;                        ///< at which something was due, recorded and submitted
  int64_t packets = 0;                      ///< complete, handed to the sink
  std::map<std::string, int64_t> records;   ///< by sensor
  std::map<std::string, PassTotal> passes;  ///< by scope name
  /// Wall time of "record NAME" and "collect NAME" of each sensor (the latter while the GPU works on the tick
  /// after), of "wait" for the GPU ("wait to look ahead" if a sensor does), of "compare" (the check of one
  /// world) and of "hand over" to the sink; only if samples are kept.
  std::map<std::string, PassTotal> host;
  std::map<std::string, uint64_t> counters;  ///< what sensors count: paths, candidates, overflows
  std::vector<std::pair<std::string, std::string>>
      notes;  ///< (name, text): how candidates were found, what holds
  std::vector<std::string>
      warnings;             ///< data that was lost; `greatx generate` prints them even when it is quiet
  Consistency consistency;  ///< of the run, by figure
  std::vector<ConsistencyRow> rows;  ///< the same by record, of what is written
};

class Simulator {
 public:
  /// Uploads the scene and builds the pipelines of the plan. Both arguments outlive the simulator.
  Simulator(gpu::Device& device, const Experiment& experiment);
  ~Simulator();

  /// What the packets will hold; index = Record::sensor.
  const std::vector<SensorSpec>& sensors() const { return specs_; }

  /// Begins a sequence at its first tick, or later (`first_tick`) to finish an interrupted one.
  void start(uint32_t sequence, int64_t first_tick = 0);
  /// Records and submits the next tick that is due and hands the packet of the one before to `sink`.
  /// False: nothing is left; the last packet has been handed over.
  bool step(RecordSink& sink);
  /// Hands over what is in flight (before stopping early).
  void drain(RecordSink& sink);

  int64_t next_tick() const { return next_tick_; }  ///< the tick that step() will record
  RunStatistics statistics() const;
  void keep_pass_samples(bool keep) { keep_samples_ = keep; }

 private:
  struct InFlight;
  Moment moment_at(int64_t tick) const;
  void replay(int64_t end);
  void record(gpu::TickSlot& slot, const Moment& moment, const std::vector<Due>& due);
  void record_ahead(gpu::TickSlot& slot);
  void collect(const InFlight& in_flight, RecordSink& sink);
  void compare(const Packet& packet);
  class HostScope;

  const Scenario& scenario_;
  const World& world_;
  gpu::Device& device_;
  scene::GpuScene gpu_scene_;
  gpu::TickRing ring_;
  Clock clock_;
  Schedule schedule_;
  SharedPasses passes_;
  std::vector<RunSensor> sensors_;
  std::vector<SensorSpec> specs_;  ///< [sensor]
  Comparer comparer_;
  Courses courses_;
  std::unique_ptr<InFlight> pending_;
  uint32_t sequence_ = 0;
  int64_t next_tick_ = 0;
  int64_t due_ticks_ = 0;  ///< of the sequence, before next_tick_
  bool looks_ahead_ = false;
  bool keep_samples_ = false;
  RunStatistics statistics_;
};

}  // namespace greatx::sim
