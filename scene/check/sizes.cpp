// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/sizes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "scene/build/facets.h"

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind sliver{FaultSeverity::doubt, "sliver", "triangles of a very small height", "m",
                                 true};
constexpr FaultList::Kind tiny_facet{FaultSeverity::doubt, "tiny_facet", "very narrow facets", "m", true};
constexpr FaultList::Kind rounded{FaultSeverity::doubt, "rounded",
                                  "objects whose coordinates fp32 rounds in the file", "m"};
constexpr FaultList::Kind far_away{FaultSeverity::doubt, "far_away", "objects far away from the others", "m"};
constexpr FaultList::Kind scene_size{FaultSeverity::doubt, "scene_size",
                                     "scenes of a size that makes the unit doubtful", "m"};
constexpr FaultList::Kind object_size{FaultSeverity::doubt, "object_size",
                                      "objects of a size that does not suit their class", "m"};
constexpr FaultList::Kind on_its_side{FaultSeverity::fault, "on_its_side",
                                      "scenes that seem to lie on their side", "m2"};

double side_of(const dvec3* c, int i) { return glm::distance(c[i], c[(i + 1) % 3]); }

/// Returns the largest distance between two corners; of many corners, the diagonal of their box.
double diameter_of(const std::vector<dvec3>& corners) {
  if (corners.size() > 48) {
    Bounds bounds;
    for (const dvec3& corner : corners) bounds.add(corner);
    return glm::length(bounds.size());
  }
  double most = 0.0;
  for (size_t i = 0; i < corners.size(); ++i)
    for (size_t j = 0; j < i; ++j) most = std::max(most, glm::distance(corners[i], corners[j]));
  return most;
}

/// Merges the triangles of one object with one material into facets and adds those that are narrow.
uint64_t add_facets(const Soup& soup, const std::vector<uint32_t>& triangles, const Topology& topology,
                    const CheckOptions& options, FaultList& faults) {
  FacetInput input;
  const uint32_t object = soup.object[triangles.front()];
  input.noise_m = soup.objects[object].noise_m;
  for (const uint32_t t : triangles)
    for (uint32_t i = 0; i < 3; ++i) {
      input.corners.push_back(soup.triangles[t].corners[i]);
      input.vertices.push_back(topology.corners[3 * t + i]);
    }
  const FacetGroups facets = merge_coplanar(input, {});
  for (const FacetGroup& group : facets.groups) {
    double area = 0.0;
    std::vector<dvec3> corners;
    for (uint32_t i = group.first; i < group.first + group.count; ++i) {
      const uint32_t t = triangles[facets.triangles[i]];
      area += soup.areas[t];
      corners.insert(corners.end(), soup.triangles[t].corners, soup.triangles[t].corners + 3);
    }
    const double width = area / diameter_of(corners);
    if (width < options.facet_m)
      faults.add(tiny_facet, {corners.front(), object, nothing, soup.material[triangles.front()], width});
  }
  return facets.groups.size();
}

struct SizeRange {
  double least, most;  ///< of the longest side, m
};

/// Returns the range of the longest side of objects of a class, generous at both ends.
std::optional<SizeRange> range_of(SemanticClass semantic_class) {
  switch (semantic_class) {
    case SemanticClass::building:
      return SizeRange{1.0, 2000.0};
    case SemanticClass::vehicle:
      return SizeRange{1.0, 60.0};
    case SemanticClass::uav:
      return SizeRange{0.02, 30.0};
    case SemanticClass::person:
      return SizeRange{0.3, 3.0};
    case SemanticClass::street_lamp:
      return SizeRange{0.02, 40.0};
    case SemanticClass::mast:
      return SizeRange{0.1, 700.0};
    case SemanticClass::furniture:
      return SizeRange{0.05, 30.0};
    default:
      return std::nullopt;
  }
}

/// Returns the bounds of an object with all that hangs on its node.
Bounds whole_of(const Soup& soup, uint32_t object) {
  const std::vector<ModelInstance>& instances = soup.model->instances;
  const uint32_t end = soup.model->nodes[instances[object].node].end;
  Bounds bounds;
  for (uint32_t i = object; i < instances.size() && instances[i].node < end; ++i)
    if (!soup.objects[i].bounds.empty()) bounds.add(soup.objects[i].bounds);
  return bounds;
}

/// Returns whether the object hangs on another one of its class, as a wheel does on a car. Instances are in
/// the order of their nodes, parents before children.
bool is_piece_of_its_kind(const Model& model, uint32_t object) {
  const ModelInstance& one = model.instances[object];
  for (uint32_t i = object; i-- > 0;) {
    const ModelInstance& other = model.instances[i];
    if (model.nodes[other.node].end > one.node && other.semantic_class == one.semantic_class) return true;
    if (object - i > 1000) break;  // siblings in between: a flat list of many objects has no such parent
  }
  return false;
}

