// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Holds the working memory of FacetEchoes while it follows the beam of one facet (facet_echoes.cpp) and sends
// back from what the beam lights (facet_echoes_home.cpp).
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "rf/radar/echoes/facet_echoes.h"
#include "rf/radar/echoes/visible_cells.h"

namespace greatx::rf {

/// Fraction of the area of a beam; smaller parts are dropped.
inline constexpr double smallest_beam_part = 1e-9;
/// Relative difference between two computations of a distance.
inline constexpr double same_beam_distance = 1e-6;

struct FacetEchoes::Job : BeamWay {
  /// Holds surfaces that a beam has met in turn.
  struct Surfaces {
    std::array<uint32_t, most_surfaces> chain{};
    uint32_t count = 0;
    bool operator==(const Surfaces& o) const {
      return count == o.count && std::equal(chain.begin(), chain.begin() + count, o.chain.begin());
    }
  };
  struct Lit {  ///< what a beam lights of the last surface
    Surfaces surfaces;
    Polygon part;
  };
  struct Shown {  ///< a mirror that some rays from the last surface meet
    Surfaces surfaces;
    uint32_t mirror = 0;
    bool operator==(const Shown& o) const = default;
  };
  Surfaces met(uint32_t count) const { return {chain, count}; }

  uint32_t limit = 0;     ///< number of surfaces that the beam may meet
  double smallest = 0.0;  ///< area in the (u, v) plane; smaller parts are dropped
  std::vector<FacetPiece> pieces;
  std::array<std::vector<VisibleCell>, most_surfaces> cells;
  std::array<std::vector<Polygon>, most_surfaces> parts;  ///< of one facet
  std::vector<FacetPiece> hiding;                         ///< what may hide a part from the receiver
  std::vector<Polygon> seen;                              ///< of a part, by the receiver
  std::vector<VisibleCell> on_mirror;                     ///< of the way to the receiver
  std::vector<VisibleCell> behind;                        ///< veils
  std::vector<Polygon> sending;                           ///< what the receiver sees of a part
  std::vector<Lit> lit;                                   ///< of the present beam
  std::vector<Shown> shown;                               ///< without repetition
  bool records = false;                                   ///< into `cones`
  std::vector<EchoTracer::Reach> cones;                   ///< what the tracer was asked for the present facet
  VisibleScratch scratch;
};

}  // namespace greatx::rf
