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
