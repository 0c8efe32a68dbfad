// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/channel/wavefront.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

std::vector<dvec3> places_of(const ArrayPose& end) {
  std::vector<dvec3> places;
  for (uint32_t port = 0; port < end.array.port_count(); port += end.array.polarization_count())
    places.push_back(end.orientation * end.array.element_position(port));
  return places;
}

/// Returns L - |L direction - place|, which is direction . place for an infinite L. The difference of squares
/// keeps all digits.
double lead_m(const dvec3& direction, double length_m, const dvec3& place) {
  const double along = glm::dot(direction, place);
  if (std::isinf(length_m)) return along;
  const double from_element = glm::length(length_m * direction - place);
  return (2.0 * length_m * along - glm::dot(place, place)) / (length_m + from_element);
}

bool is_plane(InteractionType type) {
  return type == InteractionType::reflection || type == InteractionType::transmission;
}

/// Mirrors directions as the reflection does that turns `in` into `out`, both unit vectors. Grazing waves,
/// whose directions hardly differ, have a normal that is exact to a rounding over the angle, and turn the
/// place by twice that angle: the error stays a rounding.
void mirror(const dvec3& in, const dvec3& out, std::vector<dvec3>& places) {
  const dvec3 across = out - in;
  const double squared = glm::dot(across, across);
  if (squared == 0.0) return;
  for (dvec3& place : places) place -= across * (2.0 * glm::dot(across, place) / squared);
}

/// Returns the direction of each segment; a segment without length has that of the one before.
std::vector<dvec3> segment_directions(const Path& path) {
  std::vector<dvec3> directions{path.departure};
  for (size_t i = 1; i + 1 < path.vertices.size(); ++i) {
    const dvec3 segment = path.vertices[i + 1] - path.vertices[i];
    directions.push_back(segment == dvec3(0.0) ? directions.back() : glm::normalize(segment));
  }
  return directions;
}

/// Mirrors places as all reflections of the path do, one after the other.
void mirror_at_all(const Path& path, std::vector<dvec3>& places) {
  const std::vector<dvec3> directions = segment_directions(path);
  for (size_t i = 0; i < path.interactions.size(); ++i)
    if (path.interactions[i].type == InteractionType::reflection)
      mirror(directions[i], directions[i + 1], places);
}

/// Returns the length of the path from its transmitter to vertex `vertex`.
double length_to(const Path& path, size_t vertex) {
  double length_m = 0.0;
  for (size_t i = 0; i < vertex; ++i) length_m += glm::distance(path.vertices[i], path.vertices[i + 1]);
  return length_m;
}

}  // namespace

Leads::Leads(const ArrayPose& transmitter, const ArrayPose& receiver)
    : curved_(transmitter.wavefront == Wavefront::curved),
      sent_m_(places_of(transmitter)),
      received_m_(places_of(receiver)) {
  GREATX_CHECK(transmitter.wavefront == receiver.wavefront, "the ends of a link take waves differently");
}

WaveShape wave_shape(const Path& path) {
  GREATX_CHECK(path.interactions.empty() || path.vertices.size() == path.interactions.size() + 2,
               "{} vertices of a path with {} interactions", path.vertices.size(), path.interactions.size());
  const auto other = std::ranges::find_if_not(path.interactions, is_plane, &Interaction::type);
  WaveShape shape;
  if (other == path.interactions.end()) {
    shape.image = true;
    std::vector<dvec3> axes{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    mirror_at_all(path, axes);
    shape.mirror = dmat3(axes[0], axes[1], axes[2]);
    return shape;
  }
  const auto diffracts = [](InteractionType type) { return type == InteractionType::diffraction; };
  if (std::ranges::any_of(path.interactions, diffracts, &Interaction::type)) return shape;
  const auto first = static_cast<size_t>(other - path.interactions.begin());
  size_t last = path.interactions.size() - 1;
  while (is_plane(path.interactions[last].type)) --last;
  shape.transmitter_radius_m = length_to(path, first + 1);
  shape.receiver_radius_m = length_to(path, path.vertices.size() - 1) - length_to(path, last + 1);
  return shape;
}

void Leads::operator()(const Path& path, double* out) {
  if (!curved_) return of_ends(path, {}, out);
  const WaveShape shape = wave_shape(path);
  return shape.image ? of_image(path, out) : of_ends(path, shape, out);
}

void Leads::of_ends(const Path& path, const WaveShape& shape, double* out) {
  for (const dvec3& received : received_m_) {
    const double lead = lead_m(path.arrival, shape.receiver_radius_m, received);
    for (const dvec3& sent : sent_m_)
      *out++ = (lead + lead_m(path.departure, shape.transmitter_radius_m, sent)) / speed_of_light;
  }
}

void Leads::of_image(const Path& path, double* out) {
  mirrored_m_ = sent_m_;
  mirror_at_all(path, mirrored_m_);
  for (const dvec3& received : received_m_)
    for (const dvec3& mirrored : mirrored_m_)
      *out++ = lead_m(path.arrival, path.length_m, received - mirrored) / speed_of_light;
}

}  // namespace greatx::rf
