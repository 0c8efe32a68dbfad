// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/radar_bench.h"

#include <cmath>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "apps/bench/first_sensor.h"
#include "apps/bench/measure.h"
#include "apps/bench/sensor_alone.h"
#include "rf/radar/signal/receiver.h"
#include "rf/radar/signal/window.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/sensors/radar/radar_sensor.h"

namespace greatx::apps {

namespace {

constexpr const char* radar_option = "--radar";
constexpr double factors[] = {0.5, 1.0, 2.0, 4.0, 8.0}, reference_factor = 32.0;
constexpr uint32_t compared_every = 3;

using RadarChange = std::function<void(sim::RadarConfig&, sim::Scenario&)>;

sim::RadarConfig& radar_of(sim::Scenario& scenario, const sim::SensorPlace& place) {
  return std::get<sim::RadarConfig>(scenario.nodes[place.node].sensors[place.sensor].config);
}

/// Measures one row: a radar with its own experiment.
class RadarRow {
 public:
  RadarRow(gpu::Device& device, std::string name, sim::Experiment experiment, const sim::SensorPlace& place)
      : name_(std::move(name)), radar_(device, std::move(experiment), place) {}

  void shoot(const sim::Moment& moment, bool counts) {
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    const gpu::TickSlot& slot = radar_.trace(moment);
    const sim::RadarSensor::Echoes echoes = radar_.sensor().find_echoes(slot);
    const double cpu_echoes = cpu_milliseconds() - cpu_before;
    const Clock::time_point found = Clock::now();
    radar_.sensor().process(echoes);
    if (!counts) return;
    frame_.push_back(milliseconds_since(begin));
    signal_.push_back(milliseconds_since(found));
    echo_.push_back(std::chrono::duration<double, std::milli>(found - begin).count());
    cpu_.push_back(cpu_milliseconds() - cpu_before);
    cpu_echo_.push_back(cpu_echoes);
    for (const rf::EchoList& list : echoes.lists) echoes_ += list.echoes.size();
    detections_ += radar_.sensor().frame().detections.size();
  }
  /// Returns the range-Doppler map of the last frame, [range, velocity], W.
  const std::vector<float>& map() const { return radar_.sensor().frame().range_doppler; }

  nlohmann::json frame_result() const {
    return {{"name", name_},
            {"frame_ms", distribution(frame_)},
            {"echoes_ms", distribution(echo_)},
            {"signal_ms", distribution(signal_)},
            {"cpu_ms", distribution(cpu_)},
            {"echoes", mean(echoes_)},
            {"detections", mean(detections_)}};
  }
  nlohmann::json echo_result() const {
    std::map<std::string, uint64_t> counters;
    radar_.sensor().count(counters);
    const std::string& name = radar_.sensor().spec().name;
    const double tubes = double(counters.at(name + " ray tubes")) / double(counters.at(name + " frames"));
    return {{"tubes", tubes},
            {"echoes_ms", distribution(echo_)},
            {"cpu_ms", distribution(cpu_echo_)},
            {"echoes", mean(echoes_)}};
  }

 private:
  double mean(uint64_t sum) const { return frame_.empty() ? 0.0 : double(sum) / double(frame_.size()); }

  std::string name_;
  SensorAlone<sim::RadarSensor> radar_;
  std::vector<double> frame_, echo_, signal_, cpu_, cpu_echo_;
  uint64_t echoes_ = 0, detections_ = 0;
};

/// Multiplies the number of tubes by `factor`. The only output is the range-Doppler map,
/// without noise.
void refine(sim::RadarConfig& config, double factor) {
  const auto times = [&](uint32_t count) {
    return static_cast<uint32_t>(std::max(1.0, std::round(factor * count)));
  };
  config.echoes.tubes = times(config.echoes.tubes);
  config.echoes.max_echoes = times(config.echoes.max_echoes);
  config.updates = 1;
  config.signal.receiver = {};
  config.outputs = {.cube = false, .range_doppler = true, .range_azimuth = false, .detections = false};
  config.signal.processing.range_doppler = true;
  config.signal.processing.range_azimuth = config.signal.processing.detections = false;
}

/// Returns the noise power of a cell of the range-Doppler map, W: k T0 B F ENBW_r ENBW_d/(N M)
/// (docs/radar.md).
double cell_noise_w(const rf::RadarSignalConfig& signal) {
  const rf::RadarWaveform& waveform = signal.waveform;
  return rf::noise_power_w(waveform.noise_bandwidth_hz(), signal.receiver.noise_figure_db.value_or(0.0)) *
         rf::Window(signal.processing.range_window, waveform.samples).noise_bandwidth() *
         rf::Window(signal.processing.doppler_window, waveform.chirps()).noise_bandwidth() /
         (double(waveform.samples) * waveform.chirps());
}

class RadarBench {
 public:
  RadarBench(const ScenarioOptions& options, const RunOptions& run)
      : scenario_(first_sensor_alone<sim::RadarConfig>(load_scenario(options), radar_option, "a radar")),
        place_(first_sensor<sim::RadarConfig>(scenario_, radar_option, "a radar")),
        world_(std::make_shared<const sim::World>(sim::load_world(scenario_))),
        device_(run.device_options()) {}

