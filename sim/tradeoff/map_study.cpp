// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/map_study.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/units.h"
#include "sim/tradeoff/stopwatch.h"

namespace greatx::sim {

namespace {

constexpr double largest_factor = 8.0;  // of the default size
constexpr double most_largest = 6.0;    // cells along a side of the area, for one transmitter

MapRequest sized(const MapRequest& request, double cell_m) {
  MapRequest result = request;
  result.cell_m = cell_m;
  return result;
}

/// Computes one map and times it. Returns false if it was stopped.
bool compute(ChannelSnapshot& snapshot, const MapRequest& request, const std::function<bool()>& go_on,
             SettingResult& result) {
  const Stopwatch watch;
  RadioMapRun run(snapshot, request, {});
  std::vector<MapLink> links;
  bool stopped = false;
  run.solve(0, [&](std::span<const MapLink> more) {
    links.insert(links.end(), more.begin(), more.end());
    stopped = !go_on();
    return !stopped;
  });
  if (stopped) return false;
  Record record;
  record.arrays.push_back(map_array(run.map(links), map_quantity("path_gain")));
  result.wall_ms.push_back(watch.wall_ms());
  result.cpu_ms.push_back(watch.cpu_ms());

  const MapGrid& grid = run.cells().grid;
  SensorSpec spec;
  spec.name = snapshot.experiment().scenario.channels[snapshot.channel()].name;
  spec.kind = "map";
  spec.arrays.push_back({"path_gain", DType::f64, record.arrays[0].shape, "1",
                         "[tx, rows, columns]; 0: no path, NaN: no value"});
  spec.metadata_json =
      nlohmann::json{{"min_m", {grid.min_m.x, grid.min_m.y}}, {"cell_m", grid.cell_m}}.dump();
  result.specs = {std::move(spec)};
  result.last.records = {std::move(record)};
  return true;
}

/// Returns the gains, dB, between which 98 % of the cells with a path lie.
std::pair<double, double> range_db(const Array& gain) {
  std::vector<double> values;
  for (const double value : gain.as<double>())
    if (value > 0.0) values.push_back(decibels(value));
  if (values.empty()) return {-1.0, 0.0};
  std::ranges::sort(values);
  const auto at = [&](double share) {
    return values[static_cast<size_t>(share * double(values.size() - 1))];
  };
  return {at(0.01), std::max(at(0.99), at(0.01) + 1.0)};
}

/// Compares a map with the reference and gives it the reference's range for pictures.
void compare(const SettingResult& reference, SettingResult& result) {
  const std::unique_ptr<ErrorSum> sum = make_error_sum("map");
  sum->add(reference.specs[0], reference.last.records[0], result.specs[0], result.last.records[0]);
  for (const ErrorFigure& figure : sum->figures()) result.errors.push_back({result.specs[0].name, figure});
  result.exact = &reference == &result;
  const auto [low, high] = range_db(reference.last.records[0].arrays[0]);
  nlohmann::json metadata = nlohmann::json::parse(result.specs[0].metadata_json);
  metadata["range_db"] = {low, high};
  result.specs[0].metadata_json = metadata.dump();
}

}  // namespace

MapStudy plan_map_study(const Experiment& experiment, bool quick) {
  MapStudy study;
  study.turns = quick ? 2 : 3;
  const scene::Scene& scene = experiment.scene();
  if (scene.bounds.empty()) {
    study.skipped = "the scene is empty, so that there is no area to map";
    return study;
  }
  const size_t transmitters = experiment.scenario.channels.front().transmitters.size();
  const double own_m = map_grid_of({}, {}, {}, scene, transmitters).cell_m,
               largest_m = largest_factor * own_m;
  for (double cell_m = largest_m; cell_m >= (quick ? 1.0 : 0.5) * own_m; cell_m *= 0.5) {
    if (cell_m == own_m) study.standard = study.cells_m.size();
    study.cells_m.push_back(cell_m);
  }
  const dvec2 middle(scene.bounds.center() + scene.origin),
      extent(scene.bounds.max.x - scene.bounds.min.x, scene.bounds.max.y - scene.bounds.min.y);
  const double most = std::max(1.0, std::floor(most_largest / std::sqrt(static_cast<double>(transmitters))));
  const dvec2 side = largest_m * glm::clamp(glm::floor(extent / largest_m), dvec2(1.0), dvec2(most));
  study.request.min_m = middle - 0.5 * side;
  study.request.max_m = middle + 0.5 * side;
  return study;
}

Knob map_knob(const MapStudy& study) {
  Knob knob;
  knob.name = "cell";
  knob.about = "side of the cells of a radio map of path gain; the time is that of the whole map";
  knob.unit = "m";
  knob.timed = "map";
  knob.skipped = study.skipped;
  if (!study.skipped.empty()) return knob;
  const dvec2 side = *study.request.max_m - *study.request.min_m;
  knob.context = fmt::format("an area of {:g} x {:g} m in the middle of the scene, {:g} m above its ground",
                             side.x, side.y, study.request.height.above_m);
  for (const double cell_m : study.cells_m)
    knob.settings.push_back({fmt::format("{:g} m", cell_m), cell_m, {}});
  knob.reference = knob.settings.size() - 1;
  knob.standard = study.standard;
  return knob;
}

std::vector<SettingResult> measure_maps(gpu::Device& device, const Experiment& given, const MapStudy& study,
                                        const std::function<bool()>& go_on) {
  GREATX_CHECK(!study.cells_m.empty(), "{} sizes of cells", study.cells_m.size());
  const std::vector<double>& cells_m = study.cells_m;
  const ChannelConfig& channel = given.scenario.channels.front();
  // The centres of the finest cells surround those of all others.
  const scene::Bounds points = map_bounds(sized(study.request, cells_m.back()), channel, given.scene());
  const Experiment experiment = make_experiment(given.scenario, given.world, points);
  const Stopwatch building;
  ChannelSnapshot snapshot(device, experiment, 0, {});
  const double build_ms = building.wall_ms();
  const Stopwatch starting;
  const dvec3 middle = points.center();
  snapshot.solve(
      std::span(&middle, 1), 0, [](ChannelSnapshot::Link) { return false; }, false);
  const double start_ms = starting.wall_ms();

  std::vector<SettingResult> results(cells_m.size());
  SettingResult warm_up;
  if (!compute(snapshot, sized(study.request, cells_m.front()), go_on, warm_up)) return {};
  for (uint32_t turn = 0; turn < study.turns; ++turn)
    for (size_t k = 0; k < cells_m.size(); ++k) {
      // Every second turn goes backwards, as with other knobs.
      const size_t i = turn % 2 == 0 ? k : cells_m.size() - 1 - k;
      if (!compute(snapshot, sized(study.request, cells_m[i]), go_on, results[i])) return {};
    }
  for (SettingResult& result : results) {
    result.build_ms = build_ms;
    result.start_ms = {start_ms};
    compare(results.back(), result);
  }
  return results;
}

}  // namespace greatx::sim
