// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/fit/problem.h"

#include <algorithm>
#include <cmath>

namespace greatx::sim {

const char* name_of(FitProperty property) {
  constexpr const char* names[] = {"permittivity", "conductivity",       "thickness",        "roughness",
                                   "scattering",   "cross_polarization", "backscatter_share"};
  return names[static_cast<size_t>(property)];
}

const char* unit_of(FitProperty property) {
  constexpr const char* units[] = {"1", "S/m", "m", "m", "1", "1", "1"};
  return units[static_cast<size_t>(property)];
}

const char* name_of(FitUnknownKind kind) {
  constexpr const char* names[] = {"scale_db", "clock_s", "orientation_deg", "antenna_offset_m"};
  return names[static_cast<size_t>(kind)];
}

const char* name_of(FitQuantity quantity) {
  constexpr const char* names[] = {"power_db", "delay_spread_ns", "cir", "cfr"};
  return names[static_cast<size_t>(quantity)];
}

double FitLoss::cost(double x) const {
  const double a = std::abs(x);
  switch (kind) {
    case FitLossKind::squares:
      break;
    case FitLossKind::huber:
      return a <= scale ? 0.5 * x * x : scale * (a - 0.5 * scale);
    case FitLossKind::cauchy:
      return 0.5 * scale * scale * std::log1p((x / scale) * (x / scale));
  }
  return 0.5 * x * x;
}

double FitLoss::weight(double x) const {
  switch (kind) {
    case FitLossKind::squares:
      break;
    case FitLossKind::huber:
      return std::abs(x) <= scale ? 1.0 : scale / std::abs(x);
    case FitLossKind::cauchy:
      return 1.0 / (1.0 + (x / scale) * (x / scale));
  }
  return 1.0;
}

double FitLoss::slope(double x) const { return weight(x) * x; }

double FitLoss::curvature(double x) const {
  switch (kind) {
    case FitLossKind::squares:
      break;
    case FitLossKind::huber:
      return std::abs(x) <= scale ? 1.0 : 0.0;
    case FitLossKind::cauchy: {
      const double q = (x / scale) * (x / scale);
      return (1.0 - q) / ((1.0 + q) * (1.0 + q));
    }
  }
  return 1.0;
}

}  // namespace greatx::sim
