// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests a channel over time: what its paths keep from tick to tick, and which settings must not change a
// byte.
#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <map>
#include <sched.h>
#include <set>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include "core/parallel.h"
#include "core/units.h"
#include "tests/sim/radio_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

namespace fs = std::filesystem;
using sim::testing::expect_same_bytes;
using sim::testing::radio_material;
using sim::testing::RadioRun;
using sim::testing::run;
using test::TinyScene;

constexpr double channel_carrier_hz = 3.5e9, tick_s = 0.01;
constexpr int ticks = 25;

/// Returns a street with gaps and thin walls, some of which scatter.
scene::Scene channel_street() {
  TinyScene tiny;
  const uint32_t ground = tiny.material_as(radio_material("medium_dry_ground"));
  scene::Material rough = radio_material("brick", 0.2);
  rough.radio->scattering_coefficient = 0.3;
  const uint32_t wall = tiny.material_as(rough), pane = tiny.material_as(radio_material("glass", 0.01));
  tiny.object("ground", 0, ground).quad({-40, -40, 0}, {40, -40, 0}, {40, 40, 0}, {-40, 40, 0});
  tiny.object("north", 0, wall).box({-12, 8, 0}, {-1, 14, 9});
  tiny.object("east", 0, wall).box({4, 8, 0}, {14, 14, 6});
  tiny.object("south", 0, wall).box({-9, -14, 0}, {6, -7, 7});
  tiny.object("pane", 0, pane).quad({2, -5, 0}, {2, 1, 0}, {2, 1, 4}, {2, -5, 4});
  return tiny.build();
}

/// A terminal that moves along x from its own place.
struct Terminal {
  dvec3 from;
  double speed_m_s = 20.0;
};
const std::vector<Terminal> terminals{
    {{3.1, 0.4, 1.5}}, {{6.2, -1.3, 1.7}}, {{-3.0, 2.2, 12.0}}, {{8.4, 4.1, 1.6}}, {{-14.2, -4.0, 2.5}}};

std::string channel_scenario(const std::vector<uint32_t>& receivers, const std::string& channel = "",
                             const std::string& more = "") {
  std::string text = fmt::format(
      "greatx: 1\nname: test\nseed: 5\nticks: {}\ntick_rate_hz: 100\nnodes:\n"
      "  - name: bs\n    trajectory: {{type: static, position_m: [-6.3, 1.1, 5.2]}}\n"
      "    sensors: [{{name: antenna, type: antenna, polarization: slant}}]\n",
      ticks);
  for (size_t i = 0; i < terminals.size(); ++i) {
    const dvec3& p = terminals[i].from;
    text += fmt::format(
        "  - name: ue{}\n    trajectory: {{type: waypoints, interpolation: linear, points: [{{t_s: 0, "
        "position_m: "
        "[{}, {}, {}]}}, {{t_s: 1, position_m: [{}, {}, {}]}}]}}\n"
        "    sensors: [{{name: antenna, type: antenna}}]\n",
        i, p.x, p.y, p.z, p.x + terminals[i].speed_m_s, p.y, p.z);
  }
  std::vector<std::string> names;
  for (const uint32_t r : receivers) names.push_back(fmt::format("ue{}/antenna", r));
  return text +
         fmt::format(
             "channels:\n  - {{name: csi, tx: bs/antenna, rx: [{}], rate_hz: 100, subcarriers: 16, "
             "bandwidth_hz: 20e6, carrier_hz: {}, max_depth: 2{}}}\n",
             fmt::join(names, ", "), channel_carrier_hz, channel) +
         more;
}

/// Switches on every effect that makes paths.
const std::string everything = "effects: {diffraction: on, scattering: on}\n";

/// A path of one tick: its interactions, which decide its id, and its values.
struct Known {
  std::vector<uint8_t> types;
  std::vector<uint32_t> facets, elements;
  double delay = 0.0, doppler = 0.0;
  std::complex<float> transfer[4];
};

/// Returns the paths of a packet as [receiver][id].
std::vector<std::map<uint64_t, Known>> paths_of(const RadioRun& run, size_t packet, size_t receivers) {
  std::vector<std::map<uint64_t, Known>> paths(receivers);
  const auto rx = run.values<int32_t>(packet, "rx");
  const auto id = run.values<uint64_t>(packet, "id");
  const auto delay = run.values<double>(packet, "delay"), doppler = run.values<double>(packet, "doppler");
  const auto type = run.values<uint8_t>(packet, "interaction");
  const auto facet = run.values<uint32_t>(packet, "facet"), element = run.values<uint32_t>(packet, "element");
  const auto& arrays = run.spec("csi").arrays;
  const bool has_end = std::ranges::find(arrays, "end", &ArraySpec::name) != arrays.end();
  const auto end = has_end ? run.values<uint8_t>(packet, "end") : std::vector<uint8_t>(type.size());
  const auto transfer = run.values<std::complex<float>>(packet, "transfer");
  const size_t depth = id.empty() ? 0 : type.size() / id.size();
  for (size_t i = 0; i < id.size(); ++i) {
    Known path;
    path.types.assign(type.begin() + i * depth, type.begin() + (i + 1) * depth);
    path.facets.assign(facet.begin() + i * depth, facet.begin() + (i + 1) * depth);
    path.elements.assign(element.begin() + i * depth, element.begin() + (i + 1) * depth);
    path.elements.insert(path.elements.end(), end.begin() + i * depth, end.begin() + (i + 1) * depth);
    path.delay = delay[i], path.doppler = doppler[i];
    std::copy_n(transfer.begin() + 4 * i, 4, path.transfer);
    EXPECT_TRUE(paths[rx[i]].emplace(id[i], path).second) << "an id twice in one link";
  }
  return paths;
}

