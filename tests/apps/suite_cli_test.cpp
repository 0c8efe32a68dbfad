// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests `greatx bench --suite` with its smallest scene, and `greatx bench --compare` with files made by hand.
// The tests do not judge how long anything takes.
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

void expect_times(const nlohmann::json& times, size_t count) {
  EXPECT_EQ(times["count"], count);
  EXPECT_GE(times["min"], 0.0);
  EXPECT_LE(times["min"], times["median"]);
  EXPECT_LE(times["median"], times["max"]);
}

TEST(Suite, MeasuresEveryPassWithEveryTracerAndWritesItsFiles) {
  const greatx::test::TemporaryFolder temporary;
  const fs::path folder = temporary.path() / "out";
  const Outcome outcome = greatx(
      fmt::format("bench --suite --quick --most-triangles 1000 --repeats 2 -o {} --json", folder.string()));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json result = nlohmann::json::parse(read_file(folder / "suite.json"));
  EXPECT_EQ(nlohmann::json::parse(outcome.out), result);
  EXPECT_EQ(result["greatx_suite"], 1);
  EXPECT_EQ(result["finished"], true);
  EXPECT_FALSE(result["device"]["name"].get<std::string>().empty());
  std::set<std::string> seen;
  for (const nlohmann::json& row : result["rows"]) {
    ASSERT_FALSE(row.contains("skipped")) << row;
    const std::string pass = row["pass"], tracer = row["tracer"];
    seen.insert(fmt::format("{} {} {} {}", row["axis"].get<std::string>(), row["size"].get<uint64_t>(), pass,
                            tracer));
    expect_times(row["wall_ms"], pass == "set-up" ? 1 : 2);
    expect_times(row["cpu_ms"], pass == "set-up" ? 1 : 2);
    EXPECT_GT(row["count"], 0);
    EXPECT_GT(row["per_second"], 0.0);
    // The tracers agree on all rays but those that pass an edge within roundings.
    if (row.contains("differing")) {
      EXPECT_LE(row["differing"], row["count"].get<uint64_t>() / 100) << row;
    }
  }
  std::vector<std::string> tracers{"tree"};
  if (result["device"]["ray_query"]) tracers.push_back("driver");
  for (const std::string& tracer : tracers) {
    for (const char* pass : {"set-up", "single rays", "LiDAR sweep", "path segments", "candidate rays",
                             "radar rays", "whole tick"})
      EXPECT_TRUE(seen.contains(fmt::format("triangles 1000 {} {}", pass, tracer))) << pass << " " << tracer;
    EXPECT_TRUE(seen.contains("bodies 100 radar rays " + tracer));
    EXPECT_TRUE(seen.contains("bodies 100 whole tick " + tracer));
    EXPECT_TRUE(seen.contains("receivers 1000 path segments " + tracer));
  }
  EXPECT_TRUE(seen.contains("triangles 1000 camera picture raster"));
  EXPECT_TRUE(seen.contains("triangles 1000 event interval raster"));
  EXPECT_TRUE(seen.contains("lamps 1000 camera at night raster"));
  EXPECT_EQ(seen.contains("triangles 1000 single rays embree"), result["embree"] != "");
  const std::string table = read_file(folder / "suite.md");
  EXPECT_THAT(table, HasSubstr(result["device"]["name"].get<std::string>()));
  EXPECT_EQ(table.find("built without Embree") != std::string::npos, result["embree"] == "");
  for (const char* axis : {"triangles", "bodies", "lamps", "receivers"})
    EXPECT_THAT(read_file(folder / fmt::format("{}.png", axis)), HasSubstr("PNG")) << axis;
  const nlohmann::json device = nlohmann::json::parse(read_file(folder / "device.json"));
  EXPECT_EQ(device["triangles"], 1000);
  EXPECT_EQ(device["device"], result["device"]);
  EXPECT_GE(device["passes"].size(), 7u * tracers.size() + 2);
}

TEST(Suite, NeedsAFolder) {
  const Outcome outcome = greatx("bench --suite");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("bench --suite: expected -o DIR"));
}

/// Returns a file of two rows whose runs take `first_ms` and 10 ms, give or take a tenth.
nlohmann::json suite_of(double first_ms) {
  const auto row = [](const char* pass, double ms, int runs) {
    return nlohmann::json{
        {"axis", "triangles"},
        {"size", 1000},
        {"pass", pass},
        {"tracer", "tree"},
        {"unit", "rays"},
        {"count", 65536},
        {"wall_ms", {{"count", runs}, {"min", 0.9 * ms}, {"median", ms}, {"max", 1.1 * ms}}}};
  };
  return {
      {"greatx_suite", 1},
      {"greatx", "0.1.0"},
      {"device", {{"name", "card"}}},
      {"rows", {row("single rays", first_ms, 5), row("radar rays", 10.0, 5), row("set-up", first_ms, 1)}}};
}

class Compare : public ::testing::Test {
 protected:
  Outcome compare(const nlohmann::json& a, const nlohmann::json& b, const std::string& options = "") const {
    std::ofstream(folder_ / "a.json") << a.dump(1);
    std::ofstream(folder_ / "b.json") << b.dump(1);
    return greatx(fmt::format("bench --compare {0}/a.json {0}/b.json {1}", folder_.string(), options));
  }
  greatx::test::TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST_F(Compare, NamesARowThatIsTwiceAsSlow) {
  const Outcome outcome = compare(suite_of(5.0), suite_of(10.0), "--json");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json rows = nlohmann::json::parse(outcome.out)["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_NEAR(rows[0]["ratio"], 2.0, 1e-12);
  EXPECT_EQ(rows[0]["verdict"], "slower");
  EXPECT_EQ(rows[1]["verdict"], "within the spread");
  EXPECT_EQ(rows[2]["verdict"], "too few runs");
  const Outcome text = compare(suite_of(10.0), suite_of(5.0));
  EXPECT_THAT(text.out, HasSubstr("1 of 3 rows differ by more than the spread"));
  EXPECT_THAT(text.out, HasSubstr("faster"));
  EXPECT_THAT(text.out, Not(HasSubstr("slower")));
}

TEST_F(Compare, ListsRowsOfOneFileAlone) {
  nlohmann::json shorter = suite_of(5.0);
  shorter["rows"].erase(1);
  EXPECT_THAT(compare(suite_of(5.0), shorter).out, HasSubstr("only in a"));
}

TEST_F(Compare, BadFilesAreNamedWithTheirFields) {
  nlohmann::json bad = suite_of(5.0);
  bad["rows"][1]["wall_ms"]["max"] = 1.0;
  Outcome outcome = compare(suite_of(5.0), bad);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("b.json"));
  EXPECT_THAT(outcome.err, HasSubstr("rows[1].wall_ms.max"));
  bad = suite_of(5.0);
  bad["greatx_suite"] = 2;
  outcome = compare(bad, suite_of(5.0));
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("greatx_suite"));
  outcome = greatx("bench --compare /nowhere/a.json /nowhere/b.json");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.err, HasSubstr("/nowhere/a.json"));
}

}  // namespace
}  // namespace greatx::apps::test
