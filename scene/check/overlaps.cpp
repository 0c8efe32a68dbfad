// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/overlaps.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/parallel.h"

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind duplicate{FaultSeverity::fault, "duplicate", "triangles that are there twice",
                                    "m2"};
constexpr FaultList::Kind coincident{FaultSeverity::fault, "coincident",
                                     "pairs of triangles that lie on each other", "m2"};
constexpr FaultList::Kind back_to_back{
    FaultSeverity::doubt, "back_to_back",
    "pairs of triangles of two objects that touch back to back, as party walls that both have do", "m2"};
constexpr FaultList::Kind close_faces{FaultSeverity::doubt, "close_faces",
                                      "pairs of triangles with a gap so small that they flicker", "m2"};
/// Planes at a larger angle are no layers of one surface.
constexpr double least_cosine = 0.995;
/// Pairs of one triangle with larger ones that are counted: a heap of n copies makes no n * n pairs.
constexpr size_t most_of_one = 16;

/// A convex polygon in a plane: a triangle cut by up to three lines has at most six corners.
struct Polygon {
  std::array<dvec2, 7> corners;
  size_t count = 0;
  void add(const dvec2& corner) { corners[std::min<size_t>(count++, 6)] = corner; }
};

double cross(const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Keeps what is to the left of the line from a to b (Sutherland and Hodgman, CACM 17(1), 1974).
Polygon left_of_line(const Polygon& polygon, const dvec2& a, const dvec2& b) {
  Polygon kept;
  for (size_t i = 0; i < polygon.count; ++i) {
    const dvec2 &p = polygon.corners[i], &q = polygon.corners[(i + 1) % polygon.count];
    const double at_p = cross(b - a, p - a), at_q = cross(b - a, q - a);
    if (at_p >= 0.0) kept.add(p);
    if ((at_p >= 0.0) != (at_q >= 0.0)) kept.add(p + at_p / (at_p - at_q) * (q - p));
  }
  return kept;
}

double area_of(const Polygon& polygon) {
  double twice = 0.0;
  for (size_t i = 2; i < polygon.count; ++i)
    twice += cross(polygon.corners[i - 1] - polygon.corners[0], polygon.corners[i] - polygon.corners[0]);
  return 0.5 * std::abs(twice);
}

/// What two triangles have in common.
struct Overlap {
  double area = 0.0, gap = 0.0;
  dvec3 at{0.0};
};

std::optional<Overlap> overlap_of(const FacetTriangle& first, const dvec3& normal,
                                  const FacetTriangle& second, const dvec3& second_normal, double gap,
                                  double least_area) {
  const dvec3* a = first.corners;
  const dvec3* b = second.corners;
  // Nothing that follows can be near if all corners of the second are on one side, farther than the gap.
  const double h0 = glm::dot(b[0] - a[0], normal), h1 = glm::dot(b[1] - a[0], normal),
               h2 = glm::dot(b[2] - a[0], normal);
  if (std::min({h0, h1, h2}) > gap || std::max({h0, h1, h2}) < -gap) return std::nullopt;
  const dvec3 x = glm::normalize(a[1] - a[0]), y = glm::cross(normal, x);
  const auto flat = [&](const dvec3& p) { return dvec2(glm::dot(p - a[0], x), glm::dot(p - a[0], y)); };
  Polygon polygon;
  const bool same_way = glm::dot(normal, second_normal) > 0.0;
  for (size_t i = 0; i < 3; ++i) polygon.add(flat(b[same_way ? i : 2 - i]));
  for (size_t i = 0; i < 3; ++i) polygon = left_of_line(polygon, flat(a[i]), flat(a[(i + 1) % 3]));
  Overlap overlap;
  overlap.area = area_of(polygon);
  if (polygon.count < 3 || overlap.area < least_area) return std::nullopt;
  for (size_t i = 0; i < polygon.count; ++i) {
    const dvec3 p = a[0] + polygon.corners[i].x * x + polygon.corners[i].y * y;
    const double distance = glm::dot(p - b[0], second_normal);
    overlap.gap = std::max(overlap.gap, std::abs(distance));
    overlap.at += p / static_cast<double>(polygon.count);
  }
  if (overlap.gap > gap) return std::nullopt;
  return overlap;
}

bool same_corners(const FacetTriangle& a, const FacetTriangle& b, double tolerance) {
  return std::all_of(a.corners, a.corners + 3, [&](const dvec3& p) {
    return std::any_of(b.corners, b.corners + 3,
                       [&](const dvec3& q) { return glm::distance(p, q) <= tolerance; });
  });
}

struct Found {
  const FaultList::Kind* kind;
  Place place;
};

void compare(const Soup& soup, uint32_t i, uint32_t j, const CheckOptions& options,
             std::vector<Found>& found) {
  const double cosine = glm::dot(soup.normals[i], soup.normals[j]);
  if (std::abs(cosine) < least_cosine) return;
  const auto overlap = overlap_of(soup.triangles[i], soup.normals[i], soup.triangles[j], soup.normals[j],
                                  options.gap_m, options.overlap_m2);
  // Of two small triangles the area may be below the threshold, but a duplicate is one at any size.
  const uint32_t a = soup.object[i], b = soup.object[j];
  const double exact = std::max(1e-5, 2.0 * std::max(soup.objects[a].noise_m, soup.objects[b].noise_m));
  const double size = std::sqrt(std::min(soup.areas[i], soup.areas[j]));
  const bool twice = same_corners(soup.triangles[i], soup.triangles[j], std::min(exact, 1e-3 * size));
  if (!overlap && !twice) return;
  const Place place{overlap ? overlap->at : soup.centroid(i), a, a == b ? nothing : b, soup.material[i],
                    overlap ? overlap->area : soup.areas[i]};
  const bool opposite = cosine < 0.0;
  const bool apart = !twice && overlap->gap > exact;
  if (opposite && a != b)
    found.push_back({&back_to_back, place});
  else if (apart && !opposite)
    found.push_back({&close_faces, place});
  else if (!apart)
    found.push_back({twice ? &duplicate : &coincident, place});
}

}  // namespace

