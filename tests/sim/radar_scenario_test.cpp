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

TEST(RadarScenario, WaveformsAreRead) {
  const rf::RadarWaveform ramps = radar_with("").signal.waveform;
  EXPECT_EQ(ramps.modulation, rf::RadarModulation::fmcw);
  EXPECT_EQ(ramps.multiplexing, rf::RadarMultiplexing::time);

  const rf::RadarWaveform steps =
      radar_with(
          ", waveform: {type: stepped, carrier_hz: 24e9, bandwidth_hz: 200e6, step_s: 2e-6, "
          "settle_s: 0.5e-6, steps: 100, interval_s: 250e-6, sweeps: 64}")
          .signal.waveform;
  EXPECT_EQ(steps.modulation, rf::RadarModulation::stepped);
  EXPECT_NEAR(steps.bandwidth_hz(), 200e6, 1e-3);
  EXPECT_NEAR(steps.range_span_m(), speed_of_light / (2 * 2e6), 1e-9);
  EXPECT_NEAR(steps.integration_s, 1.5e-6, 1e-18);
  EXPECT_NEAR(steps.latest_delay_s(), 0.5e-6, 1e-15);
  EXPECT_EQ(steps.interval_s, 250e-6);
  EXPECT_EQ(steps.slots, 4u * 64);

  const rf::RadarWaveform symbols =
      radar_with(
          ", waveform: {type: ofdm, spacing_hz: 1e6, subcarriers: 300, prefix_s: 0.4e-6, symbols: 96, "
          "multiplexing: ddm, empty_bands: 2}")
          .signal.waveform;
  EXPECT_EQ(symbols.modulation, rf::RadarModulation::ofdm);
  EXPECT_NEAR(symbols.bandwidth_hz(), 300e6, 1e-3);
  EXPECT_NEAR(symbols.interval_s, 1.4e-6, 1e-15);
  EXPECT_NEAR(symbols.slot_middle_s(0), 0.9e-6, 1e-15);
  EXPECT_NEAR(symbols.latest_delay_s(), 0.4e-6, 1e-15);
  EXPECT_EQ(symbols.multiplexing, rf::RadarMultiplexing::doppler);
  EXPECT_EQ(symbols.bands(), 6u);
  EXPECT_EQ(symbols.slots, 96u);
  EXPECT_NEAR(symbols.repetition_s(), 1.4e-6, 1e-15);

  const rf::RadarWaveform code =
      radar_with(
          ", waveform: {type: pmcw, chip_rate_hz: 1e9, code: apas, chips: 256, averages: 4, blocks: 32}")
          .signal.waveform;
  EXPECT_EQ(code.modulation, rf::RadarModulation::pmcw);
  EXPECT_EQ(code.code, rf::RadarCode::apas);
  EXPECT_NEAR(code.range_bin_m(), speed_of_light / 2e9, 1e-12);
  EXPECT_NEAR(code.interval_s, 5 * 256e-9, 1e-15);
  EXPECT_NEAR(code.latest_delay_s(), 256e-9, 1e-15);
  EXPECT_NEAR(code.noise_bandwidth_hz(), 0.25e9, 1e-3);
  EXPECT_EQ(code.slots, 4u * 32);
  EXPECT_EQ(radar_with(", waveform: {type: pmcw}").signal.waveform.samples, 511u);
}

TEST(RadarScenario, LeakageIsRead) {
  const auto leakage =
      radar_with(", receiver: {leakage: {level_db: -45, length_m: 0.3}}").signal.receiver.leakage;
  ASSERT_TRUE(leakage.has_value());
  EXPECT_EQ(leakage->level_db, -45.0);
  EXPECT_EQ(leakage->length_m, 0.3);
  EXPECT_FALSE(radar_with("").signal.receiver.leakage.has_value());
}

/// Returns a scenario with a radar on each of two nodes; the fields of the first begin in line 6.
Scenario two_radars(const std::string& first, const std::string& second = "") {
  return parse_scenario(R"(greatx: 1
name: radars
ticks: 2
scene: {generate: {kind: room}}
nodes:
  - {name: a, trajectory: {type: static, position_m: [0, 0, 0]}, )"
                        R"(sensors: [{name: radar, type: radar, rate_hz: 10)" +
                            first + R"(}]}
  - name: b
    trajectory: {type: static, position_m: [9, 0, 0]}
    sensors:
      - {name: horn, type: antenna}
      - {name: radar, type: radar, rate_hz: 10)" +
                            second + "}\n",
                        "radars.yaml", ".");
}

