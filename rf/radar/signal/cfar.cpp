// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/signal/cfar.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/parallel.h"

namespace greatx::rf {
namespace {

/// Returns the argument above 0 at which a falling function passes `value`.
template <typename Function>
double root_of_falling(const Function& function, double value) {
  double low = -40.0, high = 60.0;  // natural logarithms
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (function(std::exp(middle)) > value ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

/// Returns P(x > threshold) of Gamma(looks) for a whole number of looks: e^{-t} sum_{k<looks} t^k/k!.
double gamma_tail(uint32_t looks, double threshold) {
  double term = 1.0, sum = 1.0;
  for (uint32_t k = 1; k < looks; ++k) {
    term *= threshold / k;
    sum += term;
    if (!std::isfinite(sum)) return 1.0;
  }
  return std::min(1.0, std::exp(std::log(sum) - threshold));
}

/// Returns the x whose tail probability is `tail`.
double gamma_quantile(uint32_t looks, double tail) {
  return root_of_falling([&](double x) { return gamma_tail(looks, x); }, tail);
}

constexpr int steps = 800;

/// Returns the mean of f(x) over the rank-th smallest x of n Gamma(looks) variates. n and rank are real
/// numbers. The midpoint rule is applied in the logit of F(x). F(x) follows Beta(rank, n - rank + 1).
template <typename Function>
double order_statistic_mean(double cells, double rank, const std::vector<double>& quantiles,
                            const Function& f) {
  const double a = rank, b = cells - rank + 1.0;
  double sum = 0.0, weights = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double logit = -30.0 + 60.0 * (i + 0.5) / steps;
    const double log_u = -std::log1p(std::exp(-logit)), log_v = -std::log1p(std::exp(logit));
    const double weight = std::exp(a * log_u + b * log_v + std::lgamma(a + b) - std::lgamma(a) -
                                   std::lgamma(b));  // du = u (1-u) dlogit
    weights += weight;
    if (weight > 1e-300) sum += weight * f(quantiles[i]);
  }
  return sum / weights;
}

std::vector<double> quantiles_of(uint32_t looks) {
  std::vector<double> quantiles;
  for (int i = 0; i < steps; ++i)
    quantiles.push_back(gamma_quantile(looks, 1.0 / (1.0 + std::exp(-30.0 + 60.0 * (i + 0.5) / steps))));
  return quantiles;
}

double statistic_factor(double cells, double rank, uint32_t looks, double false_alarm,
                        const std::vector<double>& quantiles) {
  return root_of_falling(
      [&](double t) {
        return order_statistic_mean(cells, rank, quantiles,
                                    [&](double x) { return gamma_tail(looks, t * x); });
      },
      false_alarm);
}

double statistic_mean(double cells, double rank, uint32_t looks, const std::vector<double>& quantiles) {
  return order_statistic_mean(cells, rank, quantiles, [](double x) { return x; }) / looks;
}

}  // namespace

double cell_averaging_factor(double cells, uint32_t looks, double false_alarm) {
  const double shape = cells * looks;
  const auto tail = [&](double p) {
    // The first term is (1+p)^-shape. The factor from one term to the next is (shape + k) p/((k+1)(1+p)). The
    // terms are computed as logarithms.
    const double by = std::log(p) - std::log1p(p);
    double log_term = -shape * std::log1p(p), sum = std::exp(log_term);
    for (uint32_t k = 0; k + 1 < looks; ++k) {
      log_term += std::log((shape + k) / (k + 1.0)) + by;
      sum += std::exp(log_term);
    }
    return sum;
  };
  return cells * root_of_falling(tail, false_alarm);
}

double ordered_statistic_factor(uint32_t cells, uint32_t rank, uint32_t looks, double false_alarm) {
  GREATX_CHECK(rank >= 1 && rank <= cells, "rank {} of {}", rank, cells);
  return statistic_factor(cells, rank, looks, false_alarm, quantiles_of(looks));
}

double ordered_statistic_mean(uint32_t cells, uint32_t rank, uint32_t looks) {
  GREATX_CHECK(rank >= 1 && rank <= cells, "rank {} of {}", rank, cells);
  return statistic_mean(cells, rank, looks, quantiles_of(looks));
}

Cfar::Cfar(const RadarCfar& config, const Window& range_window, const Window& doppler_window, uint32_t looks,
           double rise)
    : config_(config),
      ranges_(range_window.size()),
      velocities_(doppler_window.size()),
      looks_(looks),
      rise_(rise) {
  // The square of a sum of four cosines correlates bins that are up to six apart.
  constexpr uint32_t farthest = 6;
  for (const auto& [window, correlation] :
       {std::pair{&range_window, &range_correlation_}, {&doppler_window, &doppler_correlation_}})
    for (uint32_t d = 0; d <= std::min(farthest, window->size() - 1); ++d) {
      const double rho = window->noise_correlation(d);
      correlation->push_back(rho * rho);
    }
  if (config.kind == RadarCfar::Kind::ordered_statistic) quantiles_ = quantiles_of(looks);
  const uint32_t reach = config.guard_range + config.train_range;
  std::map<std::pair<uint32_t, uint32_t>, Factor> known;
  const auto of = [&](uint32_t range) {
    const std::pair key{std::min(range, reach), std::min(ranges_ - 1 - range, reach)};
    const auto found = known.find(key);
    return found != known.end() ? found->second
                                : known.emplace(key, factor_for(key.first, key.second)).first->second;
  };
  for (uint32_t i = 0; i < ranges_; ++i) factors_.push_back(of(i));
}

Cfar::Factor Cfar::factor_for(uint32_t below, uint32_t above) const {
  const int32_t across = static_cast<int32_t>(config_.guard_doppler + config_.train_doppler);
  const int32_t first = -static_cast<int32_t>(below), last = static_cast<int32_t>(above);
  const auto trains = [&](int32_t r, int32_t d) {
    return r >= first && r <= last && std::abs(d) <= across &&
           (std::abs(r) > static_cast<int32_t>(config_.guard_range) ||
            std::abs(d) > static_cast<int32_t>(config_.guard_doppler));
  };
  const int32_t near_r = static_cast<int32_t>(range_correlation_.size()) - 1;
  const int32_t near_d = static_cast<int32_t>(doppler_correlation_.size()) - 1;
  uint32_t cells = 0;
  double alike = 0.0;
  for (int32_t r = first; r <= last; ++r)
    for (int32_t d = -across; d <= across; ++d) {
      if (!trains(r, d)) continue;
      ++cells;
      for (int32_t i = -near_r; i <= near_r; ++i)
        for (int32_t j = -near_d; j <= near_d; ++j)
          if (trains(r + i, d + j))
            alike += range_correlation_[std::abs(i)] * doppler_correlation_[std::abs(j)];
    }
  GREATX_CHECK(cells > 0, "no training cell with {} below and {} above", below, above);
  const double independent = double(cells) * cells / alike;
  if (config_.kind == RadarCfar::Kind::cell_averaging)
    return {cell_averaging_factor(independent, looks_, config_.false_alarm), 1.0, 0};
  const uint32_t rank = std::clamp(static_cast<uint32_t>(std::nearbyint(config_.rank * cells)), 1u, cells);
  const double by = independent / cells;
  const double share = std::max(1.0, rank * by), of = std::max(share, independent);
  return {statistic_factor(of, share, looks_, config_.false_alarm, quantiles_),
          statistic_mean(of, share, looks_, quantiles_), rank};
}

Cfar::Row Cfar::row(std::span<const float> map, uint32_t range) const {
  const Factor& f = factors_[range];
  const uint32_t guard_r = config_.guard_range, guard_d = config_.guard_doppler;
  const uint32_t reach_r = guard_r + config_.train_range, reach_d = guard_d + config_.train_doppler;
  const uint32_t first = range - std::min(range, reach_r), last = std::min(ranges_ - 1, range + reach_r);
  const auto guarded = [&](uint32_t r) { return r + guard_r >= range && r <= range + guard_r; };
  Row result{std::vector<double>(velocities_), f.threshold * f.bias};
  if (config_.kind == RadarCfar::Kind::cell_averaging) {
    // Sums of each column over the rows beyond the guard cells, and over the rows within them.
    std::vector<double> beyond(velocities_, 0.0), within(velocities_, 0.0);
    uint32_t rows_beyond = 0, rows_within = 0;
    for (uint32_t r = first; r <= last; ++r) {
      auto& sums = guarded(r) ? within : beyond;
      ++(guarded(r) ? rows_within : rows_beyond);
      for (uint32_t d = 0; d < velocities_; ++d) sums[d] += map[size_t{r} * velocities_ + d];
    }
    const uint32_t cells = rows_beyond * (2 * reach_d + 1) + rows_within * 2 * config_.train_doppler;
    // The columns around the circle, `reach_d` more on each side. All cells of the row are summed side by
    // side.
    std::vector<double> around[2];
    for (const auto& [sums, out] : {std::pair{&beyond, &around[0]}, {&within, &around[1]}}) {
      out->reserve(velocities_ + 2 * reach_d);
      for (uint32_t k = 0; k < velocities_ + 2 * reach_d; ++k)
        out->push_back((*sums)[(k + velocities_ - reach_d) % velocities_]);
    }
    const auto add = [&](const double* columns) {
      for (uint32_t d = 0; d < velocities_; ++d) result.noise_w[d] += columns[d];
    };
    for (uint32_t i = 0; i <= 2 * reach_d; ++i) {
      add(around[0].data() + i);
      if (i < config_.train_doppler || i > reach_d + guard_d) add(around[1].data() + i);
    }
    for (double& noise : result.noise_w) noise = noise / cells / rise_;
    return result;
  }
  std::vector<float> cells;
  for (uint32_t d = 0; d < velocities_; ++d) {
    cells.clear();
    for (uint32_t r = first; r <= last; ++r)
      for (uint32_t i = 0; i <= 2 * reach_d; ++i)
        if (!guarded(r) || i < config_.train_doppler || i > reach_d + guard_d)
          cells.push_back(map[size_t{r} * velocities_ + (d + velocities_ + i - reach_d) % velocities_]);
    std::nth_element(cells.begin(), cells.begin() + (f.rank - 1), cells.end());
    result.noise_w[d] = cells[f.rank - 1] / f.bias / rise_;
  }
  return result;
}

std::vector<CfarPeak> Cfar::peaks(std::span<const float> map, uint32_t threads) const {
  GREATX_CHECK(map.size() == size_t{ranges_} * velocities_, "{} cells", map.size());
  std::vector<std::vector<CfarPeak>> rows(ranges_);
  const auto highest = [&](uint32_t range, uint32_t velocity) {
    const size_t here = size_t{range} * velocities_ + velocity;
    for (uint32_t r = range - std::min(range, 1u); r <= std::min(ranges_ - 1, range + 1); ++r)
      for (const uint32_t d :
           {(velocity + velocities_ - 1) % velocities_, velocity, (velocity + 1) % velocities_}) {
        const size_t there = size_t{r} * velocities_ + d;
        if (map[there] > map[here] || (map[there] == map[here] && there < here)) return false;
      }
    return true;
  };
  parallel_for(ranges_, threads, [&](size_t range) {
    const Row noise = row(map, static_cast<uint32_t>(range));
    for (uint32_t d = 0; d < velocities_; ++d) {
      const double power = map[range * velocities_ + d];
      if (power > noise.noise_w[d] * noise.factor && highest(static_cast<uint32_t>(range), d))
        rows[range].push_back({static_cast<uint32_t>(range), d, power, noise.noise_w[d]});
    }
  });
  std::vector<CfarPeak> all;
  for (const auto& row_peaks : rows) all.insert(all.end(), row_peaks.begin(), row_peaks.end());
  return all;
}

}  // namespace greatx::rf
