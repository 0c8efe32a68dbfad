// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/contact_sheet.h"

#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/units.h"
#include "io/panels.h"
#include "io/png.h"
#include "io/summary.h"
#include "io/verify.h"
#include "tests/io/sample_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(Canvas, DrawsInsideItsClipOnly) {
  Canvas canvas(20, 10, {0, 0, 0});
  canvas.clip({5, 2, 4, 4});
  canvas.fill({0, 0, 20, 10}, {255, 0, 0});
  const Array image = canvas.image();
  int red = 0;
  for (size_t i = 0; i < image.bytes.size(); i += 3) red += image.as<uint8_t>()[i] == 255;
  EXPECT_EQ(red, 16);
}

TEST(Canvas, TextHasTheGlyphsDots) {
  Canvas canvas(20, 20, {0, 0, 0});
  canvas.text(0, 0, "!", 2, {255, 255, 255});  // one column of seven rows, the sixth empty
  const Array image = canvas.image();
  int white = 0;
  for (size_t i = 0; i < image.bytes.size(); i += 3) white += image.as<uint8_t>()[i] == 255;
  EXPECT_EQ(white, 6 * 4);
}

TEST(Canvas, PictureKeepsTheMeanWhenItShrinks) {
  Array rgb(DType::u8, {4, 4, 3});
  for (size_t i = 0; i < 48; ++i) rgb.as<uint8_t>()[i] = i / 3 % 2 == 0 ? 200 : 100;
  Canvas canvas(2, 2, {0, 0, 0});
  canvas.picture({0, 0, 2, 2}, rgb);
  const Array image = canvas.image();
  for (const uint8_t value : image.as<uint8_t>()) EXPECT_EQ(value, 150);
}

TEST(Plot, TicksAreRoundAndInside) {
  EXPECT_THAT((Scale{0.0, 1.0}.ticks(5)),
              testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}));
  EXPECT_THAT((Scale{-32.0, 41.0}.ticks(4)), ElementsAre(-20.0, 0.0, 20.0, 40.0));
  EXPECT_THAT((Scale{0.5, 60.0, true}.ticks(5)),
              testing::Pointwise(testing::DoubleNear(1e-9), {0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0}));
  EXPECT_EQ(round_down(73.0), 50.0);
  EXPECT_EQ(tick_text(0.0), "0");
}

TEST(Colors, NeighbouringIdsDiffer) {
  std::set<std::tuple<int, int, int>> colors;
  for (uint32_t id = 0; id < 100; ++id) {
    const Color c = color_of_id(id);
    colors.insert({c.r, c.g, c.b});
  }
  EXPECT_GT(colors.size(), 95u);
}

TEST(ContactSheet, ShowsASampleRun) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path() / "set", sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  const DatasetReader reader(folder.path() / "set");
  write_contact_sheet(reader, folder.path() / "set" / "contact_sheet.png", 1);
  const Array sheet = decode_png(read_file(folder.path() / "set" / "contact_sheet.png"), "sheet");
  EXPECT_EQ(sheet.bytes, contact_sheet(reader, 1).bytes);
  EXPECT_GT(sheet.shape[0], 800);
  EXPECT_GT(sheet.shape[1], 1200);
  EXPECT_TRUE(verify(folder.path() / "set").empty()) << "the sheet may lie beside the data";
  EXPECT_THROW(contact_sheet(reader, 2), UserError);
}

TEST(ContactSheet, WorksForAnySensorAlone) {
  for (size_t keep = 0; keep < 4; ++keep) {
    const test::TemporaryFolder folder;
    DatasetInfo info = sample_info();
    info.sensors = {info.sensors[keep]};
    {
      DatasetWriter writer(folder.path(), info);
      writer.begin_sequence(0);
      for (int64_t tick = 0; tick < info.ticks_per_sequence; ++tick) {
        Packet packet = sample_packet(sample_info(), 0, tick);
        std::erase_if(packet.records, [&](const Record& record) { return record.sensor != keep; });
        for (Record& record : packet.records) record.sensor = 0;
        writer.write(std::move(packet));
      }
      writer.flush();
    }
    EXPECT_GT(contact_sheet(DatasetReader(folder.path())).shape[1], 1000)
        << "an unfinished set, " << info.sensors[0].name;
  }
}

