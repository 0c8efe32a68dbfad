// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The simulator's view of a sensor. A sensor declares what it delivers, records its part of a tick into a
// command buffer, and hands over the result when the GPU has done it.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/record.h"
#include "gpu/tick_ring.h"
#include "sim/compare/evidence.h"
#include "sim/world/tick_context.h"

namespace greatx::sim {

/// A sensor of a run. Two ticks are in flight, and record() of a tick is called before collect() of the tick
/// before it. So a sensor keeps the state that waits for its collect() by slot (gpu::TickSlot::index).
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// What the sensor delivers; it does not change during a run.
  virtual const SensorSpec& spec() const = 0;
  /// Called once for each sequence, before its first record(): set-up that depends on where things are then.
  /// If a run begins within a sequence, the context is that of the first tick that it records, unless
  /// remembers().
  virtual void start(const TickContext&) {}
  /// Whether a record depends on the records before it. start() then gets the context of the sequence's first
  /// tick, and a run that goes on within a sequence first goes again through the ticks before: record() and
  /// catch_up(), without a file.
  virtual bool remembers() const { return false; }
  /// Whether record() draws pictures. The shadows of the tick are then recorded before it.
  virtual bool draws_pictures() const { return false; }
  /// Adds the sensor's passes to the tick's command buffer. The scene on the GPU is where it is at the tick,
  /// and the sensor leaves it there.
  virtual void record(gpu::TickSlot& slot, const TickContext& context) = 0;
  /// Whether record() needs results of the submission before. That submission is then done before record() is
  /// called.
  virtual bool looks_ahead() const { return false; }
  /// Only of a sensor that looks ahead: adds passes at the end of the submission before each tick at which
  /// the sensor is due, with the scene on the GPU already where it is at that tick. No submission comes
  /// before the first tick that a run records of a sequence: there record() follows start() alone.
  virtual void record_ahead(gpu::TickSlot&, const TickContext&) {}
  /// The arrays of the record, in the order of the spec. Called once for each record(), in the same order,
  /// when the slot's submission is done.
  virtual std::vector<Array> collect(const gpu::TickSlot& slot) = 0;
  /// Only of a sensor that remembers: called instead of collect() at a tick that is gone through again. It
  /// counts nothing.
  virtual void catch_up(const gpu::TickSlot&) {}
  /// What the record collected last can be compared by with the other records of its tick.
  virtual Evidence evidence() const { return {}; }
  /// Adds the sensor's counts over the run: candidates, paths, overflows.
  virtual void count(std::map<std::string, uint64_t>&) const {}
  /// Adds sentences that a user must read, whatever else is printed: data that the run lost.
  virtual void warn(std::vector<std::string>&) const {}
  /// Adds sentences for the run's summary, as (name, text).
  virtual void note(std::vector<std::pair<std::string, std::string>>&) const {}
};

/// Slots of the tick ring: one is in flight while the one before it is collected.
inline constexpr uint32_t slots_in_flight = 2;

}  // namespace greatx::sim
