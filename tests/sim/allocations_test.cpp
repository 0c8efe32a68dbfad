// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Counts what a tick of the default scenario allocates once it runs steadily. The count is that of this
// program's own code: the driver allocates by malloc.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include <gtest/gtest.h>

#include "assets/assets.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/gpu_fixture.h"

namespace {

std::atomic<uint64_t> allocations = 0, allocated_bytes = 0;

void* counted(std::size_t bytes, std::size_t alignment) {
  allocations.fetch_add(1, std::memory_order_relaxed);
  allocated_bytes.fetch_add(bytes, std::memory_order_relaxed);
  const std::size_t rounded = (std::max<std::size_t>(bytes, 1) + alignment - 1) / alignment * alignment;
  if (void* const memory = std::aligned_alloc(alignment, rounded)) return memory;
  throw std::bad_alloc();
}

}  // namespace

// GCC 12 sees only one of two inlined functions that belong together, and warns of the other.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"

// The other forms of new and delete call these.
void* operator new(std::size_t bytes) { return counted(bytes, alignof(std::max_align_t)); }
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  return counted(bytes, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }

namespace greatx::sim {
namespace {

struct Discard : RecordSink {
  void write(Packet) override {}
};

struct Count {
  uint64_t allocations = 0, bytes = 0;
};

/// Returns the default scenario with one picture a record for its events: a software driver allocates some
/// 4000 times for each picture.
std::string default_scenario() {
  std::string text(std::ranges::find(embedded_scenarios(), "city", &EmbeddedScenario::name)->text);
  const std::string steps = "steps: 40";
  EXPECT_NE(text.find(steps), text.npos);
  return text.replace(text.find(steps), steps.size(), "steps: 1");
}

/// Returns the default scenario without its radar.
std::string without_radar() {
  std::string text = default_scenario();
  const size_t begin = text.find("      - name: radar\n"), end = text.find("      - {name: antenna", begin);
  EXPECT_TRUE(begin != text.npos && end != text.npos);
  return text.erase(begin, end - begin);
}

/// Runs some ticks of a scenario to warm up. Returns the most that one of the next ticks allocates.
Count most_of_a_tick(const std::string& scenario) {
  constexpr int warm_up = 6, measured = 4;
  const Experiment experiment = make_experiment(parse_scenario(scenario, "scenario", {}, {}));
  Simulator simulator(test::device(), experiment);
  simulator.start(0);
  Discard sink;
  for (int tick = 0; tick < warm_up; ++tick) simulator.step(sink);
  Count most;
  for (int tick = 0; tick < measured; ++tick) {
    const uint64_t before = allocations, bytes_before = allocated_bytes;
    simulator.step(sink);
    most.allocations = std::max<uint64_t>(most.allocations, allocations - before);
    most.bytes = std::max<uint64_t>(most.bytes, allocated_bytes - bytes_before);
  }
  return most;
}

TEST(Allocations, TickOfTheDefaultScenarioStaysWithinItsNumber) {
  const Count most = most_of_a_tick(default_scenario());
  EXPECT_GT(most.allocations, 0u);  // the records themselves
  EXPECT_LE(most.allocations, 58'000u);
  EXPECT_LE(most.bytes, 170'000'000u);
}

TEST(Allocations, TickWithoutRadarStaysWithinItsNumber) {
  const Count most = most_of_a_tick(without_radar());
  EXPECT_GT(most.allocations, 0u);
  EXPECT_LE(most.allocations, 25'500u);
  EXPECT_LE(most.bytes, 29'000'000u);
}

}  // namespace
}  // namespace greatx::sim
