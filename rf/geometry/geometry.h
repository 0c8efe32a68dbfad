// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Exact paths by the image method, fp64. Geometry only: what stands in the way is decided by the visibility
// pass, what a reflection does to the field by path_field.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "rf/facets/facet_world.h"
#include "rf/geometry/candidates.h"
#include "rf/geometry/path.h"
#include "rf/geometry/reach_filter.h"

namespace greatx::rf {

/// Which end of the path stays put while the other one is solved for many points.
enum class Source : uint32_t { transmitter, receiver };

/// The images of one end of the channel in every candidate's facets, shared between candidates with a common
/// prefix (a trie). Built once for a static source; solve() then costs about a nanosecond for each sequence
/// that cannot reach the target and a full chain of intersections for each that may.
///
/// What counts as a path:
/// - a reflection may happen on either side of a facet, both neighbours of the reflection point being on the
/// same side;
/// - facets are closed: a point on an outline or on an inner edge is inside, within PosedFacet::tolerance_m;
/// - an end that lies in a facet's plane (within that tolerance) is not reflected by it: no segment of zero
/// length
///   starts or ends a path; a line of sight shorter than 1 nm is none either, so transmitter = receiver has
///   no line of sight but keeps its echoes;
/// - two reflections at the same point (the path meets the edge where two facets join) are a path only if
/// each facet
///   lies on the reflecting side of the other, as in the corner of a room;
/// - paths with the same polyline (vertices within 1e-6 m, or 1e-9 of the length if that is more) are one,
/// and the
///   first facet sequence in the canonical order is kept: duplicated facets, ties at corners.
///
/// A target's paths depend on that target alone: solving it among others gives the same bits.
class ImageTree {
 public:
  /// `candidates`, in canonical order, run from the source, whichever end that is; their windows, if they
  /// have any, are used as bounds. `world` is read by solve() and must outlive the tree.
  ImageTree(const FacetWorld& world, const dvec3& source, const CandidateList& candidates,
            Source end = Source::transmitter);
  /// Works the images out again: the source has moved, or a body with candidate facets has. Windows hold for
  /// the source and the bodies that they were searched for: they are dropped.
  void update(const dvec3& source);
  /// Every path between the source and `target`, from transmitter to receiver, in canonical order of the
  /// sequences.
  std::vector<GeometricPath> solve(const dvec3& target) const;

  size_t node_count() const { return nodes_.size(); }
  const dvec3& source() const { return source_; }
  Source end() const { return end_; }

  /// The ends of chains that go on after their reflections (a diffraction, a scattering). `sequence` is an
  /// index into the candidates that the tree was built from.
  size_t sequence_count() const { return node_of_sequence_.size(); }
  /// Number of reflections of a sequence.
  uint32_t depth(size_t sequence) const;
  /// The source, mirrored at every facet of the sequence.
  const dvec3& image(size_t sequence) const;
  /// The reflections by which the sequence leads from the source to `point`: appends them and their points to
  /// `path`, outwards from the source, without the source and without `point`. False, and nothing appended,
  /// if it does not.
  bool reach(size_t sequence, const dvec3& point, GeometricPath& path) const;

 private:
  static constexpr uint32_t none = ~0u;
  struct Node {
    double distance = 0.0, u = 0.0, v = 0.0;  ///< of the image in this node's facet
    uint32_t slot = 0;                        ///< into used_facets_
    uint32_t parent = none;
    bool candidate = false;  ///< false: a prefix only
    uint32_t depth = 0;
    double min_u = 0.0, max_u = 0.0, min_v = 0.0,
           max_v = 0.0;  ///< where its facet may reflect: the window, if known
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
  struct Chain {  ///< from the target inwards
    FacetSequence facets;
    std::vector<dvec3> points;
  };
  bool trace(uint32_t leaf, const dvec3& target, Chain& chain) const;

  const FacetWorld* world_;
  dvec3 source_;
  Source end_;
  bool line_of_sight_ = false;
  std::vector<uint32_t> node_of_sequence_;  ///< [candidates]; none: the empty sequence
  std::vector<Node> nodes_;                 ///< parents before children
  std::vector<dvec3> images_;               ///< [nodes]
  std::vector<uint32_t> used_facets_;       ///< ascending
  ReachFilter filter_;                      ///< groups: slots
  std::vector<uint32_t> filtered_;          ///< nodes that are candidates, by the filter's indices
};

/// Canonical order; of paths with the same polyline the first. What solve() does, for paths of several trees.
void keep_distinct(std::vector<GeometricPath>& paths);

/// The same for a single pair: builds the tree, solves, forgets.
std::vector<GeometricPath> solve_paths(const FacetWorld& world, const dvec3& transmitter,
                                       const dvec3& receiver, const CandidateList& candidates);

}  // namespace greatx::rf