  void add_rows() {
    const auto frame = [&](const char* name, const RadarChange& change) {
      frames_.push_back(row(name, change));
    };
    frame("as in the scenario", [](auto&, auto&) {});
    frame("1 bounce", [](auto& r, auto&) { r.echoes.max_bounces = 1; });
    frame("4 tracings a frame", [](auto& r, auto&) { r.updates = std::min(4u, r.signal.waveform.chirps()); });
    const auto no_clutter = [](sim::Scenario& s) { s.effects["radar_clutter"] = sim::Switch::off; };
    frame("without clutter", [=](auto&, auto& s) { no_clutter(s); });
    frame("no imperfections", [](auto& r, auto&) { r.signal.receiver = {}; });
    if (radar_of(scenario_, place_).signal.waveform.modulation == rf::RadarModulation::fmcw)
      frame("phase noise", [](auto& r, auto& s) {
        if (!r.signal.receiver.phase_noise) r.signal.receiver.phase_noise.emplace();
        s.effects["radar_phase_noise"] = sim::Switch::on;
      });
    frame("range-Doppler map alone", [](auto& r, auto&) {
      r.outputs = {.cube = false, .range_doppler = true, .range_azimuth = false, .detections = false};
      r.signal.processing.range_doppler = true;
      r.signal.processing.range_azimuth = r.signal.processing.detections = false;
    });
    // The number of tubes does not change the power of clutter, but which scatterers the maps would have.
    const auto echoes = [this, no_clutter](double factor) {
      return row("", [=](auto& r, auto& s) { refine(r, factor), no_clutter(s); });
    };
    for (const double factor : factors) echoes_.push_back(echoes(factor));
    reference_ = echoes(reference_factor);
    errors_.resize(echoes_.size());
  }

  nlohmann::json measure(const RadarBenchOptions& options) {
    const auto warm = static_cast<uint32_t>(options.warm_up);
    const sim::Courses courses = sim::make_courses(scenario_, *world_, 0);
    const std::vector<sim::Moment> moments = moments_of(scenario_, *world_, courses, options.frames + warm);
    for (uint32_t i = 0; i < moments.size(); ++i) {
      for (const auto& row : frames_) row->shoot(moments[i], i >= warm);
      for (const auto& row : echoes_) row->shoot(moments[i], i >= warm);
      if (i >= warm && (i - warm) % compared_every == 0) compare(moments[i]);
    }
    return result();
  }
  const gpu::Device& device() const { return device_; }

 private:
  std::unique_ptr<RadarRow> row(const char* name, const RadarChange& change) {
    sim::Scenario scenario = scenario_;
    change(radar_of(scenario, place_), scenario);
    return std::make_unique<RadarRow>(device_, name, sim::make_experiment(std::move(scenario), world_),
                                      place_);
  }

  void compare(const sim::Moment& moment) {
    reference_->shoot(moment, true);
    const double least_w = cell_noise_w(radar_of(scenario_, place_).signal);
    const std::vector<float>& truth = reference_->map();
    for (size_t cell = 0; cell < truth.size(); ++cell) {
      if (truth[cell] < least_w) continue;
      ++cells_;
      // An empty cell of a row counts as 1e-37 W, about the smallest normal float, so that the error is
      // finite.
      for (size_t r = 0; r < echoes_.size(); ++r)
        errors_[r].push_back(
            std::abs(10.0 * std::log10(std::max<double>(echoes_[r]->map()[cell], 1e-37) / truth[cell])));
    }
  }

