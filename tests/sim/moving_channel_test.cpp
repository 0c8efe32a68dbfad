// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Compares channels that keep their search between ticks, among moving meshes, with channels that repeat the
// whole search at every tick.
#include <cstddef>
#include <map>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "rf/channel/dispersion.h"
#include "sim/channel/channel_snapshot.h"
#include "sim/channel/ends.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/kept_run.h"

namespace greatx::sim {
namespace {

using test::expect_same_bytes;
using test::keep_run;
using test::KeptRun;

const std::string antenna =
    "    sensors: [{name: antenna, type: antenna, mount: {position_m: [0, 0, 2.2]}}]\n";

/// Returns a street with a mast, a car and a drone, all with antennas.
std::string street(const std::string& channel, const std::string& effects) {
  return "greatx: 1\nname: test\nseed: 5\nticks: 5\ntick_rate_hz: 2\n"
         "scene: {generate: {kind: canyon, seed: 3, size_m: 80}}\n"
         "nodes:\n"
         "  - name: bs\n    trajectory: {type: static, position_m: [1, -20, 6]}\n" +
         antenna +
         "  - name: car\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, -15, 0]}, "
         "{t_s: 2, position_m: [-2, 12, 0]}]}\n    model: {generate: {kind: car, variant: hatchback}}\n" +
         antenna +
         "  - name: uav\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [3, 15, 9]}, "
         "{t_s: 2, position_m: [-3, -5, 5]}]}\n    model: {generate: {kind: quadrotor, variant: large}}\n" +
         antenna +
         "channels:\n  - {name: csi, rate_hz: 2, subcarriers: 16, bandwidth_hz: 20e6, max_depth: 3, " +
         channel + "}\neffects: {moving_reflectors: on" + effects + "}\n";
}

TEST(MovingChannel, AStaticTransmitterKeepsItsSearch) {
  const std::string link = "tx: bs/antenna, rx: [uav/antenna, car/antenna]";
  const KeptRun kept = keep_run(street(link, "")),
                whole = keep_run(street(link + ", search: every_tick", ""));
  EXPECT_TRUE(kept.plan.moving_reflectors.on);
  EXPECT_GT(kept.counter("csi.paths"), 20u);
  EXPECT_THAT(kept.note("csi.search"), ::testing::HasSubstr("every tick for what moves"));
  EXPECT_THAT(kept.note("csi.guarantee_moving"), ::testing::HasSubstr("with a moving facet"));
  expect_same_bytes(kept, whole);
  // The moving bodies do reflect.
  std::string still = street(link, "");
  still.replace(still.find("moving_reflectors: on"), 21, "moving_reflectors: off");
  EXPECT_NE(keep_run(still).counter("csi.paths"), kept.counter("csi.paths"));
}

TEST(MovingChannel, StaticReceiversKeepTheirs) {
  const std::string link = "tx: uav/antenna, rx: [bs/antenna]";
  const KeptRun kept = keep_run(street(link, ", transmission: off"));
  EXPECT_THAT(kept.note("csi.search"), ::testing::StartsWith("once, from each receiver"));
  // A search from the other end finds the same sequences in reverse order. Compares their numbers with those
  // of the whole search at every tick.
  const KeptRun whole = keep_run(street(link + ", search: every_tick", ", transmission: off"));
  EXPECT_EQ(kept.counter("csi.paths"), whole.counter("csi.paths"));
  EXPECT_EQ(kept.counter("csi.path_births"), whole.counter("csi.path_births"));
}

TEST(MovingChannel, BothEndsMove) {
  for (const std::string effects : {"", ", transmission: off"}) {
    const std::string link = "tx: car/antenna, rx: [uav/antenna]";
    const KeptRun between = keep_run(street(link, effects)),
                  whole = keep_run(street(link + ", search: every_tick", effects));
    EXPECT_GT(between.counter("csi.paths"), 10u);
    EXPECT_THAT(between.note("csi.search"), ::testing::StartsWith("every tick, from both ends"));
    EXPECT_LT(between.counter("csi.candidates"), whole.counter("csi.candidates"));
    expect_same_bytes(between, whole);
  }
}

TEST(MovingChannel, BothEndsMoveAndEdgesDiffract) {
  for (const std::string effects : {", diffraction: on", ", diffraction: on, transmission: off"})
    for (const std::string rest : {"", ", max_reflections_beside_diffraction: 0"}) {
      const auto run = [&](const std::string& search) {
        std::string yaml = street("tx: car/antenna, rx: [uav/antenna]" + rest + search, effects);
        yaml.replace(yaml.find("moving_reflectors: on"), 21, "moving_reflectors: off");
        return keep_run(yaml);
      };
      const KeptRun between = run(""), whole = run(", search: every_tick");
      EXPECT_GT(between.counter("csi.paths"), 150u);
      EXPECT_THAT(between.note("csi.search"), ::testing::StartsWith("every tick, from both ends"));
      EXPECT_THAT(between.note("csi.guarantee_edges"), ::testing::HasSubstr("no path over one edge"));
      EXPECT_LT(between.counter("csi.candidates"), whole.counter("csi.candidates"));
      expect_same_bytes(between, whole);
    }
}

/// Returns the transfers of all paths of a tick by their identity.
std::map<uint64_t, std::vector<std::byte>> transfers_of(const KeptRun& run, size_t packet) {
  const auto ids = run.array<uint64_t>(packet, "csi", "id");
  const Array& transfer = run.array(packet, "csi", "transfer");
  const size_t bytes = ids.empty() ? 0 : transfer.bytes.size() / ids.size();
  std::map<uint64_t, std::vector<std::byte>> paths;
  for (size_t i = 0; i < ids.size(); ++i) {
    const auto begin = transfer.bytes.begin() + static_cast<ptrdiff_t>(i * bytes);
    paths[ids[i]] = {begin, begin + static_cast<ptrdiff_t>(bytes)};
  }
  return paths;
}

TEST(MovingChannel, EdgesDiffractAmongMovingReflectors) {
  // The whole search leaves out what is nearer to other edges than its clearance. What is found from both
  // ends may hold such paths, too; all others are the same to the bit.
  size_t same = 0, more = 0;
  for (const std::string link :
       {"tx: car/antenna, rx: [uav/antenna]",
        "tx: bs/antenna, rx: [uav/antenna], max_reflections_beside_diffraction: 1"}) {
    const auto run = [&](const std::string& search) {
      return keep_run(street(link + search, ", diffraction: on, transmission: off"));
    };
    const KeptRun between = run(", outputs: [paths]"), whole = run(", outputs: [paths], search: every_tick");
    EXPECT_THAT(between.note("csi.search"), ::testing::StartsWith("every tick, from both ends"));
    EXPECT_LT(between.counter("csi.candidates"), whole.counter("csi.candidates"));
    ASSERT_EQ(between.packets.size(), whole.packets.size());
    for (size_t packet = 0; packet < whole.packets.size(); ++packet) {
      const auto found = transfers_of(between, packet), expected = transfers_of(whole, packet);
      for (const auto& [id, transfer] : expected) {
        const auto path = found.find(id);
        ASSERT_TRUE(path != found.end()) << "packet " << packet;
        EXPECT_EQ(path->second, transfer);
      }
      same += expected.size(), more += found.size() - expected.size();
    }
  }
  EXPECT_GT(same, 3000u);
  EXPECT_LT(more, same / 200);
}

/// The simulator records the next tick before it computes the fields of a tick. The fields need the facets as
/// they stood at their own tick.
TEST(MovingChannel, ATickKnowsNothingOfTheTickAfterIt) {
  for (const std::string reflect : {"on", "off"}) {
    std::string yaml = street("tx: bs/antenna, rx: [uav/antenna, car/antenna]", "");
    yaml.replace(yaml.find("moving_reflectors: on"), 21, "moving_reflectors: " + reflect);
    const KeptRun all = keep_run(yaml);
    for (int64_t tick = 0; tick < 5; ++tick) {
      std::string one = yaml;
      one.replace(one.find("ticks: 5"), 8, fmt::format("ticks: {}", tick + 1));
      KeptRun alone = keep_run(one, 0, tick);
      ASSERT_EQ(alone.packets.size(), 1u);
      KeptRun same = all;
      same.packets = {all.packets[static_cast<size_t>(tick)]};
      expect_same_bytes(same, alone);
    }
  }
}

/// Results that outlive a tick keep its facets, whatever is solved afterwards.
TEST(MovingChannel, ASnapshotThatMovesOnLeavesEarlierResultsAsTheyAre) {
  const Experiment experiment = make_experiment(
      parse_scenario(street("tx: bs/antenna, rx: [uav/antenna, car/antenna]", ""), "test.yaml", "."));
  ChannelSnapshot snapshot(test::device(), experiment, 0, {.tick = 1});
  const rf::Dispersion dispersion(experiment.scene(), snapshot.model().field_model(), {},
                                  {experiment.scenario.channels[0].carrier_hz, 30e6, 3, 1, 0.0});
  const auto solve = [&] {
    std::vector<ChannelSnapshot::Link> links;
    snapshot.solve([&](ChannelSnapshot::Link link) {
      links.push_back(std::move(link));
      return true;
    });
    return links;
  };
  const auto spectra_of = [&](const ChannelSnapshot::Link& link) {
    return dispersion.spectra(link.paths, *link.world);
  };
  // The last facet belongs to a moving body, because facets of moving bodies come last.
  const uint32_t facet = snapshot.model().facets.facet_count() - 1;
  const std::vector<ChannelSnapshot::Link> before = solve();
  ASSERT_EQ(before.size(), 2u);
  EXPECT_EQ(before[0].world, before[1].world) << "links of a tick share one";
  const dvec3 stood = before[0].world->facet(facet).centroid;
  const auto spectra = spectra_of(before[0]);
  snapshot.move(0, 3);
  std::vector<ChannelSnapshot::Link> after = solve();
  EXPECT_NE(before[0].world, after[0].world);
  EXPECT_EQ(before[0].world->facet(facet).centroid, stood);
  EXPECT_NE(after[0].world->facet(facet).centroid, stood);
  EXPECT_TRUE(spectra_of(before[0]) == spectra);
  // Facets that nobody holds any more are moved in place instead of copied.
  const rf::FacetWorld* const released = after[0].world.get();
  after.clear();
  snapshot.move(0, 4);
  const std::vector<ChannelSnapshot::Link> again = solve();
  EXPECT_EQ(again[0].world.get(), released);
  EXPECT_EQ(again[0].world->facet(facet).centroid, snapshot.model().facets.facet(facet).centroid);
}

TEST(MovingChannel, ScatteringWithMovingReflectorsSearchesWholeAndSaysSo) {
  const KeptRun r = keep_run(street("tx: bs/antenna, rx: [uav/antenna]", ", scattering: on"));
  EXPECT_THAT(r.note("csi.search"), ::testing::StartsWith("every tick, from the transmitter"));
  EXPECT_THAT(r.note("csi.reuse"), ::testing::StartsWith("none"));
}

/// Each rule decides where those before it leave a tie, whichever end transmits.
TEST(SearchedFrom, TheOrderOfTheEndsDecidesWhicheverTransmits) {
  const auto end = [](const char* name, bool rests, uint32_t elements, int64_t height_mm) {
    ChannelEnd made;
    made.name = name;
    made.rests = rests;
    made.elements = elements;
    made.height_mm = height_mm;
    return made;
  };
  const ChannelEnd pairs[][2] = {{end("z/a", true, 1, 0), end("a/a", false, 64, 0)},
                                 {end("z/a", true, 4, 1500), end("a/a", true, 2, 25000)},
                                 {end("z/a", false, 4, 0), end("a/a", false, 2, 0)},
                                 {end("z/a", true, 4, 1501), end("a/a", true, 4, 1500)},
                                 {end("a/a", true, 4, 1500), end("a/b", true, 4, 1500)}};
  for (const auto& [first, second] : pairs) {
    EXPECT_EQ(searched_from(first, second), rf::Source::transmitter) << first.name << ' ' << second.name;
    EXPECT_EQ(searched_from(second, first), rf::Source::receiver) << first.name << ' ' << second.name;
  }
}

TEST(SearchedFrom, TheNoteSaysSoAndReflectionsAloneNeedNoOrder) {
  const std::string links = "tx: uav/antenna, rx: [car/antenna, bs/antenna]";
  std::string yaml = street(links, ", diffraction: on");
  EXPECT_EQ(keep_run(yaml).note("csi.search"), "every tick, from both ends");
  std::string scattered = yaml;
  scattered.replace(yaml.find("diffraction: on"), 15, "diffraction: on, scattering: on");
  EXPECT_EQ(keep_run(scattered).note("csi.search"),
            "from one end of each link, the same in both directions; every tick");
  yaml.replace(yaml.find("moving_reflectors: on"), 21, "moving_reflectors: off");
  EXPECT_EQ(keep_run(yaml).note("csi.search"), "every tick, from both ends");
  yaml.replace(yaml.find("diffraction: on"), 15, "diffraction: on, scattering: on");
  EXPECT_EQ(keep_run(yaml).note("csi.search"),
            "from one end of each link, the same in both directions; once if it rests, else every tick");
  EXPECT_EQ(keep_run(street(links, "")).note("csi.search"), "every tick, from both ends");
}

}  // namespace
}  // namespace greatx::sim
