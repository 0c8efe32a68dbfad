// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tries every number of a scenario at the ends of its range and beyond. The result must be a run or an error
// that names file and line, never a broken contract, a crash or an endless allocation. The numbers are those
// of scenarios/sweep/*.yaml, which together contain everything that the schema knows.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <sys/resource.h>

#include <gtest/gtest.h>

#include "gpu/kept_pipelines.h"
#include "io/dataset/dataset_format.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "tests/sim/sweep_support.h"

namespace greatx::sim {
namespace {

namespace fs = std::filesystem;
using test::Number;

const fs::path folder = fs::path(GREATX_SCENARIOS) / "sweep";

std::string read(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_TRUE(stream) << file;
  return text.str();
}

std::vector<std::string> documents() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

const test::Ranges& schema() {
  static const test::Ranges ranges = test::ranges_of(nlohmann::json::parse(read(GREATX_SCHEMA)));
  return ranges;
}

std::string with(std::string text, const Number& number, const std::string& value) {
  return text.replace(number.at, number.length, value);
}

/// Returns what is wrong with the error that refused a text. An empty string means a UserError with file and
/// line.
std::string fault_of(const std::exception& error) {
  static const std::regex located(R"(sweep\.yaml:[0-9]+: [^]*)");
  if (dynamic_cast<const UserError*>(&error) == nullptr) return std::string("no UserError: ") + error.what();
  return std::regex_match(error.what(), located) ? "" : std::string("no file and line: ") + error.what();
}

/// Limits the address space, so that a runaway allocation throws bad_alloc and does not exhaust the machine.
void limit_memory() {
#if !defined(__SANITIZE_ADDRESS__)
  const struct rlimit limit { rlim_t{16} << 30, rlim_t{16} << 30 };
  setrlimit(RLIMIT_AS, &limit);
#endif
}

class Sweep : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { limit_memory(); }
  const std::string text_ = read(folder / (GetParam() + ".yaml"));
};

Experiment planned(const std::string& text) {
  return make_experiment(parse_scenario(text, "sweep.yaml", folder));
}

/// Does the same for a text with another number. Most numbers leave the world as it is, and it is not made
/// again then.
Experiment planned(const std::string& text, const Experiment& before) {
  return make_experiment(parse_scenario(text, "sweep.yaml", folder), before);
}

/// Returns whether an alternative of the schema holds the value, and true if the value is no number.
bool schema_holds(const std::vector<test::Range>& ranges, const std::string& value) {
  size_t end = 0;
  double number = 0.0;
  try {
    number = std::stod(value, &end);
  } catch (const std::exception&) {
    return true;
  }
  if (end != value.size() || !std::isfinite(number)) return true;
  return ranges.empty() || std::any_of(ranges.begin(), ranges.end(),
                                       [&](const test::Range& range) { return range.holds(number); });
}

TEST(SweepCoverage, DocumentsHaveEveryNumberOfTheSchema) {
  std::set<std::string> swept;
  for (const std::string& name : documents())
    for (const Number& number : test::numbers_of(read(folder / (name + ".yaml")))) swept.insert(number.name);
  ASSERT_GT(schema().size(), 150u);
  for (const auto& [name, ranges] : schema())
    EXPECT_TRUE(swept.count(name)) << name << ": no document of " << folder << " has it; add it to one";
  for (const std::string& name : swept) EXPECT_TRUE(schema().count(name)) << name << " is not in the schema";
}

TEST_P(Sweep, EveryEndIsAnErrorByNameOrAPlan) {
  std::optional<Experiment> whole;
  ASSERT_NO_THROW(whole = planned(text_));
  for (const Number& number : test::numbers_of(text_)) {
    const std::vector<test::Range>& ranges = schema().at(number.name);
    for (const std::string& value : test::ends_and_beyond(ranges)) {
      try {
        planned(with(text_, number, value), *whole);
        EXPECT_TRUE(schema_holds(ranges, value))
            << number.element << ": " << value << " is not in the schema";
      } catch (const std::exception& error) {
        EXPECT_EQ(fault_of(error), "") << number.element << ": " << value;
      }
    }
  }
}

/// Checks values as the writer of a data set does.
struct Check : RecordSink {
  std::vector<SensorSpec> sensors;
  void write(Packet packet) override {
    for (const Record& record : packet.records)
      for (size_t i = 0; i < record.arrays.size(); ++i) {
        const SensorSpec& sensor = sensors[record.sensor];
        const std::string bad = io::find_bad_value(sensor, sensor.arrays[i], record.arrays[i]);
        if (!bad.empty()) throw std::runtime_error(sensor.name + ": " + bad);
      }
  }
};

void run_a_tick(gpu::Device& device, Experiment experiment) {
  experiment.scenario.ticks = 1;
  Check sink;
  Simulator simulator(device, experiment);
  sink.sensors = simulator.sensors();
  simulator.start(0);
  while (simulator.step(sink)) {
  }
}

/// Returns whether a number is an integer. Integers are counts: the time and memory of their upper ends
/// follow from their meaning, which has bounds of its own.
bool is_count(const std::vector<test::Range>& ranges) {
  return std::any_of(ranges.begin(), ranges.end(), [](const test::Range& range) { return range.integer; });
}

/// Returns the least and the greatest value that give a plan.
std::vector<std::string> accepted_ends(const std::string& text, const Number& number,
                                       const Experiment& whole) {
  const std::vector<test::Range>& ranges = schema().at(number.name);
  std::map<double, std::string> accepted;
  for (const std::string& value : test::ends_and_beyond(ranges)) {
    size_t end = 0;
    double real = 0.0;
    try {
      real = std::stod(value, &end);
      if (end == value.size() && std::isfinite(real))
        planned(with(text, number, value), whole);
      else
        continue;
    } catch (const std::exception&) {
      continue;
    }
    accepted[real] = value;
  }
  std::vector<std::string> ends;
  if (!accepted.empty()) ends.push_back(accepted.begin()->second);
  if (accepted.size() > 1 && !is_count(ranges)) ends.push_back(accepted.rbegin()->second);
  return ends;
}

/// Returns whether a number is tried: every fourth one, or each if GREATX_SWEEP=all. Each run builds its own
/// simulator, which takes three minutes for all numbers.
bool chosen(size_t index) {
  const char* const sweep = std::getenv("GREATX_SWEEP");
  return (sweep != nullptr && std::string(sweep) == "all") || index % 4 == 0;
}

TEST_P(Sweep, AcceptedEndsRunATick) {
  gpu::Device device(gpu::DeviceOptions{});
  const gpu::KeptPipelines pipelines(device);  // most runs have the same ones
  std::optional<Experiment> whole;
  ASSERT_NO_THROW(whole = planned(text_));
  ASSERT_NO_THROW(run_a_tick(device, *whole));
  std::set<std::string> done;  // only the first item of a list is tried
  for (const Number& number : test::numbers_of(text_)) {
    if (!done.insert(number.name).second || !chosen(done.size())) continue;
    for (const std::string& value : accepted_ends(text_, number, *whole)) {
      try {
        run_a_tick(device, planned(with(text_, number, value), *whole));
      } catch (const std::exception& error) {
        EXPECT_EQ(fault_of(error), "") << number.element << ": " << value;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Numbers, Sweep, ::testing::ValuesIn(documents()),
                         [](const auto& document) { return document.param; });

}  // namespace
}  // namespace greatx::sim
