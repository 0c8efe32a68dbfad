// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "draw/paths/stroke.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace greatx::apps {

namespace {

/// Clips the part [t0, t1] of a line to low..high in one coordinate. Returns false if nothing remains.
bool clip(double from, double to, double low, double high, double& t0, double& t1) {
  const double delta = to - from;
  if (delta == 0.0) return from >= low && from <= high;
  double enter = (low - from) / delta, leave = (high - from) / delta;
  if (enter > leave) std::swap(enter, leave);
  t0 = std::max(t0, enter);
  t1 = std::min(t1, leave);
  return t0 < t1;
}

/// Returns the signed distance to an axis-aligned square with sides of 2 * `half` around the origin.
double box_distance(const dvec2& p, double half) {
  const dvec2 d = glm::abs(p) - half;
  return glm::length(glm::max(d, dvec2(0.0))) + std::min(std::max(d.x, d.y), 0.0);
}

/// Returns the largest signed distance to the lines through the edges of a regular polygon, negative inside.
/// The polygon has `corners` corners on a circle around the origin, one of them at the top.
double polygon_distance(const dvec2& p, double radius, int corners) {
  double distance = -1e300;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / corners;
    distance = std::max(distance, glm::dot(p, dvec2(std::sin(angle), -std::cos(angle))));
  }
  return distance - radius * std::cos(pi / corners);
}

/// Holds a range of steps [first, last) that are all hidden or all visible.
struct Run {
  int first = 0, last = 0;
  bool hidden = false;
};

std::vector<Run> runs_of(const std::vector<bool>& hidden) {
  std::vector<Run> runs;
  const int steps = static_cast<int>(hidden.size());
  for (int first = 0; first < steps;) {
    int last = first + 1;
    while (last < steps && hidden[static_cast<size_t>(last)] == hidden[static_cast<size_t>(first)]) ++last;
    // A run of one or two pixels is joined to the run before it, to avoid flicker.
    if (!runs.empty() && (last - first <= 2 || runs.back().hidden == hidden[static_cast<size_t>(first)]))
      runs.back().last = last;
    else
      runs.push_back({first, last, hidden[static_cast<size_t>(first)]});
    first = last;
  }
  return runs;
}

}  // namespace

ShapeCoverage::ShapeCoverage(int width, int height)
    : width_(width), height_(height), share_(static_cast<size_t>(width) * static_cast<size_t>(height)) {}

void ShapeCoverage::shape(const dvec2& low, const dvec2& high,
                          const std::function<double(const dvec2&)>& distance) {
  const int left = std::max(0, static_cast<int>(std::floor(std::max(low.x, -1e6) - 1.0)));
  const int top = std::max(0, static_cast<int>(std::floor(std::max(low.y, -1e6) - 1.0)));
  const int right = std::min(width_ - 1, static_cast<int>(std::ceil(std::min(high.x, 1e6) + 1.0)));
  const int bottom = std::min(height_ - 1, static_cast<int>(std::ceil(std::min(high.y, 1e6) + 1.0)));
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const double share = std::clamp(0.5 - distance({x + 0.5, y + 0.5}), 0.0, 1.0);
      if (share <= 0.0) continue;
      const uint32_t pixel =
          static_cast<uint32_t>(y) * static_cast<uint32_t>(width_) + static_cast<uint32_t>(x);
      if (share_[pixel] == 0.0f) touched_.push_back(pixel);
      share_[pixel] = std::max(share_[pixel], static_cast<float>(share));
    }
}

void ShapeCoverage::line(const dvec2& a, const dvec2& b, double width) {
  // The line is divided into short pieces, so that a slanted line does not visit every pixel of its bounding
  // box.
  const int pieces = std::max(1, static_cast<int>(glm::distance(a, b) / 24.0));
  const double half = 0.5 * width;
  for (int i = 0; i < pieces; ++i) {
    const dvec2 from = glm::mix(a, b, static_cast<double>(i) / pieces),
                to = glm::mix(a, b, (i + 1.0) / pieces), along = to - from;
    const double square = glm::dot(along, along);
    shape(glm::min(from, to) - half, glm::max(from, to) + half, [&](const dvec2& p) {
      const double t = square > 0.0 ? std::clamp(glm::dot(p - from, along) / square, 0.0, 1.0) : 0.0;
      return glm::distance(p, from + t * along) - half;
    });
  }
}

