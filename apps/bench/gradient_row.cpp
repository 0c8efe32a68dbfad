// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The row of the gradient of a frequency response by parameters of materials.
#include <algorithm>
#include <cmath>

#include "apps/bench/radio_rows.h"
#include "apps/bench/recall_scene.h"
#include "core/random.h"
#include "rf/gradient/changed_surfaces.h"
#include "rf/gradient/response_gradient.h"
#include "sim/channel/blocks.h"
#include "sim/channel/link_ends.h"
#include "sim/plan/antennas.h"
#include "sim/plan/array_plan.h"

namespace greatx::apps {

namespace {

using Kind = rf::ChannelParameter::Kind;

constexpr double gradient_target_ms = 5.0;  ///< on one core
constexpr size_t gradient_paths = 20, gradient_parameters = 12;

/// Returns parameters of materials that the paths meet, in their order, as many as there are up to 12.
std::vector<rf::ChannelParameter> some_parameters(std::span<const rf::Path> paths,
                                                  const rf::RadioModel& model) {
  std::vector<rf::ChannelParameter> list;
  const auto add = [&](uint32_t material) {
    for (const Kind kind : {Kind::permittivity, Kind::conductivity, Kind::thickness, Kind::roughness}) {
      const rf::ChannelParameter parameter{.kind = kind, .index = material};
      const rf::RadioSurface& surface = model.surfaces.surface(material);
      if (list.size() == gradient_parameters || !rf::has_parameter(surface, parameter)) continue;
      // A value of 0 is at the end of its range: it has no difference to both sides.
      if (rf::parameter_value(surface, parameter, model.surfaces.carrier_hz()) == 0.0) continue;
      if (std::ranges::find(list, parameter) == list.end()) list.push_back(parameter);
    }
  };
  for (const rf::Path& path : paths)
    for (const rf::Interaction& at : path.interactions)
      if (at.type == rf::InteractionType::reflection || at.type == rf::InteractionType::transmission)
        add(model.facets.facet(at.element).material);
  for (const scene::Facet& facet : model.scene->facets) add(facet.material);
  return list;
}

/// Differentiates Re sum of conj(G) H in a direction G.
class GradientBench {
 public:
  GradientBench(const rf::RadioModel& model, std::vector<rf::Path> paths, const sim::LinkEnds& ends,
                const rf::ChannelGrid& grid)
      : model_(model),
        field_(model.field_model()),
        paths_(std::move(paths)),
        ends_(ends),
        grid_(grid),
        parameters_(some_parameters(paths_, model)),
        cotangent_(rf::response_size(ends.transmitter, ends.receiver, grid)) {
    RandomStream random(1, 0);
    for (rf::Complex& value : cotangent_) value = {random.uniform(-1, 1), random.uniform(-1, 1)};
  }
  size_t parameters() const { return parameters_.size(); }

  /// Returns the paths with fields of a model.
  std::vector<rf::Path> fields(const rf::FieldModel& model) const {
    std::vector<rf::Path> fields;
    for (const rf::Path& path : paths_) fields.push_back(rf::path_field(path, model, dvec3(0.0), dvec3(0.0)));
    return fields;
  }
  std::vector<rf::Path> fields() const { return fields(field_); }
  std::vector<rf::Complex> response(std::span<const rf::Path> paths) const {
    return rf::frequency_response_fp64(paths, ends_.transmitter, ends_.receiver, grid_);
  }
  std::vector<double> gradient() const {
    const rf::ResponseGradient response({paths_, ends_.transmitter, ends_.receiver}, grid_);
    const rf::LinkCotangent cotangent = response.pull_back(cotangent_);
    std::vector<double> gradient(parameters_.size());
    for (size_t i = 0; i < paths_.size(); ++i) {
      const std::vector<rf::PathSlope> slopes =
          rf::path_slopes(paths_[i], field_, dvec3(0.0), dvec3(0.0), parameters_);
      for (size_t p = 0; p < slopes.size(); ++p) gradient[p] += cotangent.paths[i].along({slopes[p]});
    }
    return gradient;
  }
  /// Returns the largest difference from central differences, extrapolated twice, relative to each.
  double error() const {
    const std::vector<double> exact = gradient();
    double most = 0.0, largest = 0.0;
    for (const double value : exact) largest = std::max(largest, std::abs(value));
    for (size_t p = 0; p < exact.size(); ++p) {
      const double numeric = difference(parameters_[p]);
      // A parameter that hardly matters has a difference of roundings.
      most = std::max(most, std::abs(exact[p] - numeric) / std::max(std::abs(numeric), 1e-6 * largest));
    }
    return most;
  }

