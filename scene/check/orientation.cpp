// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "scene/check/orientation.h"

#include <algorithm>
#include <cmath>

namespace greatx::scene::check {
namespace {

constexpr FaultList::Kind flipped{FaultSeverity::fault, "flipped",
                                  "triangles that face another way than their neighbours", "m2"};
constexpr FaultList::Kind inside_out{FaultSeverity::fault, "inside_out",
                                     "solids whose faces all look inwards", "m3"};
constexpr FaultList::Kind perhaps_a_room{FaultSeverity::doubt, "looks_inwards",
                                         "solids around everything whose faces look inwards, as a room's do",
                                         "m3"};
constexpr FaultList::Kind not_orientable{FaultSeverity::fault, "not_orientable",
                                         "parts without a consistent front and back", "m2"};
constexpr FaultList::Kind against_winding{FaultSeverity::fault, "normals_against_winding",
                                          "triangles whose normals all point to their back", "m2"};

bool contains(const Bounds& outer, const Bounds& inner) {
  return glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
         glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

/// Returns whether a part has a volume, and not only the rounding errors of one.
bool has_volume(const Part& part) {
  return part.volume_m3 > 1e-9 * part.area_m2 * glm::length(part.bounds.size());
}

/// Returns whether the part lies within another closed part of its object (the walls of a cavity do).
bool is_cavity(const Topology& topology, const std::vector<uint32_t>& parts_of_object, uint32_t index) {
  const Part& part = topology.parts[index];
  return std::ranges::any_of(parts_of_object, [&](uint32_t other) {
    const Part& outer = topology.parts[other];
    return other != index && outer.kind != PartKind::sheet && outer.volume_m3 > part.volume_m3 &&
           contains(outer.bounds, part.bounds);
  });
}

class WrongSides {
 public:
  WrongSides(const Soup& soup, const Topology& topology, FaultList& faults)
      : soup_(soup), topology_(topology), faults_(faults), parts_of_(soup.objects.size()) {
    for (uint32_t p = 0; p < topology.parts.size(); ++p) parts_of_[topology.parts[p].object].push_back(p);
  }

  void find() {
    for (uint32_t p = 0; p < topology_.parts.size(); ++p) check(p);
  }

 private:
  void check(uint32_t index) {
    const Part& part = topology_.parts[index];
    const std::span<const uint32_t> triangles = topology_.triangles_of(part);
    const uint32_t first = triangles.front();
    if (!part.one_sided) {
      faults_.add(not_orientable,
                  {soup_.centroid(first), part.object, nothing, soup_.material[first], part.area_m2});
      return;
    }
    double turned_area = 0.0;
    for (const uint32_t t : triangles) turned_area += topology_.turned[t] ? soup_.areas[t] : 0.0;
    const bool mostly_turned = turned_area > 0.5 * part.area_m2;
    if (mostly_turned && part.kind != PartKind::sheet && has_volume(part) &&
        !is_cavity(topology_, parts_of_[part.object], index))
      faults_.add(contains(part.bounds, soup_.bounds) ? perhaps_a_room : inside_out,
                  {part.bounds.center(), part.object, nothing, soup_.material[first], part.volume_m3});
    for (const uint32_t t : triangles)
      if ((topology_.turned[t] != 0) != mostly_turned)
        faults_.add(flipped, {soup_.centroid(t), part.object, nothing, soup_.material[t], soup_.areas[t]});
  }

  const Soup& soup_;
  const Topology& topology_;
  FaultList& faults_;
  std::vector<std::vector<uint32_t>> parts_of_;  ///< [objects]
};

}  // namespace

void find_wrong_sides(const Soup& soup, const Topology& topology, FaultList& faults) {
  WrongSides(soup, topology, faults).find();
}

void find_wrong_normals(const Model& model, FaultList& faults) {
  for (uint32_t object = 0; object < model.instances.size(); ++object) {
    const ModelInstance& instance = model.instances[object];
    for (const ModelPrimitive& primitive : model.meshes[instance.mesh].primitives) {
      if (primitive.normals.empty()) continue;
      for (size_t first = 0; first + 2 < primitive.indices.size(); first += 3) {
        const uint32_t* v = primitive.indices.data() + first;
        // A transform, mirroring or not, keeps the side of the triangle to which a normal points.
        const dvec3 a(primitive.positions[v[0]]), b(primitive.positions[v[1]]), c(primitive.positions[v[2]]);
        const dvec3 cross = glm::cross(b - a, c - a);
        const bool against = std::all_of(
            v, v + 3, [&](uint32_t i) { return glm::dot(cross, dvec3(primitive.normals[i])) < 0.0; });
        if (!against) continue;
        const dvec3 center(instance.model_from_mesh * dvec4((a + b + c) / 3.0, 1.0));
        const dmat3 linear(instance.model_from_mesh);
        const double area = 0.5 * glm::length(glm::cross(linear * (b - a), linear * (c - a)));
        faults.add(against_winding, {center, object, nothing, primitive.material, area});
      }
    }
  }
}

}  // namespace greatx::scene::check
