// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/place/assemble/polyline.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace greatx::scene::place {

double line_length(const std::vector<dvec2>& line) {
  double length = 0.0;
  for (size_t i = 1; i < line.size(); ++i) length += glm::distance(line[i - 1], line[i]);
  return length;
}

std::vector<dvec2> part_of_line(const std::vector<dvec2>& line, double from_m, double to_m) {
  std::vector<dvec2> part;
  double at = 0.0;
  const auto add = [&](const dvec2& point) {
    if (part.empty() || glm::distance(part.back(), point) > 0.05) part.push_back(point);
  };
  for (size_t i = 1; i < line.size(); ++i) {
    const double step = glm::distance(line[i - 1], line[i]);
    if (at + step > from_m && at < to_m && step > 0.0) {
      add(glm::mix(line[i - 1], line[i], std::clamp((from_m - at) / step, 0.0, 1.0)));
      add(glm::mix(line[i - 1], line[i], std::clamp((to_m - at) / step, 0.0, 1.0)));
    }
    at += step;
  }
  return part;
}

std::vector<dvec2> without_corners(std::vector<dvec2> line) {
  for (int round = 0; round < 4 && line.size() > 2; ++round) {
    std::vector<dvec2> cut{line.front()};
    for (size_t i = 0; i + 1 < line.size(); ++i) {
      if (i > 0) cut.push_back(glm::mix(line[i], line[i + 1], 0.25));
      if (i + 2 < line.size()) cut.push_back(glm::mix(line[i], line[i + 1], 0.75));
    }
    cut.push_back(line.back());
    line = std::move(cut);
  }
  return line;
}

std::vector<dvec2> moved_right(const std::vector<dvec2>& line, double by_m) {
  std::vector<dvec2> moved;
  for (size_t i = 0; i < line.size(); ++i) {
    const dvec2 before = glm::normalize(line[std::max<size_t>(i, 1)] - line[std::max<size_t>(i, 1) - 1]);
    const size_t next = std::min(i + 1, line.size() - 1);
    const dvec2 after = glm::normalize(line[next] - line[next - 1]);
    const dvec2 along = glm::normalize(before + after + 1e-9 * before);
    const double miter = 1.0 / std::max(glm::dot(along, before), 0.5);
    moved.push_back(line[i] + by_m * miter * dvec2(along.y, -along.x));
  }
  return moved;
}

std::vector<dvec2> points_along(const std::vector<dvec2>& line, double step_m) {
  std::vector<dvec2> points;
  for (size_t i = 0; i + 1 < line.size(); ++i) {
    const int parts = std::max(1, static_cast<int>(std::ceil(glm::distance(line[i], line[i + 1]) / step_m)));
    for (int k = 0; k < parts; ++k)
      points.push_back(glm::mix(line[i], line[i + 1], static_cast<double>(k) / parts));
  }
  points.push_back(line.back());
  return points;
}

}  // namespace greatx::scene::place
