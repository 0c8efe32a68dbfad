// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes exact paths by the image method in fp64. This is geometry only: the visibility pass decides
// whether a path is blocked, and path_field computes the effect of a reflection on the field.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/path.h"
#include "rf/geometry/reach_filter.h"

namespace greatx::rf {

/// Names the end of the path that stays fixed while the paths to many points are solved.
enum class Source : uint32_t { transmitter, receiver };

/// Holds the images of one end of the channel in every candidate's facets. Candidates with a common prefix
/// share images (a trie). The tree is built once for a static source. Then solve() costs about a nanosecond
/// for each sequence that cannot reach the target, and a full chain of intersections for each other sequence.
///
/// The following rules define a path:
/// - A reflection may happen on either side of a facet. Both neighbours of the reflection point are on the
///   same side.
/// - Facets are closed: a point on an outline or on an inner edge is inside, within PosedFacet::tolerance_m.
/// - A facet does not reflect an end that lies in its plane (within that tolerance): no path starts or ends
///   with a segment of zero length. A line of sight shorter than 1 nm is not a path, so that transmitter =
///   receiver has no line of sight but keeps its echoes.
/// - Two reflections at the same point (the path meets the edge where two facets join) are a path only if
///   each facet lies on the reflecting side of the other, as in the corner of a room.
/// - Paths with the same polyline (vertices within 1e-6 m, or 1e-9 of the length if that is more) are one
///   path, as happens with duplicated facets and at corners. The first facet sequence in the canonical order
///   is kept.
///
/// The paths of a target depend on that target alone: solving it among others gives the same bits.
class ImageTree {
 public:
  /// `candidates` are in canonical order and run from the source, whichever end that is. Their windows, if
  /// they have any, serve as bounds. solve() reads `world`, which must outlive the tree.
  ImageTree(const FacetWorld& world, const dvec3& source, const CandidateList& candidates,
            Source end = Source::transmitter);
  /// Computes the images again after the source or a body with candidate facets has moved. The windows are
  /// dropped, because they hold only for the source and the bodies of their search.
  void update(const dvec3& source);
  /// Returns every path between the source and `target`, from transmitter to receiver, in canonical order of
  /// the sequences.
  std::vector<GeometricPath> solve(const dvec3& target) const;
  size_t node_count() const { return nodes_.size(); }
  const dvec3& source() const { return source_; }
  Source end() const { return end_; }

  /// The functions below give the ends of chains that go on after their reflections, with a diffraction or a
  /// scattering. `sequence` is an index into the candidates from which the tree was built.
  size_t sequence_count() const { return node_of_sequence_.size(); }
  /// Returns the number of reflections of a sequence.
  uint32_t depth(size_t sequence) const;
  /// Returns the source, mirrored at every facet of the sequence.
  const dvec3& image(size_t sequence) const;
  /// Appends to `path` the reflections and reflection points by which the sequence leads from the source to
  /// `point`, outwards from the source, without the source and without `point`. Returns false and appends
  /// nothing if the sequence does not lead there.
  bool reach(size_t sequence, const dvec3& point, GeometricPath& path) const;

 private:
  static constexpr uint32_t none = ~0u;
  struct Node {
    double distance = 0.0, u = 0.0, v = 0.0;  ///< of the image, in this node's facet
    uint32_t slot = 0;                        ///< index into used_facets_
    uint32_t parent = none;
    bool candidate = false;  ///< false: the node is only a prefix of candidates
    uint32_t depth = 0;
    /// The part of the facet that may reflect: the window, if it is known.
    double min_u = 0.0, max_u = 0.0, min_v = 0.0, max_v = 0.0;
  };
  struct TargetInFacet {
    double distance = 0.0, u = 0.0, v = 0.0, tolerance = 0.0;
  };
  void build(const CandidateList& candidates);
  void mirror(const dvec3& source);
  void build_filter();
  static double room(const Node& node, double tolerance_m);
  bool may_reach(const Node& node, const TargetInFacet& target) const;
  std::vector<uint32_t> seen_from(const dvec3& target) const;
  /// The frame of a used facet; a copy, so that seen_from() reads one run of memory.
  struct Plane {
    dvec3 normal{0.0}, axis_u{0.0}, axis_v{0.0};
    double offset = 0.0, offset_u = 0.0, offset_v = 0.0, tolerance_m = 0.0;
    TargetInFacet locate(const dvec3& target) const;
  };
  void copy_planes();
  template <typename Visit>
  bool trace(uint32_t leaf, const dvec3& target, const Visit& visit) const;

  const FacetWorld* world_;
  dvec3 source_;
  Source end_;
  bool line_of_sight_ = false;
  std::vector<uint32_t> node_of_sequence_;  ///< [candidates]; none for the empty sequence
  std::vector<Node> nodes_;                 ///< parents before children
  std::vector<dvec3> images_;               ///< [nodes]
  std::vector<uint32_t> used_facets_;       ///< ascending
  std::vector<Plane> planes_;               ///< [used_facets_]
  ReachFilter filter_;                      ///< its groups are slots
  std::vector<uint32_t> filtered_;          ///< the candidate node of each index of the filter
};

/// Sorts the paths of a link into canonical order and keeps one of the paths with the same polyline, as
/// solve() does, for paths of several trees. It keeps the first in canonical order as seen from the end with
/// the smaller coordinates (x, then y, then z), so that both directions of a link keep the same.
void keep_distinct(std::vector<GeometricPath>& paths);

}  // namespace greatx::rf
