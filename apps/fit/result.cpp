// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "apps/fit/result.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace greatx::apps {
namespace {

using Json = nlohmann::ordered_json;

bool has_single_values(const sim::FitSet& set) {
  return set.quantity == sim::FitQuantity::power_db || set.quantity == sim::FitQuantity::delay_spread_ns;
}

double error_of(const sim::FitBlock& block, bool single) {
  if (single) return block.residuals[0];
  // Real and imaginary part are rows of their own, so the sum over them is the relative squared error.
  return std::sqrt(block.residuals.squaredNorm() / static_cast<double>(block.residuals.size()));
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json errors_json(const FitResult& result, uint32_t set, FitPart part) {
  Json json;
  for (const bool before : {true, false}) {
    const FitErrors errors = errors_of(result, set, part, before);
    json["positions"] = errors.positions;
    json[before ? "before" : "after"] = {{"rms", number(errors.rms)},
                                         {"mean", number(errors.mean)},
                                         {"median_magnitude", number(errors.median)}};
  }
  return json;
}

Json estimates_json(const FitResult& result) {
  Json all = Json::array();
  const std::vector<sim::FitVariable>& variables = result.model->variables();
  for (size_t v = 0; v < variables.size(); ++v) {
    const sim::FitVariable& variable = variables[v];
    const sim::FitEstimate& estimate = result.assessment.estimates[v];
    Json json{{"name", variable.name},
              {"unit", variable.unit},
              {"kind", variable.of_material ? "material" : "measurement"},
              {"before", variable.value(result.state.before[v])},
              {"value", estimate.value},
              {"logarithmic", variable.logarithmic},
              {"deviation", number(estimate.deviation)},
              {"deviation_of_residuals", number(estimate.deviation_of_residuals)},
              {"deviation_of_blocks", number(estimate.deviation_of_blocks)},
              {"interval", {number(estimate.low), number(estimate.high)}},
              {"bounds", {variable.low, variable.high}},
              {"verdict", sim::name_of(estimate.verdict)}};
    if (variable.of_material) {
      json["power_share"] = result.assessment.shares[v];
      json["positions"] = result.assessment.positions[v];
    }
    all.push_back(std::move(json));
  }
  return all;
}

/// Returns the variables with the largest parts of a direction, e.g. "0.71 a - 0.70 b".
std::string direction_words(const FitResult& result, const sim::FitDirection& direction) {
  std::vector<size_t> order(direction.parts.size());
  for (size_t v = 0; v < order.size(); ++v) order[v] = v;
  std::ranges::stable_sort(
      order, [&](size_t a, size_t b) { return std::abs(direction.parts[a]) > std::abs(direction.parts[b]); });
  std::string words;
  for (const size_t v : order) {
    if (std::abs(direction.parts[v]) < 0.2) break;
    words += fmt::format("{}{:.2f} [{}]",
                         words.empty()              ? ""
                         : direction.parts[v] < 0.0 ? " - "
                                                    : " + ",
                         std::abs(direction.parts[v]), result.model->variables()[v].name);
  }
  return words;
}

std::string value_words(const sim::FitVariable& variable, double value) {
  return fmt::format("{:.5g}{}{}", value, variable.unit == "1" ? "" : " ",
                     variable.unit == "1" ? "" : variable.unit);
}

std::string estimate_words(const FitResult& result, size_t v) {
  const sim::FitVariable& variable = result.model->variables()[v];
  const sim::FitEstimate& estimate = result.assessment.estimates[v];
  std::string words = fmt::format("  {:<44} {:>14} -> {:<14}", variable.name,
                                  value_words(variable, variable.value(result.state.before[v])),
                                  value_words(variable, estimate.value));
  if (std::isfinite(estimate.deviation))
    words += fmt::format(" ({:.5g} to {:.5g})", estimate.low, estimate.high);
  if (estimate.verdict != sim::FitVerdict::determined)
    words += fmt::format("  {}", sim::name_of(estimate.verdict));
  return words + "\n";
}

std::string verdict_words(const FitResult& result) {
  std::string words;
  const std::vector<sim::FitVariable>& variables = result.model->variables();
  for (size_t v = 0; v < variables.size(); ++v) {
    const std::string& name = variables[v].name;
    switch (result.assessment.estimates[v].verdict) {
      case sim::FitVerdict::determined:
        break;
      case sim::FitVerdict::untouched:
        words += fmt::format(
            "- No path to a fitted position meets the material of [{}]: it keeps its start.\n", name);
        break;
      case sim::FitVerdict::no_effect:
        words += fmt::format("- Nothing that was measured changes with [{}]: it keeps its start.\n", name);
        break;
      case sim::FitVerdict::at_bound:
        words += fmt::format("- [{}] lies at a bound, beyond which the measurements pull it.\n", name);
        break;
      case sim::FitVerdict::undetermined:
        words += fmt::format("- The measurements do not determine [{}] within its bounds.\n", name);
        break;
      case sim::FitVerdict::by_prior:
        words += fmt::format("- [{}] is known by its prior; the measurements hardly add to it.\n", name);
        break;
    }
  }
  for (const sim::FitPair& pair : result.assessment.pairs)
    words += fmt::format("- [{}] and [{}] can hardly be told apart (correlation {:.4f}).\n",
                         variables[pair.first].name, variables[pair.second].name, pair.correlation);
  for (const sim::FitDirection& direction : result.assessment.directions)
    if (direction.singular_value < 0.1)
      words += fmt::format("- Weakest combination (singular value {:.2g}): {}.\n", direction.singular_value,
                           direction_words(result, direction));
  return words;
}

}  // namespace

const char* error_unit(const sim::FitSet& set) {
  if (set.complex_values) return "of the rms";
  return set.quantity == sim::FitQuantity::delay_spread_ns ? "ns" : "dB";
}

std::vector<FitPlace> places_of(const sim::FitModel& model, const sim::FitState& state,
                                const sim::FitBlocks& blocks) {
  std::vector<FitPlace> places;
  std::vector<uint32_t> usable;
  for (uint32_t l = 0; l < model.links().size(); ++l) {
    const sim::FitLink& link = model.links()[l];
    FitPlace place;
    place.set = link.set, place.position = link.position, place.block = blocks.of[l];
    place.at = link.place;
    place.held_out = blocks.held_out[place.block];
    place.usable = model.usable(l);
    place.measured = place.modelled_before = place.modelled = place.error_before = place.error = NAN;
    if (place.usable) usable.push_back(l);
    places.push_back(place);
  }
  const std::vector<sim::FitBlock> before = model.blocks(state.before, usable, false),
                                   after = model.blocks(state.coordinates, usable, false);
  for (size_t i = 0; i < usable.size(); ++i) {
    FitPlace& place = places[usable[i]];
    const sim::FitSet& set = model.problem().sets[place.set];
    const bool single = has_single_values(set);
    place.error_before = error_of(before[i], single);
    place.error = error_of(after[i], single);
    if (!single) continue;
    place.measured = set.values[place.position];
    place.modelled_before = place.measured + place.error_before;
    place.modelled = place.measured + place.error;
  }
  return places;
}

FitErrors errors_of(const FitResult& result, uint32_t set, FitPart part, bool before) {
  FitErrors errors;
  std::vector<double> magnitudes;
  double sum = 0.0, squares = 0.0;
  for (const FitPlace& place : result.places) {
    if (place.set != set || !place.usable || place.held_out != (part == FitPart::held_out)) continue;
    const double error = before ? place.error_before : place.error;
    sum += error;
    squares += error * error;
    magnitudes.push_back(std::abs(error));
  }
  errors.positions = magnitudes.size();
  errors.rms = errors.mean = errors.median = NAN;
  if (magnitudes.empty()) return errors;
  const double count = static_cast<double>(magnitudes.size());
  errors.rms = std::sqrt(squares / count);
  errors.mean = sum / count;
  const auto middle = magnitudes.begin() + static_cast<ptrdiff_t>(magnitudes.size() / 2);
  std::nth_element(magnitudes.begin(), middle, magnitudes.end());
  errors.median = *middle;
  return errors;
}

Json fit_json(const FitResult& result) {
  const sim::FitProblem& problem = result.model->problem();
  Json json{{"converged", result.state.converged},
            {"iterations", result.state.iteration},
            {"cost", result.state.cost},
            {"fitted_positions", result.fitted},
            {"held_out_positions", result.held_out},
            {"without_path_or_value", result.places.size() - result.fitted - result.held_out}};
  json["variables"] = estimates_json(result);
  json["sets"] = Json::array();
  for (uint32_t s = 0; s < problem.sets.size(); ++s)
    json["sets"].push_back({{"name", problem.sets[s].name},
                            {"quantity", sim::name_of(problem.sets[s].quantity)},
                            {"unit", error_unit(problem.sets[s])},
                            {"sigma", result.state.sigmas[s]},
                            {"sigma_estimated", !problem.sets[s].sigma.has_value()},
                            {"fitted", errors_json(result, s, FitPart::fitted)},
                            {"held_out", errors_json(result, s, FitPart::held_out)}});
  Json& identifiability = json["identifiability"];
  identifiability["singular_values"] = Json::array();
  identifiability["directions"] = Json::array();
  for (const sim::FitDirection& direction : result.assessment.directions) {
    identifiability["singular_values"].push_back(direction.singular_value);
    identifiability["directions"].push_back(direction.parts);
  }
  identifiability["correlation"] = Json::array();
  for (Eigen::Index a = 0; a < result.assessment.correlation.rows(); ++a) {
    Json row = Json::array();
    for (Eigen::Index b = 0; b < result.assessment.correlation.cols(); ++b)
      row.push_back(result.assessment.correlation(a, b));
    identifiability["correlation"].push_back(std::move(row));
  }
  identifiability["pairs"] = Json::array();
  for (const sim::FitPair& pair : result.assessment.pairs)
    identifiability["pairs"].push_back({{"first", result.model->variables()[pair.first].name},
                                        {"second", result.model->variables()[pair.second].name},
                                        {"correlation", pair.correlation}});
  return json;
}

std::string fit_words(const FitResult& result) {
  const sim::FitProblem& problem = result.model->problem();
  std::string words = fmt::format(
      "{} positions fitted, {} held out, {} without a path or a value; {} iterations{}\n", result.fitted,
      result.held_out, result.places.size() - result.fitted - result.held_out, result.state.iteration,
      result.state.converged ? "" : ", not converged: the fit ran out of iterations");
  words += "values, before and after (one deviation below and above):\n";
  for (size_t v = 0; v < result.model->variables().size(); ++v) words += estimate_words(result, v);
  words += "errors, rms (median of the magnitudes), before and after:\n";
  for (uint32_t s = 0; s < problem.sets.size(); ++s)
    for (const FitPart part : {FitPart::fitted, FitPart::held_out}) {
      const FitErrors before = errors_of(result, s, part, true), after = errors_of(result, s, part, false);
      if (after.positions == 0) continue;
      words +=
          fmt::format("  {:<24} {:<9} {:>6} positions  {:.4g} ({:.4g}) -> {:.4g} ({:.4g}) {}\n",
                      problem.sets[s].name, part == FitPart::fitted ? "fitted" : "held out", after.positions,
                      before.rms, before.median, after.rms, after.median, error_unit(problem.sets[s]));
    }
  const std::string verdicts = verdict_words(result);
  if (!verdicts.empty()) words += "to be taken with care:\n" + verdicts;
  return words;
}

std::string places_csv(const FitResult& result) {
  std::string csv =
      "set,position,x_m,y_m,z_m,block,part,measured,modelled_before,modelled,error_before,error\n";
  const auto cell = [](double value) {
    return std::isfinite(value) ? fmt::format("{}", value) : std::string();
  };
  for (const FitPlace& place : result.places)
    csv += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", result.model->problem().sets[place.set].name,
                       place.position, place.at.x, place.at.y, place.at.z, place.block,
                       !place.usable    ? "none"
                       : place.held_out ? "held_out"
                                        : "fitted",
                       cell(place.measured), cell(place.modelled_before), cell(place.modelled),
                       cell(place.error_before), cell(place.error));
  return csv;
}

}  // namespace greatx::apps
