// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Writes Slurm scripts with the program and runs them by bash. Executables named sbatch and scontrol record
// how they are called; one named greatx ends as the test wants it. tests/slurm runs scripts on a real Slurm.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/campaign_base.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* slurm_campaign = R"(greatx_campaign: 1
name: streets
base: base.yaml
sequences: 3
axes:
  carrier:
    low: {}
    high:
      channels[csi].carrier_hz: 4.5e9
)";

/// Records its arguments, one a line, and its input. $FAKE is the folder of the records.
constexpr const char* fake_sbatch = R"bash(#!/bin/bash
count=$(ls "$FAKE" | grep -c '^sbatch_') || true
printf '%s\n' "$@" >"$FAKE/sbatch_$count"
[ "$count" = 0 ] || cat >"$FAKE/input"
echo "$((40 + count))"
)bash";
constexpr const char* fake_scontrol = R"bash(#!/bin/bash
printf '%s\n' "$@" >>"$FAKE/scontrol"
)bash";
/// Records its arguments, waits for SIGTERM if there is a file `waits`, and ends with the code in `code`.
constexpr const char* fake_greatx = R"bash(#!/bin/bash
printf '%s\n' "$@" -- >>"$FAKE/greatx"
if [ -e "$FAKE/waits" ]; then
  trap 'exit 130' TERM
  touch "$FAKE/ready"
  while true; do sleep 0.05; done
fi
code=$(cat "$FAKE/code")
[ "$code" -lt 128 ] || kill -KILL $$
exit "$code"
)bash";

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

