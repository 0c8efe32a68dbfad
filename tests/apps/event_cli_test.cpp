// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests event cameras from the command line: threads, a run that is cut short, and the check of the files.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace greatx::apps::test {
namespace {

class EventCli : public testing::Test {
 protected:
  EventCli() {
    std::ofstream(path("events.yaml")) << R"(
greatx: 1
name: events
ticks: 100
tick_rate_hz: 1000
scene: {generate: {kind: canyon, seed: 3, size_m: 60}, optical_only: true}
environment: {clouds: 0}
nodes:
  - name: van
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -6, 0]}, )"
                                          R"({t_s: 0.2, position_m: [2, -4, 0]}]}
    model: {generate: {kind: car, variant: van}}
  - name: eye
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [2, -16, 1.6], rotation_deg: [90, 0, 0]},
                                           {t_s: 0.1, position_m: [2, -16, 1.6], rotation_deg: [95, 0, 0]}]}
    sensors:
      - {name: dvs, type: event_camera, rate_hz: 30, width: 62, height: 46, fov_deg: 70,
         threshold: {on: 0.15, off: 0.2, sigma: 0.03}, )"
                                          R"(noise: {leak_rate_hz: 2, shot_rate_hz: 10}, cutoff_hz: 300,
         refractory_s: 0.0005, steps: {by: brightness, max_change: 1, most: 8},
         outputs: [events, instance, differences, hdf5, text]}
)";
  }
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  std::string manifest(const std::string& name) const { return read_file(path(name) + "/manifest.json"); }
  Outcome generate(const std::string& name, const std::string& arguments, const std::string& before = "") {
    return greatx(fmt::format("generate {} -o {} -q {}", path("events.yaml"), path(name), arguments), before);
  }
  greatx::test::TemporaryFolder folder_;
};

TEST_F(EventCli, HardCaseN63AnyNumberOfThreadsGivesTheSameBytes) {
  ASSERT_EQ(generate("one", "--threads 1", "LP_NUM_THREADS=1").code, 0);
  ASSERT_EQ(generate("two", "--threads 2", "LP_NUM_THREADS=2").code, 0);
  ASSERT_EQ(generate("many", "--threads 16", "LP_NUM_THREADS=16").code, 0);
  EXPECT_FALSE(manifest("one").empty());
  EXPECT_EQ(manifest("one"), manifest("two"));
  EXPECT_EQ(manifest("one"), manifest("many"));
  EXPECT_THAT(manifest("one"), testing::HasSubstr("eye/dvs/events.h5"));
  EXPECT_THAT(manifest("one"), testing::HasSubstr("eye/dvs/events_text.txt"));
  EXPECT_EQ(greatx("verify " + path("one")).code, 0);
}

TEST_F(EventCli, AKilledRunIsFinishedToTheSameBytes) {
  const std::string longer = "--ticks 1500";
  ASSERT_EQ(generate("whole", longer).code, 0);
  // The run is killed when the fifth of 45 difference images exists.
  const std::string command = fmt::format(
      "'{}' generate {} -o {} -q {} & run=$!; n=0; while [ ! -e "
      "{}/sequence_0000/eye/dvs/differences/000004.png ] && "
      "[ $n -lt 6000 ]; do sleep 0.005; n=$((n+1)); done; kill -9 $run; wait $run 2>/dev/null; true",
      GREATX_PROGRAM, path("events.yaml"), path("cut"), longer, path("cut"));
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_THAT(greatx("verify " + path("cut")).out, testing::HasSubstr("unfinished"));
  const Outcome resumed = generate("cut", longer + " --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_EQ(manifest("cut"), manifest("whole"));
}

TEST_F(EventCli, LostEventsAreWarnedOfHoweverQuiet) {
  std::string text = read_file(path("events.yaml"));
  const std::string cutoff = "cutoff_hz: 300";
  text.replace(text.find(cutoff), cutoff.size(), "max_events_per_pixel: 1");
  const std::string threshold = "on: 0.15, off: 0.2";
  text.replace(text.find(threshold), threshold.size(), "on: 0.02, off: 0.02");
  std::ofstream(path("events.yaml")) << text;
  const Outcome quiet = generate("lossy", "");
  ASSERT_EQ(quiet.code, 0) << quiet.err;
  EXPECT_TRUE(quiet.out.empty());
  EXPECT_THAT(quiet.err, testing::HasSubstr("warning: eye/dvs: "));
  EXPECT_THAT(quiet.err, testing::HasSubstr(" events were left out"));
  const Outcome json = generate("lossy_json", "--json");
  ASSERT_EQ(json.code, 0) << json.err;
  EXPECT_EQ(json.err, quiet.err);
  const auto summary = nlohmann::json::parse(json.out);
  ASSERT_EQ(summary["warnings"].size(), 1u);
  const std::string warning = summary["warnings"][0];
  EXPECT_THAT(json.err, testing::HasSubstr(warning));
  EXPECT_THAT(warning, testing::HasSubstr(fmt::format(
                           "{} events", summary["counters"]["eye/dvs.event_overflow"].get<uint64_t>())));
}

TEST_F(EventCli, NothingIsWarnedOfWhereNothingIsLost) {
  const Outcome json = generate("data", "--json");
  ASSERT_EQ(json.code, 0);
  EXPECT_EQ(json.err, "");
  EXPECT_TRUE(nlohmann::json::parse(json.out)["warnings"].empty());
}

TEST_F(EventCli, AChangedExportIsFound) {
  ASSERT_EQ(generate("data", "").code, 0);
  std::ofstream(path("data") + "/sequence_0000/eye/dvs/events.h5", std::ios::app) << "x";
  const Outcome verified = greatx("verify " + path("data"));
  EXPECT_NE(verified.code, 0);
  EXPECT_THAT(verified.out + verified.err, testing::HasSubstr("events.h5"));
}

}  // namespace
}  // namespace greatx::apps::test
