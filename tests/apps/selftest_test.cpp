// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Runs the catalogue of `greatx selftest` on the test device, and proves that every case can fail.
#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "apps/selftest/report.h"
#include "tests/support/gpu_fixture.h"

namespace greatx::apps::selftest {
namespace {

std::vector<Row> rows_of(const Case& item, Fault fault) {
  std::vector<Row> rows;
  run(item, Lab(test::device(), fault), rows);
  return rows;
}

/// Each case is a test of its own.
class Catalogue : public testing::TestWithParam<size_t> {};

TEST_P(Catalogue, HardCaseHasTheExpectedFigures) {
  const std::vector<Row> rows = rows_of(catalogue()[GetParam()], Fault::none);
  ASSERT_FALSE(rows.empty());
  for (const Row& row : rows) EXPECT_TRUE(row.passed()) << line_of(row);
}

TEST_P(Catalogue, FailsWithAPlantedFault) {
  const Case item = catalogue()[GetParam()];
  size_t failed = 0;
  for (const Fault fault : {Fault::hole, Fault::scale})
    for (const Row& row : rows_of(item, fault)) failed += !row.passed() && row.error.empty();
  // An exception alone would not show that a figure is compared.
  EXPECT_GT(failed, 0u) << item.number << ' ' << item.title;
}

std::vector<size_t> every_case() {
  std::vector<size_t> all(catalogue().size());
  for (size_t i = 0; i < all.size(); ++i) all[i] = i;
  return all;
}
INSTANTIATE_TEST_SUITE_P(Selftest, Catalogue, testing::ValuesIn(every_case()), [](const auto& test) {
  const std::vector<Case> cases = catalogue();
  const auto same = [&](const Case& item) { return item.number == cases[test.param].number; };
  const auto before = std::count_if(cases.begin(), cases.begin() + static_cast<long>(test.param), same);
  return "N" + std::to_string(cases[test.param].number) + "_" + std::to_string(before + 1);
});

/// Every number of the catalogue of hard cases has figures, its own or those of a case whose title names it.
TEST(SelftestReport, EveryHardCaseHasFigures) {
  std::set<uint32_t> numbers;
  for (const Case& item : catalogue()) {
    numbers.insert(item.number);
    const std::string title = item.title;
    const size_t open = title.rfind('(');
    if (open == std::string::npos) continue;
    std::istringstream list(title.substr(open + 1));
    for (uint32_t number = 0; list >> number; list.ignore(1)) numbers.insert(number);
  }
  for (uint32_t number = 1; number <= 64; ++number) EXPECT_TRUE(numbers.contains(number)) << number;
}

TEST(SelftestReport, AFigureThatIsNotFiniteOrThrowsFails) {
  Row row;
  EXPECT_TRUE(row.passed());
  row.got = 1e-9;
  EXPECT_FALSE(row.passed());
  row.tolerance = 1e-9;
  EXPECT_TRUE(row.passed());
  row.got = std::nan("");
  EXPECT_FALSE(row.passed());
  std::vector<Row> rows;
  run({7, "throws", [](const Lab&, Rows&) { throw std::runtime_error("no such thing"); }},
      Lab(test::device()), rows);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_FALSE(rows[0].passed());
  EXPECT_NE(line_of(rows[0]).find("no such thing"), std::string::npos);
}

TEST(SelftestReport, JsonHasEveryRowAndItsVerdict) {
  std::vector<Row> rows(2);
  rows[1].number = 36;
  rows[1].got = std::nan("");
  const nlohmann::json json = json_of(rows, {1, 2, 1, 0.5}, test::device().info());
  EXPECT_EQ(json["rows"].size(), 2u);
  EXPECT_TRUE(json["rows"][0]["passed"]);
  EXPECT_FALSE(json["rows"][1]["passed"]);
  EXPECT_FALSE(json["passed"]);
  EXPECT_NE(json.dump().find("\"got\":null"), std::string::npos);
}

/// Every tracer and every precision that the product has is judged by some row.
TEST(SelftestReport, EveryTracerAndPrecisionIsThere) {
  std::map<std::string, size_t> by;
  for (const Case& item : catalogue())
    for (const Row& row : rows_of(item, Fault::none)) ++by[row.by];
  for (const char* name : {"tree, fp32", "host, fp64", "host, complex64", "device, fp32",
                           "device rays, fp32 + fp64", "host rays, fp32 + fp64"})
    EXPECT_GE(by[name], 3u) << name;
  const Lab lab(test::device());
  EXPECT_GE(by[lab.host_and_tracer()], 3u);
  for (const gpu::Tracer tracer : lab.tracers()) EXPECT_GE(by[precision_of(tracer)], 3u);
}

}  // namespace
}  // namespace greatx::apps::selftest
