// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Waits for runs, and compares what they show with packets.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "core/record.h"
#include "view/run/run.h"

namespace greatx::view {

/// Waits until `done` returns true. Gives up after twenty seconds.
inline bool wait_until(const std::function<bool()>& done) {
  const auto begin = std::chrono::steady_clock::now();
  while (!done()) {
    if (std::chrono::steady_clock::now() - begin > std::chrono::seconds(20)) return false;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return true;
}

inline bool shows(const Run& run, uint32_t sequence, int64_t tick) {
  const std::shared_ptr<const ShownTick> shown = run.shown();
  return shown != nullptr && shown->sequence == sequence && shown->packet.tick == tick;
}
/// Waits until the tick is shown, or an error is reported. Returns whether it is shown.
inline bool wait_for_tick(const Run& run, uint32_t sequence, int64_t tick) {
  const bool done = wait_until([&] { return shows(run, sequence, tick) || !run.status().error.empty(); });
  EXPECT_TRUE(done) << "tick " << tick << " of sequence " << sequence << " does not come";
  EXPECT_EQ(run.status().error, "");
  return shows(run, sequence, tick);
}
inline bool wait_for_pause(const Run& run) {
  return wait_until([&] { return !run.status().playing; });
}
inline bool wait_for_error(const Run& run) {
  return wait_until([&] { return !run.status().error.empty(); });
}

/// Expects the record to be the same in all that it holds.
void expect_same_record(const Record& wanted, const Record& found, const std::string& what);
/// Expects that the tick has the packet's bytes, and that `newest` holds its records and, of the other
/// sensors, the newest record of `before`. `before` are the packets of the sequence before it.
/// `may_lack`: a sensor that is not due may have none.
void expect_shown(const Packet& wanted, const std::vector<Packet>& before, const ShownTick& shown,
                  bool may_lack = false);

}  // namespace greatx::view
