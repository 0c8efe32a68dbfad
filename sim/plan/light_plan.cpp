// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/plan/light_plan.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "renderer/daylight/almanac.h"
#include "renderer/daylight/atmosphere.h"
#include "renderer/daylight/twilight.h"
#include "renderer/light/sky.h"

namespace greatx::sim {

namespace {

/// The share of the sky under clouds where the scenario gives none.
constexpr double fair_weather_clouds = 0.3;
constexpr double astronomical_unit_m = 149597870700.0, mean_moon_distance_m = 384400e3;

/// Describes the position of sun or moon and its light in clear air.
struct Lamp {
  double azimuth = 0.0, elevation = -0.5 * pi, true_elevation = -0.5 * pi;
  double level_lux = 0.0;   ///< on level ground, from the disc and the sky that it lights
  double direct_lux = 0.0;  ///< from the disc alone, on a surface that faces it
  double sky_lux() const { return level_lux - direct_lux * std::max(0.0, std::sin(true_elevation)); }
};

/// Splits level_lux into the light of the disc and of the sky, in the proportion of the model of the
/// atmosphere. Below an elevation of one degree the light of the disc decreases to 0 with the elevation.
void split(Lamp& lamp, const Environment& environment) {
  if (lamp.true_elevation <= 0.0 || lamp.level_lux <= 0.0) return;
  const double at_least = std::max(lamp.true_elevation, radians(1.0));
  const render::Atmosphere air(environment.turbidity, at_least, render::Lighting{}.ground_albedo);
  const double direct = render::luminance(air.direct_illuminance());
  const double level = direct * std::sin(at_least);
  const double share = direct / (level + render::luminance(air.sky_illuminance()));
  lamp.direct_lux = lamp.level_lux * share * std::min(1.0, lamp.true_elevation / at_least);
}

struct Bodies {
  Lamp sun, moon;
  double moon_phase_angle = 0.0;
};

Bodies bodies_of(const Environment& environment) {
  Bodies bodies;
  double sun_scale = 1.0, moon_scale = 1.0;
  if (const auto& place = environment.place) {
    const render::SunAndMoon seen =
        render::sun_and_moon(place->unix_s, {place->latitude, place->longitude, place->height_m,
                                             environment.pressure_hpa, environment.temperature_k});
    bodies.sun = {seen.sun.azimuth, seen.sun.elevation, seen.sun.true_elevation};
    bodies.moon = {seen.moon.azimuth, seen.moon.elevation, seen.moon.true_elevation};
    bodies.moon_phase_angle = seen.moon_phase_angle;
    sun_scale = std::pow(astronomical_unit_m / seen.sun.distance_m, 2.0);
    moon_scale = std::pow(mean_moon_distance_m / seen.moon.distance_m, 2.0);
  } else {
    bodies.sun = {environment.sun_azimuth, environment.sun_elevation, environment.sun_elevation};
    if (const auto& moon = environment.moon) {
      bodies.moon = {moon->azimuth, moon->elevation, moon->elevation};
      const double apart =
          std::acos(glm::clamp(glm::dot(render::Lighting::direction(bodies.sun.azimuth, bodies.sun.elevation),
                                        render::Lighting::direction(moon->azimuth, moon->elevation)),
                               -1.0, 1.0));
      bodies.moon_phase_angle = moon->phase_angle.value_or(pi - apart);
    }
  }
  // Far below the horizon the model gives starlight, which does not depend on the distance of the sun.
  bodies.sun.level_lux =
      render::natural_night_lux +
      sun_scale * (render::sunlight_lux(bodies.sun.true_elevation) - render::natural_night_lux);
  bodies.moon.level_lux = moon_scale * render::moon_phase_share(bodies.moon_phase_angle) *
                          render::full_moonlight_lux(bodies.moon.true_elevation);
  return bodies;
}

}  // namespace

double haze_extinction(const Environment& environment) {
  return render::fog_extinction(environment.fog_g_m3) + render::rain_extinction(environment.rain_mm_h);
}

double wetness_of(const Environment& environment) {
  return environment.wetness.value_or(1.0 - std::exp(-environment.rain_mm_h));
}

double puddles_of(const Environment& environment) {
  constexpr double share_of_soaked_ground = 0.2;
  const double wetness = wetness_of(environment);
  return environment.puddles.value_or(share_of_soaked_ground * wetness * wetness);
}

ResolvedLight light_of_room(const Indoors& indoors) {
  ResolvedLight light;
  light.lighting.sun_illuminance_lux = light.lighting.moon_illuminance_lux = 0.0;
  light.lighting.sky_model = render::SkyModel::uniform;
  light.lighting.sky_illuminance_lux = light.below.sky_lux = indoors.indirect_lux;
  light.below.direct_lux = 0.0;
  light.sun_elevation = light.moon_elevation = -0.5 * pi;
  return light;
}

ResolvedLight resolve(const Environment& environment, const std::optional<Indoors>& indoors) {
  if (indoors) return light_of_room(*indoors);
  Bodies bodies = bodies_of(environment);
  Lamp &sun = bodies.sun, &moon = bodies.moon;
  const bool overcast = environment.sky == SkyKind::overcast ||
                        (environment.sky == SkyKind::automatic && environment.rain_mm_h > 0.0 &&
                         !environment.sun_illuminance_lux);
  const bool by_hand = !environment.place && sun.elevation > 0.0;
  if (!by_hand && !overcast) split(sun, environment);
  if (!overcast) split(moon, environment);

  ResolvedLight light;
  render::Lighting& to = light.lighting;
  to.sun_direction = render::Lighting::direction(sun.azimuth, sun.elevation);
  to.moon_direction = render::Lighting::direction(moon.azimuth, moon.elevation);
  to.moon_phase_angle = bodies.moon_phase_angle;
  to.turbidity = environment.turbidity;
  to.sky_glow_cd_m2 = environment.sky_glow_cd_m2;
  to.clouds = overcast ? 0.0 : environment.clouds.value_or(fair_weather_clouds);
  to.horizon = std::array{render::HorizonKind::automatic, render::HorizonKind::none,
                          render::HorizonKind::plain, render::HorizonKind::city,
                          render::HorizonKind::country}[static_cast<size_t>(environment.horizon)];
  to.sky_model = overcast ? render::SkyModel::overcast : render::SkyModel::clear;

  const double default_sun = overcast ? 0.0 : by_hand ? 100000.0 : sun.direct_lux;
  to.sun_illuminance_lux = environment.sun_illuminance_lux.value_or(default_sun);
  const auto given_moon =
      environment.moon ? environment.moon->illuminance_lux : environment.moon_illuminance_lux;
  to.moon_illuminance_lux = given_moon.value_or(overcast ? 0.0 : moon.direct_lux);
  const double glow = render::night_sky_lux(environment.sky_glow_cd_m2);
  const double modelled = overcast ? render::overcast_lux(sun.true_elevation) + 0.2 * moon.level_lux + glow
                                   : sun.sky_lux() + moon.sky_lux() + glow;
  to.sky_illuminance_lux =
      environment.sky_illuminance_lux.value_or(by_hand && !overcast ? 15000.0 : modelled);
  to.haze_extinction_per_m = haze_extinction(environment);
  to.haze_depth = to.haze_extinction_per_m * environment.fog_height_m;

  to.rain_mm_h = environment.rain_mm_h;
  to.wetness = wetness_of(environment);
  to.puddles = puddles_of(environment);
  to.snow = environment.snow;

  light.haze = to.haze_extinction_per_m > 0.0;
  light.rain = to.rain_mm_h > 0.0;
  light.water = to.wetness > 0.0 || to.puddles > 0.0;
  light.snow = to.snow > 0.0;
  light.key = render::key_light(to);
  light.below = render::through_layer(light.key.lux, light.key.direction.z, to.sky_illuminance_lux,
                                      to.haze_depth, to.ground_albedo);
  light.sun_elevation = sun.elevation;
  light.moon_elevation = moon.elevation;
  light.night_sky =
      !overcast && (sun.elevation < radians(-6.0) || (moon.elevation > 0.0 && to.moon_illuminance_lux > 0.0));
  return light;
}

}  // namespace greatx::sim
