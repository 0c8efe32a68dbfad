// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the raw echoes from the hits of the rays: geometry and fields, tube by tube, in fp64.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/facet_echoes.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/echoes/ray_hits.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {

/// Computes the raw echoes of all tubes.
///
/// A tube is *whole* up to a bounce if its ray and the eight around it have met the same facets so far and
/// agree on seeing the receiver. All of the tube then falls on that facet. A tube at the border of the field
/// of view, without all eight, is never whole. Otherwise find_visible divides the tube among the facets that
/// those nine rays have met after the same facets before, provided that one of the nine sees the receiver
/// then or later. Each part continues as a beam of its own.
///
/// Where a small surface is followed by a large one (target, wall), the currents are taken on the small
/// surface, and the large one is a mirror on the way to the receiver. The wave of a small surface has no
/// parallel rays on the large one, and currents there would be too strong (by 10 dB in the test). For a
/// monostatic radar the opposite path, out over the mirror, is the reciprocal of this path. Both are added
/// together; the opposite path is not searched for where the radar sees the small surface directly.
///
/// A tube that came over a mirror also sends back over that mirror (wall, target, wall). It does so from all
/// surfaces from which the radar is seen over the mirror, wherever their own reflections go. The wall shows
/// an image of the radar, and this image sees the target as a radar at that place would.
///
/// What a tube meets first of rough surfaces, and, with a monostatic radar, what it meets after one mirror,
/// is kept for ClutterPatches. The radar sees over the mirror whatever its tube meets there.
///
/// Errors: a surface that none of the nine rays meets is missed. Where all nine rays meet one instance (a
/// fine mesh), uncovered parts count as the facet of the middle ray.
class TubeEchoes {
 public:
  /// `beamed` holds the facets that FacetEchoes follows: tubes that fall on them first give nothing, and
  /// those that fall on them after a mirror give their clutter alone. `clutter` is null if rough surfaces are
  /// not asked for.
  TubeEchoes(const RayGrid& grid, const RayHits& hits, const FacetWorld& world, const FacetTrees& trees,
             const EchoField& field, const scene::Scene& scene, const dvec3& source, bool monostatic,
             const EchoOptions& options, const ClutterPatches* clutter, const BeamedFacets& beamed);

  /// The raw echoes of all parts, in their order, are those of all tubes. Parts do not depend on each other.
  size_t parts() const { return (grid_.size() + chunk - 1) / chunk; }
  void find(size_t part, RawEchoes& out) const;

 private:
  struct Job;
  static constexpr uint32_t chunk = 128;
  /// Tells which form the integral of a whole tube takes at a bounce, so that neighbours know which sides
  /// cancel. `no`: the tube is not whole there. `silent`: it is whole and sends nothing. `border`: the border
  /// form. `other`: another form.
  enum class Whole : uint8_t { no, silent, border, other };
  void classify(uint32_t tube);
  bool ring_agrees(uint32_t tube, const std::array<uint32_t, 8>& ring, uint32_t bounce) const;
  void solve(uint32_t tube, Job& job) const;
  void follow(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start, bool whole) const;
  void divide(Job& job, uint32_t bounce, const Polygon& part, const BeamStart& start,
              std::vector<VisibleCell>& cells) const;
  void bounce_off(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet, bool whole) const;
  /// Returns whether what falls on a facet at a bounce has clutter, if the receiver is there to see it.
  bool scatters(uint32_t bounce, uint32_t facet) const;
  /// Keeps a part on a rough surface.
  void keep_rough(Job& job, uint32_t bounce, const Polygon& part, uint32_t facet) const;
  /// Returns whether the ray of a tube met, from `bounce` on, a facet from which the receiver is seen.
  bool may_send(uint32_t tube, uint32_t bounce) const;
  /// Returns the word of the first ray, of this tube or else of one around it, that met `facet` at `bounce`
  /// after the same facets as the job. Returns RayHits::nothing if there is none.
  uint32_t word_of(const Job& job, uint32_t bounce, uint32_t facet) const;
  bool same_chain(const Job& job, uint32_t tube, uint32_t length) const;
  uint32_t omitted_sides(const Job& job, uint32_t bounce, const PosedFacet& facet, const Polygon& piece,
                         bool whole) const;

  const RayGrid& grid_;
  const RayHits& hits_;
  const FacetWorld& world_;
  const FacetTrees& trees_;
  const EchoField& field_;
  const scene::Scene& scene_;
  dvec3 source_;
  bool monostatic_;
  const EchoOptions& options_;
  const ClutterPatches* clutter_;
  const BeamedFacets& beamed_;
  EchoSender sender_;
  uint32_t bounces_;          ///< number of surfaces that were traced
  std::vector<Whole> whole_;  ///< [tubes * bounces]
};

/// Returns the corners of a tube in the coordinates of `beam`, and its quadrilateral.
std::array<dvec2, 4> tube_corners(const std::array<dvec3, 4>& corners, const TubeBeam& beam);
Polygon tube_part(const std::array<dvec3, 4>& corners, const TubeBeam& beam);

}  // namespace greatx::rf
