// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Makes small campaigns with the program: in shards, killed and resumed, merged, grown. The data sets must
// have the bytes of single runs.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/campaign_base.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CampaignCli : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "base.yaml") << campaign_base(6, "rgb, depth");
    write(3, "\n      channels[csi].carrier_hz: 28e9");
  }
  void write(int sequences, const std::string& high) const {
    std::ofstream(folder_ / "c.yaml") << fmt::format(
        "greatx_campaign: 1\nname: c\nbase: base.yaml\nsequences: {}\naxes:\n  carrier:\n    low: {{}}\n    "
        "high: "
        "{}\n",
        sequences, high);
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  Outcome campaign(const std::string& command, const std::string& output,
                   const std::string& rest = "") const {
    return greatx(fmt::format("campaign {} '{}' -o '{}' {}", command, in("c.yaml"), in(output), rest));
  }
  /// All files below a folder with their contents.
  static std::map<std::string, std::string> files_of(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file())
        files[entry.path().lexically_relative(folder).string()] = read_file(entry.path());
    return files;
  }
  /// Compares each data set with that of `greatx generate` on its own scenario.
  void expect_single_runs(const std::string& output, bool resumed = false) const {
    for (const std::string cell : {"low", "high"}) {
      const fs::path data = folder_ / output / "data" / cell;
      const std::string single = in(output + "_" + cell);
      const Outcome run =
          greatx(fmt::format("generate '{}' -o '{}' -q", (data / "scenario.yaml").string(), single));
      ASSERT_EQ(run.code, 0) << run.err;
      auto merged = files_of(data), alone = files_of(single);
      // As after `generate --resume`, what compares the sensors begins where the run went on.
      if (resumed) merged.erase("consistency.csv"), alone.erase("consistency.csv");
      alone.erase("run.json");  // names machine and time
      std::vector<std::string> differ;
      for (const auto& [name, bytes] : alone)
        if (!merged.contains(name) || merged[name] != bytes) differ.push_back(name);
      EXPECT_THAT(differ, ::testing::IsEmpty()) << cell;
      EXPECT_EQ(merged.size(), alone.size()) << cell;
    }
  }

  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(CampaignCli, ShardsInAnyOrderGiveTheBytesOfSingleRuns) {
  for (const int shard : {3, 1, 4, 2}) {
    const Outcome run = campaign("run", "out", fmt::format("--shard {}/4 -q", shard));
    ASSERT_EQ(run.code, 0) << run.err;
  }
  const Outcome merged = campaign("merge", "out");
  ASSERT_EQ(merged.code, 0) << merged.err;
  EXPECT_THAT(merged.out, HasSubstr("2 of 2 cells merged"));
  EXPECT_THAT(campaign("verify", "out").out, HasSubstr("2 cells are complete and sound"));
  expect_single_runs("out");
  EXPECT_THAT(read_file(folder_ / "out/splits.csv"), HasSubstr("high,2,"));
  // Again there is nothing to do.
  EXPECT_THAT(campaign("run", "out").out, HasSubstr("0 sequences made"));
  EXPECT_THAT(campaign("merge", "out").out, HasSubstr("0 of 2 cells merged"));
}

TEST_F(CampaignCli, ACampaignGrowsAndKeepsWhatItHas) {
  ASSERT_EQ(campaign("run", "out", "-q").code, 0);
  ASSERT_EQ(campaign("merge", "out", "-q").code, 0);
  const auto before = files_of(folder_ / "out/data/low/sequence_0001");
  write(5, "\n      channels[csi].carrier_hz: 28e9");
  EXPECT_THAT(campaign("status", "out").out, HasSubstr("6 of 10 sequences are complete"));
  const Outcome more = campaign("run", "out");
  ASSERT_EQ(more.code, 0) << more.err;
  EXPECT_THAT(more.out, HasSubstr("4 sequences made"));
  const Outcome merged = campaign("merge", "out");
  ASSERT_EQ(merged.code, 0) << merged.err;
  EXPECT_EQ(files_of(folder_ / "out/data/low/sequence_0001"), before);
  expect_single_runs("out");
}

TEST_F(CampaignCli, ItMayBeKilledAtAnyMoment) {
  // Each run is killed a little later than the one before, until one ends.
  int kills = 0;
  for (useconds_t patience = 300'000;; patience += 150'000) {
    const pid_t child = fork();
    if (child == 0) {
      setenv("GREATX_CACHE", "off", 1);
      if (freopen("/dev/null", "w", stdout) == nullptr) _exit(126);
      execl(GREATX_PROGRAM, "greatx", "campaign", "run", in("c.yaml").c_str(), "-o", in("out").c_str(), "-q",
            static_cast<char*>(nullptr));
      _exit(127);
    }
    usleep(patience);
    int status = 0;
    const bool ended = waitpid(child, &status, WNOHANG) == child;
    if (ended) {
      ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
      break;
    }
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    ++kills;
  }
  EXPECT_GT(kills, 0);
  const Outcome merged = campaign("merge", "out");
  ASSERT_EQ(merged.code, 0) << merged.err;
  expect_single_runs("out", true);
}

