// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/lidar_bench.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "apps/bench/first_sensor.h"
#include "apps/bench/measure.h"
#include "apps/bench/sensor_alone.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/sensors/lidar/lidar_sensor.h"

namespace greatx::apps {

namespace {

constexpr const char* lidar_option = "--lidar";
/// Duration of a sweep in the rows with motion, if the scenario's LiDAR has none.
constexpr double spun_s = 0.1;
/// Divergence in the rows with rings, rad, if the scenario's LiDAR has none.
constexpr double divergence = 1.5e-3;
constexpr double noise_equivalent_power = 1e-8;

constexpr const char* effect_names[] = {
    "lidar_alpha_mask", "lidar_textures", "lidar_sweep_motion", "lidar_target_motion", "lidar_divergence",
    "lidar_glass",      "lidar_haze",     "lidar_backscatter",  "lidar_detection",     "lidar_range_noise"};

/// Describes what a row adds to the plain sweep.
struct LidarChange {
  std::string name;
  std::vector<std::string> effects;  ///< effects that the plan may switch on; the row measures the first one
  std::function<void(sim::LidarConfig&, sim::Environment&)> apply;
};

/// Returns a scan with all shots at the time of the tick. It has the elevations of the scenario's LiDAR if
/// their number is that of the options.
render::SpinningScan plain_scan(const render::Scan& own, const LidarBenchOptions& options) {
  render::SpinningScan scan;
  scan.azimuth_steps = options.azimuth_steps;
  const auto* spinning = std::get_if<render::SpinningScan>(&own);
  if (spinning != nullptr && spinning->elevations.size() == options.channels) {
    scan.elevations = spinning->elevations;
    return scan;
  }
  for (uint32_t i = 0; i < options.channels; ++i)
    scan.elevations.push_back(radians(-45.0 + 60.0 * i / std::max(1u, options.channels - 1)));
  return scan;
}

std::vector<LidarChange> changes(const sim::LidarConfig& own, const LidarBenchOptions& options) {
  const double sweep_s = render::duration_s(own.scan) > 0.0 ? render::duration_s(own.scan) : spun_s;
  const auto spin = [sweep_s](sim::LidarConfig& c) {
    std::get<render::SpinningScan>(c.scan).sweep_s = sweep_s;
  };
  const auto rings = [width = own.divergence > 0.0 ? own.divergence : divergence](sim::LidarConfig& c,
                                                                                  uint32_t count) {
    c.divergence = width;
    c.rings = count;
  };
  const auto detect = [](sim::LidarConfig& c) { c.receiver.detection = {noise_equivalent_power}; };
  const auto returns = [](render::ReturnMode mode) {
    return [mode](sim::LidarConfig& c, sim::Environment&) { c.returns.mode = mode; };
  };
  const auto nothing = [](sim::LidarConfig&, sim::Environment&) {};
  const auto fog = [](sim::Environment& e) { e.fog_g_m3 = std::max(e.fog_g_m3, 0.05); };
  return {
      {fmt::format("{} x {} single rays", options.channels, options.azimuth_steps), {}, nothing},
      {"holes of masks", {"lidar_alpha_mask"}, nothing},
      {"textures", {"lidar_textures"}, nothing},
      {"glass", {"lidar_glass"}, nothing},
      {"glass, all returns", {"lidar_glass"}, returns(render::ReturnMode::all)},
      {"shots at their own times", {"lidar_sweep_motion"}, [=](auto& c, auto&) { spin(c); }},
      {"bodies at their times too",
       {"lidar_target_motion", "lidar_sweep_motion"},
       [=](auto& c, auto&) { spin(c); }},
      {"1 ring, 7 rays", {"lidar_divergence"}, [=](auto& c, auto&) { rings(c, 1); }},
      {"1 ring, dual returns",
       {"lidar_divergence"},
       [=](auto& c, auto&) { rings(c, 1), c.returns.mode = render::ReturnMode::dual; }},
      {"1 ring, all returns",
       {"lidar_divergence"},
       [=](auto& c, auto&) { rings(c, 1), c.returns.mode = render::ReturnMode::all; }},
      {"2 rings, 19 rays", {"lidar_divergence"}, [=](auto& c, auto&) { rings(c, 2); }},
      {"detection", {"lidar_detection"}, [=](auto& c, auto&) { detect(c); }},
      {"noise of ranges",
       {"lidar_range_noise"},
       [](auto& c, auto&) { c.receiver.range_std_m = std::max(c.receiver.range_std_m, 0.01); }},
      {"fog", {"lidar_haze"}, [=](auto&, auto& e) { fog(e); }},
      {"fog's own echoes, detection",
       {"lidar_backscatter", "lidar_haze", "lidar_detection"},
       [=](auto& c, auto& e) { detect(c), fog(e); }},
  };
}

/// Returns the scenario with the plain sweep and one change. Every other effect is off.
sim::Scenario changed(sim::Scenario scenario, const sim::SensorPlace& place, const LidarChange& change,
                      const LidarBenchOptions& options) {
  auto& config = std::get<sim::LidarConfig>(scenario.nodes[place.node].sensors[place.sensor].config);
  const render::SpinningScan scan = plain_scan(config.scan, options);
  config.scan = scan;
  config.rings = 0;
  config.returns.mode = render::ReturnMode::strongest;
  config.receiver.detection.reset();
  config.receiver.range_std_m = config.receiver.rise_m = 0.0;
  scenario.environment.fog_g_m3 = scenario.environment.rain_mm_h = 0.0;
  for (const char* name : effect_names) scenario.effects[name] = sim::Switch::off;
  for (const std::string& name : change.effects) scenario.effects[name] = sim::Switch::automatic;
  change.apply(config, scenario.environment);
  return scenario;
}

/// One row: a LiDAR with its own experiment.
class LidarRow {
 public:
  LidarRow(gpu::Device& device, std::string name, sim::Experiment experiment, const sim::SensorPlace& place)
      : name_(std::move(name)), lidar_(device, std::move(experiment), place) {
    const auto& config =
        std::get<sim::LidarConfig>(lidar_.scenario().nodes[place.node].sensors[place.sensor].config);
    shots_ = render::scan_pattern(config.scan).size();
    rings_ = lidar_.plan().lidar_divergence.on ? config.rings : 0;
  }

