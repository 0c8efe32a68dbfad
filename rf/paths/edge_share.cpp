// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/edge_share.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "rf/edges/diffraction.h"
#include "rf/edges/utd.h"

namespace greatx::rf {

double edge_share(const scene::Wedge& wedge, const dvec3& before, const dvec3& at, const dvec3& after,
                  double wave_number) {
  constexpr double of_reflection = 1.0 / 3.0, least = 1e-12;
  const dvec3 from = before - at, to = after - at;
  const double from_m = glm::length(from), to_m = glm::length(to);
  const dvec2 source = across(wedge, from), observer = across(wedge, to);
  const double sine2 = glm::dot(source, source) / (from_m * from_m);
  const double distance_m = from_m * to_m * sine2 / (from_m + to_m);
  const UtdFactors factors = utd_factors(utd_angles(wedge.n, source, observer));
  double share = least;
  for (const UtdTerm term :
       {UtdTerm::shadow_n, UtdTerm::shadow_0, UtdTerm::reflection_n, UtdTerm::reflection_0}) {
    const UtdFactor& factor = factors[term];
    const bool reflection = term == UtdTerm::reflection_n || term == UtdTerm::reflection_0;
    const double w = std::sqrt(2.0 * wave_number * distance_m) * factor.half_sine;
    const double d = factor.amplitude / (1.0 + std::sqrt(pi) * w);
    share += (reflection ? of_reflection : 1.0) * d * d;
  }
  return share;
}

EdgeView view_of(const scene::Wedge& wedge, const dvec3& point) {
  const dvec3 edge = wedge.b - wedge.a, from = point - wedge.a;
  const double length_m = glm::length(edge);
  EdgeView view;
  view.foot_m = glm::dot(from, edge) / length_m;
  view.away_m = glm::length(from - view.foot_m / length_m * edge);
  view.from_edge_m = std::hypot(view.away_m, view.foot_m - std::clamp(view.foot_m, 0.0, length_m));
  view.first = std::atan2(-view.foot_m, view.away_m);
  view.angle = std::atan2(length_m - view.foot_m, view.away_m) - view.first;
  return view;
}

BoundaryShare::BoundaryShare(const scene::Wedge& wedge, const dvec3& point, double wave_number)
    : start_(wedge.a), tangent_0_(wedge.tangent_0), normal_0_(wedge.normal_0), wave_number_(wave_number) {
  const dvec2 at = across(wedge, point - wedge.a);
  away_m_ = glm::length(at);
  const dvec2 towards = at / away_m_, mirrored(-towards.x, towards.y);
  const double turn = 2.0 * wedge.n * pi;
  boundaries_ = {-towards, mirrored,
                 dvec2(std::cos(turn) * mirrored.x - std::sin(turn) * mirrored.y,
                       std::sin(turn) * mirrored.x + std::cos(turn) * mirrored.y)};
}

double BoundaryShare::of(const dvec3& center, double radius_m) const {
  constexpr double least_m = 1e-3;
  constexpr std::array parts{1.0, 1.0 / 3.0, 1.0 / 3.0};
  const dvec3 from = center - start_;
  const dvec2 at(glm::dot(tangent_0_, from), glm::dot(normal_0_, from));
  const double away_m = std::max(least_m, glm::length(at));
  const double distance_m = away_m * away_m_ / (away_m + away_m_);
  const double w = std::sqrt(2.0 * pi * wave_number_ * distance_m);
  double share = 0.0;
  for (size_t i = 0; i < parts.size(); ++i) {
    const double cosine = std::clamp(glm::dot(at, boundaries_[i]) / away_m, -1.0, 1.0);
    const double half_sine = std::sqrt(0.5 * (1.0 - cosine));
    const double falls = 1.0 + w * std::max(0.0, half_sine - 0.5 * radius_m / away_m);
    share += parts[i] / (falls * falls);
  }
  return share;
}

}  // namespace greatx::rf
