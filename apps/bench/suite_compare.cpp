// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/suite_compare.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/file.h"
#include "io/files/untrusted_json.h"

namespace greatx::apps {

namespace {

constexpr uint64_t most_suite_bytes = uint64_t{16} << 20;
constexpr size_t most_suite_rows = 100'000;
constexpr int64_t most_count = int64_t{1} << 53;
constexpr int64_t fewest_runs = 3;

/// Identifies what a row measures.
struct RowKey {
  std::string axis;
  int64_t size = 0;
  std::string pass, tracer, unit;
  int64_t count = 0;
  auto operator<=>(const RowKey&) const = default;
  nlohmann::json json() const {
    return {{"axis", axis}, {"size", size},   {"pass", pass},
            {"unit", unit}, {"count", count}, {"tracer", tracer}};
  }
};

struct RunTimes {
  int64_t runs = 0;
  double min_ms = 0.0, median_ms = 0.0, max_ms = 0.0;
  nlohmann::json json() const {
    return {{"count", runs}, {"min", min_ms}, {"median", median_ms}, {"max", max_ms}};
  }
};

struct SuiteFile {
  std::string device, version;
  std::vector<RowKey> order;
  std::map<RowKey, RunTimes> rows;
};

RunTimes times_of(const io::JsonValue& value) {
  constexpr double most = 1e12;
  RunTimes times;
  times.runs = value.at("count").integer(1, most_count);
  times.min_ms = value.at("min").number(0.0, most);
  times.median_ms = value.at("median").number(times.min_ms, most);
  times.max_ms = value.at("max").number(times.median_ms, most);
  return times;
}

SuiteFile read_suite(const std::filesystem::path& path) {
  const io::JsonDocument document(io::read_text_file(path, most_suite_bytes), {path.string(), 1},
                                  {.bytes = most_suite_bytes});
  const io::JsonValue root = document.root();
  root.at("greatx_suite").integer(1, 1);
  SuiteFile file;
  file.device = root.at("device").at("name").text();
  file.version = root.at("greatx").text();
  for (const io::JsonValue& row : root.at("rows").list(most_suite_rows)) {
    if (row.has("skipped")) continue;
    RowKey key{row.at("axis").text(), row.at("size").integer(0, most_count),
               row.at("pass").text(), row.at("tracer").text(),
               row.at("unit").text(), row.at("count").integer(0, most_count)};
    if (!file.rows.emplace(key, times_of(row.at("wall_ms"))).second)
      row.fail("a row that no other row repeats");
    file.order.push_back(std::move(key));
  }
  return file;
}

const char* verdict(const RunTimes& a, const RunTimes& b) {
  if (a.runs < fewest_runs || b.runs < fewest_runs) return "too few runs";
  if (b.min_ms > a.max_ms) return "slower";
  if (b.max_ms < a.min_ms) return "faster";
  return "within the spread";
}

nlohmann::json only_in(const SuiteFile& file, const SuiteFile& other) {
  nlohmann::json rows = nlohmann::json::array();
  for (const RowKey& key : file.order)
    if (!other.rows.contains(key)) rows.push_back(key.json());
  return rows;
}

std::string row_name(const nlohmann::json& row) {
  return printable(fmt::format("{} {}, {}, {}", row["size"].get<int64_t>(), row["axis"].get<std::string>(),
                               row["pass"].get<std::string>(), row["tracer"].get<std::string>()));
}

std::string compared_line(const nlohmann::json& row) {
  const auto times = [](const nlohmann::json& t) {
    return fmt::format("{:.3f} ({:.3f}..{:.3f})", t["median"].get<double>(), t["min"].get<double>(),
                       t["max"].get<double>());
  };
  return fmt::format("  {:<48} {:>30} {:>30} {:7.2f}  {}\n", row_name(row), times(row["a_ms"]),
                     times(row["b_ms"]), row["ratio"].get<double>(), row["verdict"].get<std::string>());
}

}  // namespace

nlohmann::json compare_suites(const std::filesystem::path& a, const std::filesystem::path& b) {
  const SuiteFile first = read_suite(a), second = read_suite(b);
  const auto side = [](const std::filesystem::path& path, const SuiteFile& file) {
    return nlohmann::json{{"file", path.string()}, {"device", file.device}, {"greatx", file.version}};
  };
  nlohmann::json result{{"a", side(a, first)},
                        {"b", side(b, second)},
                        {"rows", nlohmann::json::array()},
                        {"only_a", only_in(first, second)},
                        {"only_b", only_in(second, first)}};
  for (const RowKey& key : first.order) {
    const auto other = second.rows.find(key);
    if (other == second.rows.end()) continue;
    const RunTimes &before = first.rows.at(key), &after = other->second;
    nlohmann::json row = key.json();
    row["a_ms"] = before.json();
    row["b_ms"] = after.json();
    row["ratio"] = after.median_ms / std::max(before.median_ms, std::numeric_limits<double>::min());
    row["verdict"] = verdict(before, after);
    result["rows"].push_back(std::move(row));
  }
  return result;
}

std::string compare_text(const nlohmann::json& comparison) {
  std::string text;
  for (const char* side : {"a", "b"})
    text += printable(fmt::format("{}: {} ({}, greatx {})", side, comparison[side]["file"].get<std::string>(),
                                  comparison[side]["device"].get<std::string>(),
                                  comparison[side]["greatx"].get<std::string>())) +
            "\n";
  text += fmt::format("  {:<48} {:>30} {:>30} {:>7}\n", "", "a: median (min..max) ms",
                      "b: median (min..max) ms", "b / a");
  std::string differing;
  size_t count = 0;
  for (const nlohmann::json& row : comparison["rows"]) {
    text += compared_line(row);
    if (row["verdict"] != "slower" && row["verdict"] != "faster") continue;
    differing += compared_line(row);
    ++count;
  }
  for (const char* side : {"a", "b"})
    for (const nlohmann::json& row : comparison[fmt::format("only_{}", side)])
      text += fmt::format("  {:<48} only in {}\n", row_name(row), side);
  text += fmt::format("{} of {} rows differ by more than the spread of their runs\n", count,
                      comparison["rows"].size());
  return text + differing;
}

}  // namespace greatx::apps
