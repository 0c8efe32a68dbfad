// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Covers the rough surfaces that a radar sees with patches (docs/clutter.md).
//
// Every facet has lattices of scatterers, one in each square, at a random place within it. The squares are
// half a range cell wide, or 2, 4, ... times as wide where a resolution cell of range and angle, or Doppler
// frequency, is so large that it still holds about four. Places and amplitudes are drawn from (seed, facet,
// width, square): they belong to the surface and move with it. A facet smaller than a square has a scatterer
// with the probability of its share of the square, so that many small facets send back the right power. The
// part of a tube on a facet (TubeEchoes) has the scatterers that lie in it, so that shadows are exact. Each
// scatterer sends back
//   a = lambda/((4 pi)^(3/2) r1 r2) sqrt(A) F_r . [g sqrt(sigma0_hh) h h + g sqrt(sigma0_vv) v v
//       + g' sqrt(sigma0_hv) (h v + v h)] . F_t,
// with independent circular Gaussian draws g and g' of mean power 1, the area A of a square, and the fields F
// of both elements. Between two ends, a material that scatters by its lobe (ClutterTable::lobe()) has h and v
// of the receiver from those of the transmitter, by the mirror that sends the wave there. The echo of a
// resolution cell is the coherent sum of its scatterers: its amplitude is that of Rayleigh, it stays as long
// as the aspect stays, and it changes with the aspect and the carrier as the sum of as many points does.
//
// A tube of a monostatic radar that meets a mirror first lights scatterers that the mirror shows. They send
// back over the mirror, and, where the radar sees them itself, directly; and what reaches them directly goes
// home over the mirror. On a way over the mirror, r is the distance from the radar's image, and F is
// reflected by the mirror.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/radar/echoes/element_cells.h"
#include "rf/radar/echoes/polygon.h"
#include "rf/radar/echoes/ray_grid.h"
#include "rf/radar/echoes/tube_beam.h"
#include "rf/radar/signal/patches.h"
#include "rf/surface/clutter_table.h"

namespace greatx::rf {

/// Parts of tubes and of beams on rough surfaces, which both ends see, or which the transmitter sees over a
/// mirror.
struct ClutterParts {
  static constexpr uint32_t no_mirror = ~0u;
  static constexpr uint32_t of_a_beam = ~0u;  ///< in place of a tube: FacetEchoes has found the part
  struct Part {
    uint32_t tube = 0, facet = 0;
    uint32_t mirror = no_mirror;    ///< facet that the tube has met before
    uint32_t first = 0, count = 0;  ///< range of `corners`
  };
  std::vector<Part> parts;
  std::vector<dvec2> corners;  ///< in the plane coordinates of the facets

  void add(uint32_t tube, uint32_t facet, uint32_t mirror, const Polygon& piece);
  void append(const ClutterParts& more);
  Polygon piece(const Part& part) const {
    return Polygon(std::span(corners).subspan(part.first, part.count));
  }
};

/// One scatterer, and one way over it.
struct Scatterer {
  /// Which of the ways out and home leads over the mirror.
  enum class Over : uint8_t { none, both, out, home };
  Complex amplitude;
  dvec3 point{0.0};  ///< local coordinates
  uint32_t facet = 0;
  uint32_t mirror = ClutterParts::no_mirror;
  Over over = Over::none;
};

/// Returns the unit vector from `end` to the place on the mirror where it shows `point`.
inline dvec3 mirrored_direction(const PosedFacet& mirror, const dvec3& end, const dvec3& point) {
  return glm::normalize(mirrored(mirror, point) - end);
}

/// Tells what a radar sees directly of the scatterers that a mirror shows.
struct ClutterSight {
  const RayGrid& grid;
  const EchoTracer& tracer;
  const EchoTracer::View& view;
};

struct FoundPatches {
  PatchList list;
  /// Scatterers that turn too fast for a constant rate within a block (rotors), or all of them
  /// (EchoOptions::scatterer_echoes).
  std::vector<Scatterer> fast;
};

class ClutterPatches {
 public:
  /// `receiver` is null for a monostatic radar with one element. `surfaces` are those at the carrier.
  ClutterPatches(const scene::Scene& scene, const RadioSurfaces& surfaces, const EchoOptions& options,
                 const EchoEnd& transmitter, const EchoEnd* receiver);

