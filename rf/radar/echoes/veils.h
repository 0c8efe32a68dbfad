// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Weakens the echoes of what stands behind foliage and thin panes. All other searches take both for walls.
// Facets that are seen through veils have beams of their own, from which FacetEchoes keeps the parts behind
// veils. Each echo then loses what lies on its way.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "rf/surface/surfaces.h"

namespace greatx::rf {

class Veils {
 public:
  /// Takes the crowns of foliage, and panes that let at least `least_share` of the power through at normal
  /// incidence. `world` and `surfaces` outlive it.
  Veils(const scene::Scene& scene, const FacetTrees& trees, const FacetWorld& world,
        const RadioSurfaces& surfaces);

  static constexpr double least_share = 0.03;
  bool none() const { return !veils_.has_value(); }
  /// Returns the tracer that sees everything but veils. There must be some.
  const EchoTracer& sight() const { return *sight_; }

  /// Describes the ends of the ways. The bodies are not seen; 0: none.
  struct Ends {
    dvec3 source{0.0}, receiver{0.0};
    uint32_t own_body = 0, receiver_body = 0;
  };
  /// Returns those of the facets of which a corner or the middle is behind a veil.
  std::vector<uint32_t> behind(std::span<const uint32_t> facets, const Ends& ends, uint32_t threads) const;
  /// Holds what a way has passed so far.
  struct Passed {
    Complex panes{1.0};
    double depth_m = 0.0;  ///< inside crowns
    int inside = 0;        ///< number of crowns around the present point
    uint32_t crown = ~0u;  ///< material of the last crown
  };
  /// Holds the veils as both ends see them.
  struct Views {
    EchoTracer::View out, home;
  };
  const EchoTracer& tracer() const { return *veils_; }  ///< sees veils alone
  Views views(const Ends& ends) const;
  /// Returns what the straight way between two points passes.
  Passed leg(const EchoTracer::View& view, const dvec3& from, const dvec3& to) const;
  /// Weakens the echoes of a part of a beam, from `first` on. `out` is what is on the way to the part. The
  /// way home from its first surface passes the same if `monostatic`.
  void weaken(RawEchoes& raw, size_t first, const Passed& out, const Views& views, const Ends& ends,
              bool monostatic) const;

 private:
  void pass(const EchoTracer::View& view, const dvec3& from, const dvec3& to, Passed& passed) const;
  Complex factor(const Passed& passed) const;

  const scene::Scene& scene_;
  const FacetTrees& trees_;
  const FacetWorld& world_;
  const RadioSurfaces& surfaces_;
  std::optional<EchoTracer> veils_, sight_;
};

}  // namespace greatx::rf
