// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/pattern_table.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/hash.h"
#include "core/units.h"

namespace greatx::rf {

PatternTable::PatternTable(const Grid& grid, std::vector<Jones> samples, std::string name, std::string sha256)
    : grid_(grid),
      per_zenith_((grid.zeniths - 1.0) / pi),
      per_azimuth_(grid.azimuths / (2.0 * pi)),
      samples_(std::move(samples)),
      name_(std::move(name)),
      sha256_(std::move(sha256)) {
  GREATX_CHECK(grid_.zeniths >= 3 && grid_.azimuths >= 4, "a grid of {} zeniths and {} azimuths",
               grid_.zeniths, grid_.azimuths);
  GREATX_CHECK(samples_.size() == size_t{grid_.zeniths} * grid_.azimuths, "{} samples of {} by {}",
               samples_.size(), grid_.zeniths, grid_.azimuths);
  for (const Jones& sample : samples_)
    GREATX_CHECK(std::isfinite(std::norm(sample.theta)) && std::isfinite(std::norm(sample.phi)),
                 "sample ({}, {}), ({}, {})", sample.theta.real(), sample.theta.imag(), sample.phi.real(),
                 sample.phi.imag());
  if (sha256_.empty())
    sha256_ = Sha256().update_value(grid_).update(std::as_bytes(std::span(samples_))).hex();
}

Jones PatternTable::at(double zenith, double azimuth) const {
  const double row = std::clamp(zenith * per_zenith_, 0.0, grid_.zeniths - 1.0);
  const uint32_t i = std::min(static_cast<uint32_t>(row), grid_.zeniths - 2);
  const double down = row - i;
  double column = (azimuth - grid_.first_azimuth) * per_azimuth_;
  column -= grid_.azimuths * std::floor(column / grid_.azimuths);
  const uint32_t j = std::min(static_cast<uint32_t>(column), grid_.azimuths - 1);
  const double across = column - j;
  const uint32_t next = j + 1 == grid_.azimuths ? 0 : j + 1;

  const Jones* const upper = samples_.data() + size_t{i} * grid_.azimuths;
  const Jones* const lower = upper + grid_.azimuths;
  const double w00 = (1.0 - down) * (1.0 - across), w01 = (1.0 - down) * across;
  const double w10 = down * (1.0 - across), w11 = down * across;
  return {w00 * upper[j].theta + w01 * upper[next].theta + w10 * lower[j].theta + w11 * lower[next].theta,
          w00 * upper[j].phi + w01 * upper[next].phi + w10 * lower[j].phi + w11 * lower[next].phi};
}

}  // namespace greatx::rf
