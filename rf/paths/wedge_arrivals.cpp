// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/paths/wedge_arrivals.h"

#include <cmath>

#include "core/error.h"
#include "rf/edges/corners.h"
#include "rf/edges/diffraction.h"

namespace greatx::rf {

WedgeArrivals::WedgeArrivals(const CandidateList& candidates, std::span<const scene::Wedge> wedges,
                             uint32_t most_depth) {
  if (candidates.wedges.size() > ~0u)
    throw_user_error("paths: {} sequences that lead to wedges, expected at most {}; a smaller max_depth",
                     candidates.wedges.size(), ~0u);
  offsets_.assign(wedges.size() + 1, 0);
  uint32_t count = 0;  // the canonical order is by depth
  while (count < candidates.size() && candidates.sequence(count).size() <= most_depth) ++count;
  for (uint32_t sequence = 0; sequence < count; ++sequence)
    for (const uint32_t wedge : candidates.wedges_of(sequence))
      offsets_[wedge + 1] += leads_to(candidates.sequence(sequence), wedges[wedge]);
  for (uint32_t i = 0; i < wedges.size(); ++i) {
    if (offsets_[i + 1] > 0) reached_.push_back(i);
    offsets_[i + 1] += offsets_[i];
  }
  sequences_.resize(offsets_.back());
  depths_.resize(offsets_.back());
  std::vector<uint32_t> next(offsets_.begin(), offsets_.end() - 1);
  for (uint32_t sequence = 0; sequence < count; ++sequence)
    for (const uint32_t wedge : candidates.wedges_of(sequence)) {
      const auto facets = candidates.sequence(sequence);
      if (!leads_to(facets, wedges[wedge])) continue;
      depths_[next[wedge]] = static_cast<uint8_t>(facets.size());
      sequences_[next[wedge]++] = sequence;
    }
}

WedgeArrivals::Place WedgeArrivals::place_of(const Edge& edge, const dvec3& point) {
  const dvec3 from = point - edge.start;
  const double along = glm::dot(from, edge.along);
  return {along, glm::length(from - along * edge.along)};
}

/// Tells whether a point lies so clearly between the faces, inside the wedge, that in_exterior() refuses it.
bool WedgeArrivals::Edge::inside(const dvec3& point) const {
  const dvec3 from = point - start;
  const double x = glm::dot(tangent_0, from), y = glm::dot(normal_0, from);
  const double beyond_n = face_n.x * y - face_n.y * x;  // distance from face n; face 0 is at y = 0
  const double clear = 1e-6 * (std::abs(x) + std::abs(y)) + 1e2 * room + 1e-11 * glm::length(point);
  return y < -clear && beyond_n > clear;
}

void WedgeArrivals::place(const ImageTree& tree, std::span<const scene::Wedge> wedges) {
  if (edges_.empty()) {
    edges_.resize(wedges.size());
    for (const uint32_t index : reached_) {
      const scene::Wedge& wedge = wedges[index];
      const double length = glm::distance(wedge.a, wedge.b);
      edges_[index] = {
          .start = wedge.a,
          .along = (wedge.b - wedge.a) / length,
          .tangent_0 = wedge.tangent_0,
          .normal_0 = wedge.normal_0,
          .face_n = face_n_direction(wedge),
          .length = wedge.body == 0 ? length : -1.0,
          // Twice the tolerance of keller_point, for the roundings of another order of operations.
          .room = 2.0 * (1e-9 * length + 1e-13 * (glm::length(wedge.a) + length))};
    }
  }
  places_.resize(sequences_.size());
  for (const uint32_t index : reached_) {
    const Edge& edge = edges_[index];
    if (edge.length < 0.0) continue;
    for (size_t i = begin(index); i < begin(index) + count(index); ++i) {
      const dvec3& image = tree.image(sequences_[i]);
      places_[i] = edge.inside(image) ? nowhere : place_of(edge, image);
    }
  }
}

/// Tells whether Keller's point of two places lies on the edge, or near enough to one of its ends.
bool WedgeArrivals::meet(const Edge& edge, const Place& from, const Place& to, double most_excess_m) {
  // The Keller point is at (z d' + z' d)/(d + d'). Roundings are relative to the largest of the terms.
  const double sum = from.away + to.away, a = from.along * to.away, b = to.along * from.away;
  const double room = edge.room * sum + 1e-14 * (std::abs(a) + std::abs(b));
  if (!(a + b >= -room)) {  // also what is nowhere: NaN
    if (most_excess_m == 0.0 || from.along != from.along) return false;
    return corner_place(from.along, from.away, to.along, to.away).excess_m <= most_excess_m;
  }
  if (a + b <= edge.length * sum + room) return true;
  if (most_excess_m == 0.0) return false;
  return corner_place(edge.length - from.along, from.away, edge.length - to.along, to.away).excess_m <=
         most_excess_m;
}

void WedgeArrivals::joined(uint32_t wedge, const dvec3& after, uint32_t most_depth, double most_excess_m,
                           std::vector<uint32_t>& sequences) const {
  sequences.clear();
  const Edge& edge = edges_[wedge];
  const bool moves = edge.length < 0.0;
  if (!moves && edge.inside(after)) return;
  const Place to = moves ? Place{} : place_of(edge, after);
  for (size_t i = begin(wedge); i < begin(wedge) + count(wedge) && depths_[i] <= most_depth; ++i) {
    if (moves || meet(edge, places_[i], to, most_excess_m)) sequences.push_back(sequences_[i]);
  }
}

}  // namespace greatx::rf