  bool rough(uint32_t facet) const {
    const scene::Facet& one = scene_.facets[facet];
    return table_.rough(one.material) && (asked_.empty() || asked_[one.instance]);
  }
  /// Returns the patches of `parts`. The bytes do not depend on the number of threads.
  FoundPatches find(const ClutterParts& parts, const FacetWorld& world, const ClutterSight& sight,
                    const Pose& transmitter, const Pose& receiver, const EchoMotion& motion) const;

 private:
  struct Ends;
  struct Over;
  /// The wave of an element at a scatterer.
  struct Leg {
    dvec3 in{1, 0, 0};  ///< unit vector, away from the element or its image
    double length_m = 0.0;
    FieldVector field;
    /// The way to a point, without a field yet.
    Leg(const dvec3& from, const dvec3& point) : length_m(glm::length(point - from)) {
      in = (point - from) / length_m;
    }
  };
  /// A resolution cell around a place on a facet.
  struct Cell {
    double out_m = 0.0, home_m = 0.0;  ///< distances from both ends or their images
    double sine = 0.0;                 ///< mean of the sines of both grazing angles
    double depth_m = 0.0;              ///< along the range, on the surface
  };
  Cell cell_at(const PosedFacet& facet, const dvec2& place, const dvec3& out, const dvec3& home) const;
  /// Returns whether noise hides all resolution cells at the corners of a part
  /// (EchoOptions::hidden_floor_m2). `share(point)` is the share of the power that mirrors leave.
  template <typename Share>
  bool hidden(const PosedFacet& facet, const Polygon& piece, const dvec3& out, const dvec3& home,
              const Ends& ends, const Share& share) const;
  double side_of(const PosedFacet& facet, const Polygon& piece, const dvec3& out, const dvec3& home,
                 double in_a_cell, const Ends& ends) const;
  double cell_rad(const EchoMotion& motion) const;
  std::vector<Scatterer> scatterers(const ClutterParts& parts, const FacetWorld& world,
                                    const Ends& ends) const;
  /// Calls `take(point, draw)` for the scatterers of a part.
  template <typename Take>
  void spread(uint32_t facet, const Polygon& piece, double side, const FacetWorld& world,
              std::vector<Scatterer>& out, const Take& take) const;
  void cover(const ClutterParts::Part& part, const Polygon& piece, const FacetWorld& world, const Ends& ends,
             std::vector<Scatterer>& out) const;
  void cover_over(const ClutterParts::Part& part, const Polygon& piece, const FacetWorld& world,
                  const Ends& ends, std::vector<Scatterer>& out) const;
  Complex amplitude(const PosedFacet& facet, const Leg& out, const Leg& home, double side,
                    uint64_t draw) const;
  FoundPatches timed(std::vector<Scatterer> all, const FacetWorld& world, const Ends& ends,
                     const EchoMotion& motion) const;
  void add_blocks(const std::vector<Scatterer>& all, const FacetWorld& world, const Ends& ends,
                  const EchoMotion& motion, PatchList& list) const;

  const scene::Scene& scene_;
  EchoOptions options_;
  ClutterTable table_;
  std::vector<bool> asked_;            ///< [instances] those that scatter; empty: all
  std::optional<ElementCells> cells_;  ///< absent if scatterers take the field of the element itself
  const RadioSurfaces& surfaces_;
  ElementPattern transmitter_pattern_, receiver_pattern_;
  double transmitter_slant_ = 0.0, receiver_slant_ = 0.0;
  bool monostatic_;
  double wavelength_m_, side_m_;
};

}  // namespace greatx::rf