/// One path of known delay and amplitude: a line at that delay, |a| in dB, in the picture of |h|.
TEST(ContactSheet, ImpulseResponsePeaksAtTheDelay) {
  const test::TemporaryFolder folder;
  constexpr double spacing = 240e3, delay = 700e-9, amplitude = 1e-4;
  DatasetInfo info;
  info.ticks_per_sequence = 2;
  info.sensors = {{"link",
                   "csi",
                   "1000",
                   {{"cfr", DType::complex64, {1, 1, 1, 1, 1, 256}, "1", ""}},
                   {{"cfr", FileFormat::npy_stack, {"cfr"}}},
                   R"({"subcarrier_spacing_hz": 240000.0})"}};
  DatasetWriter writer(folder.path(), info);
  writer.begin_sequence(0);
  for (int64_t tick = 0; tick < 2; ++tick) {
    Array cfr(DType::complex64, {1, 1, 1, 1, 1, 256});
    for (int k = 0; k < 256; ++k)
      cfr.as<std::complex<float>>()[k] =
          std::complex<float>(std::polar(amplitude, -2.0 * pi * (k - 128) * spacing * delay));
    Packet packet{tick, tick * 1'000'000, {}};
    packet.records.push_back({0, tick, packet.time_ns, tick, {cfr}});
    writer.write(std::move(packet));
  }
  writer.end_sequence();
  writer.finish();
  const DatasetReader reader(folder.path());
  Panels panels;
  add_panels({reader, 0, 0, {}}, panels);
  ASSERT_EQ(panels.series.size(), 2u);
  Canvas canvas(600, 400, theme::page);
  panels.series[0]->draw(canvas, {0, 0, 600, 400});
  // The axis ends one eighth behind the last cell within 45 dB of the peak; the brightest row is the path's.
  const Array image = canvas.image();
  int brightest = -1, row = -1;
  const int top = 8 + theme::line_height, height = 400 - 16 - 4 * theme::line_height;
  for (int y = top; y < top + height; ++y) {
    const uint8_t* const pixel = image.as<uint8_t>().data() + (static_cast<size_t>(y) * 600 + 200) * 3;
    if (pixel[0] + pixel[1] > brightest) brightest = pixel[0] + pixel[1], row = y;
  }
  const double fraction = 1.0 - static_cast<double>(row - top) / height;
  // Hann's main lobe is +-2 / (256 spacing) = 32.6 ns wide; -45 dB is inside it. 4 * 256 cells of 4.07 ns to 1/spacing.
  const double end = 1.125 * (delay + 30e-9);
  EXPECT_NEAR(fraction * end, delay, 25e-9);
}

TEST(Summary, CountsWhatIsThere) {
  const test::TemporaryFolder folder;
  {
    DatasetWriter writer(folder.path(), sample_info());
    ASSERT_TRUE(write_sample_run(writer, sample_info()));
  }
  const Summary summary = summarize(DatasetReader(folder.path()));
  EXPECT_EQ(summary.title, "sample");
  EXPECT_TRUE(summary.finished);
  EXPECT_EQ(summary.records, 2 * 82);
  EXPECT_DOUBLE_EQ(summary.duration_s, 0.07);
  EXPECT_EQ(summary.sensors[0].records, 6);
  uint64_t bytes = 0;
  for (const auto& [path, text] : contents(folder.path())) bytes += path == "manifest.json" ? 0 : text.size();
  EXPECT_EQ(summary.bytes, bytes);
  EXPECT_THAT(to_text(summary), HasSubstr("uav/cam (camera, 30 Hz): 6 records"));
  EXPECT_THAT(to_text(summary), HasSubstr("cfr: npy_stack <c8 [1, 2, 1, 4, 1, 8]"));
  const nlohmann::json json = nlohmann::json::parse(to_json(summary));
  EXPECT_EQ(json["sensors"][3]["records"], 140);
  EXPECT_EQ(json["files"], summary.files);
}

}  // namespace
}  // namespace greatx::io
