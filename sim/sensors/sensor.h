// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What the simulator asks of a sensor: say what it delivers, record its part of a tick, hand over the result when the
// GPU is done. A sensor keeps its pending state per slot, since two ticks are in flight.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/record.h"
#include "core/vec.h"
#include "gpu/tick_ring.h"
#include "sim/compare/error_statistics.h"
#include "sim/scenario/scenario.h"
#include "sim/world/tick_context.h"

namespace greatx::sim {

/// Figures of a run that show that the modalities see one world.
struct Consistency {
  ErrorStatistics depth;          ///< interior pixels against the ray through their centre
  ErrorStatistics lidar;          ///< returns against the depth picture of a camera on the same node
  ErrorStatistics line_of_sight;  ///< c * delay of direct paths against the distance
  ErrorStatistics radar;          ///< ranges of detections against the boxes of their instances
};

class Sensor {
 public:
  virtual ~Sensor() = default;
  virtual const SensorSpec& spec() const = 0;
  /// Once before the first tick of a sequence (or of its rest): set-up that depends on where things are.
  virtual void start(const TickContext&) {}
  /// Whether a record depends on records before it. start() is then called at the sequence's first tick, and a run that
  /// goes on later first replays what was due before, without writing it.
  virtual bool remembers() const { return false; }
  /// Adds the sensor's passes to the tick's command buffer.
  virtual void record(gpu::TickSlot& slot, const TickContext& context) = 0;
  /// Whether record() needs results of the submission before. record_ahead() is then called at the end of the command
  /// buffer before each tick at which this sensor is due, with the scene already where it will be at that tick, and
  /// record() comes after that submission is done.
  virtual bool looks_ahead() const { return false; }
  virtual void record_ahead(gpu::TickSlot&, const TickContext&) {}
  /// The arrays of the record, in the order of the spec; after the slot's submission is done.
  virtual std::vector<Array> collect(const gpu::TickSlot& slot) = 0;
  /// Of a sensor that remembers: instead of collect(), at a tick that is gone through again before a resume. Counts
  /// nothing.
  virtual void catch_up(const gpu::TickSlot&) {}
  /// Adds this sensor's figures.
  virtual void report(Consistency&) const {}
  /// Adds what this sensor counted over the run: candidates, paths, overflows.
  virtual void count(std::map<std::string, uint64_t>&) const {}
  /// Adds what a user must hear of, whatever else is printed: data that the run lost. A sentence each.
  virtual void warn(std::vector<std::string>&) const {}
  /// Adds what the run's summary should say in words, (name, text).
  virtual void note(std::vector<std::pair<std::string, std::string>>&) const {}
};

/// Slots of the tick ring: one in flight while the one before it is collected.
inline constexpr uint32_t slots_in_flight = 2;

}  // namespace greatx::sim
