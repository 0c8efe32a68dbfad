// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Gives the strength and the polarization of the field that one antenna element radiates in each direction.
// Fields are resolved on the spherical basis of the antenna's frame, whose boresight is +x, or of the world.
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
/// The effect of a slant zeta on the unslanted field (F_theta, F_phi); TR 38.901 (V17), 7.3.2. All patterns
/// except imported ones have only F_theta. Both models turn the field vector in the plane across the
/// direction and keep the power: |F| is that of the unslanted element.
/// - model_2 turns by zeta in every direction (eq. 7.3-4, 7.3-5): F = F_theta (cos zeta, sin zeta).
/// - model_1 turns by psi (eq. 7.3-3), the angle between theta-hat and the theta-hat of an axis that is
///   rolled by zeta about boresight. The element is polarized as if its body were rolled. psi is zeta at
///   boresight, -zeta behind the element, and 0 everywhere if zeta = 0.
/// Neither model describes a dipole whose body is tilted together with its nulls: turn the mount of such a
/// dipole.
enum class PolarizationModel : uint32_t { model_1 = 1, model_2 = 2 };

/// Holds the unslanted field of an element that faces +x and is polarized along theta-hat (vertically):
/// - isotropic: F_theta = 1, also at the poles.
/// - short_dipole, along z: sqrt(1.5) sin theta (C. A. Balanis, "Antenna Theory", 4th ed., 4.2).
/// - half_wave_dipole, along z: sqrt(1.6409223770) cos(pi/2 cos theta)/sin theta, zero at the poles (Balanis,
///   eq. 4-84, 4-91).
/// - tr38901: the square root of A = 8 dBi - min(A_v + A_h, 30 dB) with A_v = min(12 ((theta - 90)/65)^2, 30)
///   and A_h = min(12 (phi/65)^2, 30) (TR 38.901, Table 7.3-1, angles in degrees). The mean gain over the
///   sphere is 0.656798: a third of the power is lost in the element. On the z axis phi = 0.
/// - imported: the samples of `table`.
struct ElementPattern {
  ElementPattern(Pattern pattern = Pattern::isotropic,
                 PolarizationModel polarization_model = PolarizationModel::model_2,
                 std::shared_ptr<const PatternTable> samples = nullptr)
      : shape(pattern), model(polarization_model), table(std::move(samples)) {}

  Pattern shape;
  PolarizationModel model;
  std::shared_ptr<const PatternTable> table;  ///< samples of imported patterns; null for other patterns
};

/// Returns the field pattern of one element with polarization slant `slant` (rad) towards `direction` in the
/// antenna's frame, resolved on (theta, phi) of that frame.
Jones element_field(const ElementPattern& pattern, double slant, const dvec3& direction);

/// Evaluates all polarizations of an element that `orientation` (world_from_antenna) turns. The constructor
/// computes everything that does not depend on the direction, for loops over paths. Allocates nothing.
class TurnedElement {
 public:
  /// `slants`: one slant per polarization, rad; at most two.
  TurnedElement(ElementPattern pattern, std::span<const double> slants, const dquat& orientation);

  /// Computes the field for each slant, resolved on the world's (theta, phi) at the world direction (TR
  /// 38.901, eq. 7.1-11). `fields` must have room for all polarizations.
  void respond(const dvec3& world_direction, std::span<Jones> fields) const;
  size_t polarization_count() const { return count_; }

 private:
  ElementPattern pattern_;
  std::array<dvec2, 2> slants_;  ///< (cos, sin)
  size_t count_;
  dmat3 world_from_antenna_;
};

}  // namespace greatx::rf
