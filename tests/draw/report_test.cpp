// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The data of the page against the data set that it shows: each value within the bound that docs/report.md
// states.
#include "draw/report/report.h"

#include <cmath>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "io/dataset/verify.h"
#include "tests/draw/report_run.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const std::string hostile = "</script><img src=x onerror=alert(1)>'\"&amp;\xe2\x80\xae";

class Report : public testing::Test {
 protected:
  DatasetReader made(const std::string& name = "plain", uint32_t sequences = 1, int64_t packets = 0) {
    write_report_run(folder_.path() / "set", report_info(name, sequences), packets);
    return DatasetReader(folder_.path() / "set");
  }
  static ReadReport page_of(const DatasetReader& reader, const ReportOptions& options = {}) {
    ReportFile file;
    ReadReport page(html_report(reader, options, file));
    EXPECT_EQ(file.bytes, page.html.size());
    EXPECT_EQ(json(file.notes), page.data["notes"]);
    return page;
  }
  const test::TemporaryFolder folder_;
};

/// The pixel at which the page's camera sees a place of the page, by docs/camera.md and docs/film.md.
dvec2 pixel_in(const json& about, const json& pose, const json& place) {
  const auto number = [](const json& list, size_t i) { return list[i].get<double>(); };
  const Pose camera{{number(pose, 0), number(pose, 1), number(pose, 2)},
                    dquat(number(pose, 3), number(pose, 4), number(pose, 5), number(pose, 6))};
  const dvec3 at = camera.inverse().apply({number(place, 0), number(place, 1), number(place, 2)});
  const double x = -at.y / at.x, y = -at.z / at.x, s = x * x + y * y;
  const json& lens = about["distortion"];
  const double radial = 1.0 + s * (number(lens, 0) + s * (number(lens, 1) + s * number(lens, 4)));
  const double p1 = number(lens, 2), p2 = number(lens, 3);
  return {about["cx"].get<double>() +
              about["fx"].get<double>() * (x * radial + 2.0 * p1 * x * y + p2 * (s + 2.0 * x * x)),
          about["cy"].get<double>() +
              about["fy"].get<double>() * (y * radial + p1 * (s + 2.0 * y * y) + 2.0 * p2 * x * y)};
}

TEST_F(Report, PathsMeetTheCamerasPixels) {
  const ReadReport page = page_of(made());
  const json& eye = page.sensor("node/eye");
  size_t compared = 0;
  for (const json& record : page.sensor("csi")["records"]) {
    const json paths = page.text(record["paths"]["blob"]);
    ASSERT_EQ(paths.size(), 1u);
    EXPECT_NEAR(paths[0][2].get<double>(), 200.0, 1e-3) << "delay, ns";
    EXPECT_NEAR(paths[0][3].get<double>(), -80.0, 0.01) << "power, dB, the mean of three ports";
    EXPECT_EQ(paths[0][5], json({1})) << "a reflection";
    const auto seen =
        std::ranges::find(eye["records"], record["tick"], [](const json& r) { return r["tick"]; });
    ASSERT_NE(seen, eye["records"].end());
    // A millimetre at 30 m is 0.0014 pixels.
    const dvec2 pixel = pixel_in(eye["about"], (*seen)["pose"], paths[0][6]);
    EXPECT_LT(glm::length(pixel - run_pixel(record["tick"])), 0.005) << record["tick"];
    ++compared;
  }
  EXPECT_EQ(compared, 20u);
}

TEST_F(Report, PlacesAreFromAnOriginNearby) {
  const ReadReport page = page_of(made());
  const json& sequence = page.data["sequences"][0];
  EXPECT_EQ(sequence["origin"], json({450000.0, 5400000.0, 30.0}));
  for (const json& entry : sequence["poses"])
    EXPECT_LT(std::abs(entry["poses"][0][0].get<double>()), 100.0) << "UTM coordinates are taken off";
  EXPECT_EQ(page.data["objects"][0][2], 1 - 450000);
}

