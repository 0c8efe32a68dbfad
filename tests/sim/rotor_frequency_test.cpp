// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// A rotor of two blades turns before a radar and before the two ends of a channel. Both must measure the same
// blade frequency and flashes at the same instants.
//
// The rotor is a bar with upright faces through its axle, seen edge-on from its own height. Each of its two
// broad faces flashes once a turn, when its normal n(t) = (cos, sin)(wt + p) points at the sensors, which lie
// at -x of the axle:
//   f = blades * rpm / 60,   t_k = (pi - p + k pi) / w.
// The mirror point is D sin(angle off the flash) from the middle of the bar. A flash lasts while this is less
// than half the bar's length. At t_k the path is shortest and its Doppler shift is zero.
//
// A tick is a chirp of the radar's one frame. Both sensors therefore sample at 1/interval_s over the same
// time T = chirps interval_s.
#include <algorithm>
#include <cmath>
#include <complex>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/units.h"
#include "scene/generator/mesh/materials.h"
#include "scene/generator/mesh/scene_writer.h"
#include "tests/support/kept_run.h"
#include "tests/support/temporary_folder.h"

namespace greatx::sim {
namespace {

using test::keep_run;
using test::KeptRun;

constexpr double rpm = 1433.0, phase_deg = 40.0, sample_hz = 1600.0, distance_m = 2.5, half_length_m = 0.5;
constexpr uint32_t blades = 2, samples = 256;
constexpr double blade_hz = blades * rpm / 60.0, span_s = samples / sample_hz;

/// Writes the rotor. The bar's faces look along its own +-y, so that its phase is that of its length. The
/// pole that carries it is out of sight.
std::filesystem::path write_rotor(const std::filesystem::path& folder) {
  using namespace scene::generator;
  SceneWriter writer;
  MeshBuilder bar, pole;
  bar.box(material("motor_metal"), {-half_length_m, -0.004, -0.05}, {half_length_m, 0.004, 0.05});
  pole.box(material("motor_metal"), {-0.05, -0.05, -5.0}, {0.05, 0.05, -1.5});
  const int root = writer.add_node({.name = "pole", .mesh = writer.add_mesh("pole", pole)});
  writer.add_node({.name = "rotor", .mesh = writer.add_mesh("rotor", bar), .parent = root});
  const std::vector<std::byte> glb = writer.finish("drive");
  std::ofstream(folder / "drive.glb", std::ios::binary)
      .write(reinterpret_cast<const char*>(glb.data()), static_cast<std::streamsize>(glb.size()));
  return folder / "drive.glb";
}

/// Returns the scenario. The two ends of the channel stand on both sides of the radar.
std::string scenario(const std::filesystem::path& model, const std::string& targets = "") {
  return fmt::format(
      "greatx: 1\nname: test\nseed: 5\nticks: {}\ntick_rate_hz: {}\nnodes:\n"
      "  - name: post\n    trajectory: {{type: static, position_m: [0, 0, 8]}}\n    sensors:\n"
      "      - name: radar\n        type: radar\n        rate_hz: 5\n"
      "        waveform: {{carrier_hz: 5e9, bandwidth_hz: 200e6, interval_s: {}, chirps: {}, samples: 16, "
      "sample_rate_hz: 2e6, chirp_s: 20e-6, adc_start_s: 2e-6}}\n"
      "        transmit: {{pattern: isotropic}}\n        receive: {{pattern: isotropic}}\n"
      "        field_of_view: {{azimuth_deg: [-14, 14], elevation_deg: [-3, 3]}}\n"
      "        echoes: {{tubes: 120, max_bounces: 1, updates: {}}}\n"
      "        outputs: [cube]\n"
      "      - {{name: tx, type: antenna, mount: {{position_m: [0, 0.05, 0]}}}}\n"
      "      - {{name: rx, type: antenna, mount: {{position_m: [0, -0.05, 0]}}}}\n"
      "  - name: drive\n    trajectory: {{type: static, position_m: [{}, 0, 8]}}\n"
      "    model: {{file: {}, parts: [{{nodes: rotor, rpm: {}, phase_deg: {}}}]}}\n"
      "channels:\n  - {{name: csi, tx: post/tx, rx: [post/rx], rate_hz: {}, carrier_hz: 5e9, subcarriers: 4, "
      "bandwidth_hz: 20e6, max_depth: 1{}}}\n"
      "effects: {{moving_reflectors: on, line_of_sight: off}}\n",
      samples, sample_hz, 1.0 / sample_hz, samples, samples, distance_m, model.string(), rpm, phase_deg,
      sample_hz, targets);
}

/// Returns the instants within the span at which a turning normal points at the sensors.
std::vector<double> expected_flashes() {
  // A face's normal is 90 degrees ahead of the bar, so that it first points at -x after 90 degrees less the
  // phase.
  std::vector<double> instants;
  for (double t = (90.0 - phase_deg) / 360.0 / (rpm / 60.0); t < span_s; t += 1.0 / blade_hz)
    instants.push_back(t);
  return instants;
}

/// Returns the first and the last tick of each run of ticks for which `seen` is true.
std::vector<std::pair<uint32_t, uint32_t>> runs_of(const std::vector<bool>& seen) {
  std::vector<std::pair<uint32_t, uint32_t>> runs;
  for (uint32_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) continue;
    if (i == 0 || !seen[i - 1]) runs.emplace_back(i, i);
    runs.back().second = i;
  }
  return runs;
}

/// Returns the instants at which the Doppler shift of the path over the rotor changes its sign, interpolated
/// linearly between ticks.
std::vector<double> flashes_of_doppler(const KeptRun& run) {
  std::vector<bool> seen(samples);
  std::vector<double> doppler(samples);
  for (uint32_t tick = 0; tick < samples; ++tick) {
    const auto paths = run.array<double>(tick, "csi", "doppler");
    seen[tick] = !paths.empty();
    if (seen[tick]) doppler[tick] = paths[0];
    EXPECT_LE(paths.size(), 1u) << "the ends of the bar are too narrow to be met by chance at tick " << tick;
  }
  std::vector<double> instants;
  for (const auto& [first, last] : runs_of(seen))
    for (uint32_t i = first; i < last; ++i)
      if (doppler[i] < 0.0 && doppler[i + 1] >= 0.0)
        instants.push_back((i + doppler[i] / (doppler[i] - doppler[i + 1])) / sample_hz);
  return instants;
}

/// Returns the power of each chirp of the one frame, summed over all range bins by Parseval's theorem.
std::vector<double> power_of_chirps(const KeptRun& run) {
  const auto cube = run.array<std::complex<float>>(0, "post/radar", "cube");
  std::vector<double> power(samples);
  for (size_t i = 0; i < cube.size(); ++i) power[i / (cube.size() / samples)] += std::norm(cube[i]);
  return power;
}

/// Returns the power |H|^2 of each tick, summed over the subcarriers.
std::vector<double> power_of_channel(const KeptRun& run) {
  std::vector<double> power(samples);
  for (uint32_t tick = 0; tick < samples; ++tick)
    for (const std::complex<float>& h : run.array<std::complex<float>>(tick, "csi", "cfr"))
      power[tick] += std::norm(std::complex<double>(h));
  return power;
}

/// Returns the middle of each run whose power exceeds a quarter of the greatest power.
std::vector<double> flashes_of_power(const std::vector<double>& power) {
  const double least = 0.25 * *std::ranges::max_element(power);
  std::vector<bool> seen;
  for (const double p : power) seen.push_back(p > least);
  std::vector<double> instants;
  for (const auto& [first, last] : runs_of(seen)) instants.push_back(0.5 * (first + last) / sample_hz);
  return instants;
}

double frequency_of(const std::vector<double>& instants) {
  return static_cast<double>(instants.size() - 1) / (instants.back() - instants.front());
}

/// Returns the frequency of the strongest spectral line between 2/T and a quarter of the sample rate. The
/// series is freed of its mean and weighted by a Hann window.
double strongest_line(const std::vector<double>& series) {
  std::vector<double> window(samples), value(samples);
  double mean = 0.0;
  for (uint32_t i = 0; i < samples; ++i) {
    window[i] = 1.0 - std::cos(2.0 * pi * i / samples);
    mean += window[i] * series[i] / samples;
  }
  for (uint32_t i = 0; i < samples; ++i) value[i] = window[i] * (series[i] - mean);
  const auto line = [&](double frequency_hz) {
    const std::complex<double> turn = std::polar(1.0, -2.0 * pi * frequency_hz / sample_hz);
    std::complex<double> sum = 0.0, phase = 1.0;
    for (const double v : value) sum += v * phase, phase *= turn;
    return std::norm(sum);
  };
  double best = 2.0 / span_s;
  for (double f = best; f < 0.25 * sample_hz; f += 0.25 / span_s)
    if (line(f) > line(best)) best = f;
  double low = best - 0.25 / span_s, high = best + 0.25 / span_s;
  for (int i = 0; i < 40; ++i) {
    const double a = low + (high - low) / 3.0, b = high - (high - low) / 3.0;
    (line(a) < line(b) ? low : high) = line(a) < line(b) ? a : b;
  }
  return 0.5 * (low + high);
}

void expect_instants(const std::vector<double>& found, double bound_s) {
  const std::vector<double> expected = expected_flashes();
  ASSERT_EQ(found.size(), expected.size());
  for (size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], bound_s) << "flash " << k;
}

