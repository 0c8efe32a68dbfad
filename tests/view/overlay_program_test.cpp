// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Overlays in the real program: each is switched on by a script, and the window is drawn with it.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/apps/program.h"

namespace greatx::view {
namespace {

using apps::test::greatx;
using apps::test::Outcome;
using testing::HasSubstr;

class OverlayProgram : public testing::Test {
 protected:
  Outcome view(const std::string& what, const std::string& script) const {
    std::ofstream(temporary_.path() / "script.txt") << script;
    return greatx(fmt::format("view {} --offscreen --validation --size 640x400 --script {}/script.txt", what,
                              temporary_.path().string()),
                  fmt::format("cd {} &&", temporary_.path().string()));
  }

 private:
  greatx::test::TemporaryFolder temporary_;
};

TEST_F(OverlayProgram, SaysWhyAPathIsThere) {
  const Outcome run = view("room --paused --ticks 2",
                           "wait ready\nwait picture\nprint path\ndo show.wedges on\ndo show.facets on\n"
                           "wait frames 2\nwait picture\ndo pin 2\ndo show.tubes on\nwait frames 3\n"
                           "print path\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::StartsWith("nothing\nleaves "));
  EXPECT_THAT(run.out, HasSubstr(" deg from the "));
  EXPECT_THAT(run.out, HasSubstr(" m in all ("));
  EXPECT_THAT(run.out, HasSubstr("none\n"));
}

TEST_F(OverlayProgram, DrawsAllOfThemAtOnceAndAMap) {
  const Outcome run = view(
      "room --paused --ticks 3",
      "wait ready\nwait picture\ndo show.lidar on\ndo lidar.colors intensity\ndo lidar.colors\n"
      "do show.boxes on\ndo show.events on\ndo show.cells on\ndo show.facets on\ndo facets.colors material\n"
      "do show.wedges on\ndo show.ways on\ndo show.tubes on\ndo pin\ndo map cell=1 quantity=rss height=1\n"
      "wait picture\nwait frames 5\nkey right\nwait tick 1\nwait picture\nscreenshot all.png\n"
      "do show.map off\nwait frames 3\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("none\n"));
}

TEST_F(OverlayProgram, RefusesMapsThatItCannotMake) {
  const auto refused = [&](const std::string& command) {
    const Outcome run =
        view("room --paused --ticks 1", "wait ready\nwait picture\ndo " + command + "\nquit\n");
    EXPECT_EQ(run.code, 1);
    return run.err;
  };
  EXPECT_THAT(refused("map cell=wide"), HasSubstr("map: cell: expected a number, found 'wide'"));
  EXPECT_THAT(refused("map colour=red"), HasSubstr("expected quantity, cell, height"));
  EXPECT_THAT(refused("lidar.colors blue"), HasSubstr("expected one of height, intensity, ring, instance"));
}

}  // namespace
}  // namespace greatx::view
