// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/targets/rcs_table.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

/// Holds the four samples around a direction, with their weights.
struct Corners {
  std::array<size_t, 4> index;
  std::array<double, 4> weight;
};

Corners corners_of(const RcsTable::Grid& grid, const dvec3& direction) {
  const dvec2 angles = theta_phi(direction);
  const double zenith = angles.x / pi * (grid.zeniths - 1.0);
  const auto row = std::min(static_cast<size_t>(zenith), size_t{grid.zeniths} - 2);
  const double down = zenith - static_cast<double>(row);
  double azimuth = (angles.y - grid.first_azimuth) / (2.0 * pi);
  azimuth = (azimuth - std::floor(azimuth)) * grid.azimuths;
  const size_t column = static_cast<size_t>(azimuth) % grid.azimuths;
  const double across = azimuth - std::floor(azimuth);
  const size_t next = (column + 1) % grid.azimuths, width = grid.azimuths;
  return {{row * width + column, row * width + next, (row + 1) * width + column, (row + 1) * width + next},
          {(1.0 - down) * (1.0 - across), (1.0 - down) * across, down * (1.0 - across), down * across}};
}

void add(ScatterMatrix& sum, double weight, const ScatterMatrix& sample) {
  for (size_t i = 0; i < sum.size(); ++i) sum[i] += weight * sample[i];
}

}  // namespace

RcsTable::RcsTable(const Grid& source, const Grid& receiver, std::vector<ScatterMatrix> samples,
                   std::string name, std::string sha256)
    : source_(source),
      receiver_(receiver),
      samples_(std::move(samples)),
      name_(std::move(name)),
      sha256_(std::move(sha256)) {
  for (const Grid* grid : {&source_, &receiver_})
    GREATX_CHECK((grid == &receiver_ && grid->zeniths == 0) || (grid->zeniths >= 2 && grid->azimuths >= 1),
                 "a grid of {} zeniths and {} azimuths", grid->zeniths, grid->azimuths);
  const size_t expected = source_.size() * (bistatic() ? receiver_.size() : 1);
  GREATX_CHECK(samples_.size() == expected, "{} samples of {}", samples_.size(), expected);
}

ScatterMatrix RcsTable::scatter(const Aspect& aspect, const EchoKey&) const {
  ScatterMatrix sum{};
  const Corners in = corners_of(source_, bistatic() ? aspect.to_source : aspect.bisector());
  if (!bistatic()) {
    for (size_t i = 0; i < 4; ++i) add(sum, in.weight[i], samples_[in.index[i]]);
    return sum;
  }
  const Corners out = corners_of(receiver_, aspect.to_receiver);
  for (size_t i = 0; i < 4; ++i)
    for (size_t j = 0; j < 4; ++j)
      add(sum, in.weight[i] * out.weight[j], samples_[in.index[i] * receiver_.size() + out.index[j]]);
  return sum;
}

}  // namespace greatx::rf