/// Bounds:
/// - Zero of the Doppler shift: the mirror point's distance from the middle is odd about a flash, D (x - a
///   x^3) with a < 1 and the angle x. Between samples h = w/sample_hz = 0.094 rad apart the straight line
///   misses the zero by at most a h^3/(9 sqrt(3)) = 5.3e-5 rad, which is 0.36 us.
/// - Instants by power: a flash is symmetric. Its first and its last sample are each less than a sample from
///   its ends, so that their middle is less than half a sample from the flash.
/// - Frequency by n instants: twice the bound of one instant, divided by the time from the first to the last.
/// - Spectral lines: T resolves 1/T = 6.25 Hz. The window separates lines that are f = 7.6/T apart. One line
///   moves another by the slope of the Hann window's response at this distance over its curvature at the top,
///   (1/(7.6 (7.6^2 - 1)))/1.29 = 0.0018/T. Lines that sampling folds back lie halfway between (1600 Hz are
///   33.5 f), 3.8/T away. They move a line by 0.015/T times their strength, which is some 4 % (for pulses of
///   four samples, near the fourth null of their spectrum). One of each kind on both sides gives 0.005/T. The
///   test allows 0.01/T.
TEST(RotorBladeFrequency, IsTheSameInRadarAndChannel) {
  const test::TemporaryFolder folder;
  const KeptRun run = keep_run(scenario(write_rotor(folder.path())));
  const std::vector<double> by_doppler = flashes_of_doppler(run), chirps = power_of_chirps(run),
                            by_radar = flashes_of_power(chirps), channel = power_of_channel(run);
  const double doppler_s = 5e-7, radar_s = 0.5 / sample_hz;
  expect_instants(by_doppler, doppler_s);
  expect_instants(by_radar, radar_s);
  const double flashes_s = by_doppler.back() - by_doppler.front();
  const double relative_doppler = 2.0 * doppler_s / flashes_s, relative_radar = 2.0 * radar_s / flashes_s;
  EXPECT_NEAR(frequency_of(by_doppler), blade_hz, relative_doppler * blade_hz);
  EXPECT_NEAR(frequency_of(by_radar), blade_hz, relative_radar * blade_hz);
  EXPECT_NEAR(frequency_of(by_radar), frequency_of(by_doppler),
              (relative_radar + relative_doppler) * blade_hz);

  const double line_hz = 0.01 / span_s;  // 0.06 Hz
  EXPECT_NEAR(strongest_line(channel), blade_hz, line_hz);
  EXPECT_NEAR(strongest_line(chirps), blade_hz, line_hz);
  EXPECT_NEAR(strongest_line(chirps), strongest_line(channel), line_hz);
  EXPECT_NEAR(strongest_line(chirps), frequency_of(by_doppler), line_hz + relative_doppler * blade_hz);
}