TEST(ChannelOverTime, IdsStayWhileAPathLivesAndBirthsAndDeathsAreCounted) {
  const RadioRun r = run(channel_scenario({0, 1, 3}, "", everything), channel_street());
  ASSERT_EQ(r.packets.size(), static_cast<size_t>(ticks));
  std::map<uint64_t, Known> ever;
  uint64_t births = 0, deaths = 0, lasting = 0, all = 0;
  std::vector<std::map<uint64_t, Known>> before;
  for (size_t tick = 0; tick < r.packets.size(); ++tick) {
    const auto now = paths_of(r, tick, 3);
    for (size_t link = 0; link < now.size(); ++link) {
      all += now[link].size();
      for (const auto& [id, path] : now[link]) {
        // Ids and sequences of interactions correspond one to one, in every tick and every link.
        const auto known = ever.emplace(id, path).first;
        EXPECT_TRUE(known->second.types == path.types && known->second.facets == path.facets &&
                    known->second.elements == path.elements)
            << id;
        if (before.empty()) continue;
        const bool was = before[link].count(id) > 0;
        births += !was, lasting += was;
      }
      if (!before.empty())
        for (const auto& [id, path] : before[link]) deaths += now[link].count(id) == 0;
    }
    before = now;
  }
  std::set<std::tuple<std::vector<uint8_t>, std::vector<uint32_t>, std::vector<uint32_t>>> sequences;
  for (const auto& [id, path] : ever) sequences.emplace(path.types, path.facets, path.elements);
  EXPECT_EQ(sequences.size(), ever.size());
  EXPECT_GT(births, 5u);
  EXPECT_GT(deaths, 5u);
  EXPECT_GT(lasting, 5 * (births + deaths)) << "most paths live for many ticks";
  EXPECT_EQ(r.counter("path_births"), births);
  EXPECT_EQ(r.counter("path_deaths"), deaths);
  EXPECT_EQ(r.counter("paths"), all);
}

TEST(ChannelOverTime, PhasesTurnByWhatDopplerSaysAndNoMore) {
  // This holds for reflections and walls. The contribution of an edge changes by half a turn where the wave
  // that it belongs to begins or ends, which keeps the sum continuous (tests in rf_diffraction), and the
  // weight of a facet turns where its reflection point nears an edge.
  const RadioRun r =
      run(channel_scenario({0, 2, 3}, "", "effects: {finite_reflectors: off}\n"), channel_street());
  size_t compared = 0;
  double largest = 0.0;
  for (size_t tick = 0; tick + 1 < r.packets.size(); ++tick) {
    const auto now = paths_of(r, tick, 3), next = paths_of(r, tick + 1, 3);
    for (size_t link = 0; link < now.size(); ++link)
      for (const auto& [id, path] : now[link]) {
        const auto there = next[link].find(id);
        if (there == next[link].end()) continue;
        // Uses the strongest entry of the transfer matrix, because others may go through 0.
        const auto* entry =
            std::max_element(path.transfer, path.transfer + 4,
                             [](const auto& a, const auto& b) { return std::abs(a) < std::abs(b); });
        const size_t which = static_cast<size_t>(entry - path.transfer);
        const auto turns = [&](const Known& p) {
          return std::arg(std::complex<double>(p.transfer[which])) / (2 * pi) - channel_carrier_hz * p.delay;
        };
        const double predicted = 0.5 * (path.doppler + there->second.doppler) * tick_s;
        const double off = turns(there->second) - turns(path) - predicted;
        largest = std::max(largest, std::abs(off - std::round(off)));
        ++compared;
      }
  }
  EXPECT_GT(compared, 300u);
  EXPECT_LT(largest, 0.02) << "turns";
}