void ShapeCoverage::paint(io::Canvas& canvas, const ivec2& offset, io::Color color, double opacity) {
  for (const uint32_t pixel : touched_) {
    const int x = static_cast<int>(pixel % static_cast<uint32_t>(width_)),
              y = static_cast<int>(pixel / static_cast<uint32_t>(width_));
    canvas.blend(offset.x + x, offset.y + y, color, opacity * static_cast<double>(share_[pixel]));
    share_[pixel] = 0.0f;
  }
  touched_.clear();
}

double marker_distance(rf::InteractionType type, const dvec2& p, double radius) {
  switch (type) {
    case rf::InteractionType::transmission:
      return box_distance(dvec2(p.x + p.y, p.y - p.x) * std::sqrt(0.5), 0.8 * radius);
    case rf::InteractionType::diffraction:
      return polygon_distance(p - dvec2(0.0, 0.25 * radius), 1.4 * radius, 3);
    case rf::InteractionType::scattering: {  // four bars in steps of 45 degrees
      const double arm = 0.32 * radius;
      double distance = 1e300;
      for (int i = 0; i < 4; ++i) {
        const dvec2 along(std::cos(0.25 * pi * i), std::sin(0.25 * pi * i));
        const double t = std::clamp(glm::dot(p, along), -1.1 * radius, 1.1 * radius);
        distance = std::min(distance, glm::distance(p, t * along) - arm);
      }
      return distance;
    }
    default:
      return glm::length(p) - radius;
  }
}

std::vector<Stretch> stretches_of(const PictureView& view, std::span<const float> depth, const dvec3& a,
                                  const dvec3& b) {
  // Keep the part in front of the near plane.
  const dvec3 forward = view.local_from_sensor.rotate({1, 0, 0}), eye = view.local_from_sensor.position;
  double t0 = 0.0, t1 = 1.0;
  if (!clip(glm::dot(forward, a - eye), glm::dot(forward, b - eye), view.near_m, 1e300, t0, t1)) return {};
  const dvec3 from = view.project_straight(glm::mix(a, b, t0)),
              to = view.project_straight(glm::mix(a, b, t1));
  // Keep the part in the picture, with room for the width of the line. With lens distortion, keep the part
  // that the lens sees.
  constexpr double room = 8.0;
  dvec2 least(-room), most = dvec2(view.width, view.height) + room;
  const bool distorts = view.distortion.any();
  if (distorts) {
    const dvec2 center(view.cx, view.cy), focal(view.fx, view.fy);
    least = center + focal * view.sees.least;
    most = center + focal * view.sees.most;
  }
  double s0 = 0.0, s1 = 1.0;
  if (!clip(from.x, to.x, least.x, most.x, s0, s1) || !clip(from.y, to.y, least.y, most.y, s0, s1)) return {};
  const auto at = [&](double s) {  // 1 / depth is linear in the pinhole picture
    return dvec3(glm::mix(dvec2(from), dvec2(to), s), 1.0 / glm::mix(1.0 / from.z, 1.0 / to.z, s));
  };

  const double length = (s1 - s0) * glm::distance(dvec2(from), dvec2(to));
  const int steps = std::max(1, static_cast<int>(std::ceil(length)));
  std::vector<bool> hidden(static_cast<size_t>(steps));
  for (int i = 0; i < steps; ++i) {
    dvec3 p = at(s0 + (s1 - s0) * (i + 0.5) / steps);
    p = dvec3(view.bent(dvec2(p)), p.z);
    const auto x = std::clamp(static_cast<int64_t>(std::floor(p.x)), int64_t{0}, int64_t{view.width} - 1);
    const auto y = std::clamp(static_cast<int64_t>(std::floor(p.y)), int64_t{0}, int64_t{view.height} - 1);
    hidden[static_cast<size_t>(i)] =
        is_hidden(p.z, depth[static_cast<size_t>(y) * view.width + static_cast<size_t>(x)]);
  }
  std::vector<Stretch> stretches;
  for (const Run& run : runs_of(hidden)) {
    const auto point = [&](int step) { return view.bent(dvec2(at(s0 + (s1 - s0) * step / steps))); };
    // Lens distortion bends the line, so it is drawn as short chords.
    constexpr int chord = 8;
    const int pieces = distorts ? (run.last - run.first + chord - 1) / chord : 1;
    for (int i = 0; i < pieces; ++i)
      stretches.push_back({point(run.first + (run.last - run.first) * i / pieces),
                           point(run.first + (run.last - run.first) * (i + 1) / pieces), run.hidden});
  }
  return stretches;
}

}  // namespace greatx::apps
