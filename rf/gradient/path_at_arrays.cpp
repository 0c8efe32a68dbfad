// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/path_at_arrays.h"

#include <cmath>

#include "core/error.h"
#include "rf/channel/pair_amplitudes.h"

namespace greatx::rf {
namespace {

/// Returns F^T T G with a transfer T.
Complex between(const Jones& received, const Complex* t, const Jones& sent) {
  return (received.theta * t[0] + received.phi * t[2]) * sent.theta +
         (received.theta * t[1] + received.phi * t[3]) * sent.phi;
}

/// Returns the change of a field by a change of the direction and of its end.
Jones field_slope(const FieldSlopes& field, const dvec3& direction, const EndTangent& end, double slant) {
  Jones change{field.by_slant.theta * slant, field.by_slant.phi * slant};
  for (int x = 0; x < 3; ++x) {
    const Jones &by_direction = field.by_direction[static_cast<size_t>(x)],
                &by_attitude = field.by_attitude[static_cast<size_t>(x)];
    change.theta += by_direction.theta * direction[x] + by_attitude.theta * end.attitude[x];
    change.phi += by_direction.phi * direction[x] + by_attitude.phi * end.attitude[x];
  }
  return change;
}

/// The lead L - |L k - x| of a place x, for a wave from the distance L, or k . x for a flat wave.
struct PlaceLead {
  double lead_m = 0.0;
  /// The unit direction from the place to the source; k for a flat wave. It is the derivative by the place.
  dvec3 to_source{0.0};
};
PlaceLead place_lead(const dvec3& direction, double radius_m, const dvec3& place) {
  const double along = glm::dot(direction, place);
  if (std::isinf(radius_m)) return {along, direction};
  const dvec3 way = radius_m * direction - place;
  const double length = glm::length(way);
  GREATX_CHECK(length > 0.0, "an element stands at the source of a wave");
  return {(2.0 * radius_m * along - glm::dot(place, place)) / (radius_m + length), way / length};
}

double place_lead_slope(const dvec3& direction, double radius_m, const dvec3& place, const dvec3& d_direction,
                        double d_radius_m, const dvec3& d_place) {
  const PlaceLead at = place_lead(direction, radius_m, place);
  if (std::isinf(radius_m)) return glm::dot(d_direction, place) + glm::dot(direction, d_place);
  return d_radius_m * (1.0 - glm::dot(at.to_source, direction)) -
         radius_m * glm::dot(at.to_source, d_direction) + glm::dot(at.to_source, d_place);
}

/// Adds the share of a lead of weight `weight`. Returns the cotangent of the place.
dvec3 pull_place_lead(const dvec3& direction, double radius_m, const dvec3& place, double weight,
                      dvec3& d_direction, double& d_radius_m) {
  const PlaceLead at = place_lead(direction, radius_m, place);
  if (std::isinf(radius_m)) {
    d_direction += weight * place;
  } else {
    d_radius_m += weight * (1.0 - glm::dot(at.to_source, direction));
    d_direction -= weight * radius_m * at.to_source;
  }
  return weight * at.to_source;
}

}  // namespace

std::vector<dvec3> element_places(const ArrayPose& end) {
  std::vector<dvec3> places;
  for (uint32_t port = 0; port < end.array.port_count(); port += end.array.polarization_count())
    places.push_back(end.orientation * end.array.element_position(port));
  return places;
}

ElementSlopes element_slopes_of(const ArrayPose& end, const std::vector<double>& slants) {
  std::vector<double> all = slants;
  for (uint32_t p = 0; slants.empty() && p < end.array.polarization_count(); ++p)
    all.push_back(end.array.slant(p));
  GREATX_CHECK(all.size() == end.array.polarization_count(), "{} slants of {} polarizations", all.size(),
               end.array.polarization_count());
  return {end.array.pattern, all, end.orientation};
}

PathAmplitudes::PathAmplitudes(const ResponseLink& link, double carrier_hz)
    : sender_(element_slopes_of(link.transmitter, link.transmitter_slants)),
      receiver_(element_slopes_of(link.receiver, link.receiver_slants)),
      scale_(wavelength_factor(carrier_hz)),
      carrier_hz_(carrier_hz) {}

void PathAmplitudes::load(const Path& path) {
  path_ = &path;
  sender_.at(path.departure, sent_);
  receiver_.at(path.arrival, received_);
}

Complex PathAmplitudes::amplitude(size_t rx, size_t tx) const {
  return scale_ * between(received_[rx].field, path_->transfer, sent_[tx].field);
}

Complex PathAmplitudes::slope(size_t rx, size_t tx, const PathSlope& path, const LinkTangent& link) const {
  const FieldSlopes &received = received_[rx], &sent = sent_[tx];
  const Jones d_received = field_slope(received, path.arrival, link.receiver, link.receiver.slants[rx]);
  const Jones d_sent = field_slope(sent, path.departure, link.transmitter, link.transmitter.slants[tx]);
  const Complex change = between(d_received, path_->transfer, sent.field) +
                         between(received.field, path.transfer, sent.field) +
                         between(received.field, path_->transfer, d_sent);
  return scale_ * change - amplitude(rx, tx) * (link.carrier_hz / carrier_hz_);
}

PathLeads::PathLeads(const ArrayPose& transmitter, const ArrayPose& receiver)
    : curved_(transmitter.wavefront == Wavefront::curved),
      sent_m_(element_places(transmitter)),
      received_m_(element_places(receiver)) {
  GREATX_CHECK(transmitter.wavefront == receiver.wavefront, "the ends of a link take waves differently");
}

void PathLeads::load(const Path& path) {
  path_ = &path;
  shape_ = curved_ ? wave_shape(path) : WaveShape{};
}

double PathLeads::lead_m(size_t rx, size_t tx) const {
  if (shape_.image)
    return place_lead(path_->arrival, path_->length_m, received_m_[rx] - shape_.mirror * sent_m_[tx]).lead_m;
  return place_lead(path_->arrival, shape_.receiver_radius_m, received_m_[rx]).lead_m +
         place_lead(path_->departure, shape_.transmitter_radius_m, sent_m_[tx]).lead_m;
}

double PathLeads::slope_m(size_t rx, size_t tx, const PathTangent& path, const LinkTangent& link) const {
  const dvec3 d_received = glm::cross(link.receiver.attitude, received_m_[rx]);
  const dvec3 d_sent = glm::cross(link.transmitter.attitude, sent_m_[tx]);
  if (shape_.image)
    return place_lead_slope(path_->arrival, path_->length_m, received_m_[rx] - shape_.mirror * sent_m_[tx],
                            path.slope.arrival, path.slope.length_m, d_received - shape_.mirror * d_sent);
  return place_lead_slope(path_->arrival, shape_.receiver_radius_m, received_m_[rx], path.slope.arrival,
                          path.receiver_radius_m, d_received) +
         place_lead_slope(path_->departure, shape_.transmitter_radius_m, sent_m_[tx], path.slope.departure,
                          path.transmitter_radius_m, d_sent);
}

void PathLeads::pull_back(size_t rx, size_t tx, double weight, PathCotangent& path,
                          LinkCotangent& link) const {
  const dvec3 &received = received_m_[rx], &sent = sent_m_[tx];
  dvec3 by_received, by_sent;
  if (shape_.image) {
    by_received = pull_place_lead(path_->arrival, path_->length_m, received - shape_.mirror * sent, weight,
                                  path.arrival, path.length_m);
    by_sent = -(by_received * shape_.mirror);  // the transpose
  } else {
    by_received = pull_place_lead(path_->arrival, shape_.receiver_radius_m, received, weight, path.arrival,
                                  path.receiver_radius_m);
    by_sent = pull_place_lead(path_->departure, shape_.transmitter_radius_m, sent, weight, path.departure,
                              path.transmitter_radius_m);
  }
  link.receiver.attitude += glm::cross(received, by_received);
  link.transmitter.attitude += glm::cross(sent, by_sent);
}

}  // namespace greatx::rf