TEST_F(Report, DepthIsWithinATenthOfAPercent) {
  const ReadReport page = page_of(made());
  for (const json& record : page.sensor("node/eye")["records"]) {
    const json& depth = record["depth"];
    ASSERT_EQ(depth["by"], 1);
    const auto codes = page.numbers(depth["blob"], 2, run_width, run_width * run_height);
    for (size_t i = 0; i < codes.size(); ++i) {
      const double truth = run_depth(record["tick"], i);
      if (!std::isfinite(truth))
        ASSERT_EQ(codes[i], 0u);
      else
        ASSERT_NEAR(
            depth["low"].get<double>() * std::pow(depth["ratio"].get<double>(), codes[i] - 1.0) / truth, 1.0,
            0.00101);
    }
  }
}

TEST_F(Report, IdsAreExact) {
  const ReadReport page = page_of(made());
  const json& ids = page.sensor("node/eye")["records"][5]["instance"];
  const auto codes = page.numbers(ids["blob"], ids["bytes"], 0, run_width * run_height);
  for (size_t i = 0; i < codes.size(); ++i) ASSERT_EQ(codes[i], i % 3 == 0 ? 1u : 0u);
  EXPECT_EQ(page.data["names"]["instance"], json({{"1", {"plain", "plain"}}}));
}

TEST_F(Report, PointsAreWithinHalfAStep) {
  const ReadReport page = page_of(made());
  const json& records = page.sensor("node/lidar")["records"];
  EXPECT_EQ(records.size(), 10u);
  for (const json& record : records) {
    const json& points = record["points"];
    const size_t count = points["count"];
    ASSERT_EQ(count, 500u);
    const double step = points["step"], ratio = record["intensity"]["ratio"],
                 low = record["intensity"]["low"];
    EXPECT_GE(step, 0.001);
    EXPECT_LE(step, 0.006) << "170 m by 16 bits";
    const auto codes = page.numbers(points["blob"], 2, count, 3 * count);
    const auto levels = page.numbers(record["intensity"]["blob"], 2, 0, count);
    const auto ids = page.numbers(record["instance"]["blob"], 4, 0, count);
    for (size_t i = 0; i < count; ++i) {
      const vec4 truth = run_point(record["tick"], i);
      for (size_t c = 0; c < 3; ++c)
        ASSERT_NEAR(step * static_cast<int16_t>(codes[c * count + i]), truth[static_cast<int>(c)],
                    0.5001 * step);
      ASSERT_NEAR(low * std::pow(ratio, levels[i] - 1.0) / double{truth.w}, 1.0, 0.00501);
      ASSERT_EQ(ids[i], i % 2);
    }
  }
}

TEST_F(Report, PowersAreWithinHalfAStep) {
  const ReadReport page = page_of(made());
  for (const json& record : page.sensor("node/radar")["records"]) {
    const json& map = record["range_doppler"];
    ASSERT_EQ(map["by"], json({1, 1}));
    const auto codes = page.numbers(map["blob"], 1, 0, 40 * 30);
    const double step = map["step"], low = map["low"];
    EXPECT_LT(step, 0.5);
    for (size_t i = 0; i < codes.size(); ++i) {
      const double truth = 10.0 * std::log10(double{run_power(record["tick"], i)}) + 30.0;
      if (codes[i] == 0)
        ASSERT_LE(truth, low + step);
      else
        ASSERT_NEAR(low + step * codes[i], truth, 0.5001 * step);
    }
  }
}

