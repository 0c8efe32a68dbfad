// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Every bad scenario of scenarios/bad_scenarios.json must give exactly its message at the right line. A bad
// scenario is a change to everything.yaml or to the file `base`, or a text of its own.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {
namespace {

const std::filesystem::path bad_folder = GREATX_SCENARIOS;

std::string read(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  EXPECT_TRUE(stream) << file;
  return text.str();
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

std::string scenario_refusal(const std::string& text) {
  try {
    parse_scenario(text, "s.yaml", bad_folder);
  } catch (const UserError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(BadScenarios, EachGivesItsMessageAndLine) {
  const std::string base = read(bad_folder / "everything.yaml");
  ASSERT_EQ(scenario_refusal(base), "accepted");
  const auto cases = nlohmann::json::parse(read(bad_folder / "bad_scenarios.json"));
  ASSERT_GT(cases.size(), 100u);
  for (const auto& bad : cases) {
    SCOPED_TRACE(bad["name"].get<std::string>());
    const std::string text =
        bad.contains("text")
            ? bad["text"].get<std::string>()
            : replaced(read(bad_folder / bad.value("base", "everything.yaml")), bad["replace"], bad["with"]);
    std::string message = bad["message"];
    if (message.find("{folder}") != std::string::npos)
      message = replaced(message, "{folder}", bad_folder.string());
    message = fmt::format("s.yaml:{}: {}", bad["line"].get<int>(), message);
    if (bad.value("prefix", false))  // the rest of the message is yaml-cpp's
      EXPECT_THAT(scenario_refusal(text), ::testing::StartsWith(message));
    else
      EXPECT_EQ(scenario_refusal(text), message);
  }
}

TEST(BadScenarios, MissingFileIsNamed) {
  try {
    load_scenario(bad_folder / "missing.yaml");
    FAIL() << "accepted";
  } catch (const UserError& error) {
    EXPECT_EQ(std::string(error.what()),
              (bad_folder / "missing.yaml").string() + ": expected a scenario file, found no such file");
  }
}

TEST(BadScenarios, FolderIsNoScenario) { EXPECT_THROW(load_scenario(bad_folder), UserError); }

TEST(BadScenarios, HostileBytesAreRefusedWithoutCrash) {
  const std::string base = read(bad_folder / "everything.yaml");
  EXPECT_THROW(parse_scenario(std::string("\0\xff\xfe greatx", 10), "s.yaml", bad_folder), UserError);
  EXPECT_THROW(parse_scenario(std::string(100000, '['), "s.yaml", bad_folder), UserError);
  EXPECT_THROW(parse_scenario("greatx: 1\nname: &a [*a]\nticks: 1\n", "s.yaml", bad_folder), UserError);
  // A scenario that is cut anywhere is either read or refused by a UserError.
  for (size_t length = 0; length < base.size(); length += 7) {
    try {
      parse_scenario(base.substr(0, length), "s.yaml", bad_folder);
    } catch (const UserError&) {
    }
  }
}

}  // namespace
}  // namespace greatx::sim
