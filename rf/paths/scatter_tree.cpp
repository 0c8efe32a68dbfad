// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/scatter_tree.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "core/watch.h"

namespace greatx::rf {

namespace {

/// Returns base^exponent.
double whole_power(double base, uint32_t exponent) {
  double result = 1.0;
  for (; exponent > 0; exponent >>= 1, base *= base)
    if (exponent & 1u) result *= base;
  return result;
}

double lobe_around(const dvec3& axis, const dvec3& out, uint32_t exponent) {
  const dvec3 sum = axis + out;
  return whole_power(std::min(1.0, 0.25 * glm::dot(sum, sum)), exponent);
}

/// Returns the value of scattering_pattern() at the top of its lobes, for a wave at this cosine of incidence.
/// scattering_pattern() is lobe_of() times this value.
double peak_of(const DiffuseScattering& surface, double cosine) {
  if (surface.pattern == scene::ScatteringPattern::lambertian) return 1.0 / pi;
  const double forward = lobe_normalisation(surface.exponent, cosine);
  if (surface.pattern == scene::ScatteringPattern::directive) return 1.0 / forward;
  const double back = surface.backscatter_share;
  return 1.0 / ((1.0 - back) * forward + back * lobe_normalisation(surface.backscatter_exponent, cosine));
}

double peak_of(const LitPatch& patch) {
  return peak_of(*patch.surface, std::clamp(glm::dot(patch.specular, patch.normal), 0.0, 1.0));
}

/// Returns the shape of scattering_pattern(), at most 1.
double lobe_of(const DiffuseScattering& surface, const dvec3& normal, const dvec3& specular,
               const dvec3& out) {
  const double cos_out = glm::dot(out, normal);
  if (cos_out <= 0.0) return 0.0;
  if (surface.pattern == scene::ScatteringPattern::lambertian) return cos_out;
  const double forward = lobe_around(specular, out, surface.exponent);
  if (surface.pattern == scene::ScatteringPattern::directive) return forward;
  const dvec3 to_source = 2.0 * glm::dot(specular, normal) * normal - specular;
  return (1.0 - surface.backscatter_share) * forward +
         surface.backscatter_share * lobe_around(to_source, out, surface.backscatter_exponent);
}

/// The coordinates in which neighbours shall be alike: place, and the others in metres that count as much.
constexpr size_t measures = 10;
std::array<double, measures> measures_of(const LitPatch& s, double scale_m) {
  return {s.position.x,           s.position.y,
          s.position.z,           scale_m * s.normal.x,
          scale_m * s.normal.y,   scale_m * s.normal.z,
          scale_m * s.specular.x, scale_m * s.specular.y,
          scale_m * s.specular.z, s.length_m};
}

}  // namespace

ScatterTree::ScatterTree(std::vector<LitPatch> patches) : patches_(std::move(patches)) {
  if (patches_.empty()) return;
  nodes_.reserve(2 * patches_.size());
  build(0, static_cast<uint32_t>(patches_.size()));
}

/// Appends the node of a range and all nodes below it.
void ScatterTree::build(uint32_t first, uint32_t last) {
  checkpoint();
  const size_t index = nodes_.size();
  Node& node = nodes_.emplace_back();
  node.first = first;
  node.last = last;
  sum_up(node);
  if (last - first == 1) return;
  const double scale_m = 0.5 * node.radius_m;
  std::array<double, measures> least, most;
  least.fill(1e300), most.fill(-1e300);
  for (uint32_t i = first; i < last; ++i) {
    const auto at = measures_of(patches_[i], scale_m);
    for (size_t k = 0; k < measures; ++k)
      least[k] = std::min(least[k], at[k]), most[k] = std::max(most[k], at[k]);
  }
  size_t widest = 0;
  for (size_t k = 1; k < measures; ++k)
    if (most[k] - least[k] > most[widest] - least[widest]) widest = k;
  const uint32_t middle = first + (last - first) / 2;
  const auto before = [&](const LitPatch& a, const LitPatch& b) {
    const double x = measures_of(a, scale_m)[widest], y = measures_of(b, scale_m)[widest];
    if (x != y) return x < y;
    return a.patch != b.patch ? a.patch < b.patch : a.arrival < b.arrival;
  };
  std::nth_element(patches_.begin() + first, patches_.begin() + middle, patches_.begin() + last, before);
  build(first, middle);
  nodes_[index].second = static_cast<uint32_t>(nodes_.size());
  build(middle, last);
  // The draws of the children are known now.
  const Node &a = nodes_[index + 1], &b = nodes_[nodes_[index].second];
  nodes_[index].drawn = a.clock <= b.clock ? a.drawn : b.drawn;
  nodes_[index].clock = std::min(a.clock, b.clock);
}

void ScatterTree::sum_up(Node& node) const {
  dvec3 least(1e300), most(-1e300);
  const LitPatch& head = patches_[node.first];
  node.one_plane = true;
  double strongest = -1.0;
  for (uint32_t i = node.first; i < node.last; ++i) {
    const LitPatch& s = patches_[i];
    least = glm::min(least, s.position), most = glm::max(most, s.position);
    node.power += s.power;
    node.center += s.power * s.position;
    node.normal += s.power * s.normal;
    node.specular += s.power * s.specular;
    node.length_m += s.power * s.length_m;
    const double peak = peak_of(s);
    node.mean_peak += s.power * peak;
    node.peak = std::max(node.peak, peak);
    node.least_depth = std::min(node.least_depth, s.depth);
    node.one_plane = node.one_plane && s.facet == head.facet && glm::dot(s.normal, head.normal) > 0.0;
    if (s.power > strongest) strongest = s.power, node.surface = s.surface;
  }
  const double share = 1.0 / node.power;
  node.center *= share, node.normal *= share, node.specular *= share;
  node.length_m *= share, node.mean_peak *= share;
  node.middle = 0.5 * (least + most);
  node.radius_m = 0.5 * glm::length(most - least);
  node.drawn = node.first;
  node.clock = head.clock / head.power;
  if (node.last - node.first == 1)
    node.center = head.position, node.normal = head.normal, node.specular = head.specular;
}

double scattered_power(const LitPatch& patch, const dvec3& out, double distance_m) {
  return patch.power * peak_of(patch) * lobe_of(*patch.surface, patch.normal, patch.specular, out) /
         (distance_m * distance_m);
}

double ScatterTree::to(const Node& node, const dvec3& target) const {
  const dvec3 way = target - node.center;
  const double d2 = glm::dot(way, way);
  if (node.second == none) {
    if (d2 == 0.0) return 0.0;
    return node.power * node.mean_peak *
           lobe_of(*node.surface, node.normal, node.specular, way / std::sqrt(d2)) / d2;
  }
  if (node.one_plane && glm::dot(way, node.normal) <= 0.0) return 0.0;
  // Lobe and distance vary over the node. A part of the highest lobe keeps every patch that sends something
  // in the draw.
  const double r2 = node.radius_m * node.radius_m, far2 = std::max(d2, r2);
  const double specular = glm::length(node.specular);
  double mean = 0.0;
  if (d2 > 0.0 && specular > 0.0)
    mean =
        node.mean_peak * lobe_of(*node.surface, node.normal, node.specular / specular, way / std::sqrt(d2));
  const double room = node.one_plane ? 0.25 * std::min(1.0, std::sqrt(r2 / far2)) : 0.5;
  return node.power * ((1.0 - room) * mean + room * node.peak) / far2;
}

}  // namespace greatx::rf
