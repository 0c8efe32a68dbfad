// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A run whose packets stay in memory.
#pragma once

#include <deque>
#include <optional>

#include "python/src/session.h"
#include "sim/run/simulator.h"

namespace greatx::python {

class Stream {
 public:
  Stream(std::shared_ptr<const sim::Experiment> experiment, std::shared_ptr<Gpu> gpu, uint32_t sequence,
         int64_t first_tick);
  ~Stream();

  /// Name, kind, arrays and metadata of each sensor, as JSON; index = Record::sensor.
  std::string sensors() const;
  /// None: the sequence is over. Throws UserError after a call that ended with an error or was interrupted:
  /// the tick that it was in is lost.
  std::optional<Packet> next();
  /// Counters and notes of the run so far, as JSON.
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

}  // namespace greatx::python
