// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/world/instance_outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>

namespace greatx::sim {

namespace {

constexpr double least_height_m = 2.0;
constexpr double shortest_m = 1e-3, straight_m = 1e-3;  ///< of lines; off a line that two lines make

bool is_outlined(const scene::Instance& instance) {
  const bool tall = !instance.bounds.empty() && instance.bounds.size().z >= least_height_m;
  return tall && instance.body == 0 &&
         (instance.semantic_class == scene::SemanticClass::building ||
          instance.semantic_class == scene::SemanticClass::unlabeled);
}

dvec2 rounded(const dvec2& at) { return glm::round(1e3 * at) / 1e3; }

bool comes_before(const dvec2& a, const dvec2& b) { return std::tuple(a.x, a.y) < std::tuple(b.x, b.y); }
bool comes_before(const InstanceOutline::Line& a, const InstanceOutline::Line& b) {
  return a.from == b.from ? comes_before(a.to, b.to) : comes_before(a.from, b.from);
}

/// Returns where the plane z = level cuts a triangle's edge, computed in the same way from either end, so
/// that neighbours meet there.
dvec2 cut(dvec3 a, dvec3 b, double level) {
  if (std::tuple(b.x, b.y, b.z) < std::tuple(a.x, a.y, a.z)) std::swap(a, b);
  return dvec2(a) + dvec2(b - a) * ((level - a.z) / (b.z - a.z));
}

/// Joins lines that meet in a point, where no third one begins, and go straight on there.
std::vector<InstanceOutline::Line> joined(std::vector<InstanceOutline::Line> lines) {
  using Point = std::array<double, 2>;
  const auto key = [](const dvec2& at) { return Point{at.x, at.y}; };
  std::map<Point, std::vector<size_t>> ends;
  for (size_t i = 0; i < lines.size(); ++i) {
    ends[key(lines[i].from)].push_back(i);
    ends[key(lines[i].to)].push_back(i);
  }
  std::vector<bool> gone(lines.size());
  for (auto& [point, there] : ends) {
    if (there.size() != 2 || there[0] == there[1]) continue;
    InstanceOutline::Line &a = lines[there[0]], &b = lines[there[1]];
    const dvec2 at(point[0], point[1]);
    const dvec2 before = a.from == at ? a.to : a.from, after = b.from == at ? b.to : b.from;
    const dvec2 whole = after - before, half = at - before;
    const double length = glm::length(whole);
    if (length < shortest_m || std::abs(whole.x * half.y - whole.y * half.x) > straight_m * length ||
        glm::dot(half, after - at) < 0.0)
      continue;
    a = {before, after};
    gone[there[1]] = true;
    std::vector<size_t>& moved = ends[key(after)];
    std::ranges::replace(moved, there[1], there[0]);
  }
  std::vector<InstanceOutline::Line> kept;
  for (size_t i = 0; i < lines.size(); ++i)
    if (!gone[i]) kept.push_back(lines[i]);
  return kept;
}

std::vector<InstanceOutline::Line> tidy(std::vector<InstanceOutline::Line> lines) {
  for (InstanceOutline::Line& line : lines)
    if (comes_before(line.to, line.from)) std::swap(line.from, line.to);
  std::ranges::sort(lines, [](const auto& a, const auto& b) { return comes_before(a, b); });
  const auto same = std::ranges::unique(
      lines, [](const auto& a, const auto& b) { return a.from == b.from && a.to == b.to; });
  lines.erase(same.begin(), same.end());
  return lines;
}

}  // namespace

std::vector<std::optional<InstanceOutline>> instance_outlines(const World& world) {
  const scene::Scene& scene = world.scene;
  std::vector<std::optional<InstanceOutline>> outlines(scene.instances.size());
  for (size_t i = 0; i < outlines.size(); ++i)
    if (is_outlined(scene.instances[i]))
      outlines[i] = InstanceOutline{scene.instances[i].bounds.center().z, {}};
  for (const scene::Primitive& primitive : scene.primitives) {
    std::optional<InstanceOutline>& outline = outlines[primitive.instance];
    if (!outline) continue;
    for (uint32_t t = 0; t + 2 < primitive.index_count; t += 3) {
      dvec3 corner[3];
      for (uint32_t c = 0; c < 3; ++c)
        corner[c] = dvec3(scene.positions[scene.indices[primitive.first_index + t + c]]);
      std::array<dvec2, 2> ends{};  // a plane cuts none or two of a triangle's edges
      size_t count = 0;
      for (int c = 0; c < 3; ++c) {
        const dvec3 &a = corner[c], &b = corner[(c + 1) % 3];
        // A corner on the plane counts as above, so that an edge is cut once or not at all.
        if ((a.z >= outline->height_m) != (b.z >= outline->height_m))
          ends[count++] = rounded(cut(a, b, outline->height_m) + dvec2(scene.origin));
      }
      if (count == 2 && glm::length(ends[1] - ends[0]) >= shortest_m)
        outline->lines.push_back({ends[0], ends[1]});
    }
  }
  for (std::optional<InstanceOutline>& outline : outlines) {
    if (!outline) continue;
    outline->height_m = std::round(1e3 * (outline->height_m + scene.origin.z)) / 1e3;
    outline->lines = tidy(joined(tidy(std::move(outline->lines))));
    if (outline->lines.empty() || outline->lines.size() > most_outline_lines) outline.reset();
  }
  return outlines;
}

}  // namespace greatx::sim
