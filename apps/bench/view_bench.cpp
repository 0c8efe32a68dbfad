// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/view_bench.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <thread>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "apps/bench/measure.h"
#include "apps/bench/view_drivers.h"
#include "apps/bench/view_start.h"
#include "apps/console/command_line.h"
#include "core/error.h"
#include "io/dataset/dataset_writer.h"
#include "io/files/file.h"
#include "sim/dataset/dataset_info.h"
#include "sim/run/simulator.h"
#include "sim/scenario/parse/load_scenario.h"
#include "view/app/viewer.h"

namespace greatx::apps {

namespace {

// What the viewer should reach on two cores with lavapipe.
constexpr double least_pictures_per_s = 20.0, most_latency_ms = 100.0, most_slow_down = 15.0,
                 most_start_s = 2.5, least_scrubbed_per_s = 15.0;

double median(std::vector<double> samples) { return distribution(std::move(samples))["median"]; }

/// The value that the share `share` of the samples does not exceed.
double quantile(std::vector<double> samples, double share) {
  std::sort(samples.begin(), samples.end());
  return samples[std::min(samples.size() - 1, static_cast<size_t>(share * double(samples.size())))];
}

/// Notes when each packet came.
class Times : public RecordSink {
 public:
  void write(Packet packet) override { times_.push_back({packet.tick, Clock::now(), cpu_milliseconds()}); }
  const std::vector<TickTime>& times() const { return times_; }

 private:
  std::vector<TickTime> times_;
};

/// Returns the wall time of a tick between two ticks that both have shown, ms.
double tick_ms(const std::vector<TickTime>& times, int64_t first, int64_t last) {
  const auto at = [&](int64_t tick) { return std::ranges::find(times, tick, &TickTime::tick)->at; };
  return std::chrono::duration<double, std::milli>(at(last) - at(first)).count() / double(last - first);
}

/// Returns the processor time of a tick, ms.
double tick_cpu_ms(const std::vector<TickTime>& times, int64_t first, int64_t last) {
  const auto at = [&](int64_t tick) { return std::ranges::find(times, tick, &TickTime::tick)->cpu_ms; };
  return (at(last) - at(first)) / double(last - first);
}

bool has(const std::vector<TickTime>& times, int64_t tick) {
  return std::ranges::find(times, tick, &TickTime::tick) != times.end();
}

class ViewBench {
 public:
  ViewBench(const ScenarioOptions& scenario, const RunOptions& run, const ViewBenchOptions& options)
      : scenario_options_(scenario), run_(run), options_(options), scenario_(load_scenario(scenario)) {
    if (scenario_.ticks < options_.warm_up + 2)
      throw_user_error("{}: bench --view: expected {} ticks at least, {} to warm up and two, found {}",
                       scenario_.name, options_.warm_up + 2, options_.warm_up, scenario_.ticks);
    std::tie(width_, height_) = parse_window_size(options_.size);
    options_.block = std::min(options_.block, scenario_.ticks - options_.warm_up - 1);
    options_.scrub_ticks = std::clamp<int64_t>(options_.scrub_ticks, 2, scenario_.ticks);
    std::filesystem::create_directories(scratch_.path());
  }

  nlohmann::json measure() {
    const gpu::DeviceInfo device = gpu::Device(run_.device_options()).info();
    measure_start();
    measure_orbit();
    measure_live();
    measure_scrubbing();
    return {{"scenario", scenario_.name},
            {"device", device.name},
            {"driver", device.driver},
            {"cores", std::thread::hardware_concurrency()},
            {"width", width_},
            {"height", height_},
            {"rows", rows_}};
  }

 private:
  void add(const std::string& name, double value, const char* unit) {
    rows_.push_back({{"name", name}, {"value", value}, {"unit", unit}});
  }
  void add_least(const std::string& name, double value, const char* unit, double least) {
    add(name, value, unit);
    rows_.back()["least"] = least;
    rows_.back()["met"] = value >= least;
  }
  void add_most(const std::string& name, double value, const char* unit, double most) {
    add(name, value, unit);
    rows_.back()["most"] = most;
    rows_.back()["met"] = value <= most;
  }

  view::ViewerOptions viewer(ViewDriver& driver) const {
    view::ViewerOptions viewer;
    viewer.title = scenario_.name;
    viewer.scenario = [options = scenario_options_] { return load_scenario(options); };
    viewer.scenario_of = [this](const std::string& text, const std::filesystem::path& dataset) {
      return sim::parse_scenario(text, "scenario.yaml", dataset, scenario_options_.assets);
    };
    viewer.device = run_.device_options();
    viewer.window.width = width_;
    viewer.window.height = height_;
    viewer.window.offscreen = viewer.window.wall_clock = true;
    viewer.window.validation = run_.validation;
    viewer.window.device = run_.device;
    viewer.driver = [&driver](const view::ScriptHost& host) { return driver.after_frame(host); };
    return viewer;
  }

