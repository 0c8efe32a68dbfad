// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/traffic/pieces.h"

#include <array>
#include <cmath>

namespace greatx::sim {
namespace {

/// An offset to the left and its derivatives.
struct Offset {
  double value = 0.0, first = 0.0, second = 0.0, third = 0.0;
};

Offset offset_of(const Piece& piece, double way_m) {
  Offset offset{piece.left_m, 0.0, 0.0, 0.0};
  const double length = piece.change_length_m, since = way_m - piece.begin_m;
  if (length <= 0.0 || since >= length) return offset;
  const double u = since / length, d = piece.change_m;
  // 1 - (6 u^5 - 15 u^4 + 10 u^3)
  offset.value += d * (1.0 - u * u * u * (u * (6.0 * u - 15.0) + 10.0));
  offset.first = -d * 30.0 * u * u * (u - 1.0) * (u - 1.0) / length;
  offset.second = -d * 60.0 * u * (u - 1.0) * (2.0 * u - 1.0) / (length * length);
  offset.third = -d * 60.0 * (6.0 * u * u - 6.0 * u + 1.0) / (length * length * length);
  return offset;
}

}  // namespace

WayPlace place_on(const Piece& piece, double way_m) {
  const CurvePlace on = piece.curve->at(piece.at_m + way_m - piece.begin_m);
  const Offset d = offset_of(piece, way_m);
  const dvec2 left = on.left();
  const double k = on.curvature, k1 = on.curvature_rate, rest = 1.0 - k * d.value;
  WayPlace place;
  place.position = dvec3(on.position + d.value * left, on.height);
  place.first = dvec3(rest * on.tangent + d.first * left, on.slope);
  // With left' = -k tangent and tangent' = k left.
  place.second =
      dvec3(-(k1 * d.value + 2.0 * k * d.first) * on.tangent + (k * rest + d.second) * left, on.slope_rate);
  // The heading is that of the middle line and the angle to it.
  const double g = d.first / rest;
  const double g1 = (d.second * rest + d.first * (k1 * d.value + k * d.first)) / (rest * rest);
  const double g2 = d.third / rest;  // exact where the line is straight or the offset constant
  const double q = 1.0 / (1.0 + g * g);
  place.heading = std::atan2(place.first.y, place.first.x);
  place.heading_first = k + g1 * q;
  place.heading_second = k1 + g2 * q - 2.0 * g * g1 * g1 * q * q;
  return place;
}

double length_between(const Piece& piece, double from_m, double to_m) {
  if (piece.curve->level() && piece.change_length_m == 0.0) {
    if (piece.left_m == 0.0 || piece.curve->straight()) return to_m - from_m;
    // Beside a curve: less by the offset times the turn, which is below half a turn in one piece.
    const auto tangent = [&](double way_m) {
      return piece.curve->at(piece.at_m + way_m - piece.begin_m).tangent;
    };
    const dvec2 a = tangent(from_m), b = tangent(to_m);
    return to_m - from_m - piece.left_m * std::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b));
  }
  constexpr std::array places{0.0469100770306680, 0.2307653449471585, 0.5, 0.7692346550528415,
                              0.9530899229693320};
  constexpr std::array weights{0.1184634425280945, 0.2393143352496832, 0.2844444444444444, 0.2393143352496832,
                               0.1184634425280945};
  const int parts = std::max(1, static_cast<int>(std::ceil(std::abs(to_m - from_m))));
  const double step = (to_m - from_m) / parts;
  double sum = 0.0;
  for (int part = 0; part < parts; ++part)
    for (size_t i = 0; i < places.size(); ++i)
      sum += weights[i] * glm::length(place_on(piece, from_m + step * (part + places[i])).first);
  return sum * step;
}

}  // namespace greatx::sim