 private:
  double loss(const rf::ChannelParameter& parameter, double value) const {
    const rf::MaterialValue change{parameter, value};
    const rf::RadioSurfaces surfaces =
        rf::changed_surfaces(model_.surfaces, model_.scene->materials.size(), {&change, 1},
                             [](const rf::ChannelParameter&) { return std::string("a material"); });
    rf::FieldModel changed = field_;
    changed.surfaces = &surfaces;
    const std::vector<rf::Complex> h = response(fields(changed));
    double sum = 0.0;
    for (size_t i = 0; i < h.size(); ++i) sum += (std::conj(cotangent_[i]) * h[i]).real();
    return sum;
  }
  double difference(const rf::ChannelParameter& parameter) const {
    const double value = rf::parameter_value(model_.surfaces.surface(parameter.index), parameter,
                                             model_.surfaces.carrier_hz());
    const double step = 4e-3 * value;
    const auto central = [&](double h) {
      return (loss(parameter, value + h) - loss(parameter, value - h)) / (2.0 * h);
    };
    const double wide = central(step), half = central(0.5 * step), quarter = central(0.25 * step);
    return (16.0 * (4.0 * quarter - half) - (4.0 * half - wide)) / 45.0;
  }

  const rf::RadioModel& model_;
  rf::FieldModel field_;
  std::vector<rf::Path> paths_;
  sim::LinkEnds ends_;
  rf::ChannelGrid grid_;
  std::vector<rf::ChannelParameter> parameters_;
  std::vector<rf::Complex> cotangent_;
};

template <typename Work>
nlohmann::json timed(const Work& work) {
  std::vector<double> samples;
  for (int i = 0; i < 200; ++i) {
    const Clock::time_point begin = Clock::now();
    work();
    samples.push_back(milliseconds_since(begin));
  }
  return distribution(std::move(samples));
}

}  // namespace

nlohmann::json gradient_row(const ScenarioOptions& scenario_options, const RunOptions& run) {
  const sim::Experiment experiment = sim::make_experiment(radio_only(scenario_options, tick_rows[0]));
  gpu::Device device(run.device_options());
  sim::ChannelSnapshot snapshot(device, experiment, 0, {});
  const sim::Scenario& scenario = experiment.scenario;
  const sim::ChannelConfig& config = scenario.channels[0];
  const sim::LinkEnds ends = sim::link_ends(
      scenario, config, sim::antenna_array(scenario, config.transmitters[0], config.carrier_hz), {},
      sim::antenna_array(scenario, config.receivers[0], config.carrier_hz), {}, sim::half_band_hz(config));
  const GradientBench bench(
      snapshot.model(),
      some_paths(snapshot, draw_receivers(experiment.scene(), scenario.seed, 100), gradient_paths), ends,
      sim::channel_grid(config, experiment.plan));
  const std::vector<rf::Path> paths = bench.fields();
  nlohmann::json row{{"paths", paths.size()},
                     {"parameters", bench.parameters()},
                     {"fields_ms", timed([&] { bench.fields(); })},
                     {"response_ms", timed([&] { bench.response(paths); })},
                     {"gradient_ms", timed([&] { bench.gradient(); })},
                     {"error", bench.error()}};
  check_validation(device);
  row["ms"] = row["gradient_ms"]["median"];
  row["forward_ms"] = row["fields_ms"]["median"].get<double>() + row["response_ms"]["median"].get<double>();
  set_target(row, gradient_target_ms, row["ms"]);
  return row;
}

}  // namespace greatx::apps