  void shoot(const sim::Moment& moment, bool counts) {
    const double cpu_before = cpu_milliseconds();
    const Clock::time_point begin = Clock::now();
    const gpu::TickSlot& slot = lidar_.trace(moment);
    lidar_.sensor().collect(slot);
    if (!counts) return;
    times_.push_back(milliseconds_since(begin));
    cpu_.push_back(cpu_milliseconds() - cpu_before);
    returns_ += lidar_.sensor().scan().size();
  }

  nlohmann::json result() const {
    nlohmann::json row{{"name", name_},
                       {"tick_ms", distribution(times_)},
                       {"cpu_ms", distribution(cpu_)},
                       {"shots", shots_},
                       {"rays", 1 + 3 * rings_ * (rings_ + 1)},
                       {"returns", times_.empty() ? 0.0 : double(returns_) / double(times_.size())},
                       {"effects", nlohmann::json::array()}};
    for (const sim::Effect* effect : lidar_.plan().all())
      if (effect->on && effect->name.starts_with("lidar_")) row["effects"].push_back(effect->name);
    return row;
  }

 private:
  std::string name_;
  SensorAlone<sim::LidarSensor> lidar_;
  size_t shots_ = 0;
  uint32_t rings_ = 0;
  std::vector<double> times_, cpu_;
  uint64_t returns_ = 0;
};

class LidarBench {
 public:
  LidarBench(const ScenarioOptions& options, const RunOptions& run)
      : scenario_(first_sensor_alone<sim::LidarConfig>(load_scenario(options), lidar_option, "a LiDAR")),
        place_(first_sensor<sim::LidarConfig>(scenario_, lidar_option, "a LiDAR")),
        world_(std::make_shared<const sim::World>(sim::load_world(scenario_))),
        device_(run.device_options()) {}

