// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/tradeoff/front.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace greatx::sim {

namespace {

constexpr double least_power = 1e-20;  ///< stands for 0 on a logarithmic scale

constexpr double costly_factor = 2.0;  ///< above it, a knob's reference is costly
constexpr double last_share = 4.0;     ///< of the limit that a single costly knob may take

/// Makes the scenario's own setting the reference: the dearer ones can no longer be chosen.
void limit_to_own(FrontKnob& knob) {
  const FrontSetting own = knob.settings[knob.standard];
  for (size_t i = 0; i < knob.settings.size(); ++i) {
    const bool dearer = i != knob.standard && knob.settings[i].ms > own.ms;
    knob.settings[i].power =
        dearer ? std::numeric_limits<double>::infinity() : std::max(0.0, knob.settings[i].power - own.power);
  }
  knob.reference = knob.standard;
  knob.factor = 1.0;
}

/// Keeps what is not beaten, by ascending time.
std::vector<FrontPoint> unbeaten(std::vector<FrontPoint> points) {
  std::ranges::sort(points, [](const FrontPoint& a, const FrontPoint& b) {
    return a.ms != b.ms ? a.ms < b.ms : a.power < b.power;
  });
  std::vector<FrontPoint> front;
  double best = std::numeric_limits<double>::infinity();
  for (FrontPoint& point : points) {
    if (!(point.power < best)) continue;
    best = point.power;
    front.push_back(std::move(point));
  }
  return front;
}

}  // namespace

double error_power(double error, bool relative_db) {
  return relative_db ? std::pow(10.0, error / 10.0) : error * error;
}
double error_of_power(double power, bool relative_db) {
  return relative_db ? 10.0 * std::log10(power) : std::sqrt(power);
}

std::vector<FrontPoint> thinned(std::vector<FrontPoint> front, size_t count) {
  if (front.size() <= count || count < 2) return front;
  // Places along the curve of logarithms of time and error, evenly apart.
  std::vector<double> length{0.0};
  const auto log_of = [](double value) { return std::log(std::max(value, least_power)); };
  const double time = std::max(1e-9, log_of(front.back().ms) - log_of(front.front().ms));
  const double error = std::max(1e-9, log_of(front.front().power) - log_of(front.back().power));
  for (size_t i = 1; i < front.size(); ++i)
    length.push_back(length.back() +
                     std::hypot((log_of(front[i].ms) - log_of(front[i - 1].ms)) / time,
                                (log_of(front[i].power) - log_of(front[i - 1].power)) / error));
  std::vector<FrontPoint> kept;
  size_t next = 0;
  for (size_t k = 0; k < count; ++k) {
    const double wanted = length.back() * static_cast<double>(k) / static_cast<double>(count - 1);
    size_t i = static_cast<size_t>(std::ranges::lower_bound(length, wanted) - length.begin());
    i = std::clamp(i, next, front.size() - (count - k));
    kept.push_back(front[i]);
    next = i + 1;
  }
  kept.back() = front.back();
  return kept;
}

FrontPoint joined(FrontPoint point, double own_ms, const FrontSetting& setting, size_t choice) {
  point.choice.push_back(choice);
  if (setting.ms >= own_ms)
    point.added_ms += setting.ms - own_ms;
  else
    point.factor *= std::max(setting.ms, 0.0) / own_ms;
  point.ms = (own_ms + point.added_ms) * point.factor;
  point.power += setting.power;
  return point;
}

std::vector<FrontPoint> front_of(double own_ms, const std::vector<FrontKnob>& knobs, size_t most) {
  std::vector<FrontPoint> front(1);
  front.front().ms = own_ms;
  for (const FrontKnob& knob : knobs) {
    std::vector<FrontPoint> joint;
    for (const FrontPoint& point : front)
      for (size_t s = 0; s < knob.settings.size(); ++s)
        joint.push_back(joined(point, own_ms, knob.settings[s], s));
    front = thinned(unbeaten(std::move(joint)), most);
  }
  return front;
}

std::vector<size_t> limit_costly(std::vector<FrontKnob>& knobs, double most) {
  std::vector<size_t> limited;
  for (;;) {
    double product = 1.0;
    size_t costly = 0, out = knobs.size();
    const auto own_power = [&](size_t k) { return knobs[k].settings[knobs[k].standard].power; };
    for (size_t k = 0; k < knobs.size(); ++k) {
      product *= std::max(1.0, knobs[k].factor);
      if (knobs[k].factor <= costly_factor) continue;
      ++costly;
      if (out == knobs.size() || own_power(k) < own_power(out)) out = k;
    }
    if (costly == 0 || product <= (costly == 1 ? last_share : 1.0) * most) return limited;
    limited.push_back(out);
    limit_to_own(knobs[out]);
  }
}

}  // namespace greatx::sim
