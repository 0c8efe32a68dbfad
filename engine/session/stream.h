// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs a sequence and delivers its packets in memory.
#pragma once

#include <deque>
#include <optional>

#include "engine/session/session.h"
#include "sim/run/simulator.h"

namespace greatx::engine {

/// Throws UserError if a scenario has no such sequence or tick.
void check_instant(const sim::Scenario& scenario, uint32_t sequence, int64_t tick);

class Stream {
 public:
  Stream(std::shared_ptr<const sim::Experiment> experiment, std::shared_ptr<Gpu> gpu, uint32_t sequence,
         int64_t first_tick);
  ~Stream();

  /// Returns what each sensor delivers; index = Record::sensor.
  const std::vector<SensorSpec>& specs() const { return simulator_->sensors(); }
  /// Returns name, kind, rate, arrays and metadata of each sensor as JSON, in the order of Record::sensor.
  std::string sensors() const;
  /// Returns the next packet, or nullopt at the end of the sequence. Throws UserError if an earlier call
  /// ended with an error or was interrupted, because the tick of that call is lost.
  std::optional<Packet> next();
  /// Goes on with another sequence, with what was made for this one. What is left of this one is lost.
  void restart(uint32_t sequence, int64_t first_tick);
  /// Returns the counters, notes and warnings of the run so far as JSON.
  std::string summary();

 private:
  struct Queue : RecordSink {
    std::deque<Packet> packets;
    void write(Packet packet) override { packets.push_back(std::move(packet)); }
  };

  std::shared_ptr<const sim::Experiment> experiment_;
  std::shared_ptr<Gpu> gpu_;
  Queue queue_;
  bool broken_ = false;
  std::unique_ptr<sim::Simulator> simulator_;
};

}  // namespace greatx::engine