uint64_t find_overlaps(const Soup& soup, const SoupTree& tree, const CheckOptions& options,
                       FaultList& faults) {
  constexpr size_t block = 1024;
  const size_t blocks = (soup.triangles.size() + block - 1) / block;
  std::vector<std::vector<Found>> found(blocks);
  std::vector<uint64_t> crowds(blocks);
  parallel_for(blocks, options.threads, [&](size_t number) {
    for (size_t at = number * block; at < std::min(soup.triangles.size(), (number + 1) * block); ++at) {
      const auto i = static_cast<uint32_t>(at);
      Bounds box = tree.box(i);
      box.min -= options.gap_m, box.max += options.gap_m;
      const auto outside = [&](const Bounds& other) {
        return glm::any(glm::lessThan(box.max, other.min)) || glm::any(glm::greaterThan(box.min, other.max));
      };
      const size_t before = found[number].size();
      size_t seen = 0;
      tree.boxes().visit_until(outside, [&](uint32_t j) {
        // The smaller one of a pair looks for the larger one, since a ground has thousands of neighbours.
        const bool mine = soup.areas[j] > soup.areas[i] || (soup.areas[j] == soup.areas[i] && j > i);
        if (!mine || outside(tree.box(j))) return false;
        compare(soup, std::min(i, j), std::max(i, j), options, found[number]);
        crowds[number] += ++seen == most_neighbors ? 1 : 0;
        return seen == most_neighbors || found[number].size() - before >= most_of_one;
      });
    }
  });
  for (const std::vector<Found>& list : found)
    for (const Found& one : list) faults.add(*one.kind, one.place);
  return std::accumulate(crowds.begin(), crowds.end(), uint64_t{0});
}

}  // namespace greatx::scene::check
