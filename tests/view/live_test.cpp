// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A live run shows the bytes of the simulator, however one comes to a tick.
#include "view/run/live.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <thread>

#include <gmock/gmock.h>

#include "core/random.h"
#include "io/dataset/dataset_writer.h"
#include "sim/dataset/dataset_info.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"
#include "tests/view/run_support.h"
#include "view/run/replay.h"

namespace greatx::view {
namespace {

using test::keep_run;
using test::KeptRun;
using testing::HasSubstr;

/// Camera, LiDAR, and an event camera that remembers, in a street where a van drives; a channel that looks
/// ahead. They fire at different ticks, and noise and paths differ between sequences.
const std::string street =
    "greatx: 1\nname: street\nseed: 5\nticks: 12\ntick_rate_hz: 100\nsequences: 2\n"
    "scene: {generate: {kind: room}}\nnodes:\n"
    "  - name: bs\n    trajectory: {type: static, position_m: [-4, -3, 2.5]}\n"
    "    sensors: [{name: panel, type: antenna}]\n"
    "  - name: box\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [3, -2, 0.5]}, {t_s: "
    "0.12, "
    "position_m: [3, 2, 0.5]}]}\n    model: {generate: {kind: quadrotor, variant: large}}\n"
    "  - name: eye\n    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-2, 0, 1], "
    "rotation_deg: "
    "[0, 0, 0]}, {t_s: 0.12, position_m: [-1.5, 0.3, 1.2], rotation_deg: [4, 0, 0]}]}\n    sensors:\n"
    "      - {name: dvs, type: event_camera, rate_hz: 50, width: 30, height: 22, fov_deg: 70, noise: "
    "{shot_rate_hz: 20}, steps: 2}\n"
    "      - {name: camera, type: camera, rate_hz: 25, width: 32, height: 24, fov_deg: 70}\n"
    "      - {name: lidar, type: lidar, rate_hz: 30, channels: 8, elevation_min_deg: -20, elevation_max_deg: "
    "20, azimuth_steps: 64}\n"
    "      - {name: antenna, type: antenna}\n"
    "channels:\n  - {name: csi, tx: bs/panel, rx: [eye/antenna], rate_hz: 25, subcarriers: 8, bandwidth_hz: "
    "20e6, max_depth: 1, rays: 2000, search: every_tick}\n";

const KeptRun& reference(uint32_t sequence) {
  static const sim::Experiment experiment =
      sim::make_experiment(sim::parse_scenario(street, "street.yaml", "."));
  static const KeptRun runs[] = {keep_run(experiment, 0), keep_run(experiment, 1)};
  return runs[sequence];
}

LiveOptions options_of(const std::string& yaml, bool paused = true) {
  LiveOptions options;
  options.scenario = [yaml] { return sim::parse_scenario(yaml, "street.yaml", "."); };
  options.device.validation = true;
  options.paused = paused;
  return options;
}

void expect_packet(const Run& run, uint32_t sequence, int64_t tick, bool may_lack) {
  ASSERT_TRUE(wait_for_tick(run, sequence, tick));
  const std::vector<Packet>& packets = reference(sequence).packets;
  const auto packet =
      std::find_if(packets.begin(), packets.end(), [&](const Packet& p) { return p.tick == tick; });
  ASSERT_NE(packet, packets.end());
  const std::shared_ptr<const ShownTick> shown = run.shown();
  expect_shown(*packet, packets, *shown, may_lack);
  EXPECT_GT(shown->simulated_ms, 0.0);
}

TEST(Live, StepsShowThePacketsOfThePlainRun) {
  const auto run = live_run(options_of(street));
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  EXPECT_EQ(run->info()->sensors.size(), reference(0).sensors.size());
  EXPECT_EQ(run->experiment()->scenario.name, "street");
  bool begun = false;
  for (const uint32_t sequence : {0u, 1u})
    for (const Packet& packet : reference(sequence).packets) {
      if (begun) run->step(1);
      begun = true;
      expect_packet(*run, sequence, packet.tick, false);
    }
  EXPECT_NE(reference(0).joined<uint16_t>("eye/dvs", "x"), reference(1).joined<uint16_t>("eye/dvs", "x"));
}

std::set<std::string> rows_of(const ShownTick& tick, const io::DatasetInfo& info) {
  std::set<std::string> rows;
  for (const sim::TimeRow& row : tick.times->rows) {
    EXPECT_GE(row.milliseconds, 0.0) << row.name;
    EXPECT_GE(row.count, 1u) << row.name;
    rows.insert(fmt::format("{}: {}{}",
                            row.sensor == sim::TimeRow::shared ? "all" : info.sensors.at(row.sensor).name,
                            row.name, row.on_device ? ", device" : ""));
  }
  return rows;
}

TEST(Live, EachTickSaysWhereItsTimeWent) {
  const auto run = live_run(options_of(street));
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  const std::shared_ptr<const ShownTick> first = run->shown();
  ASSERT_NE(first->times, nullptr);
  EXPECT_THAT(
      rows_of(*first, *run->info()),
      testing::IsSupersetOf({"all: record", "all: wait", "all: compare", "eye/lidar: record",
                             "eye/lidar: collect", "eye/lidar: eye/lidar, device", "csi: crossings, device",
                             "eye/camera: eye/camera shade, device", "eye/dvs: eye/dvs events, device"}));
  EXPECT_DOUBLE_EQ(first->times->simulated_ms, 20.0) << "to the next one, which is the event camera's";
  EXPECT_GT(first->times->start_ms, 0.0);
  EXPECT_LE(first->times->start_ms, first->simulated_ms);
  EXPECT_GT(first->memory.device_bytes, 100'000u);
  EXPECT_GT(first->memory.kept_bytes, 1000u);
  run->step(1);
  ASSERT_TRUE(wait_for_tick(*run, 0, 2));
  const std::shared_ptr<const ShownTick> second = run->shown();
  ASSERT_NE(second->times, nullptr);
  EXPECT_THAT(rows_of(*second, *run->info()), testing::Not(testing::Contains("eye/camera: record")));
  EXPECT_DOUBLE_EQ(second->times->simulated_ms, 20.0);
  run->step(-1);
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  EXPECT_EQ(run->shown()->times, first->times) << "a tick that is shown again has its times";
}

TEST(Live, JumpsInAnyOrderGiveTheSameBytes) {
  LiveOptions options = options_of(street);
  options.kept_bytes = 0;  // so that each tick is simulated when it is asked for
  const auto run = live_run(std::move(options));
  const std::vector<Packet>& packets = reference(0).packets;
  std::vector<std::pair<uint32_t, int64_t>> order{{0, packets.back().tick}, {0, 0},
                                                  {1, packets[3].tick},     {1, packets[2].tick},
                                                  {0, packets[4].tick},     {0, packets[5].tick},
                                                  {0, packets[1].tick}};
  for (const auto& [sequence, tick] : order) {
    run->jump(sequence, tick);
    expect_packet(*run, sequence, tick, true);
  }
  run->step(2);
  expect_packet(*run, 0, packets[3].tick, true);
  run->step(-1);
  expect_packet(*run, 0, packets[2].tick, true);
}

TEST(Live, PlaysToTheEndAndShowsAllAgain) {
  const auto run = live_run(options_of(street, false));
  run->set_speed(0.0);
  std::set<std::string> activities;
  ASSERT_TRUE(wait_until([&] {
    activities.insert(run->status().activity);
    return !run->status().playing;
  }));
  EXPECT_THAT(activities, testing::Contains("preparing the sensors"));
  EXPECT_THAT(activities, testing::Contains("collecting a tick"));
  expect_packet(*run, 1, reference(1).packets.back().tick, false);
  std::set<double> times;
  for (const uint32_t sequence : {1u, 0u})
    for (const Packet& packet : reference(sequence).packets) {
      run->jump(sequence, packet.tick);
      expect_packet(*run, sequence, packet.tick, false);
      times.insert(run->shown()->simulated_ms);
    }
  // The packets are those of the play, which it kept.
  EXPECT_EQ(times.size(), reference(0).packets.size() + reference(1).packets.size());
}

TEST(Live, PlayedPausedAndPlayedAgain) {
  LiveOptions options = options_of(street);
  options.kept_bytes = 0;
  const auto run = live_run(std::move(options));
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  run->set_speed(0.0);
  const auto play_some = [&](int64_t until) {
    run->play(true);
    ASSERT_TRUE(wait_until([&] { return run->status().tick >= until || !run->status().playing; }));
    run->play(false);
    const RunStatus status = run->status();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    EXPECT_TRUE(shows(*run, status.sequence, status.tick)) << "a pause holds";
    expect_packet(*run, status.sequence, status.tick, false);
  };
  play_some(2);
  play_some(4);
  run->step(-1);
  ASSERT_TRUE(wait_until([&] { return run->status().activity.empty(); }));
  run->step(1);
  play_some(8);
}

TEST(Live, ASensorThatWasNotSeenHasNoNewestRecord) {
  const KeptRun& wanted = reference(0);
  const auto index_of = [&](const std::string& name) {
    return static_cast<size_t>(std::find_if(wanted.sensors.begin(), wanted.sensors.end(),
                                            [&](const SensorSpec& s) { return s.name == name; }) -
                               wanted.sensors.begin());
  };
  const size_t lidar = index_of("eye/lidar"), camera = index_of("eye/camera");
  const auto run = live_run(options_of(street));
  run->jump(0, 8);  // camera at 0, 4, 8; LiDAR at 0, 3, 7, 10
  expect_packet(*run, 0, 8, true);
  EXPECT_EQ(run->shown()->newest[lidar], nullptr);
  ASSERT_NE(run->shown()->newest[camera], nullptr);
  EXPECT_EQ(run->shown()->newest[camera]->tick, 8);
  run->jump(0, 3);
  expect_packet(*run, 0, 3, true);
  EXPECT_EQ(run->shown()->newest[camera], nullptr);
  run->jump(0, 7);  // on the way there, it sees tick 4
  expect_packet(*run, 0, 7, false);
  run->jump(0, 9);
  expect_packet(*run, 0, 10, false);
  EXPECT_EQ(run->shown()->newest[camera]->tick, 8);
}

TEST(Live, ARecordThatIsNotTheNewestIsNotShownInItsPlace) {
  const std::string beams = "elevation_min_deg: -20, elevation_max_deg: 20, channels: 2, azimuth_steps: 8";
  const auto run = live_run(options_of(
      "greatx: 1\nname: two\nticks: 40\ntick_rate_hz: 100\nscene: {generate: {kind: room}}\nnodes:\n"
      "  - name: eye\n    trajectory: {type: static, position_m: [0, 0, 1]}\n    sensors:\n"
      "      - {name: fast, type: lidar, rate_hz: 100, " +
      beams + "}\n      - {name: slow, type: lidar, rate_hz: 20, " + beams + "}\n"));
  const auto slow = [&] { return run->shown()->newest.at(2); };
  ASSERT_TRUE(wait_for_tick(*run, 0, 0));
  run->step(4);
  ASSERT_TRUE(wait_for_tick(*run, 0, 4));
  ASSERT_NE(slow(), nullptr);
  EXPECT_EQ(slow()->tick, 0);
  run->jump(0, 33);  // the slow one is due at 30, which nobody has seen
  ASSERT_TRUE(wait_for_tick(*run, 0, 33));
  EXPECT_EQ(slow(), nullptr);
  run->step(2);
  ASSERT_TRUE(wait_for_tick(*run, 0, 35));
  EXPECT_EQ(slow()->tick, 35);
  run->jump(0, 3);  // kept, as all of it was
  ASSERT_TRUE(wait_for_tick(*run, 0, 3));
  ASSERT_NE(slow(), nullptr);
  EXPECT_EQ(slow()->tick, 0);
  run->jump(0, 34);
  ASSERT_TRUE(wait_for_tick(*run, 0, 34));
  EXPECT_EQ(slow(), nullptr);
}

TEST(Live, AReplayOfItsDataSetHasItsBytes) {
  const sim::Experiment experiment = sim::make_experiment(sim::parse_scenario(street, "street.yaml", "."));
  const test::TemporaryFolder folder;
  {
    const io::DatasetInfo info = sim::dataset_info(experiment, test::device(), reference(0).sensors);
    io::DatasetWriter writer(folder.path() / "set", info);
    for (const uint32_t sequence : {0u, 1u}) {
      writer.begin_sequence(sequence);
      for (const Packet& packet : reference(sequence).packets) writer.write(packet);
      writer.end_sequence();
    }
    writer.finish();
  }
  const auto replay = replay_run(folder.path() / "set");
  bool begun = false;
  for (const uint32_t sequence : {0u, 1u})
    for (const Packet& packet : reference(sequence).packets) {
      if (begun) replay->step(1);
      begun = true;
      ASSERT_TRUE(wait_for_tick(*replay, sequence, packet.tick));
      expect_shown(packet, reference(sequence).packets, *replay->shown());
    }
}

/// A run of a changed scenario takes the world of the run before, if it is the same, and has the bytes of a
/// run that loads everything.
TEST(Live, AChangedScenarioHasTheBytesOfItsPlainRun) {
  const auto first = live_run(options_of(street));
  ASSERT_TRUE(wait_for_tick(*first, 0, 0));
  const auto changed_to = [](const std::string& before, const std::string& after) {
    std::string text = street;
    const size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos) << before;
    return text.replace(at, before.size(), after);
  };
  const std::string sensors = changed_to("max_depth: 1", "max_depth: 2");
  const std::string world = changed_to("variant: large", "variant: small");
  for (const std::string& text : {sensors, world}) {
    LiveOptions options = options_of(text);
    options.before = first->experiment();
    const auto run = live_run(std::move(options));
    run->jump(0, 8);
    ASSERT_TRUE(wait_for_tick(*run, 0, 8));
    EXPECT_EQ(run->experiment()->world == first->experiment()->world, text == sensors);
    const KeptRun plain = keep_run(sim::make_experiment(sim::parse_scenario(text, "street.yaml", ".")), 0);
    const auto packet = std::ranges::find(plain.packets, 8, &Packet::tick);
    ASSERT_NE(packet, plain.packets.end());
    expect_shown(*packet, plain.packets, *run->shown(), true);
  }
}

TEST(Live, AChangedScenarioIsCheckedAgainstItsWorld) {
  const auto first = live_run(options_of(street));
  ASSERT_TRUE(wait_for_tick(*first, 0, 0));
  std::string text = street;
  const std::string before = "max_depth: 1";
  text.replace(text.find(before), before.size(), "max_depth: 1, carrier_hz: 9e12");
  LiveOptions options = options_of(text);
  options.before = first->experiment();
  const auto run = live_run(std::move(options));
  while (run->status().phase == RunStatus::Phase::loading) std::this_thread::yield();
  EXPECT_EQ(run->status().phase, RunStatus::Phase::failed);
  EXPECT_THAT(run->status().error, HasSubstr("channels[0].carrier_hz"));
}

TEST(Live, FailuresOfLoadingAreTold) {
  const auto failure = [](LiveOptions options) {
    const auto run = live_run(std::move(options));
    EXPECT_TRUE(wait_for_error(*run));
    EXPECT_EQ(run->status().phase, RunStatus::Phase::failed);
    EXPECT_EQ(run->shown(), nullptr);
    return run->status().error;
  };
  std::string yaml = street;
  EXPECT_THAT(failure(options_of(yaml.replace(yaml.find("ticks: 12"), 9, "ticks: no"))),
              HasSubstr("street.yaml:4: ticks: expected"));
  yaml = street;
  EXPECT_THAT(failure(options_of(yaml.replace(yaml.find("seed: 5"), 7, "effects: {shadow: on}"))),
              HasSubstr("'shadow' is no effect"));
  LiveOptions options = options_of(street);
  options.device.select = "no such device";
  EXPECT_THAT(failure(options), HasSubstr("no such device"));
}

/// A radar that is 1 cm before a wall at tick 3.
const std::string wall =
    "greatx: 1\nname: wall\nseed: 5\nticks: 6\ntick_rate_hz: 10\nscene: {generate: {kind: room}}\nnodes:\n"
    "  - name: car\n    trajectory: {type: waypoints, interpolation: linear, points: [{t_s: 0, position_m: "
    "[0, "
    "0, 1.5], rotation_deg: [180, 0, 0]}, {t_s: 0.3, position_m: [-5.99, 0, 1.5], rotation_deg: [180, 0, "
    "0]}, "
    "{t_s: 0.6, position_m: [0, 0, 1.5], rotation_deg: [180, 0, 0]}]}\n    sensors:\n"
    "      - {name: radar, type: radar, rate_hz: 10, waveform: {chirps: 16, samples: 64}, echoes: {tubes: "
    "500}}\n";

TEST(Live, AfterATickThatFailsTheOthersAreThere) {
  const sim::Experiment experiment = sim::make_experiment(sim::parse_scenario(wall, "wall.yaml", "."));
  const KeptRun later = keep_run(experiment, 0, 4);
  const auto run = live_run(options_of(wall, false));
  run->set_speed(0.0);
  ASSERT_TRUE(wait_for_error(*run));
  EXPECT_THAT(run->status().error, HasSubstr("expected nothing within"));
  EXPECT_THAT(run->status().error, HasSubstr("(sequence 0, tick 3)"));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  EXPECT_FALSE(run->status().playing);
  EXPECT_TRUE(shows(*run, 0, 2)) << "the tick before, which was in flight";
  run->play(true);
  ASSERT_TRUE(wait_until([&] { return run->status().tick == 5; }));
  EXPECT_EQ(run->status().error, "");
  expect_shown(later.packets[1], later.packets, *run->shown());
  run->jump(0, 3);
  ASSERT_TRUE(wait_for_error(*run));
  run->step(1);
  ASSERT_TRUE(wait_until([&] { return shows(*run, 0, 4) && run->status().error.empty(); }));
  expect_shown(later.packets[0], later.packets, *run->shown());
}

TEST(Live, WithoutASensorNothingIsShown) {
  const auto run =
      live_run(options_of("greatx: 1\nname: empty\nticks: 3\ntick_rate_hz: 10\nnodes:\n  - name: a\n    "
                          "trajectory: {type: static, "
                          "position_m: [0, 0, 0]}\n",
                          false));
  ASSERT_TRUE(wait_for_pause(*run));
  EXPECT_EQ(run->status().phase, RunStatus::Phase::ready);
  EXPECT_EQ(run->shown(), nullptr);
  EXPECT_EQ(run->status().error, "");
}

TEST(Live, EndsWhileItLoadsAndWhileATickRuns) {
  live_run(options_of(street));  // at once
  const auto loading = live_run(options_of(street));
  ASSERT_TRUE(wait_until([&] { return loading->experiment() != nullptr; }));
  const auto playing = live_run(options_of(street, false));
  playing->set_speed(0.0);
  ASSERT_TRUE(wait_until([&] { return playing->status().tick >= 0; }));
}

TEST(Live, CommandsFromManyThreads) {
  reference(0);  // made on this thread
  const auto run = live_run(options_of(street, false));
  run->set_speed(0.0);
  ASSERT_TRUE(wait_until([&] { return run->shown() != nullptr; }));
  std::vector<std::thread> threads;
  for (uint32_t t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      RandomStream draws(3, t, 0);
      for (int i = 0; i < 40; ++i) {
        switch (draws.below(4)) {
          case 0:
            run->step(static_cast<int>(draws.below(5)) - 2);
            break;
          case 1:
            run->jump(draws.below(2), draws.below(12));
            break;
          case 2:
            run->play(draws.below(2) == 0);
            break;
          default: {
            const std::shared_ptr<const ShownTick> shown = run->shown();
            const std::vector<Packet>& packets = reference(shown->sequence).packets;
            const auto packet = std::find_if(packets.begin(), packets.end(),
                                             [&](const Packet& p) { return p.tick == shown->packet.tick; });
            ASSERT_NE(packet, packets.end());
            expect_shown(*packet, packets, *shown, true);
          }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    });
  for (std::thread& thread : threads) thread.join();
  run->play(false);
  run->jump(1, 6);
  expect_packet(*run, 1, 6, true);
}

}  // namespace
}  // namespace greatx::view
