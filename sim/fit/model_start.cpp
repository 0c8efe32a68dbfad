// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/phase.h"
#include "core/units.h"
#include "sim/fit/clock.h"
#include "sim/fit/model.h"
#include "sim/fit/model_parts.h"

namespace greatx::sim {
namespace {

using rf::Complex;
using rf::plain_product;

double median(std::vector<double> of) {
  std::erase_if(of, [](double value) { return !std::isfinite(value); });
  if (of.empty()) return 0.0;
  const auto middle = of.begin() + static_cast<ptrdiff_t>(of.size() / 2);
  std::nth_element(of.begin(), middle, of.end());
  return *middle;
}

}  // namespace

double FitModel::best_scale_db(uint32_t l, const TransferSlopes& fields,
                               std::span<const double> values) const {
  const FitLink& link = links_[l];
  const FitSet& set = problem_.sets[link.set];
  Columns columns;
  columns.set = &sets_[link.set];
  const PathTerms terms = terms_of(l, fields, values, columns, false);
  const auto response = [&] { return band_response(terms, set, values, columns, false); };
  if (set.complex_values)
    return 20.0 * std::log10(rms_of(responses_at(set, link.position)) / rms_of(response().value));
  const std::span<const double> measured = values_at(set, link.position);
  double highest = -INFINITY;
  for (const double level : measured)
    if (level > highest) highest = level;
  FitRows powers;
  if (set.quantity == FitQuantity::power_db)
    powers = set.coherent ? mean_of(powers_of(response(), terms.pairs)) : sum_of(powers_of(terms, false));
  else if (set.quantity == FitQuantity::cir)
    powers = powers_of(taps_of(response(), set.band, terms.pairs), terms.pairs);
  else
    powers = powers_of(response(), terms.pairs);
  return highest - decibels(powers.value.maxCoeff());
}

double FitModel::best_clock_s(uint32_t l, const TransferSlopes& fields,
                              std::span<const double> values) const {
  const FitLink& link = links_[l];
  const FitSet& set = problem_.sets[link.set];
  const FitVariable& clock = variables_[static_cast<size_t>(sets_[link.set].clock)];
  Columns columns;
  columns.set = &sets_[link.set];
  const PathTerms terms = terms_of(l, fields, values, columns, false);
  const Signal response = response_of(terms, set.band, carrier_hz_, false);
  if (set.complex_values && clock_steps(set.band, clock.low, clock.high) <= most_clock_steps)
    return best_clock(set.band, response.value, responses_at(set, link.position), clock.low, clock.high);
  if (set.complex_values) return clock.start;
  // The clock at which the magnitudes of the profiles agree best: whole taps first, then eighths about them.
  const std::span<const double> measured = values_at(set, link.position);
  const auto agreement = [&](double clock_s) {
    Signal delayed = response;
    const std::vector<Complex> turn = clock_turn(set.band, clock_s);
    for (size_t k = 0; k < turn.size(); ++k) delayed.value[k] = plain_product(delayed.value[k], turn[k]);
    const FitRows modelled = powers_of(taps_of(delayed, set.band, 1), 1);
    double sum = 0.0, total = 0.0;
    for (uint32_t t = 0; t < set.band.taps; ++t) {
      if (!std::isfinite(measured[t])) continue;
      sum += std::sqrt(from_decibels(measured[t]) * modelled.value[t]);
      total += modelled.value[t];
    }
    return total > 0.0 ? sum / std::sqrt(total) : 0.0;
  };
  const double tap_s = 1.0 / (set.band.subcarriers * set.band.spacing_hz);
  double best = clock.start, most = -1.0;
  const auto try_clock = [&](double clock_s) {
    const double value = agreement(std::clamp(clock_s, clock.low, clock.high));
    if (value > most) most = value, best = std::clamp(clock_s, clock.low, clock.high);
  };
  const double range_s = std::min(clock.high - clock.low, set.band.subcarriers * tap_s);
  for (double past = 0.0; past <= range_s; past += tap_s) try_clock(clock.low + past);
  const double whole = best;
  for (int eighth = -8; eighth <= 8; ++eighth) try_clock(whole + 0.125 * eighth * tap_s);
  return best;
}

std::vector<double> FitModel::start(std::span<const uint32_t> links) const {
  std::vector<double> coordinates;
  for (const FitVariable& variable : variables_) coordinates.push_back(variable.coordinate(variable.start));
  return estimated(coordinates, links);
}

std::vector<double> FitModel::estimated(std::span<const double> from, std::span<const uint32_t> links) const {
  std::vector<double> values = this->values(from);
  const TransferSlopes fields(materials_, problem_.parameters,
                              std::span(values).first(problem_.parameters.size()), false);
  const auto estimate = [&](size_t v, int SetVariables::*which, auto&& best) {
    std::vector<uint32_t> of;
    for (const uint32_t l : links)
      if (sets_[links_[l].set].*which == static_cast<int>(v)) of.push_back(l);
    std::vector<double> all(of.size());
    parallel_for(of.size(), 0, [&](size_t i) { all[i] = best(of[i]); });
    if (!of.empty()) values[v] = std::clamp(median(std::move(all)), variables_[v].low, variables_[v].high);
  };
  for (size_t v = 0; v < variables_.size(); ++v)
    if (estimated_[v] == 2)
      estimate(v, &SetVariables::clock, [&](uint32_t l) { return best_clock_s(l, fields, values); });
  for (size_t v = 0; v < variables_.size(); ++v)
    if (estimated_[v] == 1)
      estimate(v, &SetVariables::scale, [&](uint32_t l) { return best_scale_db(l, fields, values); });
  std::vector<double> coordinates(from.begin(), from.end());
  for (size_t v = 0; v < values.size(); ++v)
    if (estimated_[v] != 0) coordinates[v] = variables_[v].coordinate(values[v]);
  return coordinates;
}

std::vector<double> FitModel::shares(std::span<const double> coordinates, uint32_t l) const {
  const std::vector<double> values = this->values(coordinates);
  const TransferSlopes fields(materials_, problem_.parameters,
                              std::span(values).first(problem_.parameters.size()), false);
  Columns columns;
  columns.set = &sets_[links_[l].set];
  const PathTerms terms = terms_of(l, fields, values, columns, false);
  const FitRows powers = powers_of(terms, false);
  const double total = powers.value.sum();
  std::vector<double> shares(problem_.parameters.size());
  for (const FitLink::Touched& touched : links_[l].touched)
    for (const uint32_t p : touched.parameters) shares[p] += powers.value[touched.path] / total;
  return shares;
}

}  // namespace greatx::sim
