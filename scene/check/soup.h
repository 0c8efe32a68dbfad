// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the triangles of a model in its own frame, and the list in which the checks collect what they find.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scene/check/check.h"
#include "scene/description/triangle_tree.h"

namespace greatx::scene::check {

inline constexpr uint32_t nothing = ~0u;

/// The triangles of one ModelInstance are a range of Soup::triangles.
struct SoupObject {
  uint32_t first = 0, count = 0;
  double noise_m = 0.0;  ///< how far the file's fp32 may have moved a corner
  Bounds bounds;
};

struct Soup {
  const Model* model = nullptr;
  std::vector<FacetTriangle> triangles;
  std::vector<dvec3> normals;              ///< [triangles] unit, by the winding
  std::vector<double> areas;               ///< [triangles] m^2
  std::vector<uint32_t> object, material;  ///< [triangles] into Model::instances and Model::materials
  std::vector<SoupObject> objects;         ///< [Model::instances]
  Bounds bounds;

  SemanticClass class_of(uint32_t object_index) const {
    return model->instances[object_index].semantic_class;
  }
  dvec3 centroid(uint32_t triangle) const {
    const dvec3* c = triangles[triangle].corners;
    return (c[0] + c[1] + c[2]) / 3.0;
  }
};

/// The boxes of all triangles of a soup.
class SoupTree {
 public:
  explicit SoupTree(const Soup& soup);
  const BoxTree& boxes() const { return boxes_; }
  const Bounds& box(uint32_t triangle) const { return bounds_[triangle]; }
  /// Appends, ascending, the triangles whose box comes within `distance_m` of the segment.
  void near_segment(const dvec3& a, const dvec3& b, double distance_m, std::vector<uint32_t>& found) const;

 private:
  std::vector<Bounds> bounds_;
  BoxTree boxes_;
};

/// Returns the number of the cell of width `width` in which x is; cells beyond the range of integers are one.
int64_t cell_of(double x, double width);

/// Returns whether origin + t * direction is in the box, grown by `distance`, for a t in [0, most] (the
/// method of slabs).
bool ray_meets(const Bounds& box, const dvec3& origin, const dvec3& direction, double most, double distance);

/// Of one triangle or edge, at most this many neighbours are looked at. More are counted as a crowd
/// (CheckFigures::crowds): a fan of n triangles about one edge has n * n pairs of neighbours.
inline constexpr size_t most_neighbors = 1024;

/// A place with indices instead of names.
struct Place {
  dvec3 at{0.0};
  uint32_t object = nothing, other = nothing, material = nothing;
  double size = 0.0;
};

/// Collects places by kind.
class FaultList {
 public:
  struct Kind {
    FaultSeverity severity;
    const char* name;
    const char* text;
    const char* unit;
    bool small_is_worst = false;
  };
  void add(const Kind& kind, const Place& place) {
    Entry& entry = entries_.try_emplace(kind.name, Entry{kind, {}}).first->second;
    entry.places.push_back(place);
  }
  /// Returns the kinds, faults first and by name, with names in place of indices.
  std::vector<SceneFault> finish(const Model& model, size_t most_places);

 private:
  struct Entry {
    Kind kind;
    std::vector<Place> places;
  };
  std::map<std::string, Entry> entries_;
};

/// Places all triangles. Those with corners that are not finite and those without area go to `faults` alone.
Soup make_soup(const Model& model, FaultList& faults);

}  // namespace greatx::scene::check
