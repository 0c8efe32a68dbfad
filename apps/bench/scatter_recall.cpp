// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/scatter_recall.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>

#include <fmt/format.h>

#include "apps/bench/scatter_run.h"
#include "core/error.h"
#include "core/units.h"
#include "rf/channel/statistics.h"
#include "sim/experiment/experiment.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/receiver_list.h"

namespace greatx::apps {

namespace {

/// Bins with a smaller share of the scattered power are not compared.
constexpr double least_share = 0.01;
/// Receivers with less scattered than all other power by this factor are not compared.
constexpr double least_scattered = 1e-6;

/// What the scattered paths of a receiver sum up to. Powers are |T|^2/2.
struct Scattered {
  double power = 0.0, other_power = 0.0, deviation = 0.0;
  size_t lit = 0;
  std::map<int64_t, double> profile;  ///< by bin of 10 ns
  dvec3 direction{0.0};               ///< mean of the directions of arrival, weighted by power
};

struct Run : ScatterRun {
  std::vector<Scattered> receivers;
};

Scattered sum_of(const std::vector<rf::Path>& paths) {
  Scattered sum;
  std::vector<double> powers;
  for (const rf::Path& path : paths) {
    double power = 0.0;
    for (const rf::Complex& t : path.transfer) power += 0.5 * std::norm(t);
    powers.push_back(power);
    if (path.patch_area_m2 == 0.0) {
      sum.other_power += power;
      continue;
    }
    ++sum.lit;
    sum.power += power;
    sum.profile[static_cast<int64_t>(std::floor(path.delay_s / 10e-9))] += power;
    sum.direction += power * path.arrival;
  }
  if (sum.power > 0.0) sum.direction /= sum.power;
  sum.deviation = rf::drawn_deviation(paths, powers);
  return sum;
}

/// Solves the receivers, `at_once` in a call.
Run solve(gpu::Device& device, const sim::Experiment& base, std::span<const dvec3> receivers, uint32_t budget,
          size_t at_once) {
  sim::Scenario scenario = base.scenario;
  scenario.channels[0].limits.scattering_budget = budget;
  Run run;
  static_cast<ScatterRun&>(run) =
      run_receivers(device, base, std::move(scenario), receivers, at_once,
                    [&](const std::vector<rf::Path>& paths) { run.receivers.push_back(sum_of(paths)); });
  return run;
}

/// Returns the ratio in dB; where nothing was drawn of something, 99 dB below it.
double in_db(double ratio) { return ratio > 0.0 ? 10.0 * std::log10(ratio) : -99.0; }

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(std::round(share * static_cast<double>(values.size() - 1)))];
}

/// Holds the absolute errors of a budget.
struct Errors {
  std::vector<double> power_db, total_db, bins_db, direction_deg, spread_deg, in_deviations;
  double bias = 0.0;  ///< of the sum over all receivers of the power relative to the reference's, minus 1
};

/// rms spread of the directions about their mean (3GPP TR 38.901 calls for azimuths; this is on the sphere).
double spread_deg(const Scattered& s) {
  return degrees(std::sqrt(std::max(0.0, 1.0 - glm::dot(s.direction, s.direction))));
}

Errors errors_of(const Run& run, const Run& reference) {
  Errors errors;
  double ratios = 0.0;
  for (size_t r = 0; r < reference.receivers.size(); ++r) {
    const Scattered &is = run.receivers[r], &should = reference.receivers[r];
    if (should.power <= least_scattered * should.other_power || should.power == 0.0) continue;
    ratios += is.power / should.power;
    errors.power_db.push_back(std::abs(in_db(is.power / should.power)));
    errors.total_db.push_back(
        std::abs(in_db((is.power + is.other_power) / (should.power + should.other_power))));
    if (is.deviation > 0.0) errors.in_deviations.push_back(std::abs(is.power - should.power) / is.deviation);
    for (const auto& [bin, power] : should.profile) {
      if (power < least_share * should.power) continue;
      const auto found = is.profile.find(bin);
      errors.bins_db.push_back(std::abs(in_db(found == is.profile.end() ? 0.0 : found->second / power)));
    }
    if (is.power == 0.0) continue;
    const double sine = glm::length(glm::cross(is.direction, should.direction));
    errors.direction_deg.push_back(degrees(std::atan2(sine, glm::dot(is.direction, should.direction))));
    errors.spread_deg.push_back(std::abs(spread_deg(is) - spread_deg(should)));
  }
  if (!errors.power_db.empty()) errors.bias = ratios / static_cast<double>(errors.power_db.size()) - 1.0;
  return errors;
}

