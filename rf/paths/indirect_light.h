// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds paths whose scattering is lit indirectly: over an edge, or by another patch.
//
//   source ─► reflections ─► edge ────► patch ─► target      PathLimits::scattering_beside_diffraction
//   source ─► reflections ─► patch A ─► patch ─► target      PathLimits::max_scatterings
//
// The ways to a patch are as many as edges and patches together, so they are drawn, in two stages:
//
//   once for each source:  patch ─► one edge and one patch A, by what they send to it ─► sight ─► ScatterTree
//   once for each target:  ScatterTree ─► draw_scatterings() ─► GeometricPath
//
// Both stages know the probability of what they draw, and a path grows by its inverse: the expected power of
// every bin of delay is that of all such paths. In the first stage each patch is tried several times, and the
// mean of the tries counts. How far the tries of a patch differ tells the variance of their mean, which goes
// with the paths (GeometricPath::draw_variance), since no stratum of the second stage would show it.
//
// - Patch A is drawn from the patches that the source lights, by a descent of their tree: with about the
//   probability of its share of the power that arrives.
// - An edge is drawn by the estimate of edge_share(). There may be tens of thousands of ways to edges, so
//   that each try offers `edges_offered` of them, drawn by angle and distance alone, and takes one of these
//   with the probability of its share of the estimates (resampled importance sampling: J. F. Talbot, D.
//   Cline, P. Egbert, "Importance resampling for global illumination", EGSR 2005). The field of the edge that
//   is taken is computed before it enters the tree.
//
// What is tried depends on the seed, the facet and the number of the patch, and not on the target. Bodies
// that move hide nothing here; the crossings see them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <vector>

#include "rf/config/path_limits.h"
#include "rf/geometry/geometry.h"
#include "rf/geometry/path.h"
#include "rf/paths/radio_model.h"
#include "rf/paths/scatter_tree.h"
#include "rf/paths/scatterers.h"
#include "rf/paths/wedge_arrivals.h"

namespace greatx::rf {

/// Returns the most paths of a kind with two bends that a link draws: half of the budget of scatterings.
inline uint32_t two_bend_budget(const PathLimits& limits) {
  return std::max(1u, limits.scattering_budget / 2);
}

/// Returns the number that comes before the strata of the next draw for the same link: pairs of strata, which
/// drawn_deviation() compares, do not reach from one draw into the next.
uint32_t strata_before(const std::vector<GeometricPath>& paths);

class IndirectLight {
 public:
  /// Describes the source: its direct light, and its ways to edges, which run in the images of `edge_tree`.
  struct Origin {
    const Scatterers& scatterers;
    const ImageTree& tree;
    const ImageTree& edge_tree;
    const WedgeArrivals* edges;  ///< null: there are none
  };
  /// `model` must outlive this object. limits.scattering_budget must be greater than 0.
  IndirectLight(const RadioModel& model, const PathLimits& limits);

  /// Must be called when the source, what it lights, or bodies have changed. The first stage is drawn when
  /// the next target asks.
  void forget();
  /// Appends the paths that are drawn for a target, from transmitter to receiver. Many threads may call this,
  /// for the same origin.
  void solve(const Origin& origin, const dvec3& target, std::vector<GeometricPath>& paths);

 private:
  /// What lights a patch. Its LitPatch has the index of this as its `arrival`.
  struct Bend {
    bool edge = false;
    uint32_t element = 0;   ///< index into the wedges, or of a patch in Scatterers::lit()
    uint32_t sequence = 0;  ///< of an edge: the way to it
    dvec3 point{0.0};
    double weight = 0.0;    ///< inverse of its probability, as the mean over the tries
    double variance = 0.0;  ///< of the mean over the tries, relative to the square of what the patch sends
  };
  /// A way from the source to an edge, with the sum of the weights of all ways up to it.
  struct EdgeWay {
    uint32_t wedge = 0, sequence = 0;
    double sum = 0.0, weight = 0.0;
  };
  /// A way that is offered to a patch, with the point on the edge.
  struct Offer {
    const EdgeWay* way = nullptr;
    dvec3 point{0.0};
    double length_m = 0.0;  ///< of the whole way to the patch
    double chance = 1.0;    ///< probability of the offer
    double share = 0.0;     ///< estimate of what arrives, over the probability of the offer
  };
  struct Lit {
    LitPatch patch;
    Bend bend;
  };
  struct Work;

  void list_edges(const Origin& origin);
  void light(const Origin& origin);
  void light_patch(const Origin& origin, uint32_t patch, uint64_t seed, Work& work) const;
  void add_mean(size_t first, std::vector<Lit>& tries, std::vector<Lit>& lit) const;
  void light_by_patch(const Origin& origin, uint32_t patch, double u, Work& work) const;
  void light_by_edge(const Origin& origin, uint32_t patch, double u_offers, double u_choice,
                     Work& work) const;
  void offer_edges(const Origin& origin, const dvec3& to, double u, Work& work) const;
  void offer(const Origin& origin, const EdgeWay& way, const dvec3& to, double chance, Work& work) const;
  double over_edge(const Origin& origin, const Offer& offer, const Patch& patch, const dvec3& to,
                   GeometricPath& way) const;
  bool assemble(const Origin& origin, const LitPatch& lit, const Bend& bend, const dvec3& target,
                GeometricPath& path) const;

  const RadioModel* model_;
  PathLimits limits_;
  std::mutex mutex_;
  bool ready_ = false;
  std::vector<scene::Wedge> wedges_;  ///< posed, [wedges] if there are ways to edges
  std::vector<EdgeWay> edge_ways_;
  uint32_t tries_ = 2;   ///< of each patch and kind
  double chance_ = 1.0;  ///< that a patch is tried at all
  ScatterTree tree_;
  std::vector<Bend> bends_;
};

}  // namespace greatx::rf
