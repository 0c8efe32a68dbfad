// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// One element of an antenna: how strongly and in which polarization it radiates where. Fields are on the spherical basis of
// the antenna's frame, boresight +x, or of the world's.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "core/vec.h"
#include "rf/antenna/pattern_table.h"
#include "rf/antenna/spherical.h"

namespace greatx::rf {

enum class Pattern : uint32_t { isotropic, short_dipole, half_wave_dipole, tr38901, imported };
/// TR 38.901 (V17), 7.3.2: what a slant of zeta does to the unslanted field (F_theta, F_phi), of which all patterns but
/// imported ones have F_theta alone. Both turn the field vector in the plane across the direction and leave the power where
/// it is: |F| is that of the unslanted element.
///   model_2: by zeta, whatever the direction (eq. 7.3-4, 7.3-5): F = F_theta (cos zeta, sin zeta).
///   model_1: by psi (eq. 7.3-3), the angle from theta-hat to that of an axis rolled by zeta about boresight: the polarization
///            of an element rolled as a body. psi = zeta at boresight, -zeta behind, 0 everywhere if zeta = 0.
/// A dipole that is tilted as a body, nulls and all, is none of these: turn its mount.
enum class PolarizationModel : uint32_t { model_1 = 1, model_2 = 2 };

/// The unslanted field of an element that looks along +x and is polarized along theta-hat (vertically):
///   isotropic         F_theta = 1, at the poles as well
///   short_dipole      along z: sqrt(1.5) sin theta (C. A. Balanis, "Antenna Theory", 4th ed., 4.2)
///   half_wave_dipole  along z: sqrt(1.6409223770) cos(pi/2 cos theta)/sin theta, zero at the poles (Balanis, eq. 4-84, 4-91)
///   tr38901           sqrt of A = 8 dBi - min(A_v + A_h, 30 dB), A_v = min(12 ((theta - 90)/65)^2, 30), A_h = min(12
///                     (phi/65)^2, 30) (TR 38.901, Table 7.3-1, angles in degrees). Its mean gain over the sphere is .656798:
///                     a third of the power is lost in it. On the z axis phi = 0
///   imported          of `table`
struct ElementPattern {
  ElementPattern(Pattern pattern = Pattern::isotropic,
                 PolarizationModel polarization_model = PolarizationModel::model_2,
                 std::shared_ptr<const PatternTable> samples = nullptr)
      : shape(pattern), model(polarization_model), table(std::move(samples)) {}

  Pattern shape;
  PolarizationModel model;
  std::shared_ptr<const PatternTable> table;  ///< of imported patterns, else none
};

/// Field pattern of one element with polarization slant `slant` (rad) towards `direction` in the antenna's frame, resolved on
/// that frame's (theta, phi).
Jones element_field(const ElementPattern& pattern, double slant, const dvec3& direction);

/// The same in the world: the antenna is turned by `orientation` (world_from_antenna), the field resolved on the world's
/// (theta, phi) at the world direction (TR 38.901, eq. 7.1-11).
Jones element_field(const ElementPattern& pattern, double slant, const dquat& orientation,
                    const dvec3& world_direction);

/// All polarizations of an element that is turned by `orientation` (world_from_antenna), with everything worked out once that
/// does not depend on the direction: for loops over paths. Allocates nothing.
class TurnedElement {
 public:
  /// `slants`: rad, one a polarization, at most two.
  TurnedElement(ElementPattern pattern, std::span<const double> slants, const dquat& orientation);

  /// As element_field() in the world, for each slant; `fields` has room for them.
  void respond(const dvec3& world_direction, std::span<Jones> fields) const;
  size_t polarization_count() const { return count_; }

 private:
  ElementPattern pattern_;
  std::array<dvec2, 2> slants_;  ///< (cos, sin)
  size_t count_;
  dmat3 world_from_antenna_;
};

}  // namespace greatx::rf
