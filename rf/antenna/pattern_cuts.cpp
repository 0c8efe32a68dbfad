// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/pattern_cuts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {

PatternTable pattern_of_cuts(const PatternCuts& cuts, std::string name, std::string sha256) {
  const std::vector<double>&h = cuts.horizontal_db, &v = cuts.vertical_db;
  GREATX_CHECK(h.size() >= 4 && v.size() >= 4 && v.size() % 4 == 0, "cuts of {} and {} values", h.size(),
               v.size());
  const size_t quarter = v.size() / 4, half = v.size() / 2;
  const double behind_db =
      h.size() % 2 == 0 ? h[h.size() / 2] : 0.5 * (h[h.size() / 2] + h[h.size() / 2 + 1]);
  std::vector<Jones> samples;
  samples.reserve((half + 1) * h.size());
  for (size_t i = 0; i <= half; ++i) {                         // from the zenith downwards
    const size_t front = (quarter + v.size() - i) % v.size();  // elevation pi/2 - theta
    const size_t back = (half + v.size() - front) % v.size();
    for (size_t j = 0; j < h.size(); ++j) {
      const double turn = 2.0 * static_cast<double>(j) / static_cast<double>(h.size());  // phi/pi
      const double t = std::min(turn, 2.0 - turn);
      const bool pole = i == 0 || i == half;
      const double attenuation_db =
          pole ? v[front] : h[j] + (1.0 - t) * (v[front] - h[0]) + t * (v[back] - behind_db);
      samples.push_back({std::pow(10.0, (cuts.gain_dbi - attenuation_db) / 20.0), 0.0});
    }
  }
  return PatternTable({static_cast<uint32_t>(half + 1), static_cast<uint32_t>(h.size()), 0.0},
                      std::move(samples), std::move(name), std::move(sha256));
}

double mean_gain(const PatternTable& table) {
  const uint32_t steps = table.grid().zeniths - 1, azimuths = table.grid().azimuths;
  double mean = 0.0;
  for (uint32_t i = 0; i <= steps; ++i) {
    // The integral of sin(theta) cos(2 k theta) is 2/(1 - 4 k^2).
    double weight = 1.0;
    for (uint32_t k = 1; 2 * k <= steps; ++k)
      weight -= (2 * k == steps ? 1.0 : 2.0) / (4.0 * k * k - 1.0) * std::cos(2.0 * pi * k * i / steps);
    weight *= (i == 0 || i == steps ? 1.0 : 2.0) / steps;
    double row = 0.0;
    for (uint32_t j = 0; j < azimuths; ++j) {
      const Jones& f = table.samples()[size_t{i} * azimuths + j];
      row += std::norm(f.theta) + std::norm(f.phi);
    }
    mean += 0.5 * weight * row / azimuths;
  }
  return mean;
}

}  // namespace greatx::rf