TEST_F(Report, ResponsesAreWithinHalfAStep) {
  const ReadReport page = page_of(made());
  for (const json& record : page.sensor("csi")["records"]) {
    const json& link = record["links"][0];
    const size_t n = link["n"], pairs = link["pairs"].size();
    ASSERT_EQ(n, 32u);
    ASSERT_EQ(pairs, 3u);
    const auto codes = page.numbers(link["blob"], 2, n, 2 * pairs * n);
    const auto mean = page.numbers(link["mean"]["blob"], 2, n, n);
    const double step = link["step"];
    EXPECT_LE(step, 1e-4 / 32767.0 * 1.0001);
    for (size_t k = 0; k < n; ++k) {
      double power = 0.0;
      for (size_t port = 0; port < pairs; ++port) {
        const std::complex<double> truth(run_response(record["tick"], port, k));
        const auto value = [&](size_t half) {
          return step * (double(codes[half * pairs * n + port * n + k]) - 32768.0);
        };
        ASSERT_NEAR(value(0), truth.real(), 0.5001 * step);
        ASSERT_NEAR(value(1), truth.imag(), 0.5001 * step);
        power += std::norm(truth) / static_cast<double>(pairs);
      }
      const json& code = link["mean"];
      ASSERT_NEAR(code["low"].get<double>() * std::pow(code["ratio"].get<double>(), mean[k] - 1.0) / power,
                  1.0, 0.00252);
    }
  }
}

TEST_F(Report, NamesCannotLeaveTheirPlaces) {
  const ReadReport page = page_of(made(hostile));
  // Only the page's own elements: the JSON, a blob each, and one script.
  size_t scripts = 0, blobs = 0;
  for (size_t at = 0; (at = page.html.find("<script", at)) != std::string::npos; ++at) ++scripts;
  for (size_t at = 0; (at = page.html.find("<script type=\"text/plain\"", at)) != std::string::npos; ++at)
    ++blobs;
  EXPECT_EQ(scripts, blobs + 2);
  EXPECT_THAT(page.html, Not(HasSubstr("<img")));
  EXPECT_THAT(page.html, Not(HasSubstr("onerror=alert(1)>")));
  EXPECT_THAT(page.html, Not(HasSubstr("\xe2\x80\xae"))) << "a mark that turns the direction of writing";
  const std::string shown = "</script><img src=x onerror=alert(1)>'\"&amp;\\u202e";
  EXPECT_EQ(page.data["names"]["instance"]["1"], json({shown, shown}));
  EXPECT_EQ(page.data["summary"]["title"], shown);
  EXPECT_THAT(page.data["summary"]["scenario"].get<std::string>(), HasSubstr("alert(1)</script>"));
}

TEST_F(Report, NothingMayBeLoaded) {
  const ReadReport page = page_of(made());
  EXPECT_THAT(page.html,
              HasSubstr("default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'sha256-"));
  for (const char* const word :
       {"http://", "https://", "@import", "url(", "fetch(", "XMLHttpRequest", "innerHTML", "eval("})
    EXPECT_THAT(page.html, Not(HasSubstr(word)));
}

TEST_F(Report, StaysWithinItsBoundAndSaysSo) {
  const DatasetReader reader = made("plain", 2);
  const ReadReport whole = page_of(reader);
  EXPECT_EQ(whole.data["sequences"].size(), 2u);
  EXPECT_EQ(whole.data["sequences"][1]["moments"].size(), static_cast<size_t>(run_ticks));
  for (const double megabytes : {0.9, 0.6, 0.4, 0.3}) {
    const ReadReport page = page_of(reader, {.megabytes = megabytes});
    EXPECT_LE(static_cast<double>(page.html.size()), 1e6 * megabytes);
    for (const json& sequence : page.data["sequences"]) {
      const json& moments = sequence["moments"];
      EXPECT_EQ(moments.front()[0], 0);
      if (moments.size() > 1) {
        EXPECT_EQ(moments.back()[0], run_ticks - 1);
      }
      if (moments.size() < static_cast<size_t>(run_ticks)) {
        EXPECT_THAT(page.data["notes"].dump(),
                    HasSubstr(std::to_string(moments.size()) + " of 40 ticks with records are shown"));
      }
    }
  }
  EXPECT_LT(page_of(reader, {.megabytes = 0.3}).data["sequences"][0]["moments"].size(), 40u);
  EXPECT_THROW(page_of(reader, {.megabytes = 0.1}), UserError);
}

