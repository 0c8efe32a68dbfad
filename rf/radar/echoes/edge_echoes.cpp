// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/radar/echoes/edge_echoes.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "rf/radar/echoes/fringe.h"

namespace greatx::rf {
namespace {

constexpr double seam_rad = 0.5;     ///< edges this close to flat belong to curved surfaces
constexpr double sight_m = 0.5;      ///< length of the stretches of which one ray tells whether they are seen
constexpr double lift_m = 1e-4;      ///< distance of the ends of rays from the edge
constexpr double least_sine = 0.05;  ///< of the angle with the edge below which an end is on its line
constexpr double most_fringe = 1.5;  ///< bound on both coefficients, away from grazing incidence

/// Holds an edge in local coordinates.
struct PosedEdge {
  dvec3 a{0.0}, along{1, 0, 0}, tangent{0.0}, normal{0.0};
  double length = 0.0;
  /// Returns the angle of a point about the edge, from face 0, in [0, 2 pi).
  double angle(const dvec3& point) const {
    const dvec3 arm = point - a;
    const double turn = std::atan2(glm::dot(arm, normal), glm::dot(arm, tangent));
    return turn < 0.0 ? turn + 2.0 * pi : turn;
  }
  /// Returns the place of a point along the edge, and its distance from the line.
  dvec2 place(const dvec3& point) const {
    const dvec3 arm = point - a;
    const double x = glm::dot(arm, along);
    return {x, glm::length(arm - x * along)};
  }
};

PosedEdge posed_edge(const scene::Wedge& wedge, const FacetWorld& world) {
  const Pose pose = wedge.body == 0 ? Pose{} : world.motion(wedge.body).pose;
  PosedEdge edge;
  edge.a = pose.apply(wedge.a);
  const dvec3 side = pose.apply(wedge.b) - edge.a;
  edge.length = glm::length(side);
  edge.along = side / edge.length;
  edge.tangent = pose.rotate(wedge.tangent_0), edge.normal = pose.rotate(wedge.normal_0);
  return edge;
}

}  // namespace

EdgeEchoes::EdgeEchoes(const scene::Scene& scene, const scene::EdgeSurvey* survey)
    : wedges_(scene::find_wedges(scene, {.free_edges = true, .flat_angle_rad = seam_rad}, nullptr, survey)) {}

EdgeEchoes::Search::Search(const EdgeEchoes& edges, const FacetWorld& world, const EchoTracer& tracer,
                           const EchoField& field, const EchoSender& sender, const Ends& ends)
    : edges_(edges),
      world_(world),
      tracer_(tracer),
      field_(field),
      sender_(sender),
      ends_(ends),
      out_(tracer.view(world, ends.own_body)),
      home_(tracer.view(world, ends.own_body, ends.receiver_body)) {}

void EdgeEchoes::Search::find(size_t part, RawEchoes& out) const {
  const std::vector<scene::Wedge>& wedges = edges_.wedges_;
  for (size_t i = part * chunk; i < std::min(wedges.size(), (part + 1) * chunk); ++i) solve(wedges[i], out);
}

void EdgeEchoes::Search::solve(const scene::Wedge& wedge, RawEchoes& out) const {
  const EchoField& field = field_;
  const uint32_t own = ends_.own_body;
  if (own != 0 && wedge.body != 0 && world_.facet(wedge.facet_0).owner == own) return;
  if (!field.reflects(wedge.facet_0) || (wedge.facet_n != scene::no_facet && !field.reflects(wedge.facet_n)))
    return;
  const PosedEdge edge = posed_edge(wedge, world_);
  const dvec3 &source = ends_.source, &receiver = field.receiver_at();
  const PhaseLine line{edge.place(source), edge.place(receiver), field.wavenumber()};
  const double middle = 0.5 * edge.length;
  const auto distance = [&](const dvec2& end) { return std::hypot(middle - end.x, end.y); };
  const double before = distance(line.source), after = distance(line.receiver);
  if (line.source.y < least_sine * before || line.receiver.y < least_sine * after) return;
  // sigma = (fringe |integral|)^2/pi, and that of a phase integral is 4 pi |value|^2/lambda^2.
  const double slope_a = line.slope(0.0), slope_b = line.slope(edge.length);
  const double most =
      slope_a * slope_b > 0.0
          ? std::min(edge.length, 2.0 / std::max(1e-9, std::min(std::abs(slope_a), std::abs(slope_b))))
          : edge.length;
  if (most_fringe * most / field.wavenumber() < sender_.floor_at(before, after)) return;
  const double incident = edge.angle(source), observed = edge.angle(receiver), width = wedge.n * pi;
  if (incident > width || observed > width) return;
  const Fringe strength = fringe(wedge.n, incident, observed);

  const auto stretches = static_cast<uint32_t>(std::clamp(std::ceil(edge.length / sight_m), 1.0, 64.0));
  const auto seen = [&](uint32_t i) {
    const dvec3 at = edge.a + edge.length * (i + 0.5) / stretches * edge.along;
    const auto clear = [&](const EchoTracer::View& view, const dvec3& end) {
      const dvec3 across = end - at - glm::dot(end - at, edge.along) * edge.along;
      return tracer_.clear(view, at + lift_m * glm::normalize(across), end, wedge.facet_0);
    };
    return clear(out_, source) && (ends_.monostatic || clear(home_, receiver));
  };
  std::vector<LineContribution> contributions;
  for (uint32_t first = 0; first < stretches;) {
    if (!seen(first)) {
      ++first;
      continue;
    }
    uint32_t last = first + 1;
    while (last < stretches && seen(last)) ++last;
    integrate(line, edge.length * first / stretches, edge.length * last / stretches, contributions);
    first = last + 1;
  }
  const double least = sender_.floor_at(before, after);
  for (const LineContribution& c : contributions) {
    const double size = std::max(std::abs(strength.soft), std::abs(strength.hard)) * std::abs(c.value);
    if (size / field.wavenumber() < least) {
      ++out.below_floor;
      continue;
    }
    const dvec3 point = edge.a + c.at * edge.along;
    const EdgePoint place{glm::normalize(point - source), glm::distance(point, source), point, edge.along,
                          wedge.facet_0};
    const Complex amplitude = c.value * field.edge_density(place, strength);
    if (amplitude == 0.0) continue;
    out.echoes.push_back({amplitude, place.departure, glm::normalize(point - receiver), point,
                          line.length(c.at), static_cast<uint32_t>(out.chains.size()), 1});
    out.chains.push_back(wedge.facet_0);
  }
}

}  // namespace greatx::rf