TEST_F(CampaignCli, CompressedPartsGiveTheBytesOfSingleRuns) {
  std::ofstream(folder_ / "c.yaml", std::ios::app)
      << "set:\n  storage: {compression: small}\n  nodes[uav].sensors[cam].outputs: [rgb, flow]\n";
  for (const int shard : {2, 1}) {
    const Outcome run = campaign("run", "out", fmt::format("--shard {}/2 -q", shard));
    ASSERT_EQ(run.code, 0) << run.err;
  }
  const Outcome merged = campaign("merge", "out");
  ASSERT_EQ(merged.code, 0) << merged.err;
  EXPECT_THAT(campaign("verify", "out").out, HasSubstr("2 cells are complete and sound"));
  EXPECT_TRUE(fs::exists(folder_ / "out/data/low/sequence_0001/uav/cam/records.h5"));
  expect_single_runs("out");
}

TEST_F(CampaignCli, JobsShareAShard) {
  const Outcome run = campaign("run", "out", "--jobs 3");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("6 sequences made"));
  ASSERT_EQ(campaign("merge", "out", "-q").code, 0);
  expect_single_runs("out");
  EXPECT_EQ(campaign("run", "bad", "--jobs 2 --device nowhere").code, 1);
}

TEST_F(CampaignCli, FoldersOfShardsAreGathered) {
  ASSERT_EQ(campaign("run", "one", "--shard 1/2 -q").code, 0);
  ASSERT_EQ(campaign("run", "two", "--shard 2/2 -q").code, 0);
  EXPECT_THAT(campaign("merge", "one").err, HasSubstr("expected sequence"));
  const Outcome merged = campaign("merge", "one", fmt::format("--from '{}'", in("two")));
  ASSERT_EQ(merged.code, 0) << merged.err;
  expect_single_runs("one");
}

TEST_F(CampaignCli, FaultsAreSaidBeforeAnythingRuns) {
  ASSERT_EQ(campaign("run", "out", "--shard 1/6 -q").code, 0);
  ASSERT_EQ(campaign("run", "again", "--shard 1/6 -q").code, 0);
  const Outcome overlap = campaign("merge", "out", fmt::format("--from '{}'", in("again")));
  EXPECT_EQ(overlap.code, 1);
  EXPECT_THAT(overlap.err, HasSubstr("shards overlapped"));
  for (const std::string shard : {"0/4", "5/4", "x", "1/0", "1"})
    EXPECT_THAT(campaign("run", "out", "--shard " + shard).err, HasSubstr("--shard: expected I/N")) << shard;
  EXPECT_THAT(campaign("run", "out", "--cell middle").err, HasSubstr("expected one of the cells"));
  write(3, "\n      channels[csi].carrier_hz: 60e9");
  const Outcome changed = campaign("run", "out");
  EXPECT_EQ(changed.code, 1);
  EXPECT_THAT(changed.err, HasSubstr("cell 'high' was begun with another scenario"));
  EXPECT_THAT(greatx("campaign plan missing.yaml").err, HasSubstr("missing.yaml"));
}

TEST_F(CampaignCli, APlanMeasuresAndKeepsToTheBudget) {
  const Outcome plan = campaign("plan", "out", "--measure 2 --json");
  ASSERT_EQ(plan.code, 0) << plan.err;
  const nlohmann::json json = nlohmann::json::parse(plan.out);
  EXPECT_EQ(json["sequences"], 6);
  EXPECT_EQ(json["ticks"], 36);
  ASSERT_EQ(json["cells"].size(), 2u);
  EXPECT_GT(json["cells"][0]["tick_bytes"], 1000.0);
  EXPECT_GT(json["cells"][0]["tick_s"], 0.0);
  EXPECT_FALSE(fs::exists(folder_ / "out"));  // a plan writes nothing
  std::ofstream(folder_ / "c.yaml", std::ios::app) << "budget: {gigabytes: 1.0e-6}\n";
  const Outcome dear = campaign("plan", "out", "--measure 2");
  EXPECT_EQ(dear.code, 1);
  EXPECT_THAT(dear.err, HasSubstr("budget.gigabytes"));
}

