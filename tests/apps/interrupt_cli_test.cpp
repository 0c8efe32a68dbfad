// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Starts a search for paths that would take minutes from a terminal. The search must show its progress and
// end on Ctrl-C. No time is asserted: a search that does not end runs into the test's own limit.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <pty.h>
#include <set>
#include <string>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr const char* scenario = R"(greatx: 1
name: long
ticks: 3
tick_rate_hz: 10
scene:
  generate: {kind: city, seed: 9, size_m: 200}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [6.3, -21.7, 30]}
    sensors: [{name: a, type: antenna}]
  - name: ue
    trajectory: {type: static, position_m: [2.4, 20, 1.5]}
    sensors: [{name: a, type: antenna}]
channels:
  - {name: csi, tx: bs/a, rx: [ue/a], rate_hz: 10, bandwidth_hz: 20e6, subcarriers: 16, )"
                                 R"(max_depth: 8, max_transmissions: 2}
)";

class InterruptCli : public ::testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(folder_ / "long.yaml") << scenario;
    fs::create_directory(folder_ / "cache");
  }

  /// Runs the program with a terminal as its stderr, and presses Ctrl-C once the program shows a search.
  /// Returns all that the program wrote. Sets `code` to the exit code, or to 128 + the signal that ended the
  /// program.
  std::string interrupt(std::vector<std::string> arguments, int& code) const {
    arguments.insert(arguments.begin(), "greatx");
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    if (child == 0) {
      setenv("GREATX_CACHE", (folder_ / "cache").c_str(), 1);
      if (chdir(folder_.c_str()) != 0) _exit(126);
      std::vector<char*> raw;
      for (std::string& argument : arguments) raw.push_back(argument.data());
      raw.push_back(nullptr);
      execv(GREATX_PROGRAM, raw.data());
      _exit(127);
    }
    std::string text;
    bool pressed = false;
    char buffer[4096];
    for (ssize_t count; (count = read(terminal, buffer, sizeof buffer)) > 0;) {
      text.append(buffer, static_cast<size_t>(count));
      if (pressed || text.find(" left   ") == std::string::npos) continue;
      pressed = write(terminal, "\x03", 1) == 1;
    }
    close(terminal);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(pressed) << text;
    code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return text;
  }

  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(InterruptCli, ASearchShowsProgressAndEndsOnCtrlC) {
  const std::vector<std::vector<std::string>> commands{
      {"paths", "long.yaml"},
      {"map", "long.yaml", "-o", "map", "--cell", "50", "--no-pictures"},
      {"generate", "long.yaml", "-o", "data"},
      {"bench", "long.yaml", "--discard"},
      {"bench", "long.yaml", "--radio"}};
  for (const std::vector<std::string>& command : commands) {
    int code = 0;
    const std::string text = interrupt(command, code);
    EXPECT_EQ(code, 130) << command[0] << ": " << text;
    EXPECT_THAT(text, HasSubstr("\rsearch [")) << command[0];
    EXPECT_THAT(text, HasSubstr("about ")) << command[0];
    EXPECT_TRUE(fs::is_empty(folder_ / "cache")) << command[0] << ": nothing half done is kept";
  }
  // `greatx verify` reports the interrupted data set as unfinished.
  EXPECT_EQ(greatx(fmt::format("verify {}", (folder_ / "data").string())).code, 1);
  EXPECT_THAT(greatx(fmt::format("verify {}", (folder_ / "data").string())).out, HasSubstr("unfinished"));
}

TEST_F(InterruptCli, WithoutATerminalNothingIsShown) {
  const fs::path err = folder_ / "err";
  const pid_t child = fork();
  if (child == 0) {
    setenv("GREATX_CACHE", "off", 1);
    if (chdir(folder_.c_str()) != 0 || std::freopen("err", "w", stderr) == nullptr ||
        std::freopen("/dev/null", "w", stdout) == nullptr)
      _exit(126);
    execl(GREATX_PROGRAM, "greatx", "paths", "long.yaml", nullptr);
    _exit(127);
  }
  while (read_file(err).find("searching") == std::string::npos && waitpid(child, nullptr, WNOHANG) == 0)
    usleep(5000);
  usleep(1'500'000);  // longer than the time between two lines of a search on a terminal
  kill(child, SIGTERM);
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_THAT(read_file(err), HasSubstr("greatx: interrupted: "));
  EXPECT_EQ(read_file(err).find('\r'), std::string::npos) << read_file(err);
}

}  // namespace
}  // namespace greatx::apps::test
