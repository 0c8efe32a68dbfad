// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// What EchoPass does, without a device: where the "GPU" is a CPU, a ray costs a third of what it costs in a
// shader. In fp64, against the same convex pieces of facets that tubes are clipped to. One tree of boxes a
// body, in its frame, which no pose changes; I. Wald, "On fast construction of SAH-based bounding volume
// hierarchies", IEEE Symp. Interactive Ray Tracing 2007 (bins), three levels of it in one node, so that eight
// boxes are tested side by side. Where a ray meets two facets at the same distance it is the one of the lower
// index: what is met depends on no tree.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_pass.h"
#include "rf/radar/echoes/facet_trees.h"
#include "rf/radar/echoes/ray_grid.h"

namespace greatx::rf {

class EchoTracer {
 public:
  EchoTracer(const scene::Scene& scene, const FacetTrees& trees);

  struct Answer {
    std::vector<uint32_t> words;  ///< [max_bounces * tubes], as EchoPass::collect's
    bool direct = false;          ///< as EchoPass::direct
  };
  /// `reflects`: rays end at facets that do not. `last`: the surfaces, at most max_bounces, that a ray may
  /// meet whose first two these are. The same bytes whatever the threads.
  Answer trace(const FacetWorld& world, const EchoRays& rays, const RayGrid& grid, uint32_t max_bounces,
               bool monostatic, const std::function<bool(uint32_t facet)>& reflects,
               const std::function<uint32_t(uint32_t first, uint32_t second)>& last, uint32_t threads) const;

  /// What single rays meet, as all bodies stand.
  class View;
  /// Without the bodies of that owner; 0: with all.
  View view(const FacetWorld& world, uint32_t hidden_owner) const;
  struct Met {
    uint32_t facet = ~0u;
    double distance = 1e30;
  };
  /// `direction`: unit. `leaving`: a facet that is passed through; ~0: none.
  Met first(const View& view, const dvec3& origin, const dvec3& direction, uint32_t leaving) const;

 private:
  static constexpr uint32_t wide = 8, leaf_size = 4, bins = 16;
  /// Children side by side; a leaf has `count` pieces from `child` on, an inner one is the node `child`, an
  /// absent one has a box that nothing meets.
  struct alignas(32) Node {
    float box[3][2][wide];  ///< by axis: low, high
    uint32_t child[wide], count[wide];
  };
  struct Piece {
    dvec3 normal{0.0};
    double offset = 0.0;
    uint32_t facet = 0, first_side = 0, side_count = 0;
    double room = 0.0;  ///< that a ray may be outside of a side, metres: nothing slips between two pieces
  };
  struct Side {  ///< normal . x + offset >= 0 inside
    dvec3 normal{0.0};
    double offset = 0.0;
  };
  struct Tree {
    uint32_t root = 0, body = 0, owner = 0;
    scene::Bounds bounds;
  };
  /// A tree where its body stands now.
  struct Standing {
    const Tree* tree = nullptr;
    Pose back;  ///< body_from_local
    dvec3 center{0.0};
    double squared_radius = 0.0;
  };
  struct Build;
  /// A ray and what it has met so far, all in one body's frame.
  struct Query {
    dvec3 origin, direction;
    double nearest = 1e30;  ///< in lengths of `direction`
    uint32_t leaving = ~0u, facet = ~0u;
    bool any = false;
  };
  using Hidden = std::array<uint32_t, 2>;  ///< owners of bodies that are passed through; 0: none

  Piece piece_of(const scene::Facet& facet, uint32_t index, std::span<const dvec3> corners);
  uint32_t build(Build& work, uint32_t first, uint32_t count);
  static void meet(const Node* nodes, const Piece* pieces, const Side* sides, uint32_t root, Query& query);
  static void test(const Piece& piece, const Side* sides, Query& query);
  /// All trees but those of what is hidden.
  std::vector<Standing> standing(const FacetWorld& world, const Hidden& hidden) const;
  /// Over all bodies; `query` in local coordinates.
  void meet_all(std::span<const Standing> trees, Query& query) const;
  bool sees(std::span<const Standing> trees, const dvec3& from, const dvec3& to, uint32_t leaving) const;

  std::vector<Node> nodes_;
  std::vector<Piece> pieces_;  ///< in the order of the leaves
  std::vector<Side> sides_;
  std::vector<Tree> trees_;
};

class EchoTracer::View {
  friend class EchoTracer;
  std::vector<Standing> trees_;
};

}  // namespace greatx::rf
