// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Tests radars as written in scenarios.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/units.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/scenario.h"

namespace greatx::sim {
namespace {

/// Returns a scenario with an antenna and a radar whose fields begin in line 12.
Scenario scenario_with(const std::string& fields) {
  return parse_scenario(R"(greatx: 1
name: radars
ticks: 2
scene: {generate: {kind: room}}
nodes:
  - name: mast
    trajectory: {type: static, position_m: [0, 0, 0]}
    sensors:
      - {name: horn, type: antenna, pattern: tr38901, columns: 2}
      - {name: crossed, type: antenna, polarization: vh}
      - {name: eye, type: camera, rate_hz: 1, width: 4, height: 4, fov_deg: 60}
  - {name: car, trajectory: {type: static, position_m: [0, 0, 0]}, )"
                        R"(sensors: [{name: radar, type: radar, rate_hz: 10)" +
                            fields + "}]}\n",
                        "radars.yaml", ".");
}

RadarConfig radar_with(const std::string& fields) {
  return std::get<RadarConfig>(scenario_with(fields).nodes[1].sensors[0].config);
}

TEST(RadarScenario, NeedsNothingButARate) {
  const RadarConfig radar = radar_with("");
  EXPECT_EQ(radar.signal.waveform.slots, 4u * 128);
  EXPECT_EQ(radar.signal.arrays.transmit_m.size(), 4u);
  EXPECT_EQ(radar.signal.arrays.receive_m.size(), 4u);
  EXPECT_FALSE(radar.signal.bistatic || radar.outputs.cube || radar.see_own_body);
  EXPECT_TRUE(radar.outputs.range_doppler && radar.outputs.range_azimuth && radar.outputs.detections);
  // Sixteen virtual antennas stand in a row, half a wavelength apart.
  std::vector<double> row;
  for (const dvec3& t : radar.signal.arrays.transmit_m)
    for (const dvec3& r : radar.signal.arrays.receive_m) row.push_back(t.y + r.y);
  std::sort(row.begin(), row.end());
  for (size_t i = 1; i < row.size(); ++i)
    EXPECT_NEAR(row[i] - row[i - 1], 0.5 * radar.signal.waveform.wavelength_m(), 1e-12);
}

TEST(RadarScenario, EveryFieldIsRead) {
  const RadarConfig radar = radar_with(R"(,
      waveform: {carrier_hz: 79e9, bandwidth_hz: 1e9, chirp_s: 30e-6, interval_s: 40e-6, adc_start_s: 4e-6,
                 sample_rate_hz: 10e6, samples: 128, chirps: 32},
      transmit: {pattern: tr38901, columns: 2, column_spacing_wl: 2}, receive: {columns: 3, slant_deg: 45},
      power_dbm: 10, field_of_view: {azimuth_deg: [-20, 40], elevation_deg: [-5, 10]},
      echoes: {tubes: 500, max_bounces: 2, targets: [wall], updates: 4,
               diffuse_patch_m: 0.5, antenna_radius_m: 0.1, merge_share: 0.25, max_echoes: 77},
      receiver: {noise_figure_db: 12, phase_noise: {level_dbc_hz: -95, pole_hz: 2e6}, )"
                                       R"(adc: {bits: 10, full_scale_dbm: -20}},
      processing: {range_window: taylor, doppler_window: blackman, azimuths: 91, azimuth_limit_deg: 60,
                   cfar: {kind: ordered_statistic, false_alarm: 1e-4, )"
                                       R"(guard: [1, 0], train: [5, 3], rank: 0.5}},
      outputs: [cube, detections], see_own_body: true)");
  const rf::RadarSignalConfig& s = radar.signal;
  EXPECT_NEAR(s.waveform.bandwidth_hz(), 1e9, 1e-3);
  EXPECT_EQ(s.waveform.carrier_hz, 79e9);
  EXPECT_EQ(s.waveform.chirps(), 32u);
  EXPECT_EQ(s.waveform.slots, 64u);
  EXPECT_EQ(s.arrays.receive_m.size(), 3u);
  EXPECT_NEAR(s.transmit_power_w, 0.01, 1e-15);
  EXPECT_NEAR(radar.echoes.field_of_view.azimuth_max, radians(40.0), 1e-15);
  EXPECT_NEAR(radar.echoes.field_of_view.elevation_min, radians(-5.0), 1e-15);
  EXPECT_EQ(radar.echoes.tubes, 500u);
  EXPECT_EQ(radar.echoes.max_bounces, 2u);
  EXPECT_EQ(radar.echoes.merge_share, 0.25);
  EXPECT_EQ(radar.echoes.max_echoes, 77u);
  EXPECT_EQ(radar.targets, std::vector<std::string>{"wall"});
  EXPECT_EQ(radar.updates, 4u);
  EXPECT_EQ(s.receiver.noise_figure_db, 12.0);
  EXPECT_EQ(s.receiver.phase_noise->level_dbc_hz, -95.0);
  EXPECT_EQ(s.receiver.adc->bits, 10u);
  EXPECT_EQ(s.processing.range_window, rf::RadarWindow::taylor);
  EXPECT_EQ(s.processing.cfar.kind, rf::RadarCfar::Kind::ordered_statistic);
  EXPECT_EQ(s.processing.cfar.train_doppler, 3u);
  EXPECT_TRUE(radar.outputs.cube && radar.outputs.detections && radar.see_own_body);
  EXPECT_FALSE(radar.outputs.range_doppler || s.processing.range_doppler);
}

TEST(RadarScenario, AnotherNodesAntennaMayIlluminate) {
  const RadarConfig radar = radar_with(", illuminator: mast/horn");
  EXPECT_TRUE(radar.signal.bistatic);
  EXPECT_EQ(radar.signal.arrays.transmit_m.size(), 2u);
  EXPECT_EQ(radar.signal.waveform.slots, 2u * 128);
  EXPECT_EQ(radar.transmit.pattern.shape, rf::Pattern::tr38901);
}

TEST(RadarScenario, FaultsAreNamedWithTheirLine) {
  const struct {
    const char *fields, *message;
  } cases[] = {
      {", waveform: {chirp_s: 70e-6}",
       "radars.yaml:12: nodes[1].sensors[0].waveform.chirp_s: expected a chirp no longer"},
      {", waveform: {samples: 500}",
       "nodes[1].sensors[0].waveform.samples: expected samples that fit the chirp"},
      {", waveform: {bandwidth_hz: 1e9, slope_hz_per_s: 1e12}",
       "expected one of 'bandwidth_hz' and 'slope_hz_per_s', found both"},
      {", waveform: {carrier_hz: 0}",
       "nodes[1].sensors[0].waveform.carrier_hz: expected a number greater than 0, found '0'"},
      {", waveform: {bandwith_hz: 1e9}", "did you mean 'bandwidth_hz'"},
      {", transmit: {polarization: vh}", "nodes[1].sensors[0].transmit: expected one polarization"},
      {", transmit: {columns: 1024, rows: 2}, receive: {rows: 4}", "expected at most 4096 virtual antennas"},
      {", field_of_view: {azimuth_deg: [10, -10]}",
       "field_of_view.azimuth_deg: expected the lower angle first"},
      {", echoes: {max_bounces: 7}", "echoes.max_bounces: expected an integer from 1 to 6"},
      {", echoes: {updates: 129}", "echoes.updates: expected at most one for each of the 128 chirps"},
      {", receiver: {noise_figure_db: -1}", "receiver.noise_figure_db: expected"},
      {", receiver: {noise_figure_db: 201}", "receiver.noise_figure_db: expected 0 to 200 dB"},
      {", receiver: {phase_noise: {level_dbc_hz: 65536}}",
       "level_dbc_hz: expected -300 to 0 dBc/Hz, found 65536"},
      {", receiver: {adc: {full_scale_dbm: 65536}}", "full_scale_dbm: expected -200 to 200 dBm, found 65536"},
      {", waveform: {sample_rate_hz: 1e20}", "waveform.sample_rate_hz: expected at most 1e+12 Hz"},
      {", waveform: {slope_hz_per_s: 1e-20}",
       "slope_hz_per_s: expected a ramp that covers 0.001 Hz at least"},
      {", processing: {cfar: {train: [300, 4]}}",
       "processing.cfar.train_range: expected guard and training cells within"},
      {", processing: {cfar: {false_alarm: 0.5}}",
       "processing.cfar.false_alarm: expected above 0 and at most 0.1"},
      {", outputs: []", "nodes[1].sensors[0].outputs: expected a list of 1 or more outputs"},
      {", illuminator: mast/horn, transmit: {columns: 2}",
       "expected one of 'illuminator' and 'transmit', found both"},
      {", illuminator: mast/trumpet",
       "radars.yaml:12: nodes[1].sensors[0].illuminator: expected an antenna of one "
       "polarization as node/sensor, found unknown 'mast/trumpet'"},
      {", illuminator: mast/eye", "found 'mast/eye', which is none"},
      {", illuminator: mast/crossed", "found 'mast/crossed' with two"},
  };
  for (const auto& [fields, message] : cases) {
    try {
      scenario_with(fields);
      ADD_FAILURE() << fields;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(message));
    }
  }
}

}  // namespace
}  // namespace greatx::sim
