// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/two_bend_recall.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "apps/bench/scatter_run.h"
#include "core/error.h"
#include "rf/channel/statistics.h"
#include "sim/scenario/parse/load_scenario.h"
#include "sim/scenario/parse/receiver_list.h"

namespace greatx::apps {

namespace {

/// The reference is the mean of draws with these many seeds, which the measured rows do not use.
constexpr uint32_t reference_seeds = 16;
constexpr uint32_t reference_budget = 16'000;

constexpr std::array kind_names{"two patches", "edge and patch", "patch and edge"};
using Powers = std::array<double, kind_names.size()>;

/// Returns the kind of a path with a scattering and another bend as the wave runs, an index into kind_names.
std::optional<size_t> two_bend_kind(const rf::Path& path) {
  std::vector<rf::InteractionType> bends;
  for (const rf::Interaction& i : path.interactions)
    if (i.type == rf::InteractionType::scattering || i.type == rf::InteractionType::diffraction)
      bends.push_back(i.type);
  if (bends.size() < 2 || path.patch_area_m2 == 0.0) return std::nullopt;
  if (path.from_receiver) std::ranges::reverse(bends);
  if (bends[0] == bends[1]) return 0;
  return bends[0] == rf::InteractionType::diffraction ? 1 : 2;
}

/// What the paths of a receiver sum up to. Powers are |T|^2/2.
struct Bent {
  Powers powers{};  ///< [kinds]
  double others = 0.0, deviation = 0.0;
  bool line_of_sight = false;
  size_t lit = 0;
  double two_bends() const { return powers[0] + powers[1] + powers[2]; }
};

Bent bent_sum(const std::vector<rf::Path>& paths) {
  Bent sum;
  std::vector<rf::Path> drawn;
  std::vector<double> powers;
  for (const rf::Path& path : paths) {
    double power = 0.0;
    for (const rf::Complex& t : path.transfer) power += 0.5 * std::norm(t);
    sum.line_of_sight |= path.interactions.empty();
    if (const auto kind = two_bend_kind(path)) {
      sum.powers[*kind] += power;
      drawn.push_back(path);
      powers.push_back(power);
    } else {
      sum.others += power;
    }
  }
  sum.lit = drawn.size();
  sum.deviation = rf::drawn_deviation(drawn, powers);
  return sum;
}

struct BentRun : ScatterRun {
  std::vector<Bent> receivers;
};

BentRun bent_run(gpu::Device& device, const sim::Experiment& base, std::span<const dvec3> receivers,
                 uint32_t budget, uint64_t seed, bool two_bends = true) {
  constexpr size_t at_once = 32;
  sim::Scenario scenario = base.scenario;
  scenario.seed = seed;
  rf::PathLimits& limits = scenario.channels[0].limits;
  limits.scattering_budget = budget;
  if (!two_bends) limits.max_scatterings = 1, limits.scattering_beside_diffraction = false;
  BentRun run;
  static_cast<ScatterRun&>(run) =
      run_receivers(device, base, std::move(scenario), receivers, at_once,
                    [&](const std::vector<rf::Path>& paths) { run.receivers.push_back(bent_sum(paths)); });
  return run;
}

std::vector<Bent> bent_reference(gpu::Device& device, const sim::Experiment& base,
                                 std::span<const dvec3> receivers) {
  std::vector<Bent> mean(receivers.size());
  for (uint32_t i = 0; i < reference_seeds; ++i) {
    const BentRun run = bent_run(device, base, receivers, reference_budget, base.scenario.seed + 1 + i);
    for (size_t r = 0; r < mean.size(); ++r) {
      const Bent& one = run.receivers[r];
      for (size_t k = 0; k < kind_names.size(); ++k) mean[r].powers[k] += one.powers[k] / reference_seeds;
      mean[r].others += one.others / reference_seeds;
      mean[r].line_of_sight = one.line_of_sight;
    }
  }
  return mean;
}

double bent_db(double ratio) { return ratio > 0.0 ? 10.0 * std::log10(ratio) : -99.0; }

nlohmann::json quantiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values.empty()
               ? 0.0
               : values[static_cast<size_t>(std::round(share * static_cast<double>(values.size() - 1)))];
  };
  return {{"median", at(0.5)}, {"p90", at(0.9)}, {"most", at(1.0)}};
}

/// Returns the decibels that each kind adds to all paths with one bend or none, over the receivers in shadow.
nlohmann::json added(const std::vector<Bent>& reference) {
  nlohmann::json rows = nlohmann::json::array();
  for (size_t k = 0; k <= kind_names.size(); ++k) {
    std::vector<double> gains;
    for (const Bent& one : reference)
      if (!one.line_of_sight && one.others > 0.0)
        gains.push_back(
            bent_db(1.0 + (k < kind_names.size() ? one.powers[k] : one.two_bends()) / one.others));
    rows.push_back(quantiles(std::move(gains)));
    rows.back()["kind"] = k < kind_names.size() ? kind_names[k] : "all of them";
  }
  return rows;
}