TEST_F(Report, ShowsTheLatestRecordOfSlowSensors) {
  const ReadReport page = page_of(made(), {.moments = 8});
  const json& sequence = page.data["sequences"][0];
  ASSERT_EQ(sequence["moments"].size(), 8u);
  for (const auto& [name, every] : {std::pair{"node/eye", 1}, {"node/radar", 2}, {"node/lidar", 4}}) {
    std::set<int64_t> ticks;
    for (const json& record : page.sensor(name)["records"]) ticks.insert(record["tick"].get<int64_t>());
    std::set<int64_t> wanted;
    for (const json& moment : sequence["moments"]) wanted.insert(moment[0].get<int64_t>() / every * every);
    EXPECT_EQ(ticks, wanted) << name;
  }
}

TEST_F(Report, IsTheSameWhereverTheDataSetLies) {
  const ReadReport first = page_of(made()), again = page_of(DatasetReader(folder_.path() / "set"));
  EXPECT_EQ(first.html, again.html);
  std::filesystem::rename(folder_.path() / "set", folder_.path() / "moved");
  EXPECT_EQ(page_of(DatasetReader(folder_.path() / "moved")).html, first.html);
}

TEST_F(Report, ReplacesOnlyAReport) {
  const DatasetReader reader = made();
  const std::filesystem::path file = folder_.path() / "set" / "report.html";
  const ReportFile written = write_html_report(reader, file, {});
  EXPECT_EQ(std::filesystem::file_size(file), written.bytes);
  EXPECT_TRUE(verify(folder_.path() / "set").empty()) << "the report may lie beside the data";
  EXPECT_NO_THROW(write_html_report(reader, file, {}));
  const std::filesystem::path other = folder_.path() / "mine.html";
  std::ofstream(other) << "<!DOCTYPE html>\n<p>my own page, which is longer than the mark of a report";
  EXPECT_THROW(write_html_report(reader, other, {}), UserError);
  EXPECT_EQ(read_text_file(other).substr(0, 30), "<!DOCTYPE html>\n<p>my own page");
  std::filesystem::create_symlink(other, folder_.path() / "link.html");
  EXPECT_THROW(write_html_report(reader, folder_.path() / "link.html", {}), UserError);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "mine.html.part"));
}

TEST_F(Report, ShowsAnUnfinishedRun) {
  const ReadReport page = page_of(made("plain", 2, 11));
  EXPECT_FALSE(page.data["summary"]["finished"]);
  ASSERT_EQ(page.data["sequences"].size(), 1u);
  EXPECT_EQ(page.data["sequences"][0]["moments"].size(), 11u);
}

TEST_F(Report, ShowsAnySensorAlone) {
  const DatasetInfo all = sample_info();
  for (size_t keep = 0; keep < all.sensors.size(); ++keep) {
    DatasetInfo info = all;
    info.sensors = {all.sensors[keep]};
    info.sequences = 1;
    const std::filesystem::path place = folder_.path() / std::to_string(keep);
    {
      DatasetWriter writer(place, info);
      writer.begin_sequence(0);
      for (int64_t tick = 0; tick < info.ticks_per_sequence; ++tick) {
        Packet packet = sample_packet(all, 0, tick);
        std::erase_if(packet.records, [&](const Record& record) { return record.sensor != keep; });
        for (Record& record : packet.records) record.sensor = 0;
        if (!packet.records.empty()) writer.write(std::move(packet));
      }
      writer.end_sequence();
      writer.finish();
    }
    const ReadReport page = page_of(DatasetReader(place));
    EXPECT_EQ(page.data["sequences"][0]["sensors"][0]["name"], info.sensors[0].name);
  }
}

TEST_F(Report, RefusesASequenceWithoutRecords) {
  const DatasetReader reader = made();
  EXPECT_THROW(page_of(reader, {.sequence = 1}), UserError);
}

}  // namespace
}  // namespace greatx::io
