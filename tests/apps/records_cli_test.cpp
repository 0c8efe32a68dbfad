// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What runs leave behind: records of how data came to be, progress in logs, the cache of searches.
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Returns what stands before a command of greatx() to send it a signal after some seconds.
std::string interrupt_after(const std::string& seconds, const std::string& signal) {
  return fmt::format("(sleep {}; kill -{} \\$\\$) &", seconds, signal);
}

class RecordsCli : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "s.yaml") << R"(greatx: 1
name: kept
ticks: 1000000
tick_rate_hz: 1000
scene: {file: hall.glb}
nodes:
  - {name: a, trajectory: {type: static, position_m: [1, 1, 1]}, sensors: [{name: x, type: antenna}]}
  - {name: b, trajectory: {type: static, position_m: [-1, 1, 1]}, sensors: [{name: x, type: antenna}]}
channels:
  - {name: csi, tx: a/x, rx: [b/x], rate_hz: 1000, bandwidth_hz: 20e6, subcarriers: 16, max_depth: 1}
)";
    ASSERT_EQ(greatx("scene room -o '" + in("hall.glb") + "'").code, 0);
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  json records(const std::string& data) const {
    return json::parse(read_file(folder_ / data / "run.json"))["runs"];
  }
  greatx::test::TemporaryFolder temporary_;
  std::filesystem::path folder_ = temporary_.path();
};

TEST_F(RecordsCli, ARunSaysHowItCameToBe) {
  const Outcome run = greatx(fmt::format("generate '{}' -o '{}' --ticks 3 -q", in("s.yaml"), in("o")));
  ASSERT_EQ(run.code, 0) << run.err;
  const json runs = records("o");
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_THAT(runs[0]["command_line"].get<std::vector<std::string>>(), Contains("--ticks"));
  for (const char* name :
       {"host", "system", "greatx", "commit", "begin", "end", "device", "driver", "folder"})
    EXPECT_THAT(runs[0][name].get<std::string>(), Not(IsEmpty())) << name;
  EXPECT_EQ(runs[0]["complete"], true);
  EXPECT_EQ(runs[0]["ticks"], 3);
  const std::string dataset = read_file(folder_ / "o/dataset.json");
  EXPECT_EQ(json::parse(dataset)["run"]["commit"], runs[0]["commit"]);
  EXPECT_THAT(dataset, Not(HasSubstr(runs[0]["begin"].get<std::string>())));
  EXPECT_EQ(greatx(fmt::format("verify '{}'", in("o"))).code, 0);
}

TEST_F(RecordsCli, ADataSetRunsAgainAsItIs) {
  ASSERT_EQ(greatx(fmt::format("generate '{}' -o '{}' --ticks 3 -q", in("s.yaml"), in("deep/o"))).code, 0);
  const Outcome again =
      greatx(fmt::format("generate '{}' -o '{}' -q", in("deep/o/scenario.yaml"), in("again")));
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read_file(folder_ / "deep/o/manifest.json"), read_file(folder_ / "again/manifest.json"));
}

TEST_F(RecordsCli, AnInterruptedRunAnswersInJsonAndEndsWith130) {
  const Outcome run =
      greatx(fmt::format("generate '{}' -o '{}' --json", in("s.yaml"), in("o")), interrupt_after("2", "INT"));
  EXPECT_EQ(run.code, 130) << run.err;
  const json summary = json::parse(run.out);
  EXPECT_EQ(summary["finished"], false);
  EXPECT_EQ(records("o")[0]["complete"], false);
  EXPECT_TRUE(records("o")[0].contains("end"));
  const Outcome rest = greatx(fmt::format("generate '{}' -o '{}' --resume -q", in("s.yaml"), in("o")),
                              interrupt_after("2", "TERM"));
  EXPECT_EQ(rest.code, 130) << rest.err;
  const json runs = records("o");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_GE(runs[1]["begins_at"]["tick"], summary["packets"]);
}

TEST_F(RecordsCli, ADamagedRecordIsReplacedWithAWarning) {
  std::filesystem::create_directories(folder_ / "o");
  ASSERT_EQ(
      greatx(fmt::format("generate '{}' -o '{}' -q", in("s.yaml"), in("o")), interrupt_after("2", "INT"))
          .code,
      130);
  std::ofstream(folder_ / "o/run.json") << "{\"runs\": [";
  const Outcome run = greatx(fmt::format("generate '{}' -o '{}' --resume -q", in("s.yaml"), in("o")),
                             interrupt_after("2", "INT"));
  EXPECT_EQ(run.code, 130);
  EXPECT_THAT(run.err, HasSubstr("the records in it are lost"));
  EXPECT_EQ(records("o").size(), 1u);
}

TEST_F(RecordsCli, ProgressGoesToLogsWithoutATerminal) {
  const std::string command = fmt::format("generate '{}' -o '{}' --ticks 5000", in("s.yaml"), in("o"));
  EXPECT_THAT(greatx(command, "GREATX_PROGRESS_S=0.01").err, HasSubstr("info: kept: "));
  EXPECT_THAT(greatx(command + " --resume -q", "GREATX_PROGRESS_S=0.01").err, Not(HasSubstr("info: kept: ")));
  const Outcome wrong = greatx(fmt::format("generate '{}' -o '{}' --ticks 5", in("s.yaml"), in("p")),
                               "GREATX_PROGRESS_S=often");
  EXPECT_EQ(wrong.code, 1);
  EXPECT_THAT(wrong.err, HasSubstr("GREATX_PROGRESS_S: expected a number of seconds above 0, found 'often'"));
}

TEST_F(RecordsCli, TheCacheIsCountedAndCleared) {
  const std::string folder = "GREATX_CACHE='" + in("cache") + "'";
  ASSERT_EQ(greatx("paths room", folder).code, 0);
  const json full = json::parse(greatx("cache --json", folder).out);
  EXPECT_EQ(full["folder"], in("cache"));
  EXPECT_EQ(full["results"], 1);
  EXPECT_GT(full["bytes"], 0);
  std::ofstream(folder_ / "cache/mine.txt") << "not of the cache";
  const json cleared = json::parse(greatx("cache --clear --json", folder).out);
  EXPECT_EQ(cleared["removed"]["results"], 1);
  EXPECT_EQ(cleared["results"], 0);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cache/mine.txt"));
  EXPECT_THAT(greatx("cache", "GREATX_CACHE=off").out, HasSubstr("there is no cache"));
}

TEST_F(RecordsCli, AnInterruptedCampaignAnswersInJson) {
  std::ofstream(folder_ / "c.yaml")
      << "greatx_campaign: 1\nname: c\nbase: s.yaml\nsequences: 16\naxes:\n  n:\n    "
         "one: {}\n";
  for (const char* jobs : {"1", "2"}) {
    const std::string out = in(std::string("out") + jobs);
    const Outcome run =
        greatx(fmt::format("campaign run '{}' -o '{}' --jobs {} --json", in("c.yaml"), out, jobs),
               interrupt_after("2", "INT"));
    EXPECT_EQ(run.code, 130) << run.err;
    const json answer = json::parse(run.out);
    EXPECT_EQ(answer["complete"], false);
    EXPECT_EQ(answer["done"], 0);
    size_t kept = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out + "/runs")) {
      const json record = json::parse(read_file(entry.path()));
      EXPECT_EQ(record["complete"], false);
      EXPECT_TRUE(record.contains("end"));
      ++kept;
    }
    EXPECT_EQ(kept, std::stoul(jobs));
  }
}

}  // namespace
}  // namespace greatx::apps::test
