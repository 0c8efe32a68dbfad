// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/coherence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

struct Weighted {
  double value, weight;
  auto operator<=>(const Weighted&) const = default;
};

template <typename Value>
std::vector<Weighted> weighted(std::span<const Path> paths, std::span<const double> powers,
                               const Value& value) {
  GREATX_CHECK(powers.size() == paths.size(), "{} powers of {} paths", powers.size(), paths.size());
  std::vector<Weighted> samples;
  for (size_t i = 0; i < paths.size(); ++i)
    if (powers[i] > 0.0) samples.push_back({value(paths[i]), powers[i]});
  std::sort(samples.begin(), samples.end());
  return samples;
}

/// Centres the values on their mean, scales the weights to a sum of 1 and returns the rms of the values.
double normalise(std::vector<Weighted>& samples) {
  double total = 0.0, first = 0.0, second = 0.0;
  const double origin = samples.front().value;
  for (const Weighted& sample : samples) total += sample.weight;
  for (const Weighted& sample : samples) first += sample.weight / total * (sample.value - origin);
  for (Weighted& sample : samples) {
    sample.value = (sample.value - origin) - first;
    sample.weight /= total;
    second += sample.weight * sample.value * sample.value;
  }
  return std::sqrt(second);
}

/// Returns the first x > 0 with |sum w e^{j 2 pi v x}| <= level. The slope of the modulus is at most 2 pi sum
/// w |v| <= 2 pi rms. Therefore a step of (modulus - level)/(2 pi rms) misses no crossing, however narrow.
double decorrelation(std::vector<Weighted> samples, double level) {
  GREATX_CHECK(level > 0.0 && level < 1.0, "level {} of a correlation", level);
  if (samples.empty()) return not_a_number;
  const double rms = normalise(samples);
  if (rms == 0.0) return infinity;
  const double strongest =
      std::max_element(samples.begin(), samples.end(), [](const Weighted& a, const Weighted& b) {
        return a.weight < b.weight;
      })->weight;
  if (2.0 * strongest - 1.0 > level) return infinity;  // the other samples cannot cancel enough of it
  for (double x = 0.0; x <= 10.0 / rms;) {
    double re = 0.0, im = 0.0;
    for (const Weighted& sample : samples) {
      const double angle = 2.0 * pi * sample.value * x;
      re += sample.weight * std::cos(angle);
      im += sample.weight * std::sin(angle);
    }
    const double above = std::hypot(re, im) - level;
    const double next = x + above / (2.0 * pi * rms);
    // The second condition ends the loop if the level is below the rounding of the sum.
    if (above <= 1e-9 * level || !(next > x)) return x;
    x = next;
  }
  return infinity;
}

}  // namespace

double coherence_bandwidth_hz(std::span<const Path> paths, std::span<const double> powers, double level) {
  return decorrelation(weighted(paths, powers, [](const Path& path) { return path.delay_s; }), level);
}

double coherence_time_s(std::span<const Path> paths, std::span<const double> powers, double level) {
  return decorrelation(weighted(paths, powers, [](const Path& path) { return path.doppler_hz; }), level);
}

}  // namespace greatx::rf
