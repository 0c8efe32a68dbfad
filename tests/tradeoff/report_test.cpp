// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of `greatx tradeoff` on crafted results, and the real program on a small scenario.
#include "apps/tradeoff/report.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "io/files/file.h"
#include "io/formats/png.h"
#include "tests/apps/program.h"
#include "tests/support/temporary_folder.h"

namespace greatx::apps {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

json setting(const std::string& label, double ms, std::optional<double> error, bool exact = false) {
  const json time{{"median", ms}, {"low", 0.99 * ms}, {"high", 1.01 * ms}, {"count", 4}};
  return {{"label", label},
          {"value", nullptr},
          {"tick_ms", time},
          {"cpu_ms", time},
          {"start_ms", 1.0},
          {"exact", exact},
          {"picture", ""},
          {"errors",
           {{{"sensor", "csi"},
             {"name", "nmse"},
             {"unit", "dB"},
             {"value", error ? json(*error) : json(nullptr)},
             {"meaning", "error of H(f)"}}}}};
}

json knob(std::vector<json> settings, const std::string& standard, const std::string& reference) {
  return {{"name", "max_depth"}, {"modality", "csi"}, {"about", "interactions <at most>"},
          {"context", ""},       {"unit", ""},        {"reference", reference},
          {"default", standard}, {"skipped", ""},     {"settings", std::move(settings)}};
}

json report_of(const json& knob) {
  return {{"format", 1},
          {"scenario", "made & up"},
          {"device", "cpu"},
          {"driver", "none"},
          {"cores", 2},
          {"greatx", "0"},
          {"quick", false},
          {"how", "by hand"},
          {"minutes", 1.0},
          {"knobs", {knob}},
          {"absent", {{{"name", "x"}, {"why", "y"}}}},
          {"fronts", json::array()}};
}

TEST(TradeoffWords, SayWhereToStop) {
  const std::string words = words_of_knob(knob({setting("1", 1.0, -10.0), setting("2", 2.0, -30.0),
                                                setting("3", 3.0, {}, true), setting("4", 6.0, {}, true)},
                                               "2", "4"));
  EXPECT_THAT(words, HasSubstr("Against 4, the default 2 has an error of -30 dB."));
  EXPECT_THAT(words, HasSubstr("1 takes 0.5 of the time (1 ms), and its error is -10 dB."));
  EXPECT_THAT(words, HasSubstr("Beyond 3 nothing changes: stop there."));
}

TEST(TradeoffWords, SayThatTheDefaultIsBeaten) {
  const std::string words = words_of_knob(
      knob({setting("a", 1.0, -40.0), setting("b", 2.0, -30.0), setting("c", 4.0, {}, true)}, "b", "c"));
  EXPECT_THAT(words, HasSubstr("The default could be a: it takes 0.5 of the time and is not worse."));
}

TEST(TradeoffWords, SayHowMuchLongerASettingTakes) {
  const std::string words = words_of_knob(
      knob({setting("1", 1.0, -10.0), setting("2", 1.04, -10.5), setting("3", 15.0, {}, true)}, "1", "3"));
  EXPECT_THAT(words, HasSubstr("2 takes about as long (1.04 ms), and its error is -10.5 dB."));
  EXPECT_THAT(words, HasSubstr("3 takes 15 times as long (15 ms), with the same records"));
}

TEST(TradeoffWords, SayThatNothingChanges) {
  const std::string words =
      words_of_knob(knob({setting("off", 1.0, {}, true), setting("on", 1.001, {}, true)}, "on", "on"));
  EXPECT_THAT(words, HasSubstr("all settings give the same records"));
  EXPECT_THAT(words, HasSubstr("does not change by more than its spread"));
  json skipped = knob({}, "", "");
  skipped["skipped"] = "no rain";
  EXPECT_EQ(words_of_knob(skipped), "It was not measured: no rain.");
}

/// Whether each tag is closed by its own end.
bool balanced(const std::string& html) {
  std::vector<std::string> open;
  for (size_t i = html.find('<'); i != std::string::npos; i = html.find('<', i + 1)) {
    if (html[i + 1] == '!') continue;
    const size_t end = html.find('>', i);
    const std::string tag = html.substr(i + 1, end - i - 1);
    if (tag.starts_with('/')) {
      if (open.empty() || open.back() != tag.substr(1)) return false;
      open.pop_back();
    } else if (!tag.ends_with('/')) {
      open.push_back(tag.substr(0, tag.find(' ')));
    }
  }
  return open.empty();
}

TEST(TradeoffReport, FilesOfAMadeUpStudy) {
  const greatx::test::TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "pictures");
  Array grey(DType::u8, {4, 4, 3});
  io::write_file_atomically(folder.path() / "pictures/a.png", io::encode_png(grey));
  grey.as<uint8_t>()[0] = 10;
  io::write_file_atomically(folder.path() / "pictures/b.png", io::encode_png(grey));
  json made = knob({setting("a", 1.0, -10.0), setting("b", 2.0, {}, true)}, "a", "b");
  made["settings"][0]["picture"] = "pictures/a.png";
  made["settings"][1]["picture"] = "pictures/b.png";
  write_report(report_of(made), folder.path());
  const std::string html = io::read_text_file(folder.path() / "index.html");
  EXPECT_TRUE(balanced(html));
  EXPECT_THAT(html, HasSubstr("made &amp; up"));
  EXPECT_THAT(html, HasSubstr("interactions &lt;at most&gt;"));
  EXPECT_THAT(html, HasSubstr("data:image/png;base64,iVBOR"));
  EXPECT_THAT(html, HasSubstr("a less the reference"));
  EXPECT_THAT(html, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  const std::string csv = io::read_text_file(folder.path() / "tradeoff.csv");
  EXPECT_THAT(csv, HasSubstr("csi,max_depth,,a,1,0,1,0.99,1.01,1,1,0,csi,nmse,dB,-10\n"));
  EXPECT_THAT(csv, HasSubstr("csi,max_depth,,b,0,1,2,1.98,2.02,2,1,1,csi,nmse,dB,-inf\n"));
  EXPECT_TRUE(balanced(io::read_text_file(folder.path() / "plots/csi-max_depth.svg")));
  EXPECT_TRUE(balanced(io::read_text_file(folder.path() / "overview.svg")));
}

TEST(TradeoffProgram, MeasuresKeepsAndGoesOn) {
  const greatx::test::TemporaryFolder folder;
  const std::string command =
      "tradeoff room --quick --only csi --knob max_depth,reflection -o " + folder.path().string();
  const test::Outcome first = test::greatx(command);
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.err, HasSubstr("csi max_depth"));
  const json before = json::parse(io::read_text_file(folder.path() / "tradeoff.json"));
  ASSERT_EQ(before["knobs"].size(), 2u);
  for (const json& measured : before["knobs"]) {
    EXPECT_GE(measured["settings"].size(), 2u);
    for (const json& row : measured["settings"]) EXPECT_GT(row["tick_ms"]["median"].get<double>(), 0.0);
  }
  EXPECT_TRUE(balanced(io::read_text_file(folder.path() / "index.html")));
  // What is measured is not measured again.
  const test::Outcome second = test::greatx(command);
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_THAT(second.err, Not(HasSubstr("max_depth")));
  EXPECT_EQ(json::parse(io::read_text_file(folder.path() / "tradeoff.json"))["knobs"], before["knobs"]);
  const test::Outcome other = test::greatx("tradeoff canyon --quick --only csi -o " + folder.path().string());
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.err, HasSubstr("results of another scenario"));
}