/// Returns the power of each tick of the echoes of the bar alone, without the pole below it.
std::vector<double> power_of_bar(const KeptRun& run) {
  std::vector<double> power(samples);
  for (uint32_t tick = 0; tick < samples; ++tick) {
    const auto amplitude = run.array<std::complex<float>>(tick, "csi", "amplitude");
    const auto vertex = run.array<double>(tick, "csi", "vertex");
    const size_t row = amplitude.empty() ? 0 : vertex.size() / amplitude.size();  // one port at each end
    std::complex<double> sum = 0.0;
    for (size_t i = 0; i < amplitude.size(); ++i)
      if (std::abs(vertex[i * row + 2] - 8.0) < 0.2) sum += std::complex<double>(amplitude[i]);
    power[tick] = std::norm(sum);
  }
  return power;
}

/// A channel whose target is computed from its surfaces has the radar's own echoes in H: flashes at the same
/// instants and the same spectral lines, by ray tubes instead of mirror points.
TEST(RotorBladeFrequency, IsTheSameInTheEchoesOfATarget) {
  const test::TemporaryFolder folder;
  const KeptRun run = keep_run(
      scenario(write_rotor(folder.path()),
               ", targets: [{nodes: drive, tubes: {width_m: 0.02, budget: 20000, max_bounces: 1}}]"));
  const std::vector<double> chirps = power_of_chirps(run), channel = power_of_bar(run);
  expect_instants(flashes_of_power(channel), 0.5 / sample_hz);
  const double line_hz = 0.01 / span_s;
  EXPECT_NEAR(strongest_line(channel), blade_hz, line_hz);
  EXPECT_NEAR(strongest_line(channel), strongest_line(chirps), line_hz);
}

}  // namespace
}  // namespace greatx::sim
