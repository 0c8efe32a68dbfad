// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Lets a run meet faults from outside: killed at random moments, a full disk, its output removed, its device
// lost. Each must end in a clear message, leave nothing torn behind, and resume to the same bytes.
#include <chrono>
#include <csignal>
#include <fstream>
#include <sys/mount.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using greatx::apps::test::greatx;
using greatx::apps::test::Outcome;
using greatx::apps::test::read_file;
using testing::AnyOf;
using testing::HasSubstr;

constexpr const char* rig = R"(greatx: 1
name: rig
seed: 3
ticks: 120
tick_rate_hz: 10
scene: {generate: {kind: room}}
nodes:
  - name: bs
    trajectory: {type: static, position_m: [-4.7, 2.9, 2.8]}
    sensors: [{name: antenna, type: antenna}]
  - name: ue
    trajectory: {type: waypoints, points: [{t_s: 0, position_m: [-3, -2, 1.5]},
      {t_s: 12, position_m: [3, 2, 1.5]}]}
    sensors:
      - {name: antenna, type: antenna}
      - {name: lidar, type: lidar, rate_hz: 10, channels: 4, elevation_min_deg: -20,
         elevation_max_deg: 10, azimuth_steps: 64}
      - {name: camera, type: camera, rate_hz: 10, width: 32, height: 24, fov_deg: 90, outputs: [rgb, depth]}
channels:
  - {name: csi, tx: bs/antenna, rx: [ue/antenna], rate_hz: 10, carrier_hz: 3.5e9, bandwidth_hz: 20e6,
     subcarriers: 16, max_depth: 2}
)";

class Faults : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new greatx::test::TemporaryFolder;
    std::ofstream(folder_->path() / "rig.yaml") << rig;
    const Outcome whole = greatx(fmt::format("generate {} -o {} -q", path("rig.yaml"), path("whole")));
    ASSERT_EQ(whole.code, 0) << whole.err;
  }
  static void TearDownTestSuite() { delete folder_; }

  static std::string path(const std::string& name) { return (folder_->path() / name).string(); }
  static std::string manifest(const std::string& name) {
    return read_file(fs::path(path(name)) / "manifest.json");
  }
  static Outcome generate(const std::string& output, const std::string& more = "",
                          const std::string& before = "") {
    return greatx(fmt::format("generate {} -o {} -q {}", path("rig.yaml"), output, more), before);
  }
  /// Starts the run in the background.
  static pid_t start(const std::string& output) {
    const std::string scenario = path("rig.yaml");
    const pid_t child = fork();
    if (child != 0) return child;
    if (std::freopen((output + ".err").c_str(), "w", stderr) == nullptr) _exit(126);
    execl(GREATX_PROGRAM, "greatx", "generate", scenario.c_str(), "-o", output.c_str(), "-q", "--resume",
          nullptr);
    _exit(127);
  }
  /// Checks that what is there is whole, and finishes it.
  static void expect_to_resume(const std::string& output) {
    if (fs::exists(fs::path(output) / "dataset.json")) {
      const Outcome verified = greatx(fmt::format("verify {}", output));
      EXPECT_THAT(verified.out + verified.err, AnyOf(HasSubstr("unfinished"), HasSubstr("complete")));
    }
    const Outcome resumed = generate(output, "--resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(read_file(fs::path(output) / "manifest.json"), manifest("whole"));
    EXPECT_EQ(greatx(fmt::format("verify {}", output)).code, 0);
  }

  static greatx::test::TemporaryFolder* folder_;
};
greatx::test::TemporaryFolder* Faults::folder_ = nullptr;

TEST_F(Faults, KilledAtRandomMomentsAgainAndAgain) {
  // One data set is killed several times on its way; the moments are random, from a fixed seed.
  greatx::RandomStream random(9, 1);
  const std::string output = path("killed");
  int killed = 0;
  for (int i = 0; i < 12; ++i) {
    const pid_t child = start(output);
    std::this_thread::sleep_for(std::chrono::microseconds(static_cast<int>(random.uniform(5e3, 9e5))));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    killed += WIFSIGNALED(status);
    ASSERT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << read_file(output + ".err");
  }
  EXPECT_GE(killed, 3);
  expect_to_resume(output);
}

TEST_F(Faults, AFullDisk) {
  // A small file system of its own; only root may mount one.
  const std::string disk = path("disk");
  fs::create_directory(disk);
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=300k") != 0) GTEST_SKIP() << "no rights to mount";
  const std::string output = disk + "/out";
  const Outcome full = generate(output);
  EXPECT_EQ(full.code, 1);
  EXPECT_THAT(full.err, HasSubstr("No space left on device"));
  EXPECT_THAT(full.err, HasSubstr(disk));
  EXPECT_FALSE(fs::exists(output + "/manifest.json"));
  // The disk grows, and the run goes on.
  EXPECT_EQ(mount("tmpfs", disk.c_str(), "tmpfs", MS_REMOUNT, "size=64m"), 0);
  expect_to_resume(output);
  EXPECT_EQ(umount(disk.c_str()), 0);
}

TEST_F(Faults, AFileSizeLimit) {
  const std::string output = path("limited");
  const Outcome limited = generate(output, "", "ulimit -f 8;");  // 4 KiB
  EXPECT_EQ(limited.code, 1);
  EXPECT_THAT(limited.err, HasSubstr("file-size limit"));
  EXPECT_FALSE(fs::exists(output + "/manifest.json"));
  expect_to_resume(output);
}

TEST_F(Faults, OutputRemovedUnderway) {
  const std::string output = path("removed");
  const pid_t child = start(output);
  const fs::path picture = fs::path(output) / "sequence_0000/ue/camera/rgb/000003.png";
  for (int i = 0; i < 12'000 && !fs::exists(picture); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  ASSERT_TRUE(fs::exists(picture));
  kill(child, SIGSTOP);  // so that the removal does not race with new files
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, WUNTRACED), child);  // all of its threads stand still now
  ASSERT_TRUE(WIFSTOPPED(status));
  fs::remove_all(output);
  kill(child, SIGCONT);
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 1) << "a data set that is gone is not complete";
  EXPECT_THAT(read_file(output + ".err"), HasSubstr(output));
  EXPECT_FALSE(fs::exists(output + "/manifest.json"));
  fs::remove_all(output);
  expect_to_resume(output);
}

TEST_F(Faults, TheDeviceIsLost) {
  const std::string layer =
      "VK_LAYER_PATH=" GREATX_LAYERS " VK_INSTANCE_LAYERS=VK_LAYER_GREATX_lose_device GREATX_LOSE_AFTER=";
  // Without a loss the layer changes nothing.
  ASSERT_EQ(generate(path("layered"), "", layer + "1000000").code, 0);
  EXPECT_EQ(manifest("layered"), manifest("whole"));
  // At set-up, at an early tick, and late.
  for (const int after : {0, 9, 60}) {
    const std::string output = path(fmt::format("lost_{}", after));
    const Outcome lost = generate(output, "", layer + std::to_string(after));
    EXPECT_EQ(lost.code, 2) << lost.err;
    EXPECT_THAT(lost.err, HasSubstr("VK_ERROR_DEVICE_LOST")) << after;
    EXPECT_THAT(lost.err, HasSubstr("the device was lost")) << after;
    EXPECT_FALSE(fs::exists(output + "/manifest.json"));
    if (after == 60) {
      EXPECT_THAT(lost.err, HasSubstr("--resume"));
    }
    expect_to_resume(output);
  }
}

}  // namespace
