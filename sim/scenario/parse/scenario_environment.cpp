// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses environment: sun, moon and sky, the air, rain and fog.
#include <cmath>

#include "core/units.h"
#include "sim/scenario/date_time.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {

namespace {

/// The bounds of the height of a place above the sea.
constexpr double least_place_height_m = -500.0, most_place_height_m = 20000.0;

/// Returns the georeference's origin as a place, with its height above the vertical datum.
PlaceAndTime place_of_scene(const Georeference& scene, const Field& time) {
  PlaceAndTime place;
  place.latitude = radians(scene.origin.latitude_deg);
  place.longitude = radians(scene.origin.longitude_deg);
  place.height_m = scene.origin.height_m - scene.undulation_m;
  place.of_scene = true;
  if (!(place.height_m >= least_place_height_m && place.height_m <= most_place_height_m))
    time.fail(fmt::format("a place beside it, since the scene's origin is not between {:g} m and {:g} m high",
                          least_place_height_m, most_place_height_m),
              fmt::format("a height of {} m", place.height_m));
  return place;
}

/// Warns if sun and sky would be those of another place than the scene's.
void compare_places(const Field& field, const PlaceAndTime& place, const Georeference& scene,
                    std::vector<std::string>& warnings) {
  constexpr double most_deg = 1.0;
  const double latitude_deg = degrees(place.latitude), longitude_deg = degrees(place.longitude);
  const double apart = std::hypot(
      latitude_deg - scene.origin.latitude_deg,
      std::cos(place.latitude) * std::remainder(longitude_deg - scene.origin.longitude_deg, 360.0));
  if (apart > most_deg)
    warnings.push_back(
        fmt::format("{}:{}: {}: the sun and the sky are those of latitude {:.6g}, longitude {:.6g}, but the "
                    "scene's georeference is {:.3g} degrees away at latitude {:.6g}, longitude {:.6g}",
                    field.where().file, field.where().line, field.path(), latitude_deg, longitude_deg, apart,
                    scene.origin.latitude_deg, scene.origin.longitude_deg));
}

PlaceAndTime parse_place(const Field& field) {
  const FieldMap map(field, {"latitude_deg", "longitude_deg", "height_m"});
  PlaceAndTime place;
  place.latitude = radians(map.require("latitude_deg", "degrees, north positive").between(-90.0, 90.0));
  place.longitude = radians(map.require("longitude_deg", "degrees, east positive").between(-180.0, 180.0));
  if (const auto f = map.find("height_m"))
    place.height_m = f->between(least_place_height_m, most_place_height_m);
  return place;
}

/// Sets the time of a place.
void parse_time_of(PlaceAndTime& place, const Field& time) {
  place.time = time.text();
  const auto instant = parse_date_time(place.time);
  if (!instant) time.fail("a date and time with its offset such as 2026-06-21T12:00:00+02:00 (RFC 3339)");
  if (*instant < first_known_instant || *instant >= last_known_instant)
    time.fail("a date from 1900 to 2150, the years for which sun and moon are known");
  place.unix_s = *instant;
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

Environment parse_environment(const Field& field, const std::optional<Georeference>& scene,
                              std::vector<std::string>& warnings) {
  const FieldMap map(
      field, {"place", "time", "sun", "moon", "sky", "sky_illuminance_lux", "sky_glow_cd_m2", "turbidity",
              "clouds", "horizon", "temperature_k", "pressure_hpa", "water_vapour_g_m3", "rain_mm_h",
              "fog_g_m3", "fog_height_m", "wetness", "puddles", "snow"});
  Environment environment;
  const auto time = map.find("time");
  if (const auto f = map.find("place")) {
    environment.place = parse_place(*f);
    parse_time_of(*environment.place, map.require("time", "a date and time beside place"));
    if (scene) compare_places(*f, *environment.place, *scene, warnings);
  } else if (time && scene) {
    environment.place = place_of_scene(*scene, *time);
    parse_time_of(*environment.place, *time);
  } else if (time) {
    time->fail("a place beside it (latitude_deg, longitude_deg) or a scene with a georeference");
  }
  if (const auto f = map.find("sun")) parse_sun(*f, environment);
  if (const auto f = map.find("moon")) parse_moon(*f, environment);
  if (const auto f = map.find("sky"))
    environment.sky = std::array{SkyKind::automatic, SkyKind::clear,
                                 SkyKind::overcast}[f->choice({"auto", "clear", "overcast"})];
  if (const auto f = map.find("sky_illuminance_lux")) environment.sky_illuminance_lux = f->between(0.0, 1e6);
  if (const auto f = map.find("sky_glow_cd_m2")) environment.sky_glow_cd_m2 = f->between(0.0, 1.0);
  if (const auto f = map.find("turbidity")) environment.turbidity = f->between(1.1, 10.0);
  if (const auto f = map.find("clouds")) environment.clouds = f->between(0.0, 1.0);
  if (const auto f = map.find("horizon"))
    environment.horizon =
        std::array{Horizon::automatic, Horizon::none, Horizon::plain, Horizon::city,
                   Horizon::country}[f->choice({"auto", "none", "plain", "city", "country"})];
  if (const auto f = map.find("temperature_k")) environment.temperature_k = f->between(150.0, 350.0);
  if (const auto f = map.find("pressure_hpa")) environment.pressure_hpa = f->between(0.0, 1200.0);
  if (const auto f = map.find("water_vapour_g_m3")) environment.water_vapour_g_m3 = f->between(0.0, 100.0);
  if (const auto f = map.find("rain_mm_h")) environment.rain_mm_h = f->between(0.0, 1000.0);
  if (const auto f = map.find("fog_g_m3")) environment.fog_g_m3 = f->between(0.0, 10.0);
  if (const auto f = map.find("fog_height_m")) environment.fog_height_m = f->between(0.0, 10000.0);
  if (const auto f = map.find("wetness")) environment.wetness = f->between(0.0, 1.0);
  if (const auto f = map.find("puddles")) environment.puddles = f->between(0.0, 1.0);
  if (const auto f = map.find("snow")) environment.snow = f->between(0.0, 1.0);
  return environment;
}

}  // namespace greatx::sim
