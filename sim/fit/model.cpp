// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/model.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/parallel.h"
#include "core/phase.h"
#include "core/units.h"
#include "sim/fit/clock.h"
#include "sim/fit/model_parts.h"

namespace greatx::sim {
namespace {

using rf::Complex;
using rf::plain_product;

/// Whether a quantity depends on an unknown.
bool depends(const FitSet& set, FitUnknownKind kind) {
  switch (kind) {
    case FitUnknownKind::scale_db:
      return set.quantity != FitQuantity::delay_spread_ns;
    case FitUnknownKind::clock_s:
      return set.complex_values || set.quantity == FitQuantity::cir;
    default:
      return true;
  }
}

/// Returns the floors below which levels of a position do not count, linear; empty: there are none.
std::vector<double> floors_of(const FitSet& set, uint32_t position) {
  if (set.quantity != FitQuantity::cir && set.quantity != FitQuantity::cfr) return {};
  double highest = -INFINITY;
  for (const double level : values_at(set, position))
    if (level > highest) highest = level;
  return std::vector<double>(set.width, from_decibels(highest - set.floor_db));
}

/// Returns what is compared with the model's levels.
double compared(double measured, std::span<const double> floors) {
  return floors.empty() ? measured : decibels(from_decibels(measured) + floors[0]);
}

}  // namespace

double FitVariable::coordinate(double value) const { return logarithmic ? std::log(value) : value; }
double FitVariable::value(double coordinate) const { return logarithmic ? std::exp(coordinate) : coordinate; }

void check_unknowns(const FitProblem& problem) {
  for (const FitUnknown& unknown : problem.unknowns) {
    const char* name = name_of(unknown.kind);
    bool dependent = false;
    for (const FitSet& set : problem.sets) {
      if (!depends(set, unknown.kind)) continue;
      dependent = true;
      if (unknown.each != FitUnknown::Each::position) continue;
      if (!set.complex_values)
        throw_user_error_at(unknown.where, "{}: each: expected file or all for '{}', found position", name,
                            set.name);
      if (clock_steps(set.band, unknown.range.low, unknown.range.high) > most_clock_steps)
        throw_user_error_at(unknown.where, "{}: bounds: expected at most {:g} s in all, found {:g}", name,
                            most_clock_steps * 0.25 / (set.band.subcarriers * set.band.spacing_hz),
                            unknown.range.high - unknown.range.low);
    }
    if (!dependent)
      throw_user_error_at(unknown.where, "{}: expected a measurement that depends on it, found none", name);
  }
}

int FitModel::add_variable(const FitUnknown& unknown, const std::string& of, const char* axis) {
  constexpr const char* units[] = {"dB", "s", "deg", "m"};
  FitVariable variable;
  variable.name = fmt::format("{}: {}{}", of, name_of(unknown.kind), axis);
  variable.unit = units[static_cast<size_t>(unknown.kind)];
  variable.low = unknown.range.low;
  variable.high = unknown.range.high;
  variable.start = unknown.range.start.value_or(std::clamp(0.0, variable.low, variable.high));
  variable.prior = unknown.range.prior;
  variable.estimated = !unknown.range.start &&
                       (unknown.kind == FitUnknownKind::scale_db || unknown.kind == FitUnknownKind::clock_s);
  variables_.push_back(std::move(variable));
  uint8_t estimated = 0;
  if (!unknown.range.start && unknown.kind == FitUnknownKind::scale_db) estimated = 1;
  if (!unknown.range.start && unknown.kind == FitUnknownKind::clock_s) estimated = 2;
  estimated_.push_back(estimated);
  return static_cast<int>(variables_.size()) - 1;
}

void FitModel::bind(const FitUnknown& unknown) {
  std::vector<uint32_t> dependent;
  for (uint32_t s = 0; s < problem_.sets.size(); ++s)
    if (depends(problem_.sets[s], unknown.kind)) dependent.push_back(s);
  int shared = -1;
  for (const uint32_t s : dependent) {
    const FitSet& set = problem_.sets[s];
    if (unknown.each == FitUnknown::Each::position) {
      sets_[s].own_clock = unknown.range;
      continue;
    }
    const bool all = unknown.each == FitUnknown::Each::all;
    int variable = shared;
    if (variable < 0) {
      const std::string of = all ? "all files" : set.name;
      const bool offset = unknown.kind == FitUnknownKind::antenna_offset_m;
      variable = add_variable(unknown, of, offset ? ".x" : "");
      if (offset) add_variable(unknown, of, ".y"), add_variable(unknown, of, ".z");
      if (all) shared = variable;
    }
    SetVariables& own = sets_[s];
    switch (unknown.kind) {
      case FitUnknownKind::scale_db:
        own.scale = variable;
        break;
      case FitUnknownKind::clock_s:
        own.clock = variable;
        break;
      case FitUnknownKind::orientation_deg:
        own.orientation = variable, own.orientation_end = unknown.end;
        break;
      case FitUnknownKind::antenna_offset_m:
        own.offset = variable, own.offset_end = unknown.end;
        break;
    }
  }
}

FitModel::FitModel(const FitProblem& problem, const FitMaterials& materials, double carrier_hz,
                   std::vector<FitLink> links)
    : problem_(problem),
      materials_(materials),
      carrier_hz_(carrier_hz),
      links_(std::move(links)),
      sets_(problem.sets.size()),
      usable_(links_.size()),
      weights_(links_.size()) {
  for (size_t p = 0; p < problem.parameters.size(); ++p) {
    const FitParameter& parameter = problem.parameters[p];
    std::string name = parameter.materials[0];
    for (size_t m = 1; m < parameter.materials.size(); ++m) name += " + " + parameter.materials[m];
    name += fmt::format(": {}", name_of(parameter.property));
    if (parameter.windows || parameter.layer > 0)
      name += fmt::format(" of {} {}", parameter.windows ? "windows' layer" : "layer", parameter.layer);
    const FitRange& range = parameter.range;
    variables_.push_back({std::move(name), unit_of(parameter.property), materials.start()[p], range.low,
                          range.high, range.logarithmic, range.prior, true});
    if (range.prior && range.logarithmic) variables_.back().prior->mean = std::log(range.prior->mean);
    estimated_.push_back(0);
  }
  check_unknowns(problem);
  for (const FitUnknown& unknown : problem.unknowns) bind(unknown);
  parallel_for(links_.size(), 0, [&](size_t l) {
    const FitLink& link = links_[l];
    const FitSet& set = problem_.sets[link.set];
    bool measured = false;
    if (set.complex_values)
      measured = std::ranges::all_of(responses_at(set, link.position),
                                     [](const Complex& value) {
                                       return std::isfinite(value.real()) && std::isfinite(value.imag());
                                     }) &&
                 rms_of(responses_at(set, link.position)) > 0.0;
    else
      measured = std::ranges::any_of(values_at(set, link.position),
                                     [](double value) { return std::isfinite(value); });
    bool power = false;
    for (const rf::Path& path : link.paths)
      for (const Complex& value : path.transfer) power |= std::norm(value) > 0.0;
    usable_[l] = measured && power;
    if (!usable_[l]) return;
    weights_[l] = weights_of(link, set, carrier_hz_, 0.0, 0.0);
    bool received = false;  // an antenna may not meet the polarization or direction of any path
    for (size_t i = 0; i < link.paths.size() && !received; ++i)
      for (size_t p = 0; p < weights_[l].pairs; ++p) {
        Complex amplitude = 0.0;
        for (size_t e = 0; e < 4; ++e)
          amplitude += weights_[l].of[i * weights_[l].pairs + p][e] * link.paths[i].transfer[e];
        received |= std::norm(amplitude) > 0.0;
      }
    usable_[l] = received;
    if (!received || sets_[link.set].orientation >= 0) weights_[l] = {};
  });
}

std::vector<double> FitModel::values(std::span<const double> coordinates) const {
  std::vector<double> values(variables_.size());
  for (size_t v = 0; v < values.size(); ++v) values[v] = variables_[v].value(coordinates[v]);
  return values;
}

FitBlock FitModel::complex_block(uint32_t l, Signal response, std::span<const double> values,
                                 const Columns& columns, bool slopes) const {
  const FitLink& link = links_[l];
  const FitSet& set = problem_.sets[link.set];
  const SetVariables& own = sets_[link.set];
  const std::span<const Complex> measured = responses_at(set, link.position);
  const size_t count = measured.size();
  const double scale_db = own.scale >= 0 ? values[static_cast<size_t>(own.scale)] : 0.0;
  const double to_relative = 1.0 / rms_of(measured), gain = from_decibels(0.5 * scale_db) * to_relative;
  if (slopes && own.scale >= 0)
    for (size_t k = 0; k < count; ++k)
      response.slopes[static_cast<size_t>(columns.of(own.scale))][k] =
          response.value[k] * (std::numbers::ln10 / 20.0);

  std::vector<Complex> turn(count, Complex(gain));
  if (own.own_clock) {
    const double clock_s =
        best_clock(set.band, response.value, measured, own.own_clock->low, own.own_clock->high);
    const std::vector<Complex> by_clock = clock_turn(set.band, clock_s);
    for (size_t k = 0; k < count; ++k) turn[k] = gain * by_clock[k];
  }
  if (!set.phase_known) {
    Complex correlation = 0.0;
    for (size_t k = 0; k < count; ++k) correlation += std::conj(turn[k] * response.value[k]) * measured[k];
    const Complex phase = std::norm(correlation) > 0.0 ? correlation / std::abs(correlation) : Complex(1.0);
    for (Complex& factor : turn) factor *= phase;
  }
  const auto rows = static_cast<Eigen::Index>(2 * count);
  const auto put = [&](auto&& column, size_t k, const Complex& value) {
    column[static_cast<Eigen::Index>(2 * k)] = value.real();
    column[static_cast<Eigen::Index>(2 * k + 1)] = value.imag();
  };
  FitBlock block;
  block.columns = columns.variables;
  block.residuals.resize(rows);
  for (size_t k = 0; k < count; ++k)
    put(block.residuals, k, turn[k] * response.value[k] - to_relative * measured[k]);
  block.own_unknowns = (own.own_clock ? 1u : 0u) + (set.phase_known ? 0u : 1u);
  if (!slopes) return block;
  block.slopes.resize(rows, static_cast<Eigen::Index>(columns.variables.size()));
  for (size_t c = 0; c < response.slopes.size(); ++c)
    for (size_t k = 0; k < count; ++k)
      put(block.slopes.col(static_cast<Eigen::Index>(c)), k, turn[k] * response.slopes[c][k]);
  if (block.own_unknowns == 0) return block;
  Eigen::MatrixXd by_own(rows, block.own_unknowns);
  for (size_t k = 0; k < count; ++k) {
    const Complex modelled = turn[k] * response.value[k];
    const double number = static_cast<double>(k) - static_cast<double>(set.band.subcarriers / 2);
    Eigen::Index column = 0;
    if (!set.phase_known) put(by_own.col(column++), k, Complex(0.0, 1.0) * modelled);
    if (own.own_clock) put(by_own.col(column), k, Complex(0.0, -number) * modelled);
  }
  const Eigen::MatrixXd q = Eigen::HouseholderQR<Eigen::MatrixXd>(by_own).householderQ() *
                            Eigen::MatrixXd::Identity(rows, block.own_unknowns);
  block.slopes -= q * (q.transpose() * block.slopes);
  return block;
}

FitBlock FitModel::block(uint32_t l, const TransferSlopes& slopes_of, std::span<const double> values,
                         bool slopes) const {
  const FitLink& link = links_[l];
  const FitSet& set = problem_.sets[link.set];
  const SetVariables& own = sets_[link.set];
  Columns columns;
  columns.set = &own;
  for (const FitLink::Touched& touched : link.touched)
    columns.variables.insert(columns.variables.end(), touched.parameters.begin(), touched.parameters.end());
  for (const int variable : {own.scale, own.clock, own.orientation})
    if (variable >= 0) columns.variables.push_back(static_cast<uint32_t>(variable));
  for (int axis = 0; axis < 3 && own.offset >= 0; ++axis)
    columns.variables.push_back(static_cast<uint32_t>(own.offset + axis));
  std::ranges::sort(columns.variables);
  const auto repeated = std::ranges::unique(columns.variables);
  columns.variables.erase(repeated.begin(), repeated.end());

  const PathTerms terms = terms_of(l, slopes_of, values, columns, slopes);
  const bool sampled = set.coherent || set.from_response || set.quantity == FitQuantity::cir ||
                       set.quantity == FitQuantity::cfr;
  Signal response;
  if (sampled) response = band_response(terms, set, values, columns, slopes);
  FitBlock block;
  if (set.complex_values) {
    block = complex_block(l, std::move(response), values, columns, slopes);
  } else {
    const double scale_db = own.scale >= 0 ? values[static_cast<size_t>(own.scale)] : 0.0;
    const int scale_column = slopes ? columns.of(own.scale) : -1;
    const std::vector<double> floors = floors_of(set, link.position);
    FitRows rows;
    switch (set.quantity) {
      case FitQuantity::power_db:
        rows =
            levels_of(sampled ? mean_of(powers_of(response, terms.pairs)) : sum_of(powers_of(terms, slopes)),
                      scale_db, floors, scale_column);
        break;
      case FitQuantity::delay_spread_ns:
        if (sampled) {
          std::vector<double> delays_s;
          for (uint32_t t = 0; t < set.band.taps; ++t)
            delays_s.push_back(t / (set.band.subcarriers * set.band.spacing_hz));
          rows =
              delay_spread_of(powers_of(taps_of(response, set.band, terms.pairs), terms.pairs), delays_s, {});
        } else {
          rows = delay_spread_of(powers_of(terms, slopes), terms.delays_s, terms.delay_slopes);
        }
        break;
      case FitQuantity::cir:
        rows = levels_of(powers_of(taps_of(response, set.band, terms.pairs), terms.pairs), scale_db, floors,
                         scale_column);
        break;
      case FitQuantity::cfr:
        rows = levels_of(powers_of(response, terms.pairs), scale_db, floors, scale_column);
        break;
    }
    const std::span<const double> measured = values_at(set, link.position);
    std::vector<Eigen::Index> kept;
    for (size_t i = 0; i < measured.size(); ++i)
      if (std::isfinite(measured[i])) kept.push_back(static_cast<Eigen::Index>(i));
    block.columns = columns.variables;
    block.residuals.resize(static_cast<Eigen::Index>(kept.size()));
    if (slopes) block.slopes.resize(block.residuals.size(), rows.slopes.cols());
    for (size_t i = 0; i < kept.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      block.residuals[row] = rows.value[kept[i]] - compared(measured[static_cast<size_t>(kept[i])], floors);
      if (slopes) block.slopes.row(row) = rows.slopes.row(kept[i]);
    }
  }
  if (slopes)
    for (size_t c = 0; c < block.columns.size(); ++c)
      if (variables_[block.columns[c]].logarithmic)
        block.slopes.col(static_cast<Eigen::Index>(c)) *= values[block.columns[c]];
  return block;
}

std::vector<FitBlock> FitModel::blocks(std::span<const double> coordinates, std::span<const uint32_t> links,
                                       bool slopes, bool of_materials) const {
  const std::vector<double> values = this->values(coordinates);
  const TransferSlopes fields(materials_, problem_.parameters,
                              std::span(values).first(problem_.parameters.size()), slopes && of_materials);
  std::vector<FitBlock> blocks(links.size());
  parallel_for(links.size(), 0, [&](size_t i) { blocks[i] = block(links[i], fields, values, slopes); });
  return blocks;
}

}  // namespace greatx::sim
