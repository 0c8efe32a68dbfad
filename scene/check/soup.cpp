// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/soup.h"

#include <algorithm>
#include <cmath>

#include "core/budget.h"
#include "scene/build/build_geometry.h"

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind not_finite{FaultSeverity::fault, "not_finite",
                                     "triangles with corners or normals that are not finite numbers", ""};
constexpr FaultList::Kind no_area{FaultSeverity::doubt, "no_area",
                                  "triangles without area, which the loader drops", "m"};

bool is_finite(const dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

double longest_side(const dvec3* c) {
  return std::max({glm::distance(c[0], c[1]), glm::distance(c[1], c[2]), glm::distance(c[2], c[0])});
}

/// Adds one triangle to the soup, or to the faults.
void add_triangle(Soup& soup, const FacetTriangle& triangle, uint32_t object, uint32_t material,
                  bool normals_finite, FaultList& faults) {
  const dvec3* c = triangle.corners;
  if (!normals_finite || !std::all_of(c, c + 3, is_finite)) {
    const dvec3* good = std::find_if(c, c + 3, is_finite);
    faults.add(not_finite, {good == c + 3 ? dvec3(0.0) : *good, object, nothing, material, 0.0});
    return;
  }
  const dvec3 cross = glm::cross(c[1] - c[0], c[2] - c[0]);
  const double twice = glm::length(cross);
  if (!(twice > 0.0)) {
    faults.add(no_area, {c[0], object, nothing, material, longest_side(c)});
    return;
  }
  soup.triangles.push_back(triangle);
  soup.normals.push_back(cross / twice);
  soup.areas.push_back(0.5 * twice);
  soup.object.push_back(object);
  soup.material.push_back(material);
  for (int i = 0; i < 3; ++i) soup.objects[object].bounds.add(c[i]);
}

void add_primitive(Soup& soup, const ModelPrimitive& primitive, uint32_t object, FaultList& faults) {
  const dmat4& placed = soup.model->instances[object].model_from_mesh;
  const bool mirrored = glm::determinant(glm::dmat3(placed)) < 0.0;
  for (size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
    FacetTriangle triangle;
    bool normals_finite = true;
    for (size_t i = 0; i < 3; ++i) {
      const uint32_t vertex = primitive.indices[first + i];
      triangle.corners[i] = dvec3(placed * dvec4(dvec3(primitive.positions[vertex]), 1.0));
      if (!primitive.normals.empty()) normals_finite &= is_finite(dvec3(primitive.normals[vertex]));
    }
    if (mirrored) std::swap(triangle.corners[1], triangle.corners[2]);
    add_triangle(soup, triangle, object, primitive.material, normals_finite, faults);
  }
}

}  // namespace

Soup make_soup(const Model& model, FaultList& faults) {
  Soup soup;
  soup.model = &model;
  uint64_t planned = 0;
  for (const ModelInstance& instance : model.instances)
    for (const ModelPrimitive& primitive : model.meshes[instance.mesh].primitives)
      planned += primitive.indices.size() / 3;
  require_within(model.file.string(), planned, budget::scene_triangles);
  soup.triangles.reserve(planned);
  soup.objects.resize(model.instances.size());
  for (uint32_t object = 0; object < model.instances.size(); ++object) {
    const ModelInstance& instance = model.instances[object];
    soup.objects[object].first = static_cast<uint32_t>(soup.triangles.size());
    for (const ModelPrimitive& primitive : model.meshes[instance.mesh].primitives) {
      add_primitive(soup, primitive, object, faults);
      const double noise = rounding_noise(primitive, instance.model_from_mesh);
      if (std::isfinite(noise)) soup.objects[object].noise_m = std::max(soup.objects[object].noise_m, noise);
    }
    soup.objects[object].count = static_cast<uint32_t>(soup.triangles.size()) - soup.objects[object].first;
    soup.bounds.add(soup.objects[object].bounds);
  }
  return soup;
}

SoupTree::SoupTree(const Soup& soup) {
  bounds_.resize(soup.triangles.size());
  for (size_t t = 0; t < bounds_.size(); ++t)
    for (const dvec3& corner : soup.triangles[t].corners) bounds_[t].add(corner);
  boxes_ = BoxTree(bounds_);
}

void SoupTree::near_segment(const dvec3& a, const dvec3& b, double distance_m,
                            std::vector<uint32_t>& found) const {
  boxes_.gather([&](const Bounds& box) { return !ray_meets(box, a, b - a, 1.0, distance_m); }, found);
}

int64_t cell_of(double x, double width) {
  return static_cast<int64_t>(std::clamp(std::floor(x / width), -9e18, 9e18));
}

bool ray_meets(const Bounds& box, const dvec3& origin, const dvec3& direction, double most, double distance) {
  double enter = 0.0, leave = most;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = box.min[axis] - distance - origin[axis];
    const double high = box.max[axis] + distance - origin[axis];
    if (direction[axis] == 0.0) {
      if (low > 0.0 || high < 0.0) return false;
      continue;
    }
    const double first = low / direction[axis], second = high / direction[axis];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  return enter <= leave;
}

std::vector<SceneFault> FaultList::finish(const Model& model, size_t most_places) {
  std::vector<SceneFault> list;
  for (auto& [name, entry] : entries_) {
    SceneFault fault;
    fault.severity = entry.kind.severity;
    fault.kind = name;
    fault.text = entry.kind.text;
    fault.unit = entry.kind.unit;
    fault.count = entry.places.size();
    for (const Place& place : entry.places) fault.total += place.size;
    std::vector<Place>& places = entry.places;
    std::ranges::stable_sort(places, [&](const Place& a, const Place& b) {
      return entry.kind.small_is_worst ? a.size < b.size : a.size > b.size;
    });
    fault.worst = places.front().size;
    for (size_t i = 0; i < std::min(places.size(), most_places); ++i) {
      const Place& place = places[i];
      const auto object_name = [&](uint32_t object) {
        return object == nothing ? std::string() : model.instances[object].name;
      };
      fault.places.push_back({place.at, object_name(place.object), object_name(place.other),
                              place.material == nothing ? "" : model.materials[place.material].name,
                              place.size});
    }
    list.push_back(std::move(fault));
  }
  std::ranges::stable_sort(list, [](const SceneFault& a, const SceneFault& b) {
    return a.severity == FaultSeverity::fault && b.severity != FaultSeverity::fault;
  });
  return list;
}

}  // namespace greatx::scene::check
