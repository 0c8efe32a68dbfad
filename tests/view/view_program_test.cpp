// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The real program `greatx view`, driven by scripts, without a display.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/formats/png.h"
#include "tests/apps/program.h"

namespace greatx::view {
namespace {

using apps::test::greatx;
using apps::test::Outcome;
using apps::test::read_file;
using testing::HasSubstr;

class ViewProgram : public testing::Test {
 protected:
  std::filesystem::path folder() const { return temporary_.path(); }
  /// Runs `greatx view WHAT --offscreen` with a script, in the test's folder.
  Outcome view(const std::string& what, const std::string& script) const {
    std::ofstream(folder() / "script.txt") << script;
    return greatx(fmt::format("view {} --offscreen --validation --size 800x500 --script {}/script.txt", what,
                              folder().string()),
                  fmt::format("cd {} &&", folder().string()));
  }
  Array picture(const std::string& name) const {
    const std::string bytes = read_file(folder() / name);
    return io::decode_png(std::as_bytes(std::span(bytes)), name);
  }
  static double mean(const Array& picture, int x0, int y0, int x1, int y1) {
    double sum = 0.0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x)
        for (int c = 0; c < 3; ++c)
          sum += static_cast<double>(picture.bytes[static_cast<size_t>((y * picture.shape[1] + x) * 3 + c)]);
    return sum / (3.0 * (x1 - x0) * (y1 - y0));
  }

 private:
  greatx::test::TemporaryFolder temporary_;
};

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

}  // namespace
}  // namespace greatx::view
