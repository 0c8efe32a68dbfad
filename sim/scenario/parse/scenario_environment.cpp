// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses environment: sun, moon and sky, the air, rain and fog.
#include "core/units.h"
#include "sim/scenario/date_time.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {

namespace {

PlaceAndTime parse_place(const Field& field, const Field& time) {
  const FieldMap map(field, {"latitude_deg", "longitude_deg", "height_m"});
  PlaceAndTime place;
  place.latitude = radians(map.require("latitude_deg", "degrees, north positive").between(-90.0, 90.0));
  place.longitude = radians(map.require("longitude_deg", "degrees, east positive").between(-180.0, 180.0));
  if (const auto f = map.find("height_m")) place.height_m = f->between(-500.0, 20000.0);
  place.time = time.text();
  const auto instant = parse_date_time(place.time);
  if (!instant) time.fail("a date and time with its offset such as 2026-06-21T12:00:00+02:00 (RFC 3339)");
  if (*instant < first_known_instant || *instant >= last_known_instant)
    time.fail("a date from 1900 to 2150, the years for which sun and moon are known");
  place.unix_s = *instant;
  return place;
}

void parse_sun(const Field& field, Environment& environment) {
  const FieldMap sun(field, {"azimuth_deg", "elevation_deg", "illuminance_lux"});
  for (const char* key : {"azimuth_deg", "elevation_deg"})
    if (const auto f = sun.find(key); f && environment.place)
      f->fail("nothing: place and time say where the sun is");
  if (const auto f = sun.find("azimuth_deg")) environment.sun_azimuth = radians(f->between(-360.0, 360.0));
  if (const auto f = sun.find("elevation_deg")) environment.sun_elevation = radians(f->between(-90.0, 90.0));
  if (const auto f = sun.find("illuminance_lux")) environment.sun_illuminance_lux = f->between(0.0, 1e6);
}

void parse_moon(const Field& field, Environment& environment) {
  const FieldMap map(field, {"azimuth_deg", "elevation_deg", "phase_angle_deg", "illuminance_lux"});
  if (environment.place) {
    for (const char* key : {"azimuth_deg", "elevation_deg", "phase_angle_deg"})
      if (const auto f = map.find(key)) f->fail("nothing: place and time say where the moon is");
    if (const auto f = map.find("illuminance_lux")) environment.moon_illuminance_lux = f->between(0.0, 1e3);
    return;
  }
  MoonConfig moon;
  moon.azimuth = radians(map.require("azimuth_deg", "degrees from x towards y").between(-360.0, 360.0));
  moon.elevation = radians(map.require("elevation_deg", "degrees above the horizon").between(-90.0, 90.0));
  if (const auto f = map.find("phase_angle_deg")) moon.phase_angle = radians(f->between(0.0, 180.0));
  if (const auto f = map.find("illuminance_lux")) moon.illuminance_lux = f->between(0.0, 1e3);
  environment.moon = moon;
}

}  // namespace

Environment parse_environment(const Field& field) {
  const FieldMap map(
      field, {"place", "time", "sun", "moon", "sky", "sky_illuminance_lux", "sky_glow_cd_m2", "turbidity",
              "temperature_k", "pressure_hpa", "water_vapour_g_m3", "rain_mm_h", "fog_g_m3", "fog_height_m"});
  Environment environment;
  if (const auto f = map.find("place"))
    environment.place = parse_place(*f, map.require("time", "a date and time beside place"));
  else if (const auto time = map.find("time"))
    time->fail("a place beside it: latitude_deg, longitude_deg");
  if (const auto f = map.find("sun")) parse_sun(*f, environment);
  if (const auto f = map.find("moon")) parse_moon(*f, environment);
  if (const auto f = map.find("sky"))
    environment.sky = std::array{SkyKind::automatic, SkyKind::clear,
                                 SkyKind::overcast}[f->choice({"auto", "clear", "overcast"})];
  if (const auto f = map.find("sky_illuminance_lux")) environment.sky_illuminance_lux = f->between(0.0, 1e6);
  if (const auto f = map.find("sky_glow_cd_m2")) environment.sky_glow_cd_m2 = f->between(0.0, 1.0);
  if (const auto f = map.find("turbidity")) environment.turbidity = f->between(1.1, 10.0);
  if (const auto f = map.find("temperature_k")) environment.temperature_k = f->between(150.0, 350.0);
  if (const auto f = map.find("pressure_hpa")) environment.pressure_hpa = f->between(0.0, 1200.0);
  if (const auto f = map.find("water_vapour_g_m3")) environment.water_vapour_g_m3 = f->between(0.0, 100.0);
  if (const auto f = map.find("rain_mm_h")) environment.rain_mm_h = f->between(0.0, 1000.0);
  if (const auto f = map.find("fog_g_m3")) environment.fog_g_m3 = f->between(0.0, 10.0);
  if (const auto f = map.find("fog_height_m")) environment.fog_height_m = f->between(0.0, 10000.0);
  return environment;
}

}  // namespace greatx::sim
