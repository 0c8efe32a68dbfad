// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/scenario_values.h"

#include "core/units.h"

namespace greatx::sim {

Rational rational_of(const Field& field, const std::string& expected) {
  const auto value = Rational::parse(field.scalar());
  if (!value) field.fail(expected);
  return *value;
}

TurnRate turn_rate_of(const Field& field, const std::string& expected) {
  std::string_view text = field.scalar();
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  const auto size = Rational::parse(text);
  if (!size) field.fail(expected);
  return {*size, negative};
}

dvec3 position_of(const Field& field) { return field.vector3(most_position_m); }

dvec3 angles_of(const Field& field) {
  const std::string expected = "a list of 3 numbers: yaw, pitch, roll in degrees";
  if (!field.is_list() || field.list(expected).size() != 3) field.fail(expected);
  const dvec3 angles = field.vector3(most_angle_deg);
  return {radians(angles.x), radians(angles.y), radians(angles.z)};
}

}  // namespace greatx::sim