nlohmann::json bent_row(const BentRun& run, const BentRun& first, const BentRun& without,
                        const std::vector<Bent>& reference, uint32_t budget) {
  std::vector<double> two_bends_db, total_db, in_deviations;
  std::array<std::vector<double>, kind_names.size()> kinds_db;
  double lit = 0.0, ratios = 0.0;
  for (size_t r = 0; r < reference.size(); ++r) {
    const Bent &is = run.receivers[r], &should = reference[r];
    lit += static_cast<double>(is.lit);
    if (should.two_bends() == 0.0) continue;
    for (size_t k = 0; k < kind_names.size(); ++k)
      if (should.powers[k] > 0.0) kinds_db[k].push_back(std::abs(bent_db(is.powers[k] / should.powers[k])));
    ratios += is.two_bends() / should.two_bends();
    two_bends_db.push_back(std::abs(bent_db(is.two_bends() / should.two_bends())));
    total_db.push_back(
        std::abs(bent_db((is.two_bends() + should.others) / (should.two_bends() + should.others))));
    if (is.deviation > 0.0)
      in_deviations.push_back(std::abs(is.two_bends() - should.two_bends()) / is.deviation);
  }
  const auto count = static_cast<double>(reference.size());
  const double each = (run.cpu_ms - first.cpu_ms) / std::max(1.0, count - 1.0);
  return {{"budget", budget},
          {"compared", two_bends_db.size()},
          {"chains", static_cast<double>(run.chains - without.chains) / count},
          {"lit", lit / count},
          {"source_cpu_ms", first.cpu_ms - each},
          {"cpu_ms", each - without.cpu_ms / count},
          {"mean_ratio", ratios / std::max(1.0, static_cast<double>(two_bends_db.size()))},
          {"two_bends_db", quantiles(two_bends_db)},
          {"two_patches_db", quantiles(kinds_db[0])},
          {"edge_and_patch_db", quantiles(kinds_db[1])},
          {"patch_and_edge_db", quantiles(kinds_db[2])},
          {"total_power_db", quantiles(total_db)},
          {"in_deviations", quantiles(in_deviations)}};
}

void print_bent(const nlohmann::json& result) {
  std::cout << fmt::format("{}: {} receivers, {} in shadow, {} interactions, patches of {:g} m\n",
                           result.at("scene").get<std::string>(), result.at("receivers").get<size_t>(),
                           result.at("in_shadow").get<size_t>(), result.at("max_depth").get<uint32_t>(),
                           result.at("patch_m").get<double>());
  const auto of = [](const nlohmann::json& row, const char* quantity) {
    return row.at(quantity).get<double>();
  };
  std::cout << fmt::format("  {:<16} {:>7} {:>7} {:>7}   dB more in shadow\n", "", "median", "90 %", "most");
  for (const nlohmann::json& row : result.at("added"))
    std::cout << fmt::format("  {:<16} {:>7.3f} {:>7.3f} {:>7.3f}\n", row.at("kind").get<std::string>(),
                             of(row, "median"), of(row, "p90"), of(row, "most"));
  std::cout << fmt::format("  {:>7} {:>7} {:>7} {:>9} {:>7} {:>7} {:>15} {:>15} {:>15} {:>15} {:>15} {:>7}\n",
                           "budget", "chains", "lit", "source ms", "CPU ms", "mean", "two patches",
                           "edge, patch", "patch, edge", "of these", "all power", "err/std");
  const auto both = [&](const nlohmann::json& row, const char* name) {
    return fmt::format("{:.3f} {:.3f} dB", of(row.at(name), "median"), of(row.at(name), "p90"));
  };
  for (const nlohmann::json& row : result.at("budgets"))
    std::cout << fmt::format(
        "  {:>7} {:>7.0f} {:>7.0f} {:>9.0f} {:>7.1f} {:>7.3f} {:>15} {:>15} {:>15} {:>15} {:>15} {:>7.2f}\n",
        row.at("budget").get<uint32_t>(), of(row, "chains"), of(row, "lit"), of(row, "source_cpu_ms"),
        of(row, "cpu_ms"), of(row, "mean_ratio"), both(row, "two_patches_db"), both(row, "edge_and_patch_db"),
        both(row, "patch_and_edge_db"), both(row, "two_bends_db"), both(row, "total_power_db"),
        of(row.at("in_deviations"), "p90"));
  std::cout << std::flush;
}

}  // namespace

void measure_two_bends(gpu::Device& device, const RecallOptions& options,
                       const std::vector<std::string>& scenes, nlohmann::json& results) {
  for (const std::string& name : scenes) {
    ScenarioOptions chosen = options.scenario;
    chosen.scenario = name;
    const sim::Experiment experiment =
        sim::make_experiment(frozen_for_recall(load_scenario(chosen), options.paths));
    if (!experiment.plan.scattering.on)
      throw_user_error("{}: expected a material that scatters; {}", name, experiment.plan.scattering.reason);
    const std::vector<dvec3> receivers =
        options.receiver_file.empty()
            ? draw_receivers(experiment.scene(), experiment.scenario.seed, options.receivers)
            : sim::load_receiver_list(options.receiver_file, sim::EarthPositions(experiment.scenario.scene));
    const std::vector<Bent> reference = bent_reference(device, experiment, receivers);
    nlohmann::json& result = results.emplace_back();
    result = {{"scene", experiment.scenario.name},
              {"facets", experiment.scene().facets.size()},
              {"patch_m", experiment.scenario.channels[0].limits.patch_m},
              {"receivers", receivers.size()},
              {"in_shadow", std::ranges::count(reference, false, &Bent::line_of_sight)},
              {"max_depth", options.paths.max_depth},
              {"max_transmissions", options.paths.max_transmissions},
              {"added", added(reference)}};
    for (const uint32_t budget : options.budgets) {
      const uint64_t seed = experiment.scenario.seed;
      const BentRun without = bent_run(device, experiment, receivers, budget, seed, false);
      const BentRun first = bent_run(device, experiment, std::span(receivers).first(1), budget, seed);
      const BentRun run = bent_run(device, experiment, receivers, budget, seed);
      result["budgets"].push_back(bent_row(run, first, without, reference, budget));
    }
    if (!options.json) print_bent(result);
  }
}

}  // namespace greatx::apps
