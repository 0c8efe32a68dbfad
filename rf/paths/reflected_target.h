// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Describes a target as patches see it over reflections: each sequence of facets shows an image of the target
// behind its last facet, through the part of this facet that the target's beam lights (a view). A ScatterTree
// is drawn towards the image of a view as it is towards the target.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/scatter_tree.h"
#include "rf/search/beam_scene.h"

namespace greatx::rf {

/// Holds the mean share of the power of both polarizations that each material reflects, in steps of the
/// cosine of incidence. It serves estimates that choose what is traced.
class ReflectedShares {
 public:
  explicit ReflectedShares(const RadioModel& model);
  /// Returns the share, at least 1e-4, for a wave that meets the facet along `in` (unit).
  double of(const PosedFacet& facet, const dvec3& in) const;

 private:
  static constexpr uint32_t steps = 64;
  std::vector<float> table_;  ///< [materials][2: front, back][steps + 1]
};

class ReflectedTarget {
 public:
  /// `ways` are the sequences that lead outwards from the target, with windows; those without a facet are no
  /// views. A path has `max_depth` interactions at most. `model` and `shares` must outlive this object.
  ReflectedTarget(const RadioModel& model, const ReflectedShares& shares, const CandidateList& ways,
                  const dvec3& target, Source end, uint32_t max_depth);

  uint32_t size() const { return static_cast<uint32_t>(views_.size()); }
  const dvec3& image(uint32_t view) const { return views_[view].image; }
  /// Returns how far the image is behind the last facet.
  double behind_m(uint32_t view) const { return views_[view].behind_m; }
  /// Returns a number that belongs to the facets of a view.
  uint64_t key(uint32_t view) const { return views_[view].key; }
  /// Returns whether no patch of a node reaches the target in this way, for certain.
  bool misses(uint32_t view, const ScatterTree::Node& node) const;
  /// Returns the estimated share of the power from a point that is left after the reflections.
  double share(uint32_t view, const dvec3& from) const;
  /// Sets `way` to the reflections and their points outwards from the target to the patch. Returns false if
  /// the patch does not reach the target in this way, or if the path has too many interactions.
  bool reach(uint32_t view, const LitPatch& patch, GeometricPath& way) const;
  /// Returns whether more than `count` pairs of a patch and a view reach the target if nothing is in the way.
  bool sees_more(const ScatterTree& tree, size_t count) const;

 private:
  struct View {
    dvec3 image{0.0};
    uint64_t key = 0;
    uint32_t sequence = 0, first = 0, depth = 0;  ///< range of facets_, outwards
    double behind_m = 0.0;
    uint32_t most_before = 0;       ///< reflections before a patch
    bool usable = false;            ///< the image is not in the plane of its facet
    std::array<HalfSpace, 5> beam;  ///< the facet's plane, and the sides of the pyramid
  };
  void set_beam(View& view, const PosedFacet& facet, const PlaneWindow& window) const;

  const RadioModel* model_;
  const ReflectedShares* shares_;
  ImageTree images_;
  std::vector<View> views_;
  std::vector<uint32_t> facets_;
};

}  // namespace greatx::rf