  void add_rows(const LidarBenchOptions& options) {
    for (const LidarChange& change : changes(own(), options)) {
      sim::Experiment experiment = sim::make_experiment(changed(scenario_, place_, change, options), world_);
      if (!change.effects.empty()) {
        for (const sim::Effect* effect : experiment.plan.all())
          if (effect->name == change.effects[0] && !effect->on) left_out_[change.name] = effect->reason;
        if (left_out_.contains(change.name)) continue;
      }
      add(rows_.empty() ? change.name : "+ " + change.name, std::move(experiment));
    }
    add("as in the scenario", sim::make_experiment(scenario_, world_));
  }

  nlohmann::json measure(const LidarBenchOptions& options) {
    const auto warm = static_cast<uint32_t>(options.warm_up);
    const sim::Courses courses = sim::make_courses(scenario_, *world_, 0);
    const std::vector<sim::Moment> moments = moments_of(scenario_, *world_, courses, options.sweeps + warm);
    for (uint32_t i = 0; i < moments.size(); ++i)
      for (const auto& row : rows_) row->shoot(moments[i], i >= warm);
    return result();
  }
  const gpu::Device& device() const { return device_; }

 private:
  const sim::LidarConfig& own() const {
    return std::get<sim::LidarConfig>(scenario_.nodes[place_.node].sensors[place_.sensor].config);
  }
  void add(const std::string& name, sim::Experiment experiment) {
    rows_.push_back(std::make_unique<LidarRow>(device_, name, std::move(experiment), place_));
  }

  nlohmann::json result() const {
    const sim::NodeConfig& node = scenario_.nodes[place_.node];
    nlohmann::json result{{"scenario", scenario_.name},
                          {"device", device_.info().name},
                          {"driver", device_.info().driver},
                          {"lidar", node.name + "/" + node.sensors[place_.sensor].name},
                          {"triangles", world_->scene.triangle_count()},
                          {"rows", nlohmann::json::array()},
                          {"left_out", left_out_}};
    for (const auto& row : rows_) result["rows"].push_back(row->result());
    const double plain = result["rows"][0]["tick_ms"]["median"];
    for (nlohmann::json& row : result["rows"]) row["ratio"] = row["tick_ms"]["median"].get<double>() / plain;
    return result;
  }

  sim::Scenario scenario_;
  sim::SensorPlace place_;
  std::shared_ptr<const sim::World> world_;
  gpu::Device device_;
  std::vector<std::unique_ptr<LidarRow>> rows_;
  std::map<std::string, std::string> left_out_;
};

}  // namespace

nlohmann::json lidar_bench(const ScenarioOptions& scenario, const RunOptions& run,
                           const LidarBenchOptions& options) {
  LidarBench bench(scenario, run);
  bench.add_rows(options);
  nlohmann::json result = bench.measure(options);
  check_validation(bench.device());
  return result;
}

std::string lidar_bench_text(const nlohmann::json& result) {
  std::string text =
      fmt::format("{}, {}, {} triangles, on {} ({})\n{:<30} {:>8} {:>8} {:>8} {:>7} {:>7} {:>5} {:>8}\n",
                  result["scenario"].get<std::string>(), result["lidar"].get<std::string>(),
                  result["triangles"].get<size_t>(), result["device"].get<std::string>(),
                  result["driver"].get<std::string>(), "", "min ms", "median", "cpu ms", "ratio", "shots",
                  "rays", "returns");
  for (const nlohmann::json& row : result["rows"])
    text += fmt::format("{:<30} {:8.2f} {:8.2f} {:8.2f} {:7.2f} {:7} {:5} {:8.0f}\n",
                        row["name"].get<std::string>(), row["tick_ms"]["min"].get<double>(),
                        row["tick_ms"]["median"].get<double>(), row["cpu_ms"]["median"].get<double>(),
                        row["ratio"].get<double>(), row["shots"].get<size_t>(), row["rays"].get<uint32_t>(),
                        row["returns"].get<double>());
  for (const auto& [name, reason] : result["left_out"].items())
    text += fmt::format("left out: {} ({})\n", name, reason.get<std::string>());
  return text;
}

}  // namespace greatx::apps
