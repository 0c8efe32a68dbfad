// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/phase.h"
#include "core/units.h"
#include "sim/fit/clock.h"
#include "sim/fit/model.h"
#include "sim/fit/model_parts.h"

namespace greatx::sim {
namespace {

using rf::Complex;
using rf::plain_product;

constexpr double turn_step_rad = 1e-5;  ///< of central differences by an orientation

}  // namespace

PathTerms FitModel::terms_of(uint32_t l, const TransferSlopes& slopes_of, std::span<const double> values,
                             const Columns& columns, bool slopes) const {
  const FitLink& link = links_[l];
  const FitSet& set = problem_.sets[link.set];
  const SetVariables& own = sets_[link.set];
  const FitFields fields = slopes_of.of(link);
  double yaw[2] = {0.0, 0.0};  // of transmitter and receiver
  const size_t turning = own.orientation_end == FitUnknown::End::receiver ? 1 : 0;
  if (own.orientation >= 0) yaw[turning] = radians(values[static_cast<size_t>(own.orientation)]);
  FitWeights fresh;
  if (own.orientation >= 0) fresh = weights_of(link, set, carrier_hz_, yaw[0], yaw[1]);
  const FitWeights& weights = own.orientation >= 0 ? fresh : weights_[l];

  PathTerms terms;
  terms.pairs = weights.pairs;
  terms.columns = columns.variables.size();
  const size_t paths = link.paths.size();
  std::vector<FitTransfer> transfers(paths);
  for (size_t i = 0; i < paths; ++i) std::copy_n(link.paths[i].transfer, 4, transfers[i].begin());
  for (size_t t = 0; t < link.touched.size(); ++t) transfers[link.touched[t].path] = fields.transfers[t];
  const auto amplitude = [&](const FitWeights& by, size_t path, size_t pair, const FitTransfer& transfer) {
    Complex sum = 0.0;
    for (size_t e = 0; e < 4; ++e) sum += plain_product(by.of[path * by.pairs + pair][e], transfer[e]);
    return sum;
  };
  for (size_t i = 0; i < paths; ++i) {
    terms.delays_s.push_back(link.paths[i].delay_s);
    for (size_t p = 0; p < terms.pairs; ++p)
      terms.amplitudes.push_back(amplitude(weights, i, p, transfers[i]));
  }
  // An offset of an antenna moves the delay of each path as that of an element at this place (a plane wave).
  const size_t end = own.offset_end == FitUnknown::End::receiver ? 1 : 0;
  const dvec3 up(0.0, 0.0, 1.0);
  const dquat turn =
      glm::angleAxis(yaw[end], up) * (end == 1 ? link.receiver.orientation : link.transmitter.orientation);
  dvec3 offset(0.0);
  if (own.offset >= 0)
    for (int axis = 0; axis < 3; ++axis) offset[axis] = values[static_cast<size_t>(own.offset + axis)];
  const auto direction = [&](size_t i) { return end == 1 ? link.paths[i].arrival : link.paths[i].departure; };
  if (own.offset >= 0)
    for (size_t i = 0; i < paths; ++i)
      terms.delays_s[i] -= glm::dot(direction(i), turn * offset) / speed_of_light;
  if (!slopes) return terms;

  for (size_t t = 0; t < fields.slopes.size(); ++t)
    for (size_t q = 0; q < link.touched[t].parameters.size(); ++q) {
      PathTerms::AmplitudeSlope slope{
          static_cast<uint32_t>(columns.of(static_cast<int>(link.touched[t].parameters[q]))),
          link.touched[t].path,
          {}};
      for (size_t p = 0; p < terms.pairs; ++p)
        slope.of.push_back(amplitude(weights, slope.path, p, fields.slopes[t][q]));
      terms.amplitude_slopes.push_back(std::move(slope));
    }
  if (own.orientation >= 0) {
    double below[2] = {yaw[0], yaw[1]}, above[2] = {yaw[0], yaw[1]};
    below[turning] -= turn_step_rad, above[turning] += turn_step_rad;
    const FitWeights at_below = weights_of(link, set, carrier_hz_, below[0], below[1]),
                     at_above = weights_of(link, set, carrier_hz_, above[0], above[1]);
    for (uint32_t i = 0; i < paths; ++i) {
      PathTerms::AmplitudeSlope slope{static_cast<uint32_t>(columns.of(own.orientation)), i, {}};
      for (size_t p = 0; p < terms.pairs; ++p)
        slope.of.push_back(
            (amplitude(at_above, i, p, transfers[i]) - amplitude(at_below, i, p, transfers[i])) *
            (radians(1.0) / (2.0 * turn_step_rad)));
      terms.amplitude_slopes.push_back(std::move(slope));
    }
    std::ranges::stable_sort(terms.amplitude_slopes, {}, &PathTerms::AmplitudeSlope::path);
  }
  if (own.offset < 0) return terms;
  const auto add_delay = [&](int variable, const dvec3& moved) {
    PathTerms::DelaySlope slope{static_cast<uint32_t>(columns.of(variable)), {}};
    for (size_t i = 0; i < paths; ++i) slope.of.push_back(-glm::dot(direction(i), moved) / speed_of_light);
    terms.delay_slopes.push_back(std::move(slope));
  };
  for (int axis = 0; axis < 3; ++axis) {
    dvec3 unit(0.0);
    unit[axis] = 1.0;
    add_delay(own.offset + axis, turn * unit);
  }
  if (own.orientation >= 0 && turning == end)
    add_delay(own.orientation, radians(1.0) * glm::cross(up, turn * offset));
  return terms;
}

Signal FitModel::band_response(const PathTerms& terms, const FitSet& set, std::span<const double> values,
                               const Columns& columns, bool slopes) const {
  Signal response = response_of(terms, set.band, carrier_hz_, slopes);
  const int clock = columns.set->clock;
  if (clock < 0) return response;
  const std::vector<Complex> turn = clock_turn(set.band, values[static_cast<size_t>(clock)]);
  const size_t count = turn.size();
  const auto delay = [&](std::vector<Complex>& of) {
    for (size_t i = 0; i < of.size(); ++i) of[i] = plain_product(of[i], turn[i % count]);
  };
  delay(response.value);
  for (std::vector<Complex>& slope : response.slopes) delay(slope);
  if (!slopes) return response;
  std::vector<Complex>& by_clock = response.slopes[static_cast<size_t>(columns.of(clock))];
  for (size_t i = 0; i < by_clock.size(); ++i) {
    const double hz = (static_cast<double>(i % count) - static_cast<double>(set.band.subcarriers / 2)) *
                      set.band.spacing_hz;
    by_clock[i] = plain_product(response.value[i], Complex(0.0, -2.0 * pi * hz));
  }
  return response;
}

}  // namespace greatx::sim
