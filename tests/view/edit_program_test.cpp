// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The real program, edited by scripts.
#include "tests/view/view_program.h"

namespace greatx {
namespace {

using apps::test::greatx;
using apps::test::Outcome;
using apps::test::read_file;
using testing::HasSubstr;

class EditProgram : public ViewProgramTest {};

TEST_F(EditProgram, AChangeIsRunComparedUndoneAndSaved) {
  const Outcome run =
      view("room --paused --ticks 3",
           "wait ready\ndo tick 1\nwait tick 1\n"
           "do set channels[0].max_depth 1\nwait ready\nprint comparison\nprint tick\n"
           "do undo\nwait ready\nprint comparison\n"
           "do set seed 8\nwait ready\ndo save changed.yaml\nprint command\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("channels[0].max_depth, tick 1\n"));
  EXPECT_THAT(run.out, HasSubstr("cfr: error -"));
  EXPECT_THAT(run.out, HasSubstr("dB of its power"));
  EXPECT_THAT(run.out, HasSubstr("undone: channels[0].max_depth, tick 1\n"));
  EXPECT_THAT(run.out,
              HasSubstr("greatx generate " + (folder() / "changed.yaml").string() + " --output out/room\n"));
  EXPECT_THAT(run.out, HasSubstr("none\n"));
  const std::string saved = read_file(folder() / "changed.yaml");
  EXPECT_THAT(saved, HasSubstr("seed: 8"));
  EXPECT_THAT(saved, HasSubstr("max_depth: 3"));
  EXPECT_EQ(greatx("explain " + (folder() / "changed.yaml").string()).code, 0);
}

TEST_F(EditProgram, AScenarioThatCannotRunLeavesTheOldOne) {
  const Outcome run =
      view("room --paused --ticks 2",
           "wait ready\ndo set channels[0].carrier_hz 9e12\nwait ready\nprint error\nprint tick\n"
           "do undo\nwait ready\nprint error\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("channels[0].carrier_hz"));
  EXPECT_THAT(run.out, HasSubstr("\n0\nnone\n")) << "tick 0 stays, and the error goes with its change";
}

TEST_F(EditProgram, ARefusedValueIsAnError) {
  const Outcome run = view("room --paused --ticks 2", "wait ready\ndo set channels[0].max_depth 99\nquit\n");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("channels[0].max_depth: expected an integer from 0 to 16, found '99'"));
}

TEST_F(EditProgram, AHandleIsDraggedWithTheMouse) {
  // The view looks at the middle of the room; a handle is selected by its name and dragged by its arrow up.
  const Outcome run =
      view("room --paused --ticks 2",
           "wait ready\nwait picture\nprint scenario\ndo select bs\nwait frames 2\nprint handle\nquit\n");
  ASSERT_EQ(run.code, 0) << run.err;
  int x = 0, y = 0;
  const size_t at = run.out.rfind("arrow z: ");
  ASSERT_NE(at, std::string::npos) << run.out;
  ASSERT_EQ(std::sscanf(run.out.c_str() + at, "arrow z: %d %d", &x, &y), 2);
  const Outcome drag =
      view("room --paused --ticks 2",
           fmt::format("wait ready\nwait picture\ndo select bs\nwait frames 2\ndrag {} {} {} {}\nwait ready\n"
                       "print scenario\ndo undo\nwait ready\nprint error\nquit\n",
                       x, y, x, y - 20));
  ASSERT_EQ(drag.code, 0) << drag.err;
  const auto position = [](const std::string& text) {
    const size_t node = text.find("name: bs"), list = text.find("position_m: [", node);
    double p[3] = {};
    EXPECT_EQ(std::sscanf(text.c_str() + list, "position_m: [%lf, %lf, %lf]", p, p + 1, p + 2), 3);
    return glm::dvec3(p[0], p[1], p[2]);
  };
  const glm::dvec3 before = position(run.out), after = position(drag.out);
  EXPECT_EQ(after.x, before.x);
  EXPECT_EQ(after.y, before.y);
  EXPECT_GT(after.z, before.z + 0.01);
  EXPECT_LT(after.z, before.z + 5.0);
}

}  // namespace
}  // namespace greatx