nlohmann::json json_of(const Run& run, const Errors& errors, uint32_t budget) {
  const auto both = [](const std::vector<double>& values) {
    return nlohmann::json{
        {"median", quantile(values, 0.5)}, {"p90", quantile(values, 0.9)}, {"most", quantile(values, 1.0)}};
  };
  const auto count = static_cast<double>(run.receivers.size());
  double lit = 0.0;
  for (const Scattered& one : run.receivers) lit += static_cast<double>(one.lit);
  const auto within =
      static_cast<double>(std::ranges::count_if(errors.bins_db, [](double error) { return error <= 1.0; }));
  return {{"budget", budget},
          {"compared", errors.power_db.size()},
          {"chains", static_cast<double>(run.chains) / count},
          {"lit", lit / count},
          {"search_cpu_ms", run.search_ms},
          {"cpu_ms", run.cpu_ms / count},
          {"wall_ms", run.wall_ms / count},
          {"bias_db", in_db(1.0 + errors.bias)},
          {"power_db", both(errors.power_db)},
          {"total_power_db", both(errors.total_db)},
          {"bins_db", both(errors.bins_db)},
          {"bins_within_1_db", errors.bins_db.empty() ? 1.0 : within / double(errors.bins_db.size())},
          {"direction_deg", both(errors.direction_deg)},
          {"spread_deg", both(errors.spread_deg)},
          {"in_deviations", both(errors.in_deviations)}};
}

void print_row(const nlohmann::json& row) {
  const auto of = [&](const char* name, const char* quantity) {
    return row.at(name).at(quantity).get<double>();
  };
  const auto budget = row.at("budget").get<uint32_t>();
  std::cout << fmt::format(
                   "  {:>7} {:>8.0f} {:>7.0f} {:>8.1f} {:>8.1f} {:>7.3f} {:>7.3f} {:>7.3f} {:>7.2f} {:>7.2f} "
                   "{:>7.1f}% {:>7.2f} {:>7.2f} {:>7.2f}\n",
                   budget == 0 ? "all" : std::to_string(budget), row.at("chains").get<double>(),
                   row.at("lit").get<double>(), row.at("cpu_ms").get<double>(),
                   row.at("wall_ms").get<double>(), row.at("bias_db").get<double>(), of("power_db", "median"),
                   of("power_db", "p90"), of("bins_db", "median"), of("bins_db", "p90"),
                   100.0 * row.at("bins_within_1_db").get<double>(), of("direction_deg", "p90"),
                   of("spread_deg", "p90"), of("in_deviations", "p90"))
            << std::flush;
}

}  // namespace

void measure_scattering(gpu::Device& device, const RecallOptions& options,
                        const std::vector<std::string>& scenes, nlohmann::json& results) {
  constexpr size_t references_at_once = 4;  // of which each holds tens of thousands of paths
  for (const std::string& name : scenes) {
    ScenarioOptions chosen = options.scenario;
    chosen.scenario = name;
    sim::Experiment experiment =
        sim::make_experiment(frozen_for_recall(load_scenario(chosen), options.paths));
    if (!experiment.plan.scattering.on)
      throw_user_error("{}: expected a material that scatters; {}", name, experiment.plan.scattering.reason);
    const std::vector<dvec3> receivers =
        options.receiver_file.empty()
            ? draw_receivers(experiment.scene(), experiment.scenario.seed, options.receivers)
            : sim::load_receiver_list(options.receiver_file, sim::EarthPositions(experiment.scenario.scene));
    nlohmann::json& result = results.emplace_back();
    result = {{"scene", experiment.scenario.name},
              {"facets", experiment.scene().facets.size()},
              {"patch_m", experiment.scenario.channels[0].limits.patch_m},
              {"receivers", receivers.size()},
              {"max_depth", options.paths.max_depth},
              {"max_transmissions", options.paths.max_transmissions}};
    const Run all = solve(device, experiment, receivers, 0, references_at_once);
    const auto add = [&](const Run& run, uint32_t budget) {
      result["budgets"].push_back(json_of(run, errors_of(run, all), budget));
      if (!options.json) print_row(result["budgets"].back());
    };
    if (!options.json)
      std::cout << fmt::format(
          "{}: {} facets, {} receivers, {} interactions, of them {} walls, patches of {:g} m\n"
          "  {:>7} {:>8} {:>7} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7} {:>7}\n"
          "  {:>7} {:>8} {:>7} {:>8} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7} {:>7}\n",
          experiment.scenario.name, experiment.scene().facets.size(), receivers.size(),
          options.paths.max_depth, options.paths.max_transmissions,
          experiment.scenario.channels[0].limits.patch_m, "budget", "chains", "lit", "CPU ms", "wall ms",
          "bias", "power", "dB", "bins", "dB", "within", "mean", "spread", "error/", "", "each", "each",
          "each", "each", "dB", "median", "90 %", "median", "90 %", "1 dB", "deg", "deg", "std");
    add(all, 0);
    for (const uint32_t budget : options.budgets)
      add(solve(device, experiment, receivers, budget, receivers.size()), budget);
  }
}

}  // namespace greatx::apps