  nlohmann::json result() {
    const sim::NodeConfig& node = scenario_.nodes[place_.node];
    const rf::RadarSignalConfig& signal = radar_of(scenario_, place_).signal;
    nlohmann::json result{{"scenario", scenario_.name},
                          {"device", device_.info().name},
                          {"driver", device_.info().driver},
                          {"radar", node.name + "/" + node.sensors[place_.sensor].name},
                          {"triangles", world_->scene.triangle_count()},
                          {"transmitters", signal.waveform.transmitters},
                          {"receivers", signal.arrays.receive_m.size()},
                          {"chirps", signal.waveform.chirps()},
                          {"samples", signal.waveform.samples},
                          {"reference_factor", reference_factor},
                          {"cells", cells_},
                          {"frames", nlohmann::json::array()},
                          {"echoes", nlohmann::json::array()}};
    for (const auto& row : frames_) result["frames"].push_back(row->frame_result());
    const double own = result["frames"][0]["frame_ms"]["median"];
    for (nlohmann::json& row : result["frames"]) row["ratio"] = row["frame_ms"]["median"].get<double>() / own;
    for (size_t r = 0; r < echoes_.size(); ++r) {
      nlohmann::json row = echoes_[r]->echo_result();
      row["factor"] = factors[r];
      std::vector<double>& errors = errors_[r];
      std::sort(errors.begin(), errors.end());
      if (!errors.empty()) {
        row["median_db"] = errors[errors.size() / 2];
        row["q90_db"] = errors[errors.size() * 9 / 10];
      }
      result["echoes"].push_back(std::move(row));
    }
    nlohmann::json finest = reference_->echo_result();
    finest["factor"] = reference_factor;
    result["echoes"].push_back(std::move(finest));
    return result;
  }

  sim::Scenario scenario_;
  sim::SensorPlace place_;
  std::shared_ptr<const sim::World> world_;
  gpu::Device device_;
  std::vector<std::unique_ptr<RadarRow>> frames_, echoes_;
  std::unique_ptr<RadarRow> reference_;
  std::vector<std::vector<double>> errors_;
  uint64_t cells_ = 0;
};

}  // namespace

nlohmann::json radar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const RadarBenchOptions& options) {
  RadarBench bench(scenario, run);
  bench.add_rows();
  nlohmann::json result = bench.measure(options);
  check_validation(bench.device());
  return result;
}

std::string radar_bench_text(const nlohmann::json& result) {
  std::string text = fmt::format(
      "{}, {}, {} x {} antennas, {} chirps x {} samples, {} triangles, on {} ({})\n",
      result["scenario"].get<std::string>(), result["radar"].get<std::string>(),
      result["transmitters"].get<int>(), result["receivers"].get<int>(), result["chirps"].get<int>(),
      result["samples"].get<int>(), result["triangles"].get<size_t>(), result["device"].get<std::string>(),
      result["driver"].get<std::string>());
  text += fmt::format("{:<26} {:>8} {:>8} {:>8} {:>8} {:>8} {:>6} {:>7} {:>10}\n", "whole frames", "min ms",
                      "median", "echoes", "signal", "cpu ms", "ratio", "echoes", "detections");
  const auto median = [](const nlohmann::json& row, const char* key) {
    return row[key]["median"].get<double>();
  };
  for (const nlohmann::json& row : result["frames"])
    text += fmt::format("{:<26} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:6.2f} {:7.0f} {:10.1f}\n",
                        row["name"].get<std::string>(), row["frame_ms"]["min"].get<double>(),
                        median(row, "frame_ms"), median(row, "echoes_ms"), median(row, "signal_ms"),
                        median(row, "cpu_ms"), row["ratio"].get<double>(), row["echoes"].get<double>(),
                        row["detections"].get<double>());
  text += fmt::format("{:<26} {:>8} {:>8} {:>8} {:>8} {:>9} {:>8}\n", "echoes alone, tubes", "min ms",
                      "median", "cpu ms", "echoes", "median dB", "90 % dB");
  for (const nlohmann::json& row : result["echoes"])
    text +=
        fmt::format("{:<26} {:8.2f} {:8.2f} {:8.2f} {:8.0f} {:>9} {:>8}\n",
                    fmt::format("{:.0f} (x {:g})", row["tubes"].get<double>(), row["factor"].get<double>()),
                    row["echoes_ms"]["min"].get<double>(), median(row, "echoes_ms"), median(row, "cpu_ms"),
                    row["echoes"].get<double>(),
                    row.contains("median_db") ? fmt::format("{:.2f}", row["median_db"].get<double>()) : "",
                    row.contains("q90_db") ? fmt::format("{:.2f}", row["q90_db"].get<double>()) : "");
  return text + fmt::format(
                    "dB: difference from the last row in {} cells of its range-Doppler maps above the "
                    "receiver's noise\n",
                    result["cells"].get<uint64_t>());
}

}  // namespace greatx::apps
