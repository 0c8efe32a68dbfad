// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Which links of channels are shown, and that a panel shows the link that it names.
#include "draw/sheet/channel_links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "draw/sheet/sheet_tiles.h"
#include "io/dataset/dataset_writer.h"
#include "tests/support/temporary_folder.h"

namespace greatx::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr int64_t receivers = 3, transmitters = 2, subcarriers = 32;

/// The gain of a link: that of receiver 2 from transmitter 0 is the largest.
float gain_of(int64_t rx, int64_t tx) {
  return rx == 2 && tx == 0 ? 1e-6f : 1e-9f * static_cast<float>(1 + rx + tx);
}

DatasetInfo links_info() {
  DatasetInfo info;
  info.tick_rate = "10";
  info.ticks_per_sequence = 4;
  const auto channel = [](const char* name) {
    return SensorSpec{
        name,
        "csi",
        "10",
        {{"cfr", DType::complex64, {receivers, 1, transmitters, 2, 1, subcarriers}, "1", ""},
         {"path_gain", DType::f64, {receivers, transmitters}, "1", ""}},
        {{"cfr", FileFormat::npy_stack, {"cfr"}}, {"path_gain", FileFormat::npy_stack, {"path_gain"}}},
        R"({"subcarrier_spacing_hz": 1e6, "non_finite": ["path_gain"],
        "transmitters": [{"name": "mast/panel"}, {"name": "roof/panel"}],
        "receivers": [{"name": "van/antenna"}, {"name": "uav/front"}, {"name": "uav/rear"}]})"};
  };
  info.sensors = {channel("low"), channel("high")};
  return info;
}

class LinksOfChannels : public testing::Test {
 protected:
  void SetUp() override {
    DatasetWriter writer(folder_.path(), links_info());
    writer.begin_sequence(0);
    for (int64_t tick = 0; tick < 4; ++tick) {
      Packet packet{tick, tick * 100'000'000, {}};
      for (uint32_t sensor = 0; sensor < 2; ++sensor) {
        Array cfr(DType::complex64, {receivers, 1, transmitters, 2, 1, subcarriers}),
            gain(DType::f64, {receivers, transmitters});
        for (int64_t rx = 0; rx < receivers; ++rx)
          for (int64_t tx = 0; tx < transmitters; ++tx) {
            gain.as<double>()[static_cast<size_t>(rx * transmitters + tx)] =
                rx == 0 && tx == 1 ? std::nan("") : double{gain_of(rx, tx)};
            for (int64_t port = 0; port < 2; ++port)
              for (int64_t k = 0; k < subcarriers; ++k)
                cfr.as<std::complex<float>>()[static_cast<size_t>(
                    ((rx * transmitters + tx) * 2 + port) * subcarriers + k)] =
                    std::sqrt(gain_of(rx, tx)) * static_cast<float>(k < subcarriers / 2 ? 1.0 : 0.1);
          }
        packet.records.push_back({sensor, tick, packet.time_ns, tick, {cfr, gain}});
      }
      writer.write(std::move(packet));
    }
    writer.end_sequence();
    writer.finish();
  }
  std::vector<std::string> titles(const std::vector<std::string>& wishes) const {
    const DatasetReader reader(folder_.path());
    const std::vector<size_t> all = shown_sensors(reader, {});
    std::vector<std::string> names;
    for (const Panels& panels :
         panels_by_sensor(reader, 0, all, choose_moments(reader, 0, all, 4), {.ids = "", .links = wishes}))
      for (const auto& panel : panels.series) names.push_back(panel->title());
    return names;
  }
  std::string fault(const std::vector<std::string>& wishes) const {
    try {
      titles(wishes);
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }
  const test::TemporaryFolder folder_;
};

TEST_F(LinksOfChannels, TheStrongestOfEachChannelIsShown) {
  EXPECT_THAT(
      titles({}),
      ElementsAre("low |h| over delay, mast to uav/rear", "low |H| over frequency, mast to uav/rear",
                  "high |h| over delay, mast to uav/rear", "high |H| over frequency, mast to uav/rear"));
}

TEST_F(LinksOfChannels, NamesNodesAndNumbersChoose) {
  EXPECT_THAT(
      titles({"high:mast:van", "high:1:1", "high:roof/panel:uav/front"}),
      ElementsAre("high |h| over delay, mast to van", "high |H| over frequency, mast to van",
                  "high |h| over delay, roof to uav/front", "high |H| over frequency, roof to uav/front"))
      << "a link that two wishes name is there once";
  EXPECT_EQ(titles({"mast:van"}).size(), 4u) << "both channels have it";
}

TEST_F(LinksOfChannels, WhatIsNotThereIsNamed) {
  EXPECT_THAT(fault({"mast"}), HasSubstr("expected TX:RX or CHANNEL:TX:RX, as in bs:uav, found 'mast'"));
  EXPECT_THAT(fault({"a:b:c:d"}), HasSubstr("found 'a:b:c:d'"));
  EXPECT_THAT(fault({"mast:uav"}),
              HasSubstr("no channel has the link 'mast:uav'; channel low has the "
                        "transmitters mast/panel, roof/panel and the receivers van/antenna"))
      << "uav has two antennas";
  EXPECT_THAT(fault({"mast:7"}), HasSubstr("no channel has the link 'mast:7'"));
  EXPECT_THAT(fault({"middle:mast:van"}), HasSubstr("no channel has the link"));
}

/// The values of the plot are those of the link: half of the band is 20 dB below the other.
TEST_F(LinksOfChannels, ThePlotIsThatOfTheLink) {
  const DatasetReader reader(folder_.path());
  for (const auto& [wish, rx, tx] : {std::tuple("low:0:0", 0, 0), std::tuple("low:1:2", 2, 1)}) {
    Panels panels;
    add_panels({reader, 0, 0, {}}, panels, {.ids = "", .links = {wish}});
    ASSERT_EQ(panels.series.size(), 2u);
    Canvas canvas(600, 400, dark_theme());
    panels.series[1]->draw(canvas, {0, 0, 600, 400});
    // The highest value of the colour scale is |H|^2 in dB, within a tick's distance.
    double highest = -1e9;
    for (const DrawnText& text : canvas.texts())
      if (text.rect.x > 600 - 92 && text.text != "dB") highest = std::max(highest, std::stod(text.text));
    const double level = 10.0 * std::log10(gain_of(rx, tx));
    EXPECT_LE(highest, level + 0.01) << wish;
    EXPECT_GT(highest, level - 5.01) << wish;
  }
}

}  // namespace
}  // namespace greatx::io
