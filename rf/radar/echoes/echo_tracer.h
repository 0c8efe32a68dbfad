// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Traces rays on the host as EchoPass does on the device. Where the "GPU" is a CPU, a ray costs a third of
// what it costs in a shader. Rays are traced in fp64 against the convex pieces of facets to which tubes are
// clipped. Each body has one tree of boxes in its own frame, which poses do not change. The trees are built
// by binning the surface-area heuristic (I. Wald, "On fast construction of SAH-based bounding volume
// hierarchies", IEEE Symp. Interactive Ray Tracing 2007). A node holds three binary levels, so that eight
// boxes are tested side by side. If a ray meets two facets at the same distance, the facet with the lower
// index counts, so that the result does not depend on the tree.
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
  /// Takes the facets that `takes` accepts, or all of them.
  EchoTracer(const scene::Scene& scene, const FacetTrees& trees,
             const std::function<bool(uint32_t facet)>& takes = nullptr);

  struct Answer {
    std::vector<uint32_t> words;  ///< [max_bounces * tubes], as EchoPass::collect returns
    bool direct = false;          ///< as EchoPass::direct returns
  };
  /// Traces the rays of all tubes. `reflects` tells whether a facet reflects; rays end at facets that do not.
  /// `last` returns the number of surfaces, at most max_bounces, that a ray may meet if its first two
  /// surfaces are the given ones. The bytes do not depend on the number of threads.
  Answer trace(const FacetWorld& world, const EchoRays& rays, const RayGrid& grid, uint32_t max_bounces,
               bool monostatic, const std::function<bool(uint32_t facet)>& reflects,
               const std::function<uint32_t(uint32_t first, uint32_t second)>& last, uint32_t threads) const;

  /// Holds the bodies at their present poses, for tracing single rays.
  class View;
  /// Returns a view without the bodies of `hidden_owner` and of `another`; 0 hides none.
  View view(const FacetWorld& world, uint32_t hidden_owner, uint32_t another = 0) const;
  struct Met {
    uint32_t facet = ~0u;
    double distance = 1e30;
  };
  /// Returns the first facet that a ray meets. `direction` is a unit vector. The ray passes through the facet
  /// `leaving`; ~0: none.
  Met first(const View& view, const dvec3& origin, const dvec3& direction, uint32_t leaving) const;
  /// Describes the points origin + t direction with `from` <= t <= `to`, and all points within t `slope` of
  /// them, metres. Only points inside all half-spaces count; at most `most_sides` of them.
  struct Cone {
    dvec3 origin, direction;
    double from = 0.0, to = 1e30, slope = 0.0;
    std::span<const KeptSide> sides = {};
  };
  static constexpr uint32_t most_sides = 6;
  /// Appends the pieces of facets that a cone may meet, and perhaps some more, in the order of FacetPiece.
  void gather(const View& view, const Cone& cone, std::vector<FacetPiece>& pieces) const;
  /// The cone of a question in fp32, to be kept.
  struct Reach {
    float origin[3], direction[3], to, slope;
    Reach(const dvec3& from, const dvec3& along, double to_, double slope_);
  };
  /// Returns whether a moving body comes near a cone. False says that neither gather() nor first() would meet
  /// one there; a ray ends at `to`.
  bool moving_near(const View& view, const Reach& reach) const;
  /// Returns whether nothing but the facet `leaving` is between two points.
  bool clear(const View& view, const dvec3& from, const dvec3& to, uint32_t leaving) const;
  /// Returns a point slightly above a surface, from which a ray that leaves it does not meet what lies in its
  /// plane. `normal` points to the side of the ray.
  static dvec3 lifted(const dvec3& at, const dvec3& normal);

 private:
  static constexpr uint32_t wide = 8, leaf_size = 4, bins = 16;
  struct alignas(32) Eight {
    float lane[wide];
  };
  /// Holds eight children side by side. A leaf has `count` pieces from index `child` on. An inner child is
  /// the node `child`, with `count` = 0. The box of an absent child is empty, so that no ray meets it.
  struct alignas(32) Node {
    float box[3][2][wide];  ///< [axis][low, high][child]
    uint32_t child[wide], count[wide];
  };
  struct Piece {
    dvec3 normal{0.0};
    double offset = 0.0;
    uint32_t facet = 0, index = 0;  ///< of the piece in FacetTrees
    uint32_t first_side = 0, side_count = 0;
    /// Distance by which a ray may pass outside a side, metres, so that no ray slips between two pieces.
    double room = 0.0;
  };
  struct Side {  ///< normal . x + offset >= 0 inside the piece
    dvec3 normal{0.0};
    double offset = 0.0;
  };
  struct Tree {
    uint32_t root = 0, body = 0, owner = 0;
    scene::Bounds bounds;
  };
  /// Holds a tree at the present pose of its body.
  struct Standing {
    const Tree* tree = nullptr;
    Pose back;  ///< body_from_local
    dvec3 center{0.0};
    double squared_radius = 0.0;
  };
  struct Build;
  /// Holds a ray in the frame of one body, and the nearest facet that it has met so far.
  struct Query {
    dvec3 origin, direction;
    double nearest = 1e30;  ///< in units of the length of `direction`
    uint32_t leaving = ~0u, facet = ~0u;
    bool any = false;
    uint32_t piece = none;  ///< index of the piece that was met last
    static constexpr uint32_t none = ~0u;
  };
  /// Holds the trees of one owner, one behind the other, and a ball around them: a cyclist has a dozen bodies
  /// that turn, and most rays come near none of them.
  struct Group {
    uint32_t first = 0, count = 0;  ///< in Poses::trees
    bool is_static = false;         ///< has the tree of body 0, and no ball
    dvec3 center{0.0};
    double radius = 0.0;
  };
  struct Poses {
    std::vector<Standing> trees;
    std::vector<Group> groups;
    /// The balls of the groups in fp32, wider than the rounding errors, eight side by side. A street has
    /// hundreds of groups, and a ray comes near a few of them.
    struct EightBalls {
      Eight x, y, z, radius;
    };
    std::vector<EightBalls> balls;
  };
  using Hidden = std::array<uint32_t, 2>;  ///< owners of the bodies that rays pass through; 0: none

  Piece piece_of(const scene::Facet& facet, FacetPiece index, std::span<const dvec3> corners);
  uint32_t build(Build& work, uint32_t first, uint32_t count);
  static void meet(const Node* nodes, const Piece* pieces, const Side* sides, uint32_t root, Query& query);
  static void test(const Piece* pieces, uint32_t index, const Side* sides, Query& query);
  static void gather(const Node* nodes, const Piece* pieces, uint32_t root, const Cone& cone,
                     std::vector<FacetPiece>& found);
  /// Returns all trees except those of hidden bodies.
  Poses standing(const FacetWorld& world, const Hidden& hidden) const;
  /// Calls visit(group) for all groups that points within t `slope` of a ray up to `to` may come near, and
  /// perhaps some more, until it returns true. The static group comes first.
  template <typename Visit>
  static void near_groups(const Poses& poses, const dvec3& origin, const dvec3& direction, double to,
                          double slope, const Visit& visit);
  static void near_balls(const Poses::EightBalls* balls, uint32_t count, const float* origin,
                         const float* direction, float to, float slope, uint32_t* near);
  /// Tests the ray against all bodies. `query` is in local coordinates. `guess` is a piece of the static body
  /// that the ray probably meets, or Query::none: it is tested first, so that farther boxes are passed over.
  void meet_all(const Poses& poses, Query& query, uint32_t guess = Query::none) const;
  void meet_body(const Standing& one, double squared, Query& query) const;
  void gather(const Standing& one, const Cone& cone, double squared, std::vector<FacetPiece>& pieces) const;
  bool sees(const Poses& poses, const dvec3& from, const dvec3& to, uint32_t leaving) const;

  std::vector<Node> nodes_;
  std::vector<Piece> pieces_;  ///< in the order of the leaves
  std::vector<Side> sides_;
  std::vector<Tree> trees_;
};

class EchoTracer::View {
  friend class EchoTracer;
  Poses poses_;
};

}  // namespace greatx::rf
