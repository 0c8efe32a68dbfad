// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests that the rows of `greatx bench --view` exist. The test does not judge how long they take.
#include <cmath>
#include <map>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"

namespace greatx::view {
namespace {

using apps::test::greatx;
using apps::test::Outcome;

TEST(ViewBench, HasARowForEachTarget) {
  const std::string arguments =
      "bench room --ticks 40 --view --size 320x240 --orbit-seconds 0.3 --drags 2 --turns 1 --warm-up 1";
  const Outcome run = greatx(arguments + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json result = nlohmann::json::parse(run.out);
  EXPECT_EQ(result["scenario"], "room");
  EXPECT_EQ(result["width"], 320);
  std::map<std::string, double> targets;
  for (const nlohmann::json& row : result["rows"]) {
    EXPECT_TRUE(std::isfinite(row["value"].get<double>())) << row;
    EXPECT_EQ(row.contains("met"), row.contains("least") || row.contains("most")) << row;
    if (row.contains("met")) targets[row["name"]] = row.value("least", row.value("most", 0.0));
  }
  EXPECT_EQ(targets.size(), 10u);
  EXPECT_EQ(targets["orbit, all overlays: new pictures of the scene"], 20.0);
  EXPECT_EQ(targets["from a drag at rest to its picture, worst"], 100.0);
  EXPECT_EQ(targets["live: slow-down by the window, median"], 15.0);
  EXPECT_EQ(targets["from the start to the first picture, median"], 2.5);
}

TEST(ViewBench, TooFewTicksAreAnError) {
  const Outcome run = greatx("bench room --ticks 3 --view --warm-up 5");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, testing::HasSubstr("bench --view: expected 7 ticks at least"));
}

}  // namespace
}  // namespace greatx::view
