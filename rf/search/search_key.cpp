// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/search/search_key.h"

#include <vector>

#include "core/error.h"
#include "core/hash.h"

namespace greatx::rf {

namespace {

/// Must be increased when the search changes its results, so that old files are not used again.
constexpr uint32_t search_version = 7;

/// Collects numbers and adds many at a time to a hash.
class Numbers {
 public:
  explicit Numbers(Sha256& hash) : hash_(hash) {}
  ~Numbers() { flush(); }
  Numbers(const Numbers&) = delete;
  Numbers& operator=(const Numbers&) = delete;

  void add(double value) {
    values_.push_back(value);
    if (values_.size() == 4096) flush();
  }
  void add(const dvec3& v) { add(v.x), add(v.y), add(v.z); }

 private:
  void flush() {
    hash_.update(std::as_bytes(std::span(values_)));
    values_.clear();
  }
  Sha256& hash_;
  std::vector<double> values_;
};

/// Adds all properties of a facet that determine beams, their windows and their rectangles (BeamScene).
/// Numbers of 32 bits are exact in a double.
void add_facet(const FacetWorld& world, uint32_t index, FacetKind kind, Numbers& numbers) {
  const PosedFacet& facet = world.facet(index);
  numbers.add(index), numbers.add(static_cast<double>(kind)), numbers.add(facet.owner);
  numbers.add(facet.normal), numbers.add(facet.offset);
  numbers.add(facet.axis_u), numbers.add(facet.axis_v);
  for (const double value : {facet.offset_u, facet.offset_v, facet.min_u, facet.max_u, facet.min_v,
                             facet.max_v, facet.tolerance_m})
    numbers.add(value);
  numbers.add(facet.triangle_count);
  for (uint32_t t = 0; t < facet.triangle_count; ++t)
    for (const dvec3& corner : world.corners(index, t)) numbers.add(corner);
}

}  // namespace

std::string search_key(const FacetWorld& world, const FacetKinds& kinds, std::span<const scene::Wedge> wedges,
                       const dvec3& source, const BeamSearchOptions& options) {
  // All options are named here, so that a new option causes a compiler error until somebody decides whether
  // it changes the result.
  const auto& [max_depth, max_transmissions, capacity, threads, moving_bodies, source_body, clearance_m,
               stop_depth, wedge_depth] = options;
  static_cast<void>(threads);
  GREATX_CHECK(!moving_bodies, "the key of a search says nothing of where bodies stand");
  GREATX_CHECK(kinds.size() == world.facet_count(), "kinds of {} facets, the world has {}", kinds.size(),
               world.facet_count());
  // Selects the facets that BeamScene keeps.
  const auto met = [&](uint32_t index) {
    return index != scene::no_facet && world.facet(index).body == 0 &&
           world.facet(index).triangle_count > 0 && kinds[index] != FacetKind::foliage &&
           kinds[index] != FacetKind::absent;
  };
  Sha256 hash;
  hash.update_value(search_version);
  hash.update_value(max_depth).update_value(max_transmissions).update_value(capacity);
  hash.update_value(source_body).update_value(clearance_m).update_value(stop_depth).update_value(wedge_depth);
  hash.update_value(static_cast<uint8_t>(!wedges.empty()));  // whether the search looks for wedges
  {
    Numbers numbers(hash);
    numbers.add(source);
    for (uint32_t index = 0; index < world.facet_count(); ++index)
      if (met(index)) add_facet(world, index, kinds[index], numbers);
    numbers.add(-1.0);  // not the number of a facet: wedges begin here
    for (uint32_t index = 0; index < wedges.size(); ++index) {
      const scene::Wedge& wedge = wedges[index];
      if (!met(wedge.facet_0) && !met(wedge.facet_n)) continue;
      numbers.add(index), numbers.add(wedge.a), numbers.add(wedge.b);
      numbers.add(wedge.facet_0), numbers.add(wedge.facet_n), numbers.add(wedge.body);
    }
  }
  return hash.hex();
}

}  // namespace greatx::rf
