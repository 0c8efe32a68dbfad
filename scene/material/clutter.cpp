// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/material/clutter.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::scene {
namespace {

struct NamedClutter {
  const char* name;
  SurfaceClutter clutter;
};

/// docs/clutter.md says where each row comes from. Short grass is the middle of Kulemin's -25 to -30 dB.
constexpr NamedClutter named_clutter[] = {
    {"asphalt", {ClutterForm::kulemin, -49.0, 32.0, 20.0, 0.0, -10.0}},
    {"concrete", {ClutterForm::kulemin, -49.0, 32.0, 20.0, 0.0, -10.0}},
    {"gravel", {ClutterForm::kulemin, -37.0, 18.0, 15.0, 0.0, -10.0}},
    {"soil", {ClutterForm::kulemin, -37.0, 18.0, 15.0, 0.0, -10.0}},
    {"snow", {ClutterForm::kulemin, -34.0, 25.0, 15.0, 0.0, -10.0}},
    {"grass", {ClutterForm::kulemin, -27.5, 10.0, 6.0, 0.0, -10.0}},
    {"tall_grass", {ClutterForm::kulemin, -21.0, 10.0, 6.0, 0.0, -10.0}},
    {"buildings", {ClutterForm::kulemin, -8.5, 5.0, 3.0, 0.0, -10.0}},
    {"foliage", {ClutterForm::constant_gamma, -15.0, 0.0, 6.0, 0.0, -10.0}},
    {"water", {ClutterForm::sea, 0.0, 0.0, 0.0, 1.0, -15.0}}};

constexpr double least_grazing_deg = 0.1;  ///< below it, sigma0 falls with the sine

/// Coefficients c1 to c5 of a polarization: Gregers-Hansen and Mital 2012.
struct SeaRow {
  double c1, c2, c3, c4, c5;
};
constexpr SeaRow sea_h{-73.0, 20.781, 7.351, 25.65, 0.0054}, sea_v{-50.796, 25.93, 0.7093, 21.588, 0.00211};

double sea_db(const SeaRow& row, double grazing_deg, double f_ghz, double state) {
  const double a = grazing_deg;
  return row.c1 + row.c2 * std::log10(std::sin(radians(a))) +
         (27.5 + row.c3 * a) * std::log10(f_ghz) / (1.0 + 0.95 * a) +
         row.c4 * std::pow(1.0 + state, 1.0 / (2.0 + 0.085 * a + 0.033 * state)) + row.c5 * a * a;
}

double linear(double db) { return std::pow(10.0, 0.1 * db); }

}  // namespace

std::optional<SurfaceClutter> clutter_called(const std::string& name) {
  for (const NamedClutter& row : named_clutter)
    if (name == row.name) return row.clutter;
  return std::nullopt;
}

std::vector<std::string> clutter_names() {
  std::vector<std::string> names;
  for (const NamedClutter& row : named_clutter) names.emplace_back(row.name);
  return names;
}

Backscatter backscatter(const SurfaceClutter& clutter, double sine, double frequency_hz) {
  if (!(sine > 0.0)) return {};
  const double least = std::sin(radians(least_grazing_deg)), grazing_sine = std::clamp(sine, least, 1.0),
               grazing_deg = degrees(std::asin(grazing_sine)), decades = std::log10(frequency_hz / 10e9);
  const double below = std::min(1.0, sine / least);
  double h_db = 0.0, v_db = 0.0;
  switch (clutter.form) {
    case ClutterForm::kulemin:
      h_db = v_db = clutter.level_db + clutter.angle_db * std::log10(grazing_deg / 20.0) +
                    clutter.frequency_db * decades;
      break;
    case ClutterForm::constant_gamma:
      h_db = v_db = clutter.level_db + clutter.frequency_db * decades + 10.0 * std::log10(grazing_sine);
      break;
    case ClutterForm::sea:
      h_db = sea_db(sea_h, grazing_deg, 1e-9 * frequency_hz, clutter.sea_state);
      v_db = sea_db(sea_v, grazing_deg, 1e-9 * frequency_hz, clutter.sea_state);
      break;
  }
  const double h = below * linear(h_db), v = below * linear(v_db);
  return {h, v, linear(clutter.cross_db) * 0.5 * (h + v)};
}

}  // namespace greatx::scene