  void measure_start() {
    const std::filesystem::path script = scratch_.path() / "script.txt";
    io::write_file_atomically(script, "wait scene\nprint tick\nwait picture\nprint tick\n");
    std::vector<std::string> arguments{"view",        scenario_options_.scenario,
                                       "--offscreen", "--paused",
                                       "--script",    script.string(),
                                       "--size",      options_.size};
    const auto option = [&](const char* name, const std::string& value) {
      if (!value.empty()) arguments.insert(arguments.end(), {name, value});
    };
    option("--assets", scenario_options_.assets);
    option("--seed", scenario_options_.seed ? std::to_string(*scenario_options_.seed) : "");
    option("--ticks", scenario_options_.ticks ? std::to_string(*scenario_options_.ticks) : "");
    option("--device", run_.device);
    option("--tracer", std::string(gpu::name_of(run_.tracer)));
    std::vector<double> first, full;
    for (uint32_t i = 0; i < options_.starts; ++i) {
      const std::vector<double> times = times_of_lines(arguments);
      if (times.size() != 2) throw std::runtime_error("bench: the viewer's process showed no picture");
      first.push_back(times[0]);
      full.push_back(times[1]);
    }
    add_most("from the start to the first picture, median", median(first), "s", most_start_s);
    add("from the start to the picture at full quality, median", median(full), "s");
  }

  void measure_orbit() {
    OrbitDriver driver(width_, height_, options_.seconds, options_.drags);
    view::ViewerOptions viewer = this->viewer(driver);
    viewer.paused = true;
    view::run_viewer(viewer);
    add_least("orbit, all overlays: new pictures of the scene", driver.pictures_per_s(), "/s",
              least_pictures_per_s);
    add("orbit, all overlays: frames of the window", driver.frames_per_s(), "/s");
    add("orbit, all overlays: drawing a picture, median", median(driver.picture_ms()), "ms");
    const auto latency = [this](const std::string& name, const std::vector<double>& ms) {
      add_most(name + ", median", median(ms), "ms", most_latency_ms);
      add_most(name + ", 95th percentile", quantile(ms, 0.95), "ms", most_latency_ms);
      add_most(name + ", worst", quantile(ms, 1.0), "ms", most_latency_ms);
    };
    latency("from a drag at rest to its picture", driver.resting_ms());
    latency("from a motion of a drag to its picture", driver.moving_ms());
  }

  int64_t last_tick() const { return options_.warm_up + options_.block; }
  /// Ends with the last tick that is measured, which the window shows for certain.
  ScenarioOptions block_options() const {
    ScenarioOptions options = scenario_options_;
    options.ticks = last_tick() + 1;
    options.sequences = 1;
    return options;
  }

  std::vector<TickTime> headless() const {
    const sim::Experiment experiment = sim::make_experiment(load_scenario(block_options()));
    gpu::Device device(run_.device_options());
    sim::Simulator simulator(device, experiment);
    simulator.start(0);
    Times times;
    while (simulator.step(times)) continue;
    simulator.drain(times);
    check_validation(device);
    return times.times();
  }

  /// What the turns of a live run with one kind of window have taken.
  struct Live {
    bool every_tick = false;
    std::vector<double> alone, shown, slow_down, alone_cpu, shown_cpu;
    double pictures = 0.0, frames = 0.0;  ///< for each tick, means
  };

  std::vector<TickTime> windowed(Live& live) const {
    FollowDriver driver(last_tick(), live.every_tick);
    view::ViewerOptions viewer = this->viewer(driver);
    viewer.paused = true;
    viewer.scenario = [options = block_options()] { return load_scenario(options); };
    view::run_viewer(viewer);
    const double ticks = static_cast<double>(last_tick() + 1) * options_.rounds;
    live.pictures += static_cast<double>(driver.pictures()) / ticks;
    live.frames += static_cast<double>(driver.frames()) / ticks;
    return driver.times();
  }

