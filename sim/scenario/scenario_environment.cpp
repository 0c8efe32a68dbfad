// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// environment: sun and sky, the air and what falls from it.
#include "core/units.h"
#include "sim/scenario/scenario_parse.h"

namespace greatx::sim {

Environment parse_environment(const Field& field) {
  const FieldMap map(field, {"sun", "sky_illuminance_lux", "temperature_k", "pressure_hpa",
                             "water_vapour_g_m3", "rain_mm_h", "fog_g_m3"});
  Environment environment;
  if (const auto sun_field = map.find("sun")) {
    const FieldMap sun(*sun_field, {"azimuth_deg", "elevation_deg", "illuminance_lux"});
    if (const auto f = sun.find("azimuth_deg")) environment.sun_azimuth = radians(f->between(-360.0, 360.0));
    if (const auto f = sun.find("elevation_deg"))
      environment.sun_elevation = radians(f->between(-90.0, 90.0));
    if (const auto f = sun.find("illuminance_lux")) environment.sun_illuminance_lux = f->non_negative();
  }
  if (const auto f = map.find("sky_illuminance_lux")) environment.sky_illuminance_lux = f->non_negative();
  if (const auto f = map.find("temperature_k")) environment.temperature_k = f->between(150.0, 350.0);
  if (const auto f = map.find("pressure_hpa")) environment.pressure_hpa = f->between(0.0, 1200.0);
  if (const auto f = map.find("water_vapour_g_m3")) environment.water_vapour_g_m3 = f->between(0.0, 100.0);
  if (const auto f = map.find("rain_mm_h")) environment.rain_mm_h = f->between(0.0, 1000.0);
  if (const auto f = map.find("fog_g_m3")) environment.fog_g_m3 = f->between(0.0, 10.0);
  return environment;
}

}  // namespace greatx::sim
