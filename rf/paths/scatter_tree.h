// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds everything that scatters the waves of one source in a tree, whose nodes know what they scatter
// together. A target looks at nodes, and opens those that matter (ScatterDraw). The tree is that of
// B. Walter et al., "Lightcuts: a scalable approach to illumination", ACM Trans. Graph. 24(3), 2005.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"
#include "rf/surface/scattering.h"

namespace greatx::rf {

/// Describes a patch that a wave of the source meets on one way.
struct LitPatch {
  dvec3 position{0.0};
  dvec3 normal{0.0};    ///< unit, towards the side that the wave comes from
  dvec3 specular{0.0};  ///< unit, the direction of the wave's reflection
  /// What the patch scatters, relative to what the source sends: S^2 Gamma^2 cos(theta_i) dA / s'^2 times the
  /// share that the reflections before it leave, without the air and walls. It is greater than 0.
  double power = 0.0;
  double length_m = 0.0;  ///< unfolded, from the source
  const DiffuseScattering* surface = nullptr;
  uint32_t facet = 0, patch = 0;  ///< the facet, and the index of the patch among all
  uint32_t arrival = 0;           ///< index of the way from the source to the patch
  double clock = 0.0;             ///< an exponential variable of mean 1 that belongs to patch and way
};

class ScatterTree {
 public:
  static constexpr uint32_t none = ~0u;
  struct Node {
    dvec3 center{0.0};  ///< weighted by power
    double radius_m = 0.0;
    dvec3 normal{0.0}, specular{0.0};  ///< weighted by power; unit if all are the same
    double power = 0.0;                ///< sum
    double length_m = 0.0;             ///< mean, weighted by power
    double least_m = 0.0, most_m = 0.0;
    double peak = 0.0;             ///< bound of the lobes, 1/sr
    double inverse_norm = 0.0;     ///< 1/norm of the lobe (mean weighted by power)
    uint32_t first = 0, last = 0;  ///< range of scatterers
    uint32_t second = none;        ///< the second child; the first is the next node; none: a single scatterer
    /// The scatterer whose clock, divided by its power, is the least of the node's, and this quotient. Each
    /// scatterer is it with the probability of its share of the power.
    uint32_t drawn = 0;
    double clock = 0.0;
    bool one_plane = false;                      ///< all have one facet and are lit on the same side
    const DiffuseScattering* surface = nullptr;  ///< of the strongest
  };

  ScatterTree() = default;
  /// Orders the scatterers by place, normal, direction and length.
  explicit ScatterTree(std::vector<LitPatch> scatterers);

  bool empty() const { return nodes_.empty(); }
  const std::vector<LitPatch>& scatterers() const { return scatterers_; }
  const std::vector<Node>& nodes() const { return nodes_; }  ///< [0] is the root

  /// Returns the power that a node scatters to `target` if nothing is in the way, for an isotropic antenna, as
  /// LitPatch::power, 1/m^2. It is exact for a single scatterer. It is 0 only if every scatterer sends 0.
  double to(const Node& node, const dvec3& target) const;

 private:
  void build(uint32_t first, uint32_t last);
  void sum_up(Node& node) const;

  std::vector<LitPatch> scatterers_;
  std::vector<Node> nodes_;
};

}  // namespace greatx::rf