  /// Compares the same ticks.
  void compare(const std::vector<TickTime>& with, const std::vector<TickTime>& without, Live& live) const {
    // The ends are ticks that the window has shown. Of a scenario so fast that it shows only the last one,
    // the warm-up counts, too.
    std::vector<int64_t> both;
    for (const TickTime& time : with)
      if (time.tick >= options_.warm_up && has(without, time.tick)) both.push_back(time.tick);
    if (both.size() == 1 && has(without, with.front().tick)) both.insert(both.begin(), with.front().tick);
    if (both.size() < 2)
      throw_user_error(
          "{}: bench --view: the window showed {} of {} ticks after the warm-up; expected 2 at "
          "least: measure more ticks",
          scenario_.name, both.size(), options_.block);
    const int64_t first = both.front(), last = both.back();
    live.alone.push_back(tick_ms(without, first, last));
    live.shown.push_back(tick_ms(with, first, last));
    live.slow_down.push_back(100.0 * (live.shown.back() / live.alone.back() - 1.0));
    live.alone_cpu.push_back(tick_cpu_ms(without, first, last));
    live.shown_cpu.push_back(tick_cpu_ms(with, first, last));
  }

  void measure_live() {
    Live paced, every;
    every.every_tick = true;
    for (uint32_t round = 0; round < options_.rounds; ++round) {
      std::vector<TickTime> with, with_every, without;
      if (round % 2 == 1) with = windowed(paced);
      if (round % 2 == 1) with_every = windowed(every);
      without = headless();
      if (round % 2 == 0) with = windowed(paced);
      if (round % 2 == 0) with_every = windowed(every);
      compare(with, without, paced);
      compare(with_every, without, every);
    }
    add("live: a tick without the window, median", median(paced.alone), "ms");
    add("live: processor time of a tick without the window, median", median(paced.alone_cpu), "ms");
    add_live("live", paced);
    add_most("live: slow-down by the window, median", median(paced.slow_down), "%", most_slow_down);
    add_live("live, every tick shown", every);
    add("live, every tick shown: slow-down by the window, median", median(every.slow_down), "%");
  }
  void add_live(const std::string& name, const Live& live) {
    add(name + ": a tick with the window, median", median(live.shown), "ms");
    add(name + ": processor time of a tick with the window, median", median(live.shown_cpu), "ms");
    add(name + ": pictures of the scene for each tick", live.pictures, "");
    add(name + ": frames of the window for each tick", live.frames, "");
  }

  /// Returns the number of ticks of the data set.
  int64_t record(const std::filesystem::path& folder) const {
    ScenarioOptions options = scenario_options_;
    options.ticks = options_.scrub_ticks;
    options.sequences = 1;
    const sim::Experiment experiment = sim::make_experiment(load_scenario(options));
    gpu::Device device(run_.device_options());
    sim::Simulator simulator(device, experiment);
    io::DatasetWriter writer(folder, sim::dataset_info(experiment, device, simulator.sensors()));
    writer.begin_sequence(0);
    simulator.start(0);
    int64_t ticks = 0;
    while (simulator.step(writer)) ++ticks;
    writer.end_sequence();
    return ticks;
  }

  void measure_scrubbing() {
    const std::filesystem::path folder = scratch_.path() / "data";
    ScrubDriver driver(record(folder));
    view::ViewerOptions viewer = this->viewer(driver);
    viewer.datasets = {folder};
    view::run_viewer(viewer);
    const std::string name = fmt::format("scrubbing with {} panels: ", driver.panels());
    add_least(name + "ticks, each for the first time", driver.ticks_per_s(), "/s", least_scrubbed_per_s);
    add(name + "ticks, back again", driver.ticks_per_s_again(), "/s");
  }

  const ScenarioOptions scenario_options_;
  const RunOptions run_;
  ViewBenchOptions options_;
  int width_ = 0, height_ = 0;
  const sim::Scenario scenario_;
  ScratchFolder scratch_;
  nlohmann::json rows_ = nlohmann::json::array();
};

}  // namespace

nlohmann::json view_bench(const ScenarioOptions& scenario, const RunOptions& run,
                          const ViewBenchOptions& options) {
  return ViewBench(scenario, run, options).measure();
}

std::string view_bench_text(const nlohmann::json& result) {
  std::string text =
      fmt::format("{} on {} ({}), {} cores, a window of {} x {}\n{:<62} {:>9} {:>4}  {:>9}\n",
                  result["scenario"].get<std::string>(), result["device"].get<std::string>(),
                  result["driver"].get<std::string>(), result["cores"].get<uint32_t>(),
                  result["width"].get<int>(), result["height"].get<int>(), "", "measured", "", "target");
  for (const nlohmann::json& row : result["rows"]) {
    std::string target;
    if (row.contains("met"))
      target = fmt::format("{} {:>6g}{}", row.contains("least") ? ">=" : "<=",
                           row[row.contains("least") ? "least" : "most"].get<double>(),
                           row["met"].get<bool>() ? "" : "  missed");
    text += fmt::format("{:<62} {:9.2f} {:<4}  {}", row["name"].get<std::string>(),
                        row["value"].get<double>(), row["unit"].get<std::string>(), target);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

}  // namespace greatx::apps
