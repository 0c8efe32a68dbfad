// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/taps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/phase.h"
#include "core/units.h"
#include "rf/channel/link_sum.h"

namespace greatx::rf {
namespace {

void check_grid(const TapGrid& grid) {
  GREATX_CHECK(grid.bandwidth_hz > 0.0 && std::isfinite(grid.bandwidth_hz) && grid.taps > 0,
               "{} taps at a bandwidth of {} Hz", grid.taps, grid.bandwidth_hz);
}

/// Computes sinc(l - B tau) at whole numbers l. With B tau = nearest + fraction, sin(pi (l - B tau)) =
/// -(-1)^(l - nearest) sin(pi fraction), so that one sine serves all taps.
class Sinc {
 public:
  Sinc(double bandwidth_hz, double delay_s) {
    const ExactProduct samples = exact_product(bandwidth_hz, delay_s);
    nearest_ = std::nearbyint(samples.value);
    GREATX_CHECK(std::abs(nearest_) < 0x1p52, "a delay of {} s at {} Hz", delay_s, bandwidth_hz);
    fraction_ = (samples.value - nearest_) + samples.error;
    sine_ = std::sin(pi * fraction_) / pi;
  }
  double operator()(double tap) const {
    const double away = tap - nearest_;
    if (away == 0.0) return fraction_ == 0.0 ? 1.0 : sine_ / fraction_;
    const double value = sine_ / (away - fraction_);
    return static_cast<int64_t>(away) % 2 == 0 ? -value : value;
  }
  /// Tells whether B tau is in [first, end).
  bool in(double first, double end) const {
    return nearest_ - first + fraction_ >= 0.0 && nearest_ - end + fraction_ < 0.0;
  }

 private:
  double nearest_, fraction_, sine_;
};

LinkSum tap_sum(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                const TapGrid& grid) {
  check_grid(grid);
  const auto set_factors = [grid](double delay_s, size_t term, ColumnFactors& factors) {
    const Sinc sinc(grid.bandwidth_hz, delay_s);
    for (size_t column = 0; column < grid.taps; ++column) {
      double* factor = factors.at(column / sum_lanes, term) + column % sum_lanes;
      factor[0] = sinc(static_cast<double>(grid.first) + static_cast<double>(column));
      factor[sum_lanes] = 0.0;
    }
  };
  return {paths,
          {},
          transmitter,
          receiver,
          {grid.carrier_hz, grid.time_samples, grid.time_spacing_s},
          grid.taps,
          PathSelection::all,
          set_factors};
}

}  // namespace

void channel_taps_into(std::span<const Path> paths, const ArrayPose& transmitter, const ArrayPose& receiver,
                       const TapGrid& grid, std::span<std::complex<float>> out, uint32_t threads) {
  LinkSum sum = tap_sum(paths, transmitter, receiver, grid);
  GREATX_CHECK(out.size() == sum.size(), "room for {} values, {} needed", out.size(), sum.size());
  sum.write(out.data(), threads);
}

std::vector<Complex> channel_taps_fp64(std::span<const Path> paths, const ArrayPose& transmitter,
                                       const ArrayPose& receiver, const TapGrid& grid) {
  LinkSum sum = tap_sum(paths, transmitter, receiver, grid);
  std::vector<Complex> values(sum.size());
  sum.write(values.data());
  return values;
}

TapCoverage tap_coverage(std::span<const Path> paths, std::span<const double> powers, const TapGrid& grid) {
  GREATX_CHECK(powers.size() == paths.size(), "{} powers of {} paths", powers.size(), paths.size());
  check_grid(grid);
  TapCoverage coverage;
  std::vector<std::pair<double, double>> samples;  // (delay, power)
  for (size_t i = 0; i < paths.size(); ++i) samples.emplace_back(paths[i].delay_s, powers[i]);
  std::sort(samples.begin(), samples.end());
  double outside = 0.0, total = 0.0;
  for (const auto& [delay_s, power] : samples) {
    const Sinc sinc(grid.bandwidth_hz, delay_s);
    double inside = 0.0;
    for (uint32_t column = 0; column < grid.taps; ++column) {
      const double value = sinc(static_cast<double>(grid.first) + column);
      inside += value * value;
    }
    // The squares of all taps add up to 1, and rounding may exceed it.
    outside += power * std::max(0.0, 1.0 - inside);
    total += power;
    const double first = grid.first - 0.5;
    if (!sinc.in(first, first + grid.taps)) ++coverage.paths_outside;
  }
  if (total > 0.0) coverage.power_outside = outside / total;
  return coverage;
}

}  // namespace greatx::rf
