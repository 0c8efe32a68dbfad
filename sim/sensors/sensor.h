// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the interface between the simulator and a sensor. A sensor declares its data, records its part of a
// tick into a command buffer, and returns the result when the GPU has finished.
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

/// A sensor of a run. Two ticks are in flight: record() of a tick is called before collect() of the tick
/// before. A sensor therefore stores the state for its collect() by slot (gpu::TickSlot::index).
class Sensor {
 public:
  virtual ~Sensor() = default;
  /// Returns the declaration of the sensor's data, which does not change during a run.
  virtual const SensorSpec& spec() const = 0;
  /// Called once for each sequence before its first record(), for set-up that depends on the poses at that
  /// time. If a run begins within a sequence, the context is that of the first recorded tick, or that of the
  /// first tick of the sequence if remembers().
  virtual void start(const TickContext&) {}
  /// Returns whether a record depends on the records before it. If so, start() gets the context of the first
  /// tick of the sequence. A run that continues within a sequence first replays the earlier ticks through
  /// record() and catch_up(), without writing files.
  virtual bool remembers() const { return false; }
  /// Returns whether record() draws pictures. If so, the shadows of the tick are recorded before it.
  virtual bool draws_pictures() const { return false; }
  /// Adds the sensor's passes to the command buffer of the tick. The scene on the GPU has the poses of the
  /// tick, and the sensor leaves it so.
  virtual void record(gpu::TickSlot& slot, const TickContext& context) = 0;
  /// Returns whether record() needs results of the submission before. If so, that submission is finished
  /// before record() is called.
  virtual bool looks_ahead() const { return false; }
  /// Adds passes at the end of the submission before each tick at which the sensor is due. The scene on the
  /// GPU already has the poses of that tick. It is called only for sensors that look ahead. Before the first
  /// recorded tick of a sequence there is no submission, so record() follows start() directly.
  virtual void record_ahead(gpu::TickSlot&, const TickContext&) {}
  /// Returns the arrays of the record in the order of the spec. Called once for each record(), in the same
  /// order, when the submission of the slot is finished.
  virtual std::vector<Array> collect(const gpu::TickSlot& slot) = 0;
  /// Called instead of collect() at a replayed tick, only for sensors that remember. It counts nothing.
  virtual void catch_up(const gpu::TickSlot&) {}
  /// Returns the data by which the record collected last can be compared with other records of its tick.
  virtual Evidence evidence() const { return {}; }
  /// Adds the sensor's counts over the run: candidates, paths, overflows.
  virtual void count(std::map<std::string, uint64_t>&) const {}
  /// Adds messages about data that the run lost. They are always shown to the user.
  virtual void warn(std::vector<std::string>&) const {}
  /// Adds notes for the summary of the run, as (name, text).
  virtual void note(std::vector<std::pair<std::string, std::string>>&) const {}
};

/// Number of slots of the tick ring: one is in flight while the one before is collected.
inline constexpr uint32_t slots_in_flight = 2;

}  // namespace greatx::sim