TEST(TradeoffWords, TimesOfMapsAreNotThoseOfTicks) {
  json made = knob({setting("2 m", 1.0, 1.0), setting("1 m", 1.001, {}, true)}, "2 m", "1 m");
  EXPECT_THAT(words_of_knob(made), HasSubstr("The time of a tick does not change"));
  made["timed"] = "map";
  EXPECT_THAT(words_of_knob(made), HasSubstr("The time of a map does not change"));
  EXPECT_THAT(plot_of_knob(made, "cpu"), HasSubstr("time of a map, ms"));
}

TEST(TradeoffProgram, MeasuresTheCellsOfRadioMaps) {
  const greatx::test::TemporaryFolder folder;
  const test::Outcome outcome =
      test::greatx("tradeoff canyon --quick --only map -o " + folder.path().string());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("map cell"));
  const json report = json::parse(io::read_text_file(folder.path() / "tradeoff.json"));
  ASSERT_EQ(report["knobs"].size(), 1u);
  const json& cell = report["knobs"][0];
  EXPECT_EQ(cell["modality"], "map");
  EXPECT_EQ(cell["timed"], "map");
  ASSERT_EQ(cell["settings"].size(), 4u) << cell["skipped"];
  for (const json& row : cell["settings"]) {
    EXPECT_EQ(row["errors"].size(), 3u);
    EXPECT_EQ(row["tick_ms"]["count"], 2);
    EXPECT_EQ(row["exact"], row["label"] == cell["reference"]);
    EXPECT_EQ(row["errors"][0]["value"] == 0.0, row["label"] == cell["reference"]) << row;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / row["picture"].get<std::string>()));
  }
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "plots/map-cell.svg"));
  const std::string csv = io::read_text_file(folder.path() / "tradeoff.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 4 * 3);
  EXPECT_THAT(csv, HasSubstr(",coverage,%,"));
  const std::string html = io::read_text_file(folder.path() / "index.html");
  EXPECT_TRUE(balanced(html));
  EXPECT_THAT(html, HasSubstr("<th>map, ms</th>"));
  EXPECT_THAT(html, HasSubstr("Path gain of the strongest transmitter"));
}

TEST(TradeoffProgram, NamesWhatIsWrong) {
  const greatx::test::TemporaryFolder folder;
  const std::string out = " -o " + folder.path().string();
  EXPECT_THAT(test::greatx("tradeoff room --only sonar" + out).err,
              HasSubstr("expected one of csi, camera, events"));
  EXPECT_THAT(test::greatx("tradeoff room --only radar" + out).err,
              HasSubstr("the scenario has no such sensor"));
  EXPECT_THAT(test::greatx("tradeoff room --knob depth" + out).err, HasSubstr("expected one of max_depth"));
}

}  // namespace
}  // namespace greatx::apps
