// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/ground/bridges.h"

#include <algorithm>
#include <cmath>

namespace greatx::scene::place {

namespace {

constexpr double clearance_m = 5.0;      // of one layer over the one below
constexpr double step_m = 8.0;           // between cross sections
constexpr double above_ground_m = 0.05;  // at the ends, so that deck and ground do not coincide

/// Divides a line into steps, and keeps its corners.
std::vector<dvec2> divided(const std::vector<dvec2>& line) {
  std::vector<dvec2> points;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = glm::distance(line[i], line[i + 1]);
    if (length < 0.1) continue;
    const int steps = static_cast<int>(std::ceil(length / step_m));
    for (int k = 0; k < steps; ++k)
      points.push_back(glm::mix(line[i], line[i + 1], static_cast<double>(k) / steps));
  }
  points.push_back(line.back());
  return points;
}

}  // namespace

Deck make_deck(const Bridge& bridge, const GroundLevel& level) {
  const std::vector<dvec2> points = divided(bridge.line);
  Deck deck;
  if (points.size() < 2) return deck;
  std::vector<double> at{0.0};
  for (size_t i = 1; i < points.size(); ++i)
    at.push_back(at.back() + glm::distance(points[i - 1], points[i]));
  const double length = at.back(), first = level(points.front()), last = level(points.back());
  const auto straight = [&](size_t i) { return first + (last - first) * at[i] / length; };
  double lowest = 1e300, deck_there = 0.0;
  for (size_t i = 0; i < points.size(); ++i)
    if (const double ground = level(points[i]); ground < lowest) {
      lowest = ground;
      deck_there = straight(i);
    }
  deck.lift_m = std::max(0.0, clearance_m * bridge.layer - (deck_there - lowest));
  const double ramp = std::min(0.4 * length, 60.0);
  for (size_t i = 0; i < points.size(); ++i) {
    const dvec2 before = points[i > 0 ? i - 1 : 0], after = points[std::min(i + 1, points.size() - 1)];
    const dvec2 along = glm::normalize(after - before), across(-along.y, along.x);
    // A mitre at corners, which keeps the width.
    const double bend = i > 0 && i + 1 < points.size()
                            ? std::max(0.5, glm::dot(along, glm::normalize(points[i] - before)))
                            : 1.0;
    const dvec2 half = across * (0.5 * bridge.width_m / bend);
    const double share = std::clamp(std::min(at[i], length - at[i]) / ramp, 0.0, 1.0);
    deck.sections.push_back(
        {points[i] + half, points[i] - half, straight(i) + deck.lift_m * share + above_ground_m});
  }
  return deck;
}

}  // namespace greatx::scene::place