TEST(RadarScenario, InterferersAreNamed) {
  const auto interferers = [](const Scenario& scenario) {
    return std::get<RadarConfig>(scenario.nodes[0].sensors[0].config).interferers;
  };
  const std::vector<std::string> other{"b/radar"};
  EXPECT_TRUE(interferers(two_radars("")).empty());
  EXPECT_EQ(interferers(two_radars(", interference: {}")), other);
  EXPECT_EQ(interferers(two_radars(", interference: {radars: [b/radar]}")), other);
  const struct {
    const char *first, *second, *message;
  } cases[] = {
      {", interference: {radars: [b/radio]}", "",
       "radars.yaml:6: nodes[0].sensors[0].interference.radars: expected"},
      {", interference: {radars: [b/horn]}", "", "found 'b/horn', which is none"},
      {", interference: {radars: [a/radar]}", "", "found 'a/radar', which is the radar itself"},
      {", interference: {}", ", waveform: {type: ofdm}", "found 'b/radar' with another waveform"},
      {", interference: {}", ", illuminator: b/horn",
       "found 'b/radar', which does not transmit: 'b/horn' does"},
      {", waveform: {type: pmcw}, interference: {}", "",
       "nodes[0].sensors[0].interference: interference is modelled for waveform.type fmcw alone"},
      {", interference: {radars: []}", "", "interference.radars: expected a list of 1 or more radars"},
  };
  for (const auto& [first, second, message] : cases) {
    try {
      two_radars(first, second);
      ADD_FAILURE() << first << second;
    } catch (const UserError& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr(message));
    }
  }
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
      {", waveform: {type: chirped}", "waveform.type: expected one of fmcw, stepped, ofdm, pmcw"},
      {", waveform: {type: ofdm, chirp_s: 1e-6}", "nodes[1].sensors[0].waveform.chirp_s"},
      {", waveform: {type: pmcw, slope_hz_per_s: 1e12}", "nodes[1].sensors[0].waveform.slope_hz_per_s"},
      {", waveform: {steps: 64}", "nodes[1].sensors[0].waveform.steps"},
      {", waveform: {type: stepped, bandwidth_hz: 1e8, step_hz: 1e6}",
       "expected one of 'bandwidth_hz' and 'step_hz', found both"},
      {", waveform: {type: stepped, step_s: 1e-6, settle_s: 1e-6}",
       "radars.yaml:12: nodes[1].sensors[0].waveform.settle_s: expected less than the"},
      {", waveform: {type: stepped, interval_s: 1e-5}",
       "nodes[1].sensors[0].waveform.interval_s: expected at least the"},
      {", waveform: {type: stepped, step_hz: 2e9}",
       "waveform.step_hz: expected a band that stays above 0 Hz"},
      {", waveform: {type: ofdm, subcarriers: 8}", "waveform.subcarriers: expected an integer from 16"},
      {", waveform: {type: ofdm, interval_s: 2e-6}", "waveform.interval_s: expected at least the"},
      {", waveform: {type: pmcw, chips: 512}", "waveform.chips: expected 2^k - 1 chips of an m_sequence"},
      {", waveform: {type: pmcw, code: apas, chips: 512}",
       "waveform.chips: expected 2 (p + 1) chips of an apas code"},
      {", waveform: {type: pmcw, code: barker}", "waveform.code: expected one of m_sequence, apas"},
      {", waveform: {multiplexing: cdm}", "waveform.multiplexing: expected one of tdm, ddm"},
      {", waveform: {empty_bands: 2}", "waveform.empty_bands: only with multiplexing: ddm"},
      {", waveform: {multiplexing: ddm}", "waveform.chirps: expected a multiple of the 5 Doppler bands"},
      {", waveform: {type: ofdm, multiplexing: ddm}",
       "waveform.symbols: expected a multiple of the 5 Doppler bands (4 transmitters, 1 empty)"},
      {", waveform: {multiplexing: ddm, chirps: 128}, transmit: {columns: 1}",
       "waveform.multiplexing: expected two or more transmitters for ddm, found 1"},
      {", waveform: {type: ofdm}, receiver: {phase_noise: {}}",
       "receiver.phase_noise: expected none: phase noise is modelled for waveform.type fmcw alone"},
      {", waveform: {type: pmcw}, receiver: {adc: {}}",
       "receiver.adc: expected none with waveform.averages above 1"},
      {", receiver: {leakage: {length_m: 1}}", "receiver.leakage.level_db: expected a level"},
      {", receiver: {leakage: {level_db: 3}}", "receiver.leakage.level_db: expected"},
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