TEST_F(CampaignCli, StatsComeFromTheIndex) {
  std::ofstream(folder_ / "c.yaml", std::ios::app)
      << "card: {description: Two carriers., license: CC-BY-4.0, creators: [A. Person]}\n"
         "split: {train: 0.5, test: 0.5}\n"
         "set:\n  nodes[uav].sensors[cam].outputs: [rgb, depth, ids, boxes]\n"
         "  nodes[uav].sensors[cam].box_classes: [building]\n";
  EXPECT_THAT(campaign("stats", "out").err, HasSubstr("merge` writes it"));
  ASSERT_EQ(campaign("run", "out", "-q").code, 0);
  ASSERT_EQ(campaign("merge", "out", "-q").code, 0);
  const Outcome stats = campaign("stats", "out", "--json");
  ASSERT_EQ(stats.code, 0) << stats.err;
  const nlohmann::json json = nlohmann::json::parse(stats.out);
  // Sequences 0 to 2 are in train, test, train: multiples of the golden section.
  EXPECT_EQ(json["sequences"]["train"], 4);
  EXPECT_EQ(json["sequences"]["test"], 2);
  EXPECT_EQ(json["records"]["train"]["camera"], 24);
  EXPECT_EQ(json["poses_in_two_splits"], 0);
  const nlohmann::json& gain = json["quantities"]["path_gain_db"]["train"];
  EXPECT_EQ(gain["count"], 24);
  EXPECT_LE(gain["p5"], gain["median"]);
  EXPECT_LT(gain["most"], -50.0);
  // Two sensors of one node, five steps of each of four sequences.
  EXPECT_EQ(json["quantities"]["speed_mps"]["train"]["count"], 40);
  const nlohmann::json& classes = json["classes"]["camera"];
  for (const char* split : {"train", "test"}) {
    double sum = 0.0;
    for (const auto& [name, share] : classes[split].items()) sum += share.get<double>();
    EXPECT_NEAR(sum, 1.0, 1e-12) << split;
    EXPECT_GT(classes[split]["building"], 0.05);
  }
  EXPECT_EQ(json["sampled"]["camera"], 36);
  EXPECT_LE(json["quantities"]["visibility"]["train"]["most"], 1.0);
  EXPECT_LT(json["quantities"]["visibility"]["train"]["p5"], 1.0);
  EXPECT_EQ(nlohmann::json::parse(campaign("stats", "out", "--json --sample 10").out)["sampled"]["camera"],
            10);
  EXPECT_EQ(read_file(folder_ / "out/stats.png").substr(1, 3), "PNG");
  EXPECT_THAT(read_file(folder_ / "out/card.md"),
              AllOf(HasSubstr("CC-BY-4.0"), HasSubstr("carrier (low, high)")));
  const nlohmann::json croissant = nlohmann::json::parse(read_file(folder_ / "out/croissant.json"));
  EXPECT_EQ(croissant["distribution"][0]["@id"], "index.csv");
  EXPECT_GT(croissant["recordSet"][0]["field"].size(), 20u);
}

TEST_F(CampaignCli, EmbeddedCampaignsHaveWhatTheirTableSays) {
  const Outcome mini = greatx("campaign plan great_mcd_mini --measure 0");
  EXPECT_THAT(mini.out, HasSubstr("24 cells, 96 sequences, 960 ticks"));
  const Outcome street = greatx("campaign plan street --measure 0");
  EXPECT_THAT(street.out, HasSubstr("2 cells, 192 sequences, 7680 ticks"));
  const Outcome whole = greatx("campaign plan great_mcd --measure 0");
  EXPECT_THAT(whole.out, HasSubstr("24 cells, 3600 sequences, 960000 ticks"));
  const Outcome learn = greatx("campaign plan great_mcd_learn --measure 0");
  EXPECT_THAT(learn.out, HasSubstr("2 cells, 120 sequences, 3600 ticks"));
}

TEST_F(CampaignCli, TheIndexHasEveryRecord) {
  ASSERT_EQ(campaign("run", "out", "-q").code, 0);
  const Outcome merged = campaign("merge", "out");
  // 2 cells, 3 sequences, 6 ticks, 3 sensors: poses, camera, channel.
  EXPECT_THAT(merged.out, HasSubstr("108 records"));
  const std::string csv = read_file(folder_ / "out/index.csv");
  EXPECT_EQ(std::ranges::count(csv, '\n'), 109);
  EXPECT_THAT(csv, HasSubstr("sequence_0002/uav/cam/rgb/000005.png"));
  EXPECT_EQ(read_file(folder_ / "out/index.sqlite").substr(0, 15), "SQLite format 3");
  // Every record has the link of its tick: here each line ends with line_of_sight 1, its figures, the axis.
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_THAT(line,
              ::testing::EndsWith(
                  "rx,tx,path_count,line_of_sight,path_gain_db,delay_spread_s,k_factor_db,axis_carrier"));
  while (std::getline(lines, line))
    EXPECT_THAT(line, ::testing::ContainsRegex(",0,0,[1-9],1,-[0-9.]*,[0-9.e-]*,[0-9.e-]*,(low|high)$"));
}

}  // namespace
}  // namespace greatx::apps::test
