// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs a scenario tick by tick: poses ─► scene update ─► the passes of the sensors that are due ─► ONE
// submission. While the GPU works on a tick, the host collects the tick before into a packet. A tick changes
// nothing but the simulator's own state.
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
#include "sim/run/sensor_places.h"
#include "sim/run/tick_times.h"
#include "sim/scenario/clock.h"
#include "sim/scenario/trajectory.h"
#include "sim/sensors/registry/registry.h"
#include "sim/world/moment.h"

namespace greatx::sim {

/// Holds the GPU time of one pass, or the wall time of one activity of the host, over the run so far.
struct PassTotal {
  uint64_t count = 0;
  double milliseconds = 0.0;
  std::vector<double> samples;  ///< ms, kept only if asked for (benchmarks)
};

/// Holds counts and times of a run so far.
struct RunStatistics {
  int64_t ticks = 0;                        ///< ticks at which something was due, as submitted
  int64_t packets = 0;                      ///< complete packets handed to the sink
  std::map<std::string, int64_t> records;   ///< by sensor
  std::map<std::string, PassTotal> passes;  ///< by scope name
  /// Wall times of the host by activity, only if samples are kept: "record" of the scene, "record NAME",
  /// "look ahead NAME" and "collect NAME" of each sensor (the last while the GPU works on the next tick),
  /// "wait" for the GPU ("wait to look ahead" if a sensor looks ahead), "compare" (the consistency check),
  /// and "hand over" to the sink.
  std::map<std::string, PassTotal> host;
  std::map<std::string, uint64_t> counters;  ///< counts of the sensors: paths, candidates, overflows
  /// (name, text) pairs: how candidates were found, and which guarantees hold.
  std::vector<std::pair<std::string, std::string>> notes;
  /// Messages about lost data. `greatx generate` prints them even when it is quiet.
  std::vector<std::string> warnings;
  Consistency consistency;           ///< errors of the run, by figure
  std::vector<ConsistencyRow> rows;  ///< errors by record, of the figures that are written
};

/// Runs the sequences of an experiment on a device.
class Simulator {
 public:
  /// Uploads the scene and builds the pipelines of the plan. Both arguments must outlive the simulator.
  Simulator(gpu::Device& device, const Experiment& experiment);
  ~Simulator();

  /// Returns what each sensor delivers; index = Record::sensor.
  const std::vector<SensorSpec>& sensors() const { return specs_; }

  /// Starts a sequence at its first tick, or at the first due tick from `first_tick` on, to continue an
  /// interrupted one.
  void start(uint32_t sequence, int64_t first_tick = 0);
  /// Records and submits the next tick that is due, and hands the packet of the tick before to `sink`.
  /// Returns false if no tick is left; the last packet has then been handed over.
  bool step(RecordSink& sink);
  /// Hands over the packet of the tick in flight. Called before a run stops early.
  void drain(RecordSink& sink);

  int64_t next_tick() const { return next_tick_; }  ///< the tick that step() will record
  const Schedule& schedule() const { return schedule_; }
  /// Returns whether start() at a later tick runs through the ticks before it, because a sensor remembers.
  bool remembers() const;
  RunStatistics statistics() const;
  /// Returns RunStatistics::rows so far, without a copy.
  const std::vector<ConsistencyRow>& consistency_rows() const { return comparer_.rows(); }
  void keep_pass_samples(bool keep) { keep_samples_ = keep; }
  /// Keeps the times of each tick for times(), from the next step() on.
  void keep_tick_times(bool keep) { keep_times_ = keep; }
  /// Returns the times of the packet that the sink is being given; without rows if they are not kept.
  const TickTimes& times() const { return times_; }

 private:
  struct InFlight;
  Moment moment_at(int64_t tick) const;
  void start_sequence(uint32_t sequence, int64_t first_tick);
  void replay(int64_t end);
  void record(InFlight& in_flight, gpu::TickSlot& slot, const Moment& moment);
  void record_ahead(InFlight& in_flight, gpu::TickSlot& slot);
  void collect(InFlight& in_flight, RecordSink& sink);
  void add_passes(InFlight& in_flight);
  double simulated_ms(int64_t tick) const;
  void compare(const Packet& packet);
  /// Returns which tracer the passes use, and why, for the run's summary.
  std::string tracer_note() const;
  class HostScope;

  const Scenario& scenario_;
  const World& world_;
  gpu::Device& device_;
  std::unique_ptr<RadioAhead> radio_;  ///< exists while the scene is uploaded and the sensors are made
  scene::GpuScene gpu_scene_;
  gpu::TickRing ring_;
  Clock clock_;
  Schedule schedule_;
  SharedPasses passes_;
  std::vector<RunSensor> sensors_;
  std::vector<SensorSpec> specs_;  ///< [sensor]
  Comparer comparer_;
  SensorPlaces places_;
  std::map<std::string, uint64_t> draws_;  ///< of trajectories that keep a clearance, by node
  Courses courses_;
  std::unique_ptr<InFlight> pending_;
  uint32_t sequence_ = 0;
  int64_t next_tick_ = 0;
  int64_t due_ticks_ = 0;  ///< due ticks of the sequence before next_tick_
  bool looks_ahead_ = false;
  bool keep_samples_ = false, keep_times_ = false;
  TickTimes times_;        ///< of the packet collected last
  double start_ms_ = 0.0;  ///< of start(), until a tick is recorded; kept for times_ alone
  RunStatistics statistics_;
};

}  // namespace greatx::sim
