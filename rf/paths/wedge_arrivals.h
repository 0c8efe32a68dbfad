// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the wedges at which a path may bend towards a point. Very many sequences of reflections lead to a
// wedge, and nearly all of them meet the edge's line beyond the edge's ends. The place of each sequence's
// image beside the line is known before any point is asked for, so that such a sequence costs a few
// additions.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/geometry.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

/// Returns false if a sequence ends with a reflection at one of the wedge's own faces: that reflection is
/// part of the wedge's field (edge_dyadic).
inline bool leads_to(std::span<const uint32_t> sequence, const scene::Wedge& wedge) {
  return sequence.empty() || (sequence.back() != wedge.facet_0 && sequence.back() != wedge.facet_n);
}

/// Holds for every wedge the sequences of one candidate list that lead to it.
class WedgeArrivals {
 public:
  WedgeArrivals() = default;
  /// Leaves out sequences that do not lead to a wedge (leads_to), and those of more than `most_depth`
  /// reflections. Throws UserError beyond 2^32 - 1 pairs.
  WedgeArrivals(const CandidateList& candidates, std::span<const scene::Wedge> wedges,
                uint32_t most_depth = ~0u);

  /// Places the images of the sequences beside the edges. Must be called before joined(), and again when the
  /// images of `tree` have moved. `wedges`: as in the constructor.
  void place(const ImageTree& tree, std::span<const scene::Wedge> wedges);

  /// Returns the sequences that lead to a wedge, ascending.
  std::span<const uint32_t> of(uint32_t wedge) const {
    return std::span(sequences_).subspan(begin(wedge), count(wedge));
  }
  /// Returns the wedges to which a sequence leads, ascending.
  std::span<const uint32_t> wedges() const { return reached_; }

  /// Returns the number of reflections of the shortest sequence that leads to a wedge; ~0 if none does.
  uint32_t least_depth(uint32_t wedge) const {
    return wedge + 1 < offsets_.size() && count(wedge) > 0 ? depths_[begin(wedge)] : ~0u;
  }

  /// Sets `sequences` to those of a wedge with at most `most_depth` reflections for which keller_point() with
  /// `after` may find a point, or a point beyond an end of the edge by which the path over that end is longer
  /// by at most `most_excess_m` (rf/edges/corners.h; 0: ends do not count): to all for which it does, and few
  /// more. All sequences of a wedge that moves with a body are returned, if they are not too deep.
  void joined(uint32_t wedge, const dvec3& after, uint32_t most_depth, double most_excess_m,
              std::vector<uint32_t>& sequences) const;

 private:
  /// A wedge that does not move; length < 0 for one that does.
  struct Edge {
    dvec3 start{0.0}, along{0.0}, tangent_0{0.0}, normal_0{0.0};
    dvec2 face_n{0.0};                ///< direction across the edge, in (tangent_0, normal_0)
    double length = 0.0, room = 0.0;  ///< room: by which a point may lie beyond the ends
    bool inside(const dvec3& point) const;
  };
  /// The place of an image beside the edge's line, metres.
  struct Place {
    double along = 0.0, away = 0.0;
  };
  /// The place of an image inside the wedge. No Keller point follows from it.
  static constexpr Place nowhere{std::numeric_limits<double>::quiet_NaN(), 1.0};
  static Place place_of(const Edge& edge, const dvec3& point);
  static bool meet(const Edge& edge, const Place& from, const Place& to, double most_excess_m);
  size_t begin(uint32_t wedge) const { return offsets_[wedge]; }
  size_t count(uint32_t wedge) const { return offsets_[wedge + 1] - offsets_[wedge]; }

  std::vector<uint32_t> offsets_{0};  ///< [wedges + 1] into sequences_
  std::vector<uint32_t> sequences_, reached_;
  std::vector<uint8_t> depths_;  ///< [sequences_], ascending for each wedge
  std::vector<Edge> edges_;      ///< [wedges]
  std::vector<Place> places_;    ///< [sequences_]
};

}  // namespace greatx::rf