TEST(ChannelOverTime, AnySubsetOfReceiversGivesTheSameBytes) {
  const std::vector<uint32_t> all{0, 1, 2, 3, 4};
  for (const std::string& channel : {std::string(), std::string(", max_reflections_after: 1")}) {
    const RadioRun together = run(channel_scenario(all, channel, everything), channel_street());
    for (const std::vector<uint32_t>& some : {std::vector<uint32_t>{2}, {4, 1}, {3, 0, 1}}) {
      const RadioRun few = run(channel_scenario(some, channel, everything), channel_street());
      for (size_t tick = 0; tick < few.packets.size(); ++tick) {
        const auto mine = few.values<std::complex<float>>(tick, "cfr"),
                   theirs = together.values<std::complex<float>>(tick, "cfr");
        const size_t size = mine.size() / some.size();
        const auto a = paths_of(few, tick, some.size()), b = paths_of(together, tick, all.size());
        for (size_t i = 0; i < some.size(); ++i) {
          EXPECT_TRUE(std::equal(mine.begin() + i * size, mine.begin() + (i + 1) * size,
                                 theirs.begin() + some[i] * size))
              << "tick " << tick << ", ue" << some[i];
          ASSERT_EQ(a[i].size(), b[some[i]].size());
          for (const auto& [id, path] : a[i]) {
            ASSERT_TRUE(b[some[i]].count(id)) << id;
            const Known& other = b[some[i]].at(id);
            EXPECT_TRUE(path.delay == other.delay && path.doppler == other.doppler &&
                        std::equal(path.transfer, path.transfer + 4, other.transfer));
          }
        }
      }
    }
  }
}

TEST(ChannelOverTime, OnceAndAtEveryTickAreTheSameWhereNothingMoves) {
  for (const std::string& effects : {std::string(), everything}) {
    const RadioRun once = run(channel_scenario({0, 1, 2}, ", search: once", effects), channel_street()),
                   always =
                       run(channel_scenario({0, 1, 2}, ", search: every_tick", effects), channel_street());
    ASSERT_GT(once.counter("paths"), 100u);
    expect_same_bytes(once, always, effects);
  }
}

class SearchKept : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* value = std::getenv("GREATX_CACHE")) before_ = value;
  }
  void TearDown() override { setenv("GREATX_CACHE", before_.c_str(), 1); }
  RadioRun with(const std::string& cache, const std::string& yaml) {
    setenv("GREATX_CACHE", cache.c_str(), 1);
    return run(yaml, channel_street());
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
  std::string before_;
};

TEST_F(SearchKept, GivesTheSameBytesAsOneThatWasMade) {
  const std::string yaml = channel_scenario({0, 1, 2}, "", everything);
  const RadioRun none = with("off", yaml), first = with(folder_, yaml), second = with(folder_, yaml);
  EXPECT_EQ(none.counter("candidates_from_cache"), 0u);
  EXPECT_EQ(first.counter("candidates_from_cache"), 0u);
  EXPECT_EQ(second.counter("candidates_from_cache"), 1u);
  expect_same_bytes(none, first, "first");
  expect_same_bytes(none, second, "second");
  EXPECT_EQ(none.counter("candidates"), second.counter("candidates"));
  // If the file is damaged, the search is made again.
  for (const auto& entry : fs::directory_iterator(folder_))
    fs::resize_file(entry.path(), fs::file_size(entry.path()) / 2);
  const RadioRun third = with(folder_, yaml);
  EXPECT_EQ(third.counter("candidates_from_cache"), 0u);
  expect_same_bytes(none, third, "third");
}

TEST_F(SearchKept, IsForTheEffectsThatItWasMadeWith) {
  // Free edges and walls change which candidates exist, so the cache must tell these effects apart.
  for (const std::string effects :
       {"diffraction: on", "diffraction: on, free_edges: on", "transmission: off", "diffraction: off"}) {
    const std::string yaml = channel_scenario({0, 1}, "", "effects: {" + effects + "}\n");
    const RadioRun filled = with(folder_, yaml), again = with(folder_, yaml), none = with("off", yaml);
    EXPECT_EQ(filled.counter("candidates_from_cache"), 0u) << effects;
    EXPECT_EQ(again.counter("candidates_from_cache"), 1u) << effects;
    expect_same_bytes(none, again, effects);
  }
}

TEST(ChannelHardCase, N63_OneAndTwoThreadsGiveTheSameBytes) {
  const std::string yaml = channel_scenario({0, 1, 2, 3, 4}, ", max_reflections_after: 1", everything);
  cpu_set_t all, first;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  if (CPU_COUNT(&all) < 2) GTEST_SKIP() << "one core";
  CPU_ZERO(&first);
  for (int cpu = 0; CPU_COUNT(&first) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &first);
  // parallel_for uses as many threads as the process has cores.
  ASSERT_EQ(sched_setaffinity(0, sizeof first, &first), 0);
  EXPECT_EQ(usable_cores(), 1u);
  const RadioRun one = run(yaml, channel_street());
  ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
  EXPECT_GT(usable_cores(), 1u);
  expect_same_bytes(one, run(yaml, channel_street()), "threads");
}

}  // namespace
}  // namespace greatx::sim
