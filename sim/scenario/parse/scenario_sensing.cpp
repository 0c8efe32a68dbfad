// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the block `sensing` of a channel.
#include <algorithm>
#include <cmath>

#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

void parse_cells(const Field& where, const ChannelConfig& channel, const rf::RadarCfar& cfar) {
  if (!(cfar.false_alarm <= 0.1))
    where.fail("cfar.false_alarm above 0 and at most 0.1", fmt::format("{}", cfar.false_alarm));
  if (!(cfar.rank > 0.0)) where.fail("cfar.rank above 0 and at most 1", fmt::format("{}", cfar.rank));
  if (cfar.train_range == 0) where.fail("at least one training cell in range (cfar.train)", "0");
  const uint64_t range = uint64_t{cfar.guard_range} + cfar.train_range,
                 doppler = uint64_t{cfar.guard_doppler} + cfar.train_doppler;
  if (range >= channel.subcarriers)
    where.fail(fmt::format("guard and training cells (cfar) within the {} subcarriers, which are range bins",
                           channel.subcarriers),
               fmt::format("{} on each side", range));
  if (2 * doppler + 1 > channel.time_samples)
    where.fail(
        fmt::format("guard and training cells (cfar) within the {} time_samples, which are velocity bins",
                    channel.time_samples),
        fmt::format("{} on each side", doppler));
}

}  // namespace

void parse_sensing(const FieldMap& of_channel, ChannelConfig& channel) {
  const auto field = of_channel.find("sensing");
  if (!field) return;
  const FieldMap map(*field,
                     {"power_dbm", "noise_figure_db", "adc", "leakage", "clutter_removal", "range_window",
                      "doppler_window", "azimuths", "azimuth_limit_deg", "cfar", "outputs"});
  rf::SensingConfig& sensing = channel.sensing.emplace();
  constexpr uint32_t most = 65536;  // as many as chirps and samples of a radar
  if (channel.time_samples < 4)
    field->fail("at least 4 time_samples of the channel, which are its symbols",
                fmt::format("{}", channel.time_samples));
  if (channel.subcarriers < 4)
    field->fail("at least 4 subcarriers of the channel", fmt::format("{}", channel.subcarriers));
  if (std::max(channel.time_samples, channel.subcarriers) > most)
    field->fail(fmt::format("at most {} time_samples and as many subcarriers of the channel", most),
                fmt::format("{} and {}", channel.time_samples, channel.subcarriers));
  const auto power = map.find("power_dbm");
  if (!power && !channel.power_dbm) field->fail("a 'power_dbm' here or of the channel", "none");
  const double power_dbm = power ? power->between(-200.0, 200.0) : *channel.power_dbm;
  sensing.power_w = 1e-3 * std::pow(10.0, 0.1 * power_dbm);
  if (const auto f = map.find("noise_figure_db")) sensing.noise_figure_db = f->between(0.0, 200.0);
  if (const auto f = map.find("adc")) {
    sensing.adc = parse_adc(*f);
    if (std::abs(sensing.adc->full_scale_dbm) > 200.0)
      f->fail("full_scale_dbm from -200 to 200", fmt::format("{}", sensing.adc->full_scale_dbm));
  }
  if (const auto f = map.find("leakage")) {
    const FieldMap leakage(*f, {"level_db", "delay_s"});
    sensing.leakage_db =
        leakage.require("level_db", "a level, dB of the transmitted power").between(-300.0, 0.0);
    if (const auto g = leakage.find("delay_s")) sensing.leakage_delay_s = g->between(0.0, 1.0);
  }
  if (const auto f = map.find("clutter_removal"))
    sensing.remove_static = f->choice({"static_mean", "none"}) == 0;
  if (const auto f = map.find("range_window")) sensing.range_window = parse_window(*f);
  if (const auto f = map.find("doppler_window")) sensing.doppler_window = parse_window(*f);
  if (const auto f = map.find("azimuths")) sensing.azimuths = f->integer32(2, 4096);
  if (const auto f = map.find("azimuth_limit_deg")) sensing.azimuth_limit = radians(f->between(0.1, 180.0));
  if (const auto f = map.find("cfar")) parse_cfar(*f, sensing.cfar);
  if (const auto f = map.find("outputs")) {
    sensing.range_doppler = sensing.range_azimuth = sensing.detections = false;
    bool* const outputs[] = {&sensing.range_doppler, &sensing.range_azimuth, &sensing.detections};
    for (const Field& item : f->list("outputs", 1))
      *outputs[item.choice({"range_doppler", "range_azimuth", "detections"})] = true;
  }
  if (sensing.detections) parse_cells(*field, channel, sensing.cfar);
}

}  // namespace greatx::sim
