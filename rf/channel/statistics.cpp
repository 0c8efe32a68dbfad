// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/units.h"
#include "rf/antenna/antenna.h"
#include "rf/channel/pair_amplitudes.h"

namespace greatx::rf {
namespace {

/// Holds the summed properties of a path. Samples that agree in all of them may be in any order.
struct Sample {
  double delay_s, power, doppler_hz;
  dvec2 departure, arrival;  ///< (theta, phi)
  bool line_of_sight;
  auto key() const {
    return std::array<double, 8>{delay_s,     power,     doppler_hz, departure.x,
                                 departure.y, arrival.x, arrival.y,  line_of_sight ? 1.0 : 0.0};
  }
};

std::vector<Sample> sorted_samples(std::span<const Path> paths, std::span<const double> powers) {
  GREATX_CHECK(powers.size() == paths.size(), "{} powers of {} paths", powers.size(), paths.size());
  std::vector<Sample> samples;
  samples.reserve(paths.size());
  for (size_t i = 0; i < paths.size(); ++i) {
    const Path& path = paths[i];
    GREATX_CHECK(std::isfinite(powers[i]) && powers[i] >= 0.0 && std::isfinite(path.delay_s) &&
                     std::isfinite(path.doppler_hz),
                 "path {}: power {}, delay {} s, Doppler {} Hz", i, powers[i], path.delay_s, path.doppler_hz);
    // A path without power has no weight, and its angles may have any value.
    if (powers[i] == 0.0) continue;
    samples.push_back({path.delay_s, powers[i], path.doppler_hz, theta_phi(path.departure),
                       theta_phi(path.arrival), path.interactions.empty()});
  }
  std::sort(samples.begin(), samples.end(),
            [](const Sample& a, const Sample& b) { return a.key() < b.key(); });
  return samples;
}

struct Moments {
  double mean, spread;
};

/// Computes mean and spread, first about the first value and then about the mean, so that nothing cancels.
template <typename Value>
Moments moments(std::span<const Sample> samples, double total, const Value& value) {
  const double origin = value(samples.front());
  double first = 0.0, second = 0.0;
  for (const Sample& sample : samples) first += sample.power * (value(sample) - origin);
  const double mean = origin + first / total;
  for (const Sample& sample : samples) {
    const double off = value(sample) - mean;
    second += sample.power * off * off;
  }
  return {mean, std::sqrt(second / total)};
}

/// Returns sqrt(-2 ln R) with 1 - R = sum p 2 sin^2(off / 2) / sum p, where `off` is the difference from the
/// mean direction. R itself would lose small spreads to its rounding and give 1e-8 rad for one path.
template <typename Angle>
double circular_spread(std::span<const Sample> samples, double total, const Angle& angle) {
  const double origin = angle(samples.front());
  double along = 0.0, across = 0.0;
  for (const Sample& sample : samples) {
    along += sample.power * std::cos(angle(sample) - origin);
    across += sample.power * std::sin(angle(sample) - origin);
  }
  const double mean = std::atan2(across, along);
  double versine = 0.0;
  for (const Sample& sample : samples) {
    const double half = std::sin(0.5 * (angle(sample) - origin - mean));
    versine += sample.power * 2.0 * half * half;
  }
  // For opposite directions of equal power the ratio is 1, or exceeds 1 by a rounding.
  return std::sqrt(-2.0 * std::log1p(-std::min(1.0, versine / total)));
}

LinkStatistics undefined(uint32_t paths, bool line_of_sight) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {paths, line_of_sight, 0.0, 0.0, nan, nan, nan, nan, nan, nan, nan, nan, nan};
}

}  // namespace

std::vector<double> path_powers(std::span<const Path> paths, const ArrayPose& transmitter,
                                const ArrayPose& receiver, double carrier_hz) {
  check_link(paths, transmitter, receiver, carrier_hz);
  PairAmplitudes amplitudes(transmitter, receiver, carrier_hz);
  std::vector<double> powers;
  powers.reserve(paths.size());
  for (const Path& path : paths) powers.push_back(amplitudes.mean_power(path));
  return powers;
}

double drawn_deviation(std::span<const Path> paths, std::span<const double> powers) {
  std::vector<double> strata;
  for (size_t i = 0; i < paths.size(); ++i) {
    const uint32_t stratum = paths[i].stratum;
    if (stratum == 0) continue;
    if (strata.size() < stratum) strata.resize(stratum);
    strata[stratum - 1] += powers[i];
  }
  if (strata.size() % 2 == 1) strata.push_back(0.0);
  double variance = 0.0;
  for (size_t i = 0; i < strata.size(); i += 2)
    variance += (strata[i] - strata[i + 1]) * (strata[i] - strata[i + 1]);
  for (size_t i = 0; i < paths.size(); ++i) variance += powers[i] * powers[i] * paths[i].draw_variance;
  return std::sqrt(std::max(0.0, variance));
}

LinkStatistics link_statistics(std::span<const Path> paths, std::span<const double> powers) {
  const std::vector<Sample> samples = sorted_samples(paths, powers);
  const bool line_of_sight =
      std::any_of(paths.begin(), paths.end(), [](const Path& path) { return path.interactions.empty(); });
  LinkStatistics link = undefined(static_cast<uint32_t>(paths.size()), line_of_sight);
  if (samples.empty()) return link;

  double direct = 0.0, others = 0.0;
  for (const Sample& sample : samples) {
    link.path_gain += sample.power;
    (sample.line_of_sight ? direct : others) += sample.power;
  }
  link.path_gain_deviation = drawn_deviation(paths, powers);
  link.k_factor = direct / others;  // +inf without other paths
  const double total = link.path_gain;
  const Moments delay = moments(samples, total, [](const Sample& sample) { return sample.delay_s; });
  const Moments doppler = moments(samples, total, [](const Sample& sample) { return sample.doppler_hz; });
  link.mean_delay_s = delay.mean;
  link.delay_spread_s = delay.spread;
  link.mean_doppler_hz = doppler.mean;
  link.doppler_spread_hz = doppler.spread;
  const auto spread = [&](auto angle) { return circular_spread(samples, total, angle); };
  link.departure_azimuth_spread = spread([](const Sample& sample) { return sample.departure.y; });
  link.departure_zenith_spread = spread([](const Sample& sample) { return sample.departure.x; });
  link.arrival_azimuth_spread = spread([](const Sample& sample) { return sample.arrival.y; });
  link.arrival_zenith_spread = spread([](const Sample& sample) { return sample.arrival.x; });
  return link;
}

}  // namespace greatx::rf
