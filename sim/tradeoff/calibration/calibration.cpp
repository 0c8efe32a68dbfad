// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/calibration/calibration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "sim/tradeoff/calibration/part.h"
#include "sim/tradeoff/calibration/wishes.h"

namespace greatx::sim {

namespace {

using Parts = std::vector<std::unique_ptr<PartCalibration>>;

constexpr size_t budget_rounds = 5;
constexpr double budget_use = 0.85;  ///< of the budget: a choice that takes less is tried once more
constexpr double finest_power = 1e-12, coarsest_power = 1e12;

/// Returns the targets of a modality with the weights that guard its other figures. If the scenario gives
/// none and `weigh`, it returns all weights of the modality.
std::vector<AccuracyTarget> targets_of(const Scenario& scenario, Modality modality, bool weigh) {
  std::vector<AccuracyTarget> targets;
  for (const AccuracyTarget& target : scenario.accuracy.targets)
    if (target.kind->modality == name_of(modality)) targets.push_back(target);
  const bool asked = !targets.empty();
  if (!asked && !(weigh && has(scenario, modality))) return {};
  for (const AccuracyKind& kind : accuracy_kinds())
    if (kind.modality == name_of(modality) && !std::isnan(kind.weight) && (!asked || kind.guards) &&
        std::ranges::find(targets, &kind, &AccuracyTarget::kind) == targets.end())
      targets.push_back({&kind, kind.weight, false});
  return targets;
}

Scenario with_choice(const CalibrationRun& run, const Parts& parts) {
  std::vector<YamlChange> changes = without_wishes(run.whole.scenario);
  for (const auto& part : parts)
    for (const YamlChange& change : part->changes()) changes.push_back(change);
  return changed(run.whole.scenario, changes, run.assets);
}

/// Takes the most accurate point of every front, all of one power relative to what is allowed, whose
/// predicted times together are at most `ms`.
void take_within(Parts& parts, double ms) {
  const auto total = [&](double power) {
    double sum = 0.0;
    for (const auto& part : parts) part->take(power), sum += part->predicted_ms();
    return sum;
  };
  double low = std::log(finest_power), high = std::log(coarsest_power);
  if (total(finest_power) <= ms) return;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (total(std::exp(middle)) <= ms ? high : low) = middle;
  }
  total(std::exp(high));
}

/// Fills the budget: the times of the modalities alone do not add up to that of a tick, so the whole scenario
/// is measured, and the prediction is scaled by what was measured.
Spread fill_budget(const CalibrationRun& run, Parts& parts, double budget_ms) {
  double scale = 1.0, least = std::numeric_limits<double>::infinity();
  Spread best;
  std::vector<double> best_power, power(parts.size());
  for (size_t round = 0; round < budget_rounds; ++round) {
    take_within(parts, budget_ms / scale);
    double predicted = 0.0;
    for (size_t i = 0; i < parts.size(); ++i)
      predicted += parts[i]->predicted_ms(), power[i] = parts[i]->predicted_power();
    run.say(fmt::format("the whole tick, round {}", round + 1));
    const Experiment experiment = make_experiment(with_choice(run, parts), run.whole);
    const std::vector<SettingResult> results =
        measure_settings(run.device, {experiment}, 0, "", plan_blocks(experiment.scenario, 2, 3),
                         [&](double) { run.say({}); });
    const Spread measured = spread_of(results.front().wall_ms);
    least = std::min(least, measured.median);
    const bool fits = measured.median <= budget_ms;
    if (fits && (best.count == 0 || measured.median > best.median)) {
      best = measured;
      best_power = power;
    }
    if (fits && measured.median >= budget_use * budget_ms) break;
    const double next = measured.median / std::max(predicted, 1e-9);
    if (std::abs(next / scale - 1.0) < 0.02) break;
    scale = next;
  }
  if (best.count == 0)
    throw_user_error(
        "{}: time_budget_ms_per_tick: expected {:.3g} or more, the time of a tick with the cheapest settings "
        "on this device; found {:.6g}",
        run.whole.scenario.name, least, budget_ms);
  for (size_t i = 0; i < parts.size(); ++i) parts[i]->take(best_power[i]);
  return best;
}

}  // namespace

Calibration calibrate(gpu::Device& device, const Experiment& experiment, const std::filesystem::path& assets,
                      const std::function<void(const std::string&)>& say) {
  const Scenario& scenario = experiment.scenario;
  const double most_ms = scenario.accuracy.budget_ms > 0.0 ? scenario.accuracy.budget_ms
                                                           : std::numeric_limits<double>::infinity();
  const CalibrationRun run{device, experiment, assets, say, most_ms};
  Calibration calibration;
  calibration.budget_ms = scenario.accuracy.budget_ms;
  const bool budget = calibration.budget_ms > 0.0;
  Parts parts;
  for (const Modality modality : all_modalities) {
    std::vector<AccuracyTarget> targets = targets_of(scenario, modality, budget);
    if (targets.empty()) continue;
    parts.push_back(std::make_unique<PartCalibration>(run, modality, std::move(targets)));
    parts.back()->measure_knobs();
    if (!budget) parts.back()->choose_cheapest();
  }
  if (budget) calibration.tick_ms = fill_budget(run, parts, calibration.budget_ms);
  for (const auto& part : parts) calibration.parts.push_back(part->checked());
  calibration.text = with_choice(run, parts).text;
  return calibration;
}

double least_share(int64_t met, int64_t checked) {
  if (checked <= 0 || met <= 0) return 0.0;
  // The probability of `met` or more, which grows with p, is 5 % at the bound.
  const auto at_least = [&](double p) {
    double sum = 0.0;
    for (int64_t k = met; k <= checked; ++k)
      sum += std::exp(std::lgamma(double(checked) + 1.0) - std::lgamma(double(k) + 1.0) -
                      std::lgamma(double(checked - k) + 1.0) + double(k) * std::log(p) +
                      double(checked - k) * std::log1p(-p));
    return sum;
  };
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double p = 0.5 * (low + high);
    (at_least(p) < 0.05 ? low : high) = p;
  }
  return low;
}

}  // namespace greatx::sim
