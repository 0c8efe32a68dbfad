// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The real program `greatx view`, driven by scripts, without a display.
#include "tests/view/view_program.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/files/file.h"
#include "sim/tradeoff/error/flip.h"

namespace greatx::view {
namespace {

using apps::test::greatx;
using apps::test::Outcome;
using apps::test::read_file;
using testing::HasSubstr;

class ViewProgram : public ViewProgramTest {};

TEST_F(ViewProgram, ShowsASceneStepsAndPicks) {
  const Outcome run = view("room --paused --ticks 3",
                           "wait ready\nwait picture\nprint tick\nscreenshot a.png\n"
                           "key right\nwait tick 1\nwait picture\nprint tick\n"
                           "click 200 250\nwait frames 3\nprint picked\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("0\n1\n"));
  EXPECT_THAT(run.out, HasSubstr("object: "));
  EXPECT_THAT(run.out, HasSubstr("er "));
  EXPECT_THAT(run.out, HasSubstr("none\n"));
  const Array shot = picture("a.png");
  EXPECT_EQ(shot.shape, (std::vector<int64_t>{500, 800, 3}));
  EXPECT_GT(mean(shot, 50, 100, 400, 400), 20.0);  // the scene is there
}

TEST_F(ViewProgram, ErrorsAreShownNotThrown) {
  std::ofstream(folder() / "bad.yaml") << "greatx: 1\nname: bad\nticks: 5\nnodes: 3\n";
  const Outcome run = view(folder() / "bad.yaml", "wait ready\nwait frames 3\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("bad.yaml:4: nodes: expected a list"));
}

TEST_F(ViewProgram, RecordsTheWindow) {
  const Outcome run = view("room --paused --ticks 4",
                           "wait ready\nwait picture\ndo record shots\nscreenshot first.png\n"
                           "do step\nwait tick 1\nwait picture\ndo step\nwait tick 2\nwait picture\n"
                           "screenshot last.png\ndo record stop\n"
                           "do record.frames moving.webp\nwait frames 9\ndo record stop\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::exists(folder() / "moving.webp"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "moving.webp.part"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "shots/000003.png")) << "a picture for each of three ticks";
  // The line of menus holds times, which differ.
  const auto same_scene = [&](const std::string& a, const std::string& b) {
    const Array x = picture(a), y = picture(b);
    ASSERT_EQ(x.shape, y.shape);
    const size_t from = size_t{3} * 800 * 40, to = size_t{3} * 800 * 400;
    for (size_t row = from; row < to; row += size_t{3} * 800)
      ASSERT_TRUE(std::equal(&x.bytes[row], &x.bytes[row + 1200], &y.bytes[row])) << a << ", byte " << row;
  };
  same_scene("first.png", "shots/000000.png");
  same_scene("last.png", "shots/000002.png");
}

TEST_F(ViewProgram, RecordingsThatFailSaySo) {
  const Outcome run = view("room --paused --ticks 1",
                           "wait ready\nwait picture\ndo record none/a.webp\n"
                           "wait frames 3\ndo record stop\nquit\n");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("none/a.webp.part"));
  EXPECT_THAT(view("room --paused --ticks 1", "wait ready\ndo record a.gif\nquit\n").err,
              HasSubstr("a.gif: expected a name that ends in .webp"));
  EXPECT_THAT(view("room --paused --ticks 1", "wait ready\ndo record stop\nquit\n").err,
              HasSubstr("nothing is being recorded"));
}

TEST_F(ViewProgram, RemembersItsSettingsIfItIsAskedTo) {
  const std::string room = "room --paused --ticks 1",
                    kept = room + " --settings " + (folder() / "v.json").string();
  // The strip between scene and panels is dragged to the left.
  const Outcome first = view(kept,
                             "wait ready\nwait picture\nscreenshot a.png\ndrag 461 200 240 200\n"
                             "do show.lidar on\ndo legend off\nwait frames 3\nscreenshot b.png\nquit\n");
  ASSERT_EQ(first.code, 0) << first.err;
  const std::string json = read_file(folder() / "v.json");
  EXPECT_THAT(json, HasSubstr("\"lidar\": true"));
  EXPECT_THAT(json, HasSubstr("\"legend\": false"));
  EXPECT_THAT(json, HasSubstr("\"width\": 800"));
  EXPECT_THAT(json, HasSubstr("\"side_share\": 0.7"));
  ASSERT_EQ(view(kept, "wait ready\nwait picture\nwait frames 3\nscreenshot c.png\nquit\n").code, 0);
  EXPECT_EQ(read_file(folder() / "v.json"), json);
  EXPECT_LT(mean(picture("c.png"), 300, 420, 400, 440), 1.0 + mean(picture("b.png"), 300, 420, 400, 440));

  std::ofstream(folder() / "v.json") << "{\"version\": 1, \"speed\": \"fast\"}";
  const Outcome damaged = view(kept, "wait ready\nwait picture\nquit\n");
  EXPECT_EQ(damaged.code, 0);
  EXPECT_THAT(damaged.err, HasSubstr("settings are ignored: "));
  EXPECT_THAT(read_file(folder() / "v.json"), HasSubstr("\"speed\": 1.0"));

  ASSERT_EQ(view(kept, "wait ready\ndo settings.forget\nquit\n").code, 0);
  EXPECT_FALSE(std::filesystem::exists(folder() / "v.json"));
}

TEST_F(ViewProgram, TheTimesTabAndLargeTextsDraw) {
  const Outcome run = view("room --paused --ticks 2 --scale 2",
                           "wait ready\nwait picture\ndo tab Times\nwait frames 3\nmove 700 150\n"
                           "wait frames 3\nscale 1\nwait frames 3\nscreenshot t.png\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("none"));
  EXPECT_EQ(view("room --scale 9", "quit\n").code, 1);
  EXPECT_THAT(view("room --paused --ticks 1", "wait ready\ndo tab Tims\nquit\n").err,
              HasSubstr("tab: expected one of"));
}

TEST_F(ViewProgram, FaultsOfTheCommandLineAreErrors) {
  EXPECT_EQ(greatx("view room --offscreen").code, 1);
  EXPECT_THAT(greatx("view room --offscreen").err, HasSubstr("--script"));
  EXPECT_THAT(view("room", "fly away\n").err, HasSubstr("script.txt:1: expected an action"));
  EXPECT_THAT(view("room --size 3x3", "quit\n").err, HasSubstr("--size"));
  EXPECT_THAT(view(folder().string(), "quit\n").err, HasSubstr("expected a data set or a scenario"));
  const Outcome unknown = view("room --paused --ticks 1", "wait ready\ndo jump\nquit\n");
  EXPECT_EQ(unknown.code, 1);
  EXPECT_THAT(unknown.err, HasSubstr("expected a command of the viewer, found 'jump'"));
}

TEST_F(ViewProgram, QuitsWhileItLoads) {
  for (const char* script : {"quit\n", "wait frames 3\nquit\n", "key ctrl+q\nwait frames 100000\n"}) {
    const Outcome run = view("city", script);
    EXPECT_EQ(run.code, 0) << script << run.err;
  }
}

constexpr const char* resizing_script =
    "wait ready\nwait picture\nresize 640 400\nwait frames 5\nwait picture\nscreenshot small.png\n"
    "minimize\nwait frames 5\nrestore\nwait frames 5\nresize 900 600\nwait frames 5\nwait picture\n"
    "screenshot large.png\nkey right\nwait tick 1\nprint tick\nclick 200 250\nwait frames 3\n"
    "print error\nquit\n";

TEST_F(ViewProgram, IsResizedAndMinimized) {
  const Outcome run = view("room --paused --ticks 3", resizing_script);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, "1\nnone\n");
  EXPECT_EQ(picture("small.png").shape, (std::vector<int64_t>{400, 640, 3}));
  EXPECT_EQ(picture("large.png").shape, (std::vector<int64_t>{600, 900, 3}));
  EXPECT_GT(mean(picture("large.png"), 50, 100, 400, 400), 20.0);
}

TEST_F(ViewProgram, ARealWindowDoesTheSame) {
  if (std::string(GREATX_XVFB_RUN).empty() || std::string(GREATX_XVFB_RUN).ends_with("NOTFOUND"))
    GTEST_SKIP() << "xvfb-run is not installed";
  const Outcome run = view_x11("room --paused --ticks 3", resizing_script);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, "1\nnone\n");
  EXPECT_EQ(picture("small.png").shape, (std::vector<int64_t>{400, 640, 3}));
  EXPECT_EQ(picture("large.png").shape, (std::vector<int64_t>{600, 900, 3}));
  const double real = mean(picture("large.png"), 50, 100, 400, 400);
  ASSERT_EQ(view("room --paused --ticks 3", resizing_script).code, 0);
  EXPECT_NEAR(real, mean(picture("large.png"), 50, 100, 400, 400), 1.0);
}

TEST_F(ViewProgram, DamagedDataSetsAreErrorsInTheWindow) {
  const std::filesystem::path data = folder() / "data";
  ASSERT_EQ(greatx(fmt::format("generate room --ticks 2 -o {}", data.string())).code, 0);
  const std::string script = "wait ready\nwait frames 20\nprint error\nscreenshot error.png\nquit\n";
  EXPECT_THAT(view(data.string(), script).out, HasSubstr("none"));
  // Records that are cut off.
  const std::filesystem::path record = data / "sequence_0000" / "csi" / "cfr.npy";
  std::filesystem::resize_file(record, 300);
  Outcome run = view(data.string(), script);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr(record.filename().string()));
  // A description that is cut off.
  std::filesystem::resize_file(data / "dataset.json", 100);
  run = view(data.string(), script);
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("dataset.json"));
  const Array shot = picture("error.png");
  int red = 0;  // the colour of errors
  for (size_t i = 0; i + 2 < shot.bytes.size(); i += 3)
    red += static_cast<int>(shot.bytes[i]) > 200 && static_cast<int>(shot.bytes[i + 2]) < 120;
  EXPECT_GT(red, 100) << "the error is written in the window";
}

/// Returns the part of a screenshot without its first and last rows, whose texts tell times.
Array without_times(const Array& shot) {
  constexpr int64_t above = 24, below = 64;
  const int64_t row = shot.shape[1] * 3, height = shot.shape[0] - above - below;
  Array part(DType::u8, {height, shot.shape[1], 3});
  std::copy_n(shot.bytes.begin() + above * row, height * row, part.bytes.begin());
  return part;
}

TEST_F(ViewProgram, LooksAsBefore) {
  const Outcome run =
      view("room --paused --ticks 3 --size 480x300",
           "wait ready\ndo show.lidar on\nwait picture\nwait frames 5\nscreenshot a.png\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  const Array now = without_times(picture("a.png"));
  const std::filesystem::path golden = std::filesystem::path(GREATX_VIEW_GOLDENS) / "room.png";
  if (std::getenv("GREATX_UPDATE_GOLDENS") != nullptr) io::write_file_atomically(golden, io::encode_png(now));
  const std::string bytes = read_file(golden);
  const Array before = io::decode_png(std::as_bytes(std::span(bytes)), golden.string());
  ASSERT_EQ(now.shape, before.shape);
  // Another font or driver moves edges by a part of a pixel; an overlay or a panel that lacks is far more.
  EXPECT_LT(sim::flip(before, now).mean, 0.03);
}

}  // namespace
}  // namespace greatx::view
