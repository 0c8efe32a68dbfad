// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/earth_place.h"

#include "core/error.h"
#include "core/units.h"

namespace greatx::sim {

std::optional<EarthPlace> earth_place(const Experiment& experiment) {
  const std::optional<PlaceAndTime>& sun = experiment.scenario.environment.place;
  const std::optional<double> unix_s = sun ? std::optional(sun->unix_s) : std::nullopt;
  if (const std::optional<Georeference>& reference = experiment.scenario.scene.georeference)
    return EarthPlace{LocalFrame(*reference), unix_s};
  if (!sun) return std::nullopt;
  const Geodetic origin{degrees(sun->latitude), degrees(sun->longitude), sun->height_m};
  return EarthPlace{LocalFrame({origin, 0.0, ""}), unix_s};
}

EarthPlace require_earth_place(const Experiment& experiment, const char* who) {
  std::optional<EarthPlace> place = earth_place(experiment);
  if (!place)
    throw_user_error(
        "{} needs the place of the scene on the Earth: expected scene.georeference, or environment.place "
        "with "
        "environment.time, found neither",
        who);
  return *std::move(place);
}

}  // namespace greatx::sim
