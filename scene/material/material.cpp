// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/material.h"

#include <cmath>
#include <limits>
#include <mutex>
#include <set>

#include <spdlog/spdlog.h>

#include "core/error.h"
#include "core/units.h"

namespace greatx::scene {
namespace {

std::string ranges_of(const RadioMedium& medium) {
  std::string text;
  for (const RadioRow& row : medium.rows) {
    if (!text.empty()) text += ", ";
    text += fmt::format("{:g} to {:g} GHz", row.min_hz / 1e9, row.max_hz / 1e9);
  }
  return text;
}

/// Returns how far outside the row's range the frequency lies, in octaves (ranges span decades); 0 inside.
double octaves_outside(const RadioRow& row, double frequency_hz) {
  if (frequency_hz < row.min_hz) return std::log2(row.min_hz / frequency_hz);
  if (frequency_hz > row.max_hz) return std::log2(frequency_hz / row.max_hz);
  return 0.0;
}

const RadioRow* narrowest_row(const RadioMedium& medium, double frequency_hz) {
  const RadioRow* best = nullptr;
  for (const RadioRow& row : medium.rows) {
    if (frequency_hz < row.min_hz || frequency_hz > row.max_hz) continue;
    if (!best || row.max_hz - row.min_hz < best->max_hz - best->min_hz) best = &row;
  }
  return best;
}

const RadioRow* nearest_row(const RadioMedium& medium, double frequency_hz) {
  const RadioRow* best = nullptr;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const RadioRow& row : medium.rows) {
    const double distance = octaves_outside(row, frequency_hz);
    if (distance < best_distance) {
      best = &row;
      best_distance = distance;
    }
  }
  return best;
}

/// Warns of an extrapolation, once for each medium of a process: a city has a dozen materials of brick.
void warn_of_extrapolation(const RadioMedium& medium, double frequency_hz, const std::string& material_name) {
  static std::mutex mutex;
  static std::set<std::string> warned;
  const std::lock_guard lock(mutex);
  const bool shared = medium.source.starts_with("ITU");  // a name that means the same everywhere
  if (!warned.insert(shared ? medium.source : material_name + '\n' + medium.source).second) return;
  spdlog::warn("beyond_range: '{}' ({}: {}) is extrapolated to {:g} GHz", material_name, medium.source,
               ranges_of(medium), frequency_hz / 1e9);
}

}  // namespace

const RadioRow& row_at(const RadioMedium& medium, double frequency_hz, const std::string& material_name) {
  GREATX_CHECK(!medium.rows.empty(), "material '{}' has no row", material_name);
  if (!(frequency_hz > 0.0) || !std::isfinite(frequency_hz)) {
    throw_user_error("material '{}': frequency {} Hz: expected a positive number", material_name,
                     frequency_hz);
  }
  const RadioRow* row = narrowest_row(medium, frequency_hz);
  const bool extrapolated = row == nullptr;
  if (extrapolated) {
    if (!medium.extrapolate) {
      throw_user_error(
          "material '{}' ({}): {:g} GHz lies outside its ranges ({}); choose another frequency or material, "
          "or set 'extrapolate: true' (in radio materials for all: 'beyond_range: extrapolate') to use the "
          "nearest row",
          material_name, medium.source, frequency_hz / 1e9, ranges_of(medium));
    }
    row = nearest_row(medium, frequency_hz);
    warn_of_extrapolation(medium, frequency_hz, material_name);
  }
  spdlog::debug("material '{}' ({}) at {:g} GHz: row a={:g} b={:g} c={:g} d={:g}, {:g} to {:g} GHz{}",
                material_name, medium.source, frequency_hz / 1e9, row->a, row->b, row->c, row->d,
                row->min_hz / 1e9, row->max_hz / 1e9, extrapolated ? " (extrapolated)" : "");
  return *row;
}

std::complex<double> relative_permittivity(const RadioMedium& medium, double frequency_hz,
                                           const std::string& material_name) {
  const RadioRow& row = row_at(medium, frequency_hz, material_name);
  const double frequency_ghz = frequency_hz / 1e9;
  const double real = row.a * std::pow(frequency_ghz, row.b);
  const double conductivity = row.c * std::pow(frequency_ghz, row.d);  // S/m
  return {real, -conductivity / (2.0 * pi * frequency_hz * vacuum_permittivity)};
}

}  // namespace greatx::scene
