// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/script/script.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace greatx::view {
namespace {

using Kind = ScriptStep::Kind;
using Input = InputEvent::Kind;

std::string fault_of(const std::string& text) {
  try {
    parse_script(text, "s.txt");
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Script, EveryActionIsRead) {
  const auto steps = parse_script(
      "# comment\n\nwait ready\nwait tick 12 # there\nwait frames 3\nwait picture\nkey ctrl+q\nclick 10 20 "
      "right\n"
      "drag 1 2 9 10\nwheel 5 6 -2\nresize 800 600\nminimize\nrestore\ntext a b\nmove 7 8\n"
      "do camera uav/front\nscreenshot a.png\nprint tick\nquit\n",
      "s.txt");
  ASSERT_EQ(steps.size(), 17u);
  EXPECT_EQ(steps[0].kind, Kind::wait_ready);
  EXPECT_EQ(steps[0].line, 3);
  EXPECT_EQ(steps[1].kind, Kind::wait_tick);
  EXPECT_EQ(steps[1].number, 12);
  EXPECT_EQ(steps[2].number, 3);
  EXPECT_EQ(steps[3].kind, Kind::wait_picture);
  ASSERT_EQ(steps[4].events.size(), 2u);
  EXPECT_EQ(steps[4].events[0].key, 'Q');
  EXPECT_TRUE(steps[4].events[0].control);
  ASSERT_EQ(steps[5].events.size(), 3u);
  EXPECT_EQ(steps[5].events[1].button, 1);
  EXPECT_EQ(steps[6].events.front().kind, Input::move);
  EXPECT_EQ(steps[6].events[1].kind, Input::press);
  EXPECT_EQ(steps[6].events.back().kind, Input::release);
  EXPECT_EQ(steps[6].events.back().x, 9.0);
  EXPECT_EQ(steps[7].events[1].y, -2.0);
  EXPECT_EQ(steps[8].events[0].x, 800.0);
  EXPECT_EQ(steps[9].events[0].kind, Input::minimize);
  EXPECT_EQ(steps[11].events[0].text, "a b");
  EXPECT_EQ(steps[13].text, "camera");
  EXPECT_EQ(steps[13].argument, "uav/front");
  EXPECT_EQ(steps[14].text, "a.png");
  EXPECT_EQ(steps[15].text, "tick");
  EXPECT_EQ(steps[16].kind, Kind::quit);
}

TEST(Script, FaultsNameLineAndAction) {
  EXPECT_THAT(fault_of("wait ready\nwiat tick 1\n"),
              testing::AllOf(testing::HasSubstr("s.txt:2: expected an action"),
                             testing::HasSubstr("did you mean 'wait'")));
  EXPECT_THAT(fault_of("click 10"), testing::HasSubstr("s.txt:1: click: expected a pixel, found nothing"));
  EXPECT_THAT(fault_of("click 10 x"), testing::HasSubstr("found 'x'"));
  EXPECT_THAT(fault_of("click 10 20 top"), testing::HasSubstr("left, right or middle"));
  EXPECT_THAT(fault_of("click -1 20"), testing::HasSubstr("from 0 to 16384"));
  EXPECT_THAT(fault_of("wait tick 1.5"), testing::HasSubstr("whole number"));
  EXPECT_THAT(fault_of("wait longer"), testing::HasSubstr("ready, scene, picture, tick N or frames N"));
  EXPECT_THAT(fault_of("key hyper+a"), testing::HasSubstr("ctrl, shift or alt"));
  EXPECT_THAT(fault_of("key F13"), testing::HasSubstr("found 'F13'"));
  EXPECT_THAT(fault_of("quit now"), testing::HasSubstr("found 'now'"));
  EXPECT_THAT(fault_of("scale 9"), testing::HasSubstr("from 0.5 to 4"));
  EXPECT_THAT(fault_of("resize 10 10"), testing::HasSubstr("from 64"));
  EXPECT_THROW(load_script("/nonexistent/script.txt"), UserError);
}

TEST(Script, KeysHaveGlfwsCodes) {
  EXPECT_EQ(key_of("a"), 65);
  EXPECT_EQ(key_of("F1"), 290);
  EXPECT_EQ(key_of("F12"), 301);
  EXPECT_EQ(key_of("space"), 32);
  EXPECT_EQ(key_of("left"), 263);
  EXPECT_EQ(key_of(""), 0);
  EXPECT_EQ(key_of("Fx"), 0);
}

}  // namespace
}  // namespace greatx::view
