// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "rf/gradient/element_slopes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/units.h"

namespace greatx::rf {
namespace {

Jones scaled(const Jones& field, double by) { return {field.theta * by, field.phi * by}; }
Jones sum(const Jones& a, const Jones& b) { return {a.theta + b.theta, a.phi + b.phi}; }
/// Returns the derivative of a field that turns about its direction.
Jones turning(const Jones& field) { return {-field.phi, field.theta}; }
Jones turned_by(const Jones& field, const dvec2& turn) {
  return {turn.x * field.theta - turn.y * field.phi, turn.y * field.theta + turn.x * field.phi};
}

/// Holds an unslanted field and its derivatives by the angles of the antenna's frame.
struct UnslantedSlopes {
  Jones field, by_theta, by_phi;
};

UnslantedSlopes real_field(double amplitude, double by_theta, double by_phi) {
  return {{amplitude, 0.0}, {by_theta, 0.0}, {by_phi, 0.0}};
}

/// The constants and formulas are those of element.cpp.
UnslantedSlopes short_dipole_slopes(const Angles& at) {
  const double root = std::sqrt(1.5);
  return real_field(root * at.sin_theta, root * at.cos_theta, 0.0);
}

UnslantedSlopes half_wave_slopes(const Angles& at) {
  const double root = std::sqrt(1.6409223770);
  const double to_pole = 1.0 + std::abs(at.cos_theta);
  const double angle = 0.5 * pi * at.sin_theta * at.sin_theta / to_pole;
  // cos(pi/2 cos theta) / sin^2 theta = sin(angle) / sin^2 theta, whose limit at the poles is pi/4.
  const double ratio = at.sin_theta == 0.0 ? 0.25 * pi : std::sin(angle) / (at.sin_theta * at.sin_theta);
  const double slope = 0.5 * pi * std::sin(0.5 * pi * at.cos_theta) - at.cos_theta * ratio;
  return real_field(root * ratio * at.sin_theta, root * slope, 0.0);
}

UnslantedSlopes tr38901_slopes(const Angles& at) {
  constexpr double peak_dbi = 8.0, beamwidth = radians(65.0), floor_db = 30.0;
  const double below = std::atan2(at.cos_theta, at.sin_theta) / beamwidth;
  const double beside = std::atan2(at.sin_phi, at.cos_phi) / beamwidth;
  const double vertical_db = 12.0 * below * below, horizontal_db = 12.0 * beside * beside;
  const double loss_db = std::min(vertical_db, floor_db) + std::min(horizontal_db, floor_db);
  const double amplitude = std::pow(10.0, (peak_dbi - std::min(loss_db, floor_db)) / 20.0);
  if (loss_db >= floor_db) return real_field(amplitude, 0.0, 0.0);
  const double per_db = -amplitude * std::log(10.0) / 20.0;
  return real_field(amplitude, per_db * 24.0 * below * (-1.0 / beamwidth),
                    per_db * 24.0 * beside / beamwidth);
}

/// Differentiates the bilinear interpolation of PatternTable::at.
UnslantedSlopes table_slopes(const PatternTable& table, const Angles& angles) {
  const double zenith = std::atan2(angles.sin_theta, angles.cos_theta);
  const double azimuth = std::atan2(angles.sin_phi, angles.cos_phi);
  const auto& [zeniths, azimuths, first_azimuth] = table.grid();
  const double per_zenith = (zeniths - 1.0) / pi, per_azimuth = azimuths / (2.0 * pi);
  const double row = std::clamp(zenith * per_zenith, 0.0, zeniths - 1.0);
  const uint32_t i = std::min(static_cast<uint32_t>(row), zeniths - 2);
  double column = (azimuth - first_azimuth) * per_azimuth;
  column -= azimuths * std::floor(column / azimuths);
  const uint32_t j = std::min(static_cast<uint32_t>(column), azimuths - 1);
  const uint32_t next = j + 1 == azimuths ? 0 : j + 1;
  const double down = row - i, across = column - j;
  const Jones* const upper = table.samples().data() + size_t{i} * azimuths;
  const Jones* const lower = upper + azimuths;
  const auto mix = [](const Jones& a, const Jones& b, double share) {
    return sum(scaled(a, 1.0 - share), scaled(b, share));
  };
  const auto change = [](const Jones& from, const Jones& to, double per_rad) {
    return Jones{(to.theta - from.theta) * per_rad, (to.phi - from.phi) * per_rad};
  };
  const Jones above = mix(upper[j], upper[next], across), beneath = mix(lower[j], lower[next], across);
  return {mix(above, beneath, down), change(above, beneath, per_zenith),
          change(mix(upper[j], lower[j], down), mix(upper[next], lower[next], down), per_azimuth)};
}

UnslantedSlopes unslanted_slopes(const ElementPattern& pattern, const Angles& at) {
  switch (pattern.shape) {
    case Pattern::isotropic:
      return real_field(1.0, 0.0, 0.0);
    case Pattern::short_dipole:
      return short_dipole_slopes(at);
    case Pattern::half_wave_dipole:
      return half_wave_slopes(at);
    case Pattern::tr38901:
      return tr38901_slopes(at);
    case Pattern::imported:
      GREATX_CHECK(pattern.table != nullptr, "an imported pattern without its table");
      return table_slopes(*pattern.table, at);
  }
  GREATX_CHECK(false, "pattern {}", static_cast<uint32_t>(pattern.shape));
}

/// Holds the turn by a slant, (cos, sin) of its angle, and the derivatives of the angle.
struct SlantTurn {
  dvec2 turn;
  double by_theta = 0.0, by_phi = 0.0, by_slant = 0.0;
};

SlantTurn slant_turn(PolarizationModel model, const dvec2& slant, const Angles& at) {
  if (model == PolarizationModel::model_2) return {slant, 0.0, 0.0, 1.0};
  const dvec2 turn{slant.x * at.sin_theta + slant.y * at.sin_phi * at.cos_theta, slant.y * at.cos_phi};
  const double squared = glm::dot(turn, turn);
  if (squared == 0.0) return {{1.0, 0.0}};
  const auto angle = [&](const dvec2& change) { return (turn.x * change.y - turn.y * change.x) / squared; };
  const dvec2 by_theta{slant.x * at.cos_theta - slant.y * at.sin_phi * at.sin_theta, 0.0};
  const dvec2 by_phi{slant.y * at.cos_phi * at.cos_theta, -slant.y * at.sin_phi};
  const dvec2 by_slant{-slant.y * at.sin_theta + slant.x * at.sin_phi * at.cos_theta, slant.x * at.cos_phi};
  return {turn / std::hypot(turn.x, turn.y), angle(by_theta), angle(by_phi), angle(by_slant)};
}

/// Returns 1/sin theta, or 0 on the axis, where nothing depends on phi.
double per_sine(const Angles& at) { return at.sin_theta == 0.0 ? 0.0 : 1.0 / at.sin_theta; }

}  // namespace

ElementSlopes::ElementSlopes(ElementPattern pattern, std::span<const double> slants, const dquat& orientation)
    : pattern_(std::move(pattern)), count_(slants.size()), world_from_antenna_(glm::mat3_cast(orientation)) {
  GREATX_CHECK(count_ <= slants_.size(), "{} polarizations of at most {}", count_, slants_.size());
  for (size_t p = 0; p < count_; ++p) slants_[p] = {std::cos(slants[p]), std::sin(slants[p])};
}

void ElementSlopes::at(const dvec3& k, std::span<FieldSlopes> out) const {
  GREATX_CHECK(out.size() >= count_, "room for {} of {} polarizations", out.size(), count_);
  const Angles own = angles_of(k * world_from_antenna_), world = angles_of(k);
  const dvec3 own_theta = world_from_antenna_ * own.theta_hat(),
              own_phi = world_from_antenna_ * own.phi_hat();
  const dvec2 basis{glm::dot(world.theta_hat(), own_theta), glm::dot(world.phi_hat(), own_theta)};
  const dvec3 world_phi = world.phi_hat();
  const double per_own_sine = per_sine(own), per_world_sine = per_sine(world);
  const UnslantedSlopes slopes = unslanted_slopes(pattern_, own);
  const auto to_world = [&](const Jones& field, const SlantTurn& slant) {
    return turned_by(turned_by(field, basis), slant.turn);
  };
  for (size_t p = 0; p < count_; ++p) {
    const SlantTurn slant = slant_turn(pattern_.model, slants_[p], own);
    FieldSlopes& result = out[p];
    result.field = to_world(slopes.field, slant);
    const Jones turn = turning(result.field);
    // By the angles of the antenna's frame and by phi of the world's.
    const Jones by_theta = sum(to_world(slopes.by_theta, slant), scaled(turn, slant.by_theta));
    const Jones by_phi = sum(to_world(slopes.by_phi, slant), scaled(turn, own.cos_theta + slant.by_phi));
    const Jones by_world_phi = scaled(turn, -world.cos_theta);
    for (int x = 0; x < 3; ++x) {
      const auto axis = static_cast<size_t>(x);
      result.by_direction[axis] =
          sum(sum(scaled(by_theta, own_theta[x]), scaled(by_phi, own_phi[x] * per_own_sine)),
              scaled(by_world_phi, world_phi[x] * per_world_sine));
      result.by_attitude[axis] =
          sum(sum(scaled(by_theta, -own_phi[x]), scaled(by_phi, own_theta[x] * per_own_sine)),
              scaled(turn, k[x]));
    }
    result.by_slant = scaled(turn, slant.by_slant);
  }
}

}  // namespace greatx::rf
