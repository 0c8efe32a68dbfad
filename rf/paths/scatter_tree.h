// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds everything that scatters the waves of one source in a tree, whose nodes know what they scatter
// together. A target looks at nodes, and opens those that matter (ScatterDraw). The tree is that of
// B. Walter et al., "Lightcuts: a scalable approach to illumination", ACM Trans. Graph. 24(3), 2005.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/surface/scattering.h"

namespace greatx::rf {

/// Describes a patch that a wave of the source meets on one way. Its power is an estimate that only chooses
/// what is traced: it is the mean over both polarizations, without the air.
struct LitPatch {
  dvec3 position{0.0};
  dvec3 normal{0.0};    ///< unit, towards the side that the wave comes from
  dvec3 specular{0.0};  ///< unit, the direction of the wave's reflection
  /// What the patch scatters, relative to what the source sends: S^2 Gamma^2 cos(theta_i) dA / s'^2 times the
  /// shares that the reflections and walls before it leave. It is greater than 0.
  double power = 0.0;
  double length_m = 0.0;  ///< unfolded, from the source
  const DiffuseScattering* surface = nullptr;
  uint32_t facet = 0, patch = 0;  ///< the facet, and the index of the patch among all
  uint32_t arrival = 0;           ///< index of the way from the source to the patch
  uint32_t depth = 0;             ///< reflections on this way
  double clock = 0.0;             ///< an exponential variable of mean 1 that belongs to patch and way
};

/// Returns the power that a patch scatters along the unit vector `out` to a distance if nothing is in the
/// way, for an isotropic antenna that receives both polarizations, relative to what the source sends, 1/m^2.
double scattered_power(const LitPatch& patch, const dvec3& out, double distance_m);

class ScatterTree {
 public:
  static constexpr uint32_t none = ~0u;
  struct Node {
    dvec3 center{0.0};                 ///< weighted by power
    dvec3 middle{0.0};                 ///< of the box around the patches
    double radius_m = 0.0;             ///< of the sphere around this box
    dvec3 normal{0.0}, specular{0.0};  ///< weighted by power; unit if all are the same
    double power = 0.0;                ///< sum
    double length_m = 0.0;             ///< mean, weighted by power
    double peak = 0.0;                 ///< the largest value of a lobe, 1/sr
    double mean_peak = 0.0;            ///< mean, weighted by power
    uint32_t first = 0, last = 0;      ///< range of patches
    uint32_t least_depth = ~0u;        ///< of a patch
    uint32_t second = none;            ///< the second child; the first is the next node; none: a single patch
    /// The patch whose clock, divided by its power, is the least of the node's, and this quotient. Each patch
    /// is it with the probability of its share of the power.
    uint32_t drawn = 0;
    double clock = 0.0;
    bool one_plane = false;                      ///< all have one facet and are lit on the same side
    const DiffuseScattering* surface = nullptr;  ///< of the strongest patch
  };

  ScatterTree() = default;
  /// Puts the patches into the order of the tree: by place, normal, direction and length.
  explicit ScatterTree(std::vector<LitPatch> patches);

  bool empty() const { return nodes_.empty(); }
  const std::vector<LitPatch>& patches() const { return patches_; }
  const std::vector<Node>& nodes() const { return nodes_; }  ///< [0] is the root

  /// Returns an estimate of scattered_power() of all patches of a node to `target`. It is exact for a single
  /// patch, and 0 only if it is 0 for every patch.
  double to(const Node& node, const dvec3& target) const;

  struct Descent {
    uint32_t patch = none;
    double probability = 0.0;
  };
  /// Goes down from the root to a patch. At each node a child is taken with the probability of its share in
  /// weight(node), which must be greater than 0 for every node with a patch that matters. `u`: uniform in
  /// [0, 1). Returns the patch, or none if no patch matters.
  template <typename Weight>
  Descent descend(const Weight& weight, double u) const;

 private:
  void build(uint32_t first, uint32_t last);
  void sum_up(Node& node) const;

  std::vector<LitPatch> patches_;
  std::vector<Node> nodes_;
};

template <typename Weight>
ScatterTree::Descent ScatterTree::descend(const Weight& weight, double u) const {
  if (empty() || !(weight(nodes_[0]) > 0.0)) return {};
  uint32_t at = 0;
  double probability = 1.0;
  while (nodes_[at].second != none) {
    const uint32_t second = nodes_[at].second;
    const double a = weight(nodes_[at + 1]), b = weight(nodes_[second]);
    if (!(a + b > 0.0)) return {};
    const double share = a / (a + b);
    if (u < share) {
      u /= share, probability *= share;
      ++at;
    } else {
      u = std::min((u - share) / (1.0 - share), 1.0 - 0x1.0p-53);
      probability *= 1.0 - share;
      at = second;
    }
  }
  return {nodes_[at].first, probability};
}

}  // namespace greatx::rf
