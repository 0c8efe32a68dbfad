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
// with independent circular Gaussian draws g and g' of mean power 1, the area A of a square, and the fields
// F of both elements. The echo of a resolution cell is the coherent sum of its scatterers: its amplitude is
// that of Rayleigh, it stays as long as the aspect stays, and it changes with the aspect and the carrier as
// the sum of as many points does.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rf/config/echo_options.h"
#include "rf/facets/facet_world.h"
#include "rf/radar/echoes/echo_motion.h"
#include "rf/radar/echoes/element_cells.h"
#include "rf/radar/echoes/polygon.h"
#include "rf/radar/signal/patches.h"
#include "rf/surface/clutter_table.h"

namespace greatx::rf {

/// Parts of tubes on rough surfaces that both ends see.
struct ClutterParts {
  struct Part {
    uint32_t tube = 0, facet = 0;
    uint32_t first = 0, count = 0;  ///< range of `corners`
  };
  std::vector<Part> parts;
  std::vector<dvec2> corners;  ///< in the plane coordinates of the facets

  void add(uint32_t tube, uint32_t facet, const Polygon& piece);
  void append(const ClutterParts& more);
  Polygon piece(const Part& part) const {
    return Polygon(std::span(corners).subspan(part.first, part.count));
  }
};

/// One scatterer.
struct Scatterer {
  Complex amplitude;
  dvec3 point{0.0};  ///< local coordinates
  uint32_t facet = 0;
};

struct FoundPatches {
  PatchList list;
  /// Scatterers that turn too fast for a constant rate within a block (rotors).
  std::vector<Scatterer> fast;
};

class ClutterPatches {
 public:
  /// `receiver` is null for a monostatic radar with one element. `surfaces` are those at the carrier.
  ClutterPatches(const scene::Scene& scene, const RadioSurfaces& surfaces, const EchoOptions& options,
                 const EchoEnd& transmitter, const EchoEnd* receiver);

  bool rough(uint32_t material) const { return table_.rough(material); }
  /// Returns the patches of `parts`. The bytes do not depend on the number of threads.
  FoundPatches find(const ClutterParts& parts, const FacetWorld& world, const Pose& transmitter,
                    const Pose& receiver, const EchoMotion& motion) const;

 private:
  struct Ends;
  /// A resolution cell around a place on a facet.
  struct Cell {
    double distance = 0.0, sine = 0.0;  ///< from the transmitter; sine of the grazing angle
    double area = 0.0;                  ///< m^2 of the surface
  };
  Cell cell_at(const PosedFacet& facet, const dvec2& place, const Ends& ends) const;
  /// Returns whether noise hides all resolution cells at the corners of a part
  /// (EchoOptions::hidden_floor_m2).
  bool hidden(const PosedFacet& facet, const Polygon& piece, const Ends& ends) const;
  double side_of(const PosedFacet& facet, const Polygon& piece, const Ends& ends) const;
  double cell_rad(const EchoMotion& motion) const;
  std::vector<Scatterer> scatterers(const ClutterParts& parts, const FacetWorld& world,
                                    const Ends& ends) const;
  void cover(uint32_t tube, uint32_t facet, const Polygon& piece, const FacetWorld& world, const Ends& ends,
             std::vector<Scatterer>& out) const;
  Complex amplitude(const PosedFacet& facet, const dvec3& point, double side, const CellField& field,
                    const Ends& ends, uint64_t draw) const;
  FoundPatches timed(std::vector<Scatterer> all, const FacetWorld& world, const Ends& ends,
                     const EchoMotion& motion) const;

  const scene::Scene& scene_;
  EchoOptions options_;
  ClutterTable table_;
  ElementCells cells_;
  ElementPattern receiver_pattern_;
  double receiver_slant_ = 0.0;
  bool monostatic_;
  double wavelength_m_, side_m_;
};

}  // namespace greatx::rf
