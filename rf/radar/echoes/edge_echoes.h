// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Adds what edges send back beyond physical optics (fringe.h): plates seen from the side, blades of rotors,
// corners of buildings. The edges are those that diffract in a channel, and the borders of thin plates.
#pragma once

#include <vector>

#include "rf/radar/echoes/echo_sender.h"
#include "rf/radar/echoes/echo_tracer.h"
#include "scene/description/wedges.h"

namespace greatx::rf {

class EdgeEchoes {
 public:
  /// Finds the edges. Those that are nearly flat (within 0.5 rad) are seams of curved surfaces and left out.
  /// `survey`: null, or one of the scene's edges, which spares work.
  explicit EdgeEchoes(const scene::Scene& scene, const scene::EdgeSurvey* survey = nullptr);

  /// Describes the ends of a search. The bodies are not seen; 0: none.
  struct Ends {
    dvec3 source{0.0};
    uint32_t own_body = 0, receiver_body = 0;
    bool monostatic = true;
  };
  class Search;

 private:
  std::vector<scene::Wedge> wedges_;
};

/// Finds the echoes of all edges that both ends see and that may stand above the floor, with one bounce, at
/// the first of their two faces. All references outlive it.
class EdgeEchoes::Search {
 public:
  Search(const EdgeEchoes& edges, const FacetWorld& world, const EchoTracer& tracer, const EchoField& field,
         const EchoSender& sender, const Ends& ends);
  /// The echoes of all parts, in their order, are those of all edges. Parts do not depend on each other.
  size_t parts() const { return (edges_.wedges_.size() + chunk - 1) / chunk; }
  void find(size_t part, RawEchoes& out) const;

 private:
  static constexpr size_t chunk = 512;
  void solve(const scene::Wedge& wedge, RawEchoes& out) const;

  const EdgeEchoes& edges_;
  const FacetWorld& world_;
  const EchoTracer& tracer_;
  const EchoField& field_;
  const EchoSender& sender_;
  Ends ends_;
  EchoTracer::View out_, home_;
};

}  // namespace greatx::rf