double longest(const Bounds& bounds) {
  const dvec3 size = bounds.size();
  return std::max({size.x, size.y, size.z});
}

void find_far_objects(const Soup& soup, FaultList& faults) {
  std::vector<dvec3> middles;
  std::vector<uint32_t> objects;
  for (uint32_t object = 0; object < soup.objects.size(); ++object)
    if (!soup.objects[object].bounds.empty()) {
      middles.push_back(soup.objects[object].bounds.center());
      objects.push_back(object);
    }
  if (middles.size() < 3) return;
  dvec3 median;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const dvec3& middle : middles) values.push_back(middle[axis]);
    std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    median[axis] = values[values.size() / 2];
  }
  std::vector<double> distances;
  for (size_t i = 0; i < middles.size(); ++i)
    distances.push_back(std::max(
        0.0, glm::distance(middles[i], median) - 0.5 * glm::length(soup.objects[objects[i]].bounds.size())));
  std::vector<double> sorted = distances;
  std::ranges::sort(sorted);
  // Nine tenths of the others: of three objects, one.
  const double usual = sorted[std::min(sorted.size() - 2, sorted.size() * 9 / 10)];
  for (size_t i = 0; i < objects.size(); ++i)
    if (distances[i] > std::max(100.0, 10.0 * usual))
      faults.add(far_away, {middles[i], objects[i], nothing, nothing, distances[i]});
}

/// Finds a scene whose y axis points up although it is taken for one whose z axis does, or the like. Ground
/// and roofs face upwards, and nothing is as large in a place that people build (also
/// sim/check/scene_check.h).
void find_side(const Soup& soup, FaultList& faults) {
  constexpr double cos_25_degrees = 0.9063;
  constexpr size_t up = 4;
  std::array<double, 6> areas{};
  for (size_t t = 0; t < soup.triangles.size(); ++t)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(soup.normals[t][axis]) > cos_25_degrees)
        areas[static_cast<size_t>(2 * axis + (soup.normals[t][axis] < 0.0 ? 1 : 0))] += soup.areas[t];
  const size_t most = static_cast<size_t>(std::ranges::max_element(areas) - areas.begin());
  const dvec3 size = soup.bounds.size();
  const bool higher = most / 2 == 2 || size.z > size[static_cast<int>(most / 2)];
  // A single object may have any attitude, and a person stands upright.
  size_t objects = 0;
  for (uint32_t i = 0; i < soup.objects.size(); ++i) {
    const SemanticClass c = soup.class_of(i);
    if (c != SemanticClass::person && c != SemanticClass::vehicle && c != SemanticClass::uav) ++objects;
  }
  if (soup.objects.size() < 2 || objects == 0 || most == up || areas[most] <= 2.0 * areas[up] || !higher)
    return;
  faults.add(on_its_side, {soup.bounds.center(), nothing, nothing, nothing, areas[most]});
}

}  // namespace

uint64_t find_small_faces(const Soup& soup, const Topology& topology, const CheckOptions& options,
                          FaultList& faults) {
  uint64_t facets = 0;
  for (uint32_t t = 0; t < soup.triangles.size(); ++t) {
    const dvec3* c = soup.triangles[t].corners;
    const double height = 2.0 * soup.areas[t] / std::max({side_of(c, 0), side_of(c, 1), side_of(c, 2)});
    if (height < options.sliver_m)
      faults.add(sliver, {soup.centroid(t), soup.object[t], nothing, soup.material[t], height});
  }
  for (const SoupObject& object : soup.objects) {
    std::map<uint32_t, std::vector<uint32_t>> by_material;
    for (uint32_t t = object.first; t < object.first + object.count; ++t)
      by_material[soup.material[t]].push_back(t);
    for (const auto& [material, triangles] : by_material)
      facets += add_facets(soup, triangles, topology, options, faults);
  }
  return facets;
}

void find_strange_sizes(const Soup& soup, const CheckOptions& options, FaultList& faults) {
  for (uint32_t object = 0; object < soup.objects.size(); ++object) {
    const SoupObject& one = soup.objects[object];
    if (one.bounds.empty()) continue;
    if (one.noise_m > 0.5 * options.weld_m)
      faults.add(rounded, {one.bounds.center(), object, nothing, nothing, one.noise_m});
    if (is_piece_of_its_kind(*soup.model, object)) continue;
    const double side = longest(whole_of(soup, object));
    if (const auto range = range_of(soup.class_of(object));
        range && (side < range->least || side > range->most))
      faults.add(object_size, {one.bounds.center(), object, nothing, nothing, side});
  }
  if (soup.bounds.empty()) return;
  if (const double side = longest(soup.bounds); side < 0.1 || side > 1e5)
    faults.add(scene_size, {soup.bounds.center(), nothing, nothing, nothing, side});
  find_far_objects(soup, faults);
  find_side(soup, faults);
}

}  // namespace greatx::scene::check
