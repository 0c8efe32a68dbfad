// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/antenna/element.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

constexpr double short_directivity = 1.5;
/// 4 / Cin(2 pi): Balanis, "Antenna Theory", 4th ed., eq. 4-91.
constexpr double half_wave_directivity = 1.6409223770;

/// Returns cos(pi/2 cos theta) / sin theta times the root of the directivity. The cosine is computed as
/// sin(pi/2 (1 - |cos theta|)) with 1 - |c| = s^2 / (1 + |c|), which does not cancel near the poles.
double half_wave_amplitude(const Angles& at) {
  if (at.sin_theta == 0.0) return 0.0;
  const double versine = at.sin_theta * at.sin_theta / (1.0 + std::abs(at.cos_theta));
  return std::sqrt(half_wave_directivity) * std::sin(0.5 * pi * versine) / at.sin_theta;
}

/// Returns the amplitude of TR 38.901 (V17), Table 7.3-1.
double tr38901_amplitude(const Angles& at) {
  constexpr double peak_dbi = 8.0, beamwidth = radians(65.0), floor_db = 30.0;
  const double below = std::atan2(at.cos_theta, at.sin_theta) / beamwidth;  // (90 - theta)/65
  const double beside = std::atan2(at.sin_phi, at.cos_phi) / beamwidth;
  const double vertical_db = std::min(12.0 * below * below, floor_db);
  const double horizontal_db = std::min(12.0 * beside * beside, floor_db);
  const double gain_db = peak_dbi - std::min(vertical_db + horizontal_db, floor_db);
  return std::pow(10.0, gain_db / 20.0);
}

Jones unslanted(const ElementPattern& pattern, const Angles& at) {
  switch (pattern.shape) {
    case Pattern::isotropic:
      return {1.0, 0.0};
    case Pattern::short_dipole:
      return {std::sqrt(short_directivity) * at.sin_theta, 0.0};
    case Pattern::half_wave_dipole:
      return {half_wave_amplitude(at), 0.0};
    case Pattern::tr38901:
      return {tr38901_amplitude(at), 0.0};
    case Pattern::imported:
      GREATX_CHECK(pattern.table != nullptr, "an imported pattern without its table");
      return pattern.table->at(std::atan2(at.sin_theta, at.cos_theta), std::atan2(at.sin_phi, at.cos_phi));
  }
  GREATX_CHECK(false, "pattern {}", static_cast<uint32_t>(pattern.shape));
}

/// Returns (cos, sin) of the angle by which the slant turns the field in the antenna's (theta, phi). `slant`:
/// (cos, sin) zeta.
dvec2 turn_of(PolarizationModel model, const dvec2& slant, const Angles& at) {
  if (model == PolarizationModel::model_2) return slant;
  // `turn` is (cos psi, sin psi) times D. Its length is D, and unlike 1 - (...)^2 it does not cancel. Along
  // the rolled axis psi is arbitrary; 0 is taken.
  const dvec2 turn{slant.x * at.sin_theta + slant.y * at.sin_phi * at.cos_theta, slant.y * at.cos_phi};
  const double d = std::hypot(turn.x, turn.y);
  return d > 0.0 ? turn / d : dvec2(1.0, 0.0);
}

Jones turned(const Jones& field, const dvec2& turn) {
  return {turn.x * field.theta - turn.y * field.phi, turn.y * field.theta + turn.x * field.phi};
}

}  // namespace

Jones element_field(const ElementPattern& pattern, double slant, const dvec3& direction) {
  const Angles at = angles_of(direction);
  return turned(unslanted(pattern, at), turn_of(pattern.model, {std::cos(slant), std::sin(slant)}, at));
}

TurnedElement::TurnedElement(ElementPattern pattern, std::span<const double> slants, const dquat& orientation)
    : pattern_(std::move(pattern)), count_(slants.size()), world_from_antenna_(glm::mat3_cast(orientation)) {
  GREATX_CHECK(count_ <= slants_.size(), "{} polarizations of at most {}", count_, slants_.size());
  for (size_t p = 0; p < count_; ++p) slants_[p] = {std::cos(slants[p]), std::sin(slants[p])};
}

void TurnedElement::respond(const dvec3& world_direction, std::span<Jones> fields) const {
  GREATX_CHECK(fields.size() >= count_, "room for {} of {} polarizations", fields.size(), count_);
  const Angles own = angles_of(world_direction * world_from_antenna_);  // multiplies by the transpose
  const Angles world = angles_of(world_direction);
  // Both bases are perpendicular to the direction: the matrix of eq. 7.1-11 is a turn by the angle between
  // them (eq. 7.1-12).
  const dvec3 own_theta = world_from_antenna_ * own.theta_hat();
  const dvec2 basis{glm::dot(world.theta_hat(), own_theta), glm::dot(world.phi_hat(), own_theta)};
  const Jones field = turned(unslanted(pattern_, own), basis);  // turns about one axis commute
  for (size_t p = 0; p < count_; ++p) fields[p] = turned(field, turn_of(pattern_.model, slants_[p], own));
}

}  // namespace greatx::rf