class SlurmCli : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_ / "bin");
    fs::create_directories(folder_ / "fake");
    write("base.yaml", campaign_base(400, "rgb"));
    write("c.yaml", slurm_campaign);
    for (const auto& [name, text] : {std::pair{"bin/sbatch", fake_sbatch},
                                     {"bin/scontrol", fake_scontrol},
                                     {"bin/greatx", fake_greatx}}) {
      write(name, text);
      fs::permissions(folder_ / name, fs::perms::owner_all);
    }
    write("fake/code", "0");
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string in(const std::string& name) const { return (folder_ / name).string(); }
  std::string fake(const std::string& name) const { return read_file(folder_ / "fake" / name); }

  /// Writes OUTPUT/job.sh.
  Outcome slurm(const std::string& options, const std::string& output = "out") const {
    return greatx(fmt::format("campaign slurm '{}' -o '{}' {}", in("c.yaml"), in(output), options));
  }
  /// Starts a script by bash; `environment` precedes it.
  pid_t start(const std::string& script, const std::vector<std::string>& environment = {},
              const std::string& argument = "") const {
    const pid_t child = fork();
    if (child != 0) return child;
    setenv("PATH", fmt::format("{}:{}", in("bin"), getenv("PATH")).c_str(), 1);
    setenv("FAKE", in("fake").c_str(), 1);
    for (std::string variable : environment) putenv(strdup(variable.c_str()));
    if (freopen(in("said").c_str(), "w", stdout) == nullptr || dup2(STDOUT_FILENO, STDERR_FILENO) < 0)
      _exit(126);
    if (argument.empty())
      execlp("bash", "bash", in(script).c_str(), nullptr);
    else
      execlp("bash", "bash", in(script).c_str(), argument.c_str(), nullptr);
    _exit(127);
  }
  static int code_of(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Starts task 2 as Slurm does.
  pid_t start_task(int restarts = 0) const {
    return start("out/job.sh", {"SLURM_ARRAY_JOB_ID=7", "SLURM_ARRAY_TASK_ID=2",
                                fmt::format("SLURM_RESTART_COUNT={}", restarts)});
  }
  std::string said() const { return read_file(folder_ / "said"); }

  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(SlurmCli, TheHeaderHoldsWhatTheUserSays) {
  const Outcome written = slurm(
      "--tasks 3 --at-once 2 --time 1-02:30 --merge-time 45 --partition gpu --account lab --cpus 8 --jobs 2 "
      "--memory 16G --gpus a100:1 --device lavapipe --tracer tree --cell low --sbatch=--qos=long --restarts "
      "3 "
      "--sbatch='--comment=a b' --setup 'module load vulkan'");
  ASSERT_EQ(written.code, 0) << written.err;
  EXPECT_THAT(written.out,
              AllOf(HasSubstr("3 tasks for 3 sequences, 1-02:30:00 each; the merge has 0-00:45:00"),
                    HasSubstr("bash ")));
  const std::string script = read_file(folder_ / "out/job.sh");
  for (const std::string line :
       {"--job-name=streets", "--array=1-3%2", "--time=1-02:30:00", "--signal=B:USR1@120", "--requeue",
        "--open-mode=append", "--partition=gpu", "--account=lab", "--cpus-per-task=8", "--mem=16G",
        "--gres=gpu:a100:1", "--qos=long"})
    EXPECT_THAT(script, HasSubstr(fmt::format("\n#SBATCH {}\n", line)));
  EXPECT_THAT(script, HasSubstr("\n#SBATCH \"--comment=a b\"\n"));
  EXPECT_THAT(script, HasSubstr("\n  module load vulkan\n"));
  EXPECT_THAT(script, HasSubstr("run=(--jobs 2 --threads 4 --device lavapipe --tracer tree)"));
  EXPECT_THAT(script, HasSubstr("--cell low)"));
  // The merge has its own time, and neither the array nor the card.
  const size_t at = script.find("merge_job=(");
  const std::string merge = script.substr(at, script.find('\n', at) - at);
  EXPECT_THAT(merge,
              AllOf(HasSubstr("--time=0-00:45:00"), HasSubstr("--qos=long"), HasSubstr("'--comment=a b'"),
                    Not(HasSubstr("--array")), Not(HasSubstr("--gres"))));
  // Nothing but the arguments is in it.
  ASSERT_EQ(slurm("--cell low --time 90", "out").code, 0);
  const std::string once = read_file(folder_ / "out/job.sh");
  ASSERT_EQ(slurm("--cell low --time 90", "out").code, 0);
  EXPECT_EQ(read_file(folder_ / "out/job.sh"), once);
}

TEST_F(SlurmCli, BashSubmitsTheTasksAndTheirMerge) {
  const std::string hard = "o $ut 50% #1 & `x`";  // in single quotes within a shell's double quotes
  const std::string quoted = "o \\$ut 50% #1 & \\`x\\`";
  ASSERT_EQ(slurm("--time 90", quoted).code, 0);
  const std::string script = hard + "/job.sh";
  ASSERT_TRUE(fs::exists(folder_ / script));
  EXPECT_THAT(read_file(folder_ / script),
              HasSubstr(fmt::format("#SBATCH \"--output={}/o $ut 50%% #1 & `x`/logs/%A_%a.out\"\n",
                                    folder_.string())));
  ASSERT_EQ(code_of(start(script)), 0) << said();
  EXPECT_THAT(said(), HasSubstr("submitted 2 tasks as job 40, and their merge as job 41"));
  EXPECT_TRUE(fs::is_directory(folder_ / hard / "logs"));
  EXPECT_THAT(lines_of(fake("sbatch_0")), ::testing::ElementsAre("--parsable", in(script)));
  EXPECT_THAT(
      lines_of(fake("sbatch_1")),
      AllOf(::testing::Contains("--dependency=afterok:40"), ::testing::Contains("--kill-on-invalid-dep=yes"),
            ::testing::Contains("--time=0-01:30:00"),
            ::testing::Contains(
                fmt::format("--output={}/o $ut 50%% #1 & `x`/logs/merge_%j.out", folder_.string()))));
  // What Slurm gets for the merge runs this script's merge, with the program of the script.
  write("merge.sh", fake("input"));
  EXPECT_EQ(code_of(start("merge.sh")), 1) << said();
  EXPECT_THAT(said(), HasSubstr("expected sequence 0, complete; found it missing"));
}

TEST_F(SlurmCli, MergeEndsWithTheCodeOfTheProgram) {
  ASSERT_EQ(slurm(fmt::format("--time 90 --greatx '{}'", in("bin/greatx"))).code, 0);
  EXPECT_EQ(code_of(start("out/job.sh", {}, "merge")), 0) << said();
  EXPECT_THAT(lines_of(fake("greatx")),
              ::testing::ElementsAre("campaign", "merge", in("c.yaml"), "-o", in("out"), "--", "campaign",
                                     "verify", in("c.yaml"), "-o", in("out"), "--"));
  write("fake/code", "1");
  EXPECT_EQ(code_of(start("out/job.sh", {}, "merge")), 1);
  EXPECT_EQ(code_of(start("out/job.sh", {}, "submit")), 1);
  EXPECT_THAT(said(), HasSubstr("expected nothing or 'merge', found 'submit'"));
}

TEST_F(SlurmCli, ATaskRunsItsShardAndFailsWithoutARequeue) {
  ASSERT_EQ(slurm("--time 90 --greatx greatx").code, 0);
  EXPECT_EQ(code_of(start_task()), 0) << said();
  EXPECT_THAT(lines_of(fake("greatx")),
              ::testing::ElementsAre("campaign", "run", in("c.yaml"), "-o", in("out"), "--shard", "2/2",
                                     "--jobs", "1", "--threads", "2", "--"));
  for (const int code : {1, 2}) {
    write("fake/code", std::to_string(code));
    EXPECT_EQ(code_of(start_task()), code);
    EXPECT_THAT(said(), HasSubstr(fmt::format("greatx has failed with exit code {}", code)));
  }
  EXPECT_FALSE(fs::exists(folder_ / "fake/scontrol"));
}

TEST_F(SlurmCli, AKilledTaskIsRequeuedAFewTimes) {
  ASSERT_EQ(slurm("--time 90 --greatx greatx --restarts 3").code, 0);
  write("fake/code", "137");
  EXPECT_EQ(code_of(start_task(2)), 137);
  EXPECT_THAT(lines_of(fake("scontrol")), ::testing::ElementsAre("requeue", "7_2"));
  fs::remove(folder_ / "fake/scontrol");
  EXPECT_EQ(code_of(start_task(3)), 137);
  EXPECT_THAT(said(), HasSubstr("it has been restarted 3 times and is not again"));
  EXPECT_FALSE(fs::exists(folder_ / "fake/scontrol"));
}

TEST_F(SlurmCli, TheTimeLimitRequeuesAndACancellationDoesNot) {
  ASSERT_EQ(slurm("--time 90 --greatx greatx").code, 0);
  write("fake/waits", "");
  const auto signalled = [&](int signal) {
    fs::remove(folder_ / "fake/ready");
    const pid_t child = start_task();
    while (!fs::exists(folder_ / "fake/ready")) usleep(5000);
    kill(child, signal);
    if (signal == SIGTERM) {  // Slurm sends it to the program, too
      while (said().empty()) usleep(5000);
      usleep(100'000);
      const std::string children = read_file(fmt::format("/proc/{0}/task/{0}/children", child));
      kill(static_cast<pid_t>(std::stol(children)), SIGTERM);
    }
    return code_of(child);
  };
  EXPECT_EQ(signalled(SIGTERM), 130) << said();
  EXPECT_THAT(said(), HasSubstr("the task was stopped"));
  EXPECT_FALSE(fs::exists(folder_ / "fake/scontrol"));
  EXPECT_EQ(signalled(SIGUSR1), 130) << said();
  EXPECT_THAT(said(), HasSubstr("the time limit of the task is near; it goes on in its next run"));
  EXPECT_THAT(lines_of(fake("scontrol")), ::testing::ElementsAre("requeue", "7_2"));
}

TEST_F(SlurmCli, TimesComeFromTheMeasure) {
  const Outcome measured = slurm("--measure 2 --tasks 6 --json");
  ASSERT_EQ(measured.code, 0) << measured.err;
  const nlohmann::json json = nlohmann::json::parse(measured.out);
  EXPECT_EQ(json["tasks"], 6);
  EXPECT_EQ(json["sequences"], 6);
  // Twice the longest shard and 5 minutes, and twice the reading and 10 minutes, in minutes.
  const int64_t task_s = json["task_s"], merge_s = json["merge_s"];
  EXPECT_GT(task_s, 300);
  EXPECT_GT(merge_s, 600);
  EXPECT_EQ(task_s % 60, 0);
  EXPECT_EQ(merge_s % 60, 0);
  const Outcome one = slurm("--measure 2 --tasks 1 --json");
  // Another measure gives other times on a machine with other work, so the two are not compared.
  EXPECT_EQ(nlohmann::json::parse(one.out)["tasks"], 1);
  EXPECT_GT(nlohmann::json::parse(one.out)["task_s"], 300);
}

TEST_F(SlurmCli, FaultsOfTheOptions) {
  const std::vector<std::pair<std::string, std::string>> faults{
      {"--time 90 --tasks 7", "--tasks: expected 1 to 6, one for each sequence"},
      {"--time 90 --jobs 3", "--jobs: expected 1 to 2, one for each processor"},
      {"--time 1", "--time: expected 2 minutes or more"},
      {"--time 1:2:3:4", "--time: expected 2 minutes or more"},
      {"--time 90 --merge-time soon", "--merge-time: expected 2 minutes or more as M"},
      {"--time 90 --partition 'a b'", "--partition: expected one word without quotes, found 'a b'"},
      {"--time 90 --gpus '1 2'", "--gpus: expected one word"},
      {"--time 90 --sbatch qos", "--sbatch: expected an option of sbatch on one line"},
      {"--time 90 --logs 'a\\\\b'", "expected a folder without backslash"},
      {"--time 90 --cell middle", "expected one of the cells"}};
  for (const auto& [options, message] : faults) {
    const Outcome outcome = slurm(options);
    EXPECT_EQ(outcome.code, 1) << options;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << options;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out"));
  // An embedded campaign keeps its name, which every node knows.
  const Outcome embedded =
      greatx(fmt::format("campaign slurm great_mcd_mini -o '{}' --time 4:00:00", in("mini")));
  ASSERT_EQ(embedded.code, 0) << embedded.err;
  EXPECT_THAT(read_file(folder_ / "mini/job.sh"),
              AllOf(HasSubstr("\ncampaign=great_mcd_mini\n"), HasSubstr("#SBATCH --array=1-24\n")));
  // A campaign that has changed is a fault before anything is submitted.
  ASSERT_EQ(slurm("--time 90").code, 0);
  std::string changed = campaign_base(400, "rgb");
  changed.replace(changed.find("seed: 4"), 7, "seed: 5");
  write("base.yaml", changed);
  EXPECT_THAT(slurm("--time 90").err, HasSubstr("was begun with another scenario"));
}

TEST_F(SlurmCli, ShardsMayClaimAFolderInTheSameMoment) {
  for (int round = 0; round < 20; ++round) {
    std::vector<pid_t> children;
    for (int i = 0; i < 8; ++i) {
      children.push_back(fork());
      if (children.back() != 0) continue;
      if (freopen(in("err").c_str(), "a", stderr) == nullptr) _exit(126);
      execl(GREATX_PROGRAM, "greatx", "campaign", "slurm", in("c.yaml").c_str(), "-o",
            in(fmt::format("claim_{}", round)).c_str(), "--time", "90", "-q", "--script",
            in(fmt::format("job_{}.sh", i)).c_str(), nullptr);
      _exit(127);
    }
    for (const pid_t child : children) EXPECT_EQ(code_of(child), 0) << read_file(folder_ / "err");
    // Nothing but the two files is left.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / fmt::format("claim_{}", round)), {}), 2);
  }
}

/// Returns how many processes this one has started that have not ended.
size_t children_of(pid_t parent) {
  return std::ranges::count(read_file(fmt::format("/proc/{0}/task/{0}/children", parent)), ' ');
}

TEST_F(SlurmCli, JobsEndWithTheProcessThatHasStartedThem) {
  const auto run_and = [&](int signal) {
    const pid_t child = fork();
    if (child == 0) {
      setenv("GREATX_CACHE", "off", 1);
      if (freopen(in("err").c_str(), "w", stderr) == nullptr) _exit(126);
      execl(GREATX_PROGRAM, "greatx", "campaign", "run", in("c.yaml").c_str(), "-o", in("jobs").c_str(), "-q",
            "--jobs", "2", nullptr);
      _exit(127);
    }
    const auto begun = [&] {
      return greatx(fmt::format("campaign status '{}' -o '{}'", in("c.yaml"), in("jobs"))).out;
    };
    while (children_of(child) < 2 || begun().find("1 begun") == std::string::npos) usleep(20'000);
    kill(child, signal);  // this process alone
    return code_of(child);
  };
  EXPECT_EQ(run_and(SIGTERM), 130) << read_file(folder_ / "err");
  EXPECT_THAT(read_file(folder_ / "err"), HasSubstr("interrupted"));
  EXPECT_EQ(run_and(SIGKILL), 128 + SIGKILL);
  // Its jobs end, too, so that the same command can go on: a sequence is locked while it is written.
  Outcome more;
  for (int i = 0; i < 200; ++i) {
    more = greatx(fmt::format("campaign run '{}' -o '{}' -q", in("c.yaml"), in("jobs")));
    if (more.err.find("is being written by another process") == std::string::npos) break;
    usleep(50'000);
  }
  EXPECT_EQ(more.code, 0) << more.err;
}

}  // namespace
}  // namespace greatx::apps::test
