// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/light/sky.h"

#include <cmath>

#include "core/units.h"
#include "renderer/daylight/atmosphere.h"
#include "renderer/daylight/haze.h"
#include "renderer/daylight/twilight.h"

namespace greatx::render {

namespace {

/// The rule of Sky::over_sphere(). Its steps of z are equal, so every cell has the same solid angle.
constexpr int rings = 96, sectors = 128;
constexpr double cell_solid_angle = 4.0 * pi / (rings * sectors);

/// Calls visit(direction) for the rings from `first` to `last`, from the zenith downwards.
template <typename F>
void over_rings(int first, int last, F&& visit) {
  for (int i = first; i < last; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / rings, r = std::sqrt(1.0 - z * z);
    for (int k = 0; k < sectors; ++k) {
      const double phi = 2.0 * pi * (k + 0.5) / sectors;
      visit(dvec3(r * std::cos(phi), r * std::sin(phi), z));
    }
  }
}

/// From this sine of depression on, nothing is left of the sky in the ground's colour.
constexpr double all_ground = 0.2;

dvec2 heading_of(const dvec3& direction) {
  const dvec2 level(direction);
  return glm::length(level) > 1e-9 ? glm::normalize(level) : dvec2(1.0, 0.0);
}

double elevation_of(const dvec3& direction) { return std::asin(glm::clamp(direction.z, -1.0, 1.0)); }

dvec3 of_luminance(const dvec3& color, double value) { return color * (value / luminance(color)); }

/// The CIE standard overcast sky (P. Moon and D. Spencer, 1942). Its illuminance is 7/9 pi times the zenith's
/// luminance.
double overcast_shape(double z) { return (1.0 + 2.0 * z) / 3.0; }
constexpr double overcast_shape_lux = 7.0 / 9.0 * pi;

/// Lunar soil is redder than sunlight: B - V 0.92 against 0.65 (Allen's Astrophysical Quantities, 4th ed.,
/// 2000). It thus has 0.78 of the sun's blue for the same green. The red follows from the same slope.
constexpr dvec3 moon_tint{1.14, 1.0, 0.78};
const dvec3 airglow{1.0, 1.0, 0.85}, city_glow{1.35, 0.95, 0.45};

}  // namespace

double luminance(const dvec3& color) { return glm::dot(color, dvec3(0.2126, 0.7152, 0.0722)); }

KeyLight key_light(const Lighting& lighting) {
  if (lighting.sun_direction.z > 0.0 && lighting.sun_illuminance_lux > 0.0)
    return {lighting.sun_direction, lighting.sun_illuminance_lux, KeyLight::Body::sun};
  if (lighting.moon_direction.z > 0.0 && lighting.moon_illuminance_lux > 0.0)
    return {lighting.moon_direction, lighting.moon_illuminance_lux, KeyLight::Body::moon};
  return {lighting.sun_direction, 0.0, KeyLight::Body::none};
}

struct Sky::Lit {
  Lit(const Lighting& lighting, const dvec3& to_light, const dvec3& tint_)
      : air(lighting.turbidity, elevation_of(to_light), lighting.ground_albedo),
        heading(heading_of(to_light)),
        tint(tint_ / daylight_white) {}
  Atmosphere air;
  dvec2 heading;
  dvec3 tint;
  double scale = 0.0;  ///< illuminance of the body above the air that gives its share of the sky
  dvec3 radiance(const dvec3& d) const {
    const dvec3 turned(d.x * heading.x + d.y * heading.y, d.y * heading.x - d.x * heading.y, d.z);
    return scale * tint * air.radiance(turned);
  }
  double sky_lux() const { return luminance(air.sky_illuminance() * tint); }
};

Sky::Sky(const Lighting& lighting, bool haze, bool clouds)
    : model_(lighting.sky_model), illuminance_(lighting.sky_illuminance_lux) {
  const KeyLight key = key_light(lighting);
  key_direction_ = key.direction;
  dvec3 key_color(1.0);
  if (model_ == SkyModel::clear) {
    const double elevation = elevation_of(lighting.sun_direction);
    const bool day = elevation > radians(2.0);
    double total = 0.0;
    if (elevation > radians(-18.0)) {
      auto sun = std::make_shared<Lit>(lighting, lighting.sun_direction, dvec3(1.0));
      const double lux = std::max(sunlight_lux(elevation) - natural_night_lux, 1e-9);
      sun->scale = lux / sun->sky_lux();
      total += lux;
      if (key.body == KeyLight::Body::sun) key_color = sun->air.direct_illuminance() * sun->tint;
      sun_ = std::move(sun);
    }
    if (!day && lighting.moon_direction.z > 0.0 && lighting.moon_illuminance_lux > 0.0) {
      auto moon = std::make_shared<Lit>(lighting, lighting.moon_direction, moon_tint);
      const dvec3 direct = moon->air.direct_illuminance() * moon->tint;
      moon->scale = lighting.moon_illuminance_lux / luminance(direct);
      total += moon->scale * moon->sky_lux();
      if (key.body == KeyLight::Body::moon) key_color = direct;
      moon_ = std::move(moon);
    }
    if (!day) {
      night_ = of_luminance(airglow, natural_night_lux / night_sky_lux(1.0)) +
               of_luminance(city_glow, 1.0) * lighting.sky_glow_cd_m2;
      total += night_sky_lux(luminance(night_));
    }
    scale_ = illuminance_ / total;
  } else if (model_ == SkyModel::overcast) {
    scale_ = illuminance_ / overcast_shape_lux;
  }
  if (key.lux > 0.0) key_illuminance_ = of_luminance(key_color, key.lux);
  over_rings(0, rings / 2, [&](const dvec3& d) {
    dome_.directions.push_back(d);
    dome_.unscaled.push_back(unscaled(d));
  });
  add_ground(lighting, key);
  if (clouds && model_ != SkyModel::uniform) {
    add_clouds(lighting);
    add_ground(lighting, key);
  }
  if (haze) add_haze(lighting, key);
}

void Sky::add_ground(const Lighting& lighting, const KeyLight& key) {
  if (model_ == SkyModel::uniform) {
    ground_ = dvec3(illuminance_ / pi);
    return;
  }
  dvec3 on_ground = key_illuminance_ * std::max(key.direction.z, 0.0);
  for (size_t i = 0; i < dome_.directions.size(); ++i)
    on_ground += clear(i) * (dome_.directions[i].z * cell_solid_angle);
  ground_ = lighting.ground_albedo / pi * on_ground;
}

void Sky::add_clouds(const Lighting& lighting) {
  // Most of the light that a thick cloud takes comes back out of it: nine tenths of the direct light on the
  // side of the key light, and four fifths of what comes from everywhere.
  constexpr double direct_share = 0.9, ambient_share = 0.8;
  // Lit from below, clouds are brighter than the glow of a city in clear air (C. Kyba et al., "Red is the new
  // black", MNRAS 425 (2012): threefold and more).
  constexpr double glow_share = 3.0;
  dvec3 level(0.0);
  for (size_t i = 0; i < dome_.directions.size(); ++i)
    level += clear(i) * (dome_.directions[i].z * cell_solid_angle);
  cloud_key_ = direct_share / pi * key_illuminance_;
  cloud_ambient_ = ambient_share * (level / pi + ground_) +
                   (model_ == SkyModel::clear
                        ? of_luminance(city_glow, 1.0) * (lighting.sky_glow_cd_m2 * glow_share * scale_)
                        : dvec3(0.0));
  const double elevation = elevation_of(lighting.sun_direction);
  if (sun_ && elevation < 0.0) {
    // After sunset the sun still shines on the clouds for a while.
    const double left = glm::smoothstep(radians(-4.5), 0.0, elevation);
    cloud_key_ +=
        direct_share / pi * scale_ * left * sun_->scale * sun_->air.direct_illuminance() * sun_->tint;
  }
  clouds_ = std::make_shared<Clouds>(model_ == SkyModel::clear ? lighting.clouds : 0.0, lighting.cloud_seed,
                                     sun_ && elevation < 0.0 ? lighting.sun_direction : key_direction_);
  for (const dvec3& direction : dome_.directions) dome_.clouds.push_back(this->clouds(direction));
  // The sky's illuminance stays what it is, whatever the clouds add to it.
  double sum = 0.0;
  for (size_t i = 0; i < dome_.directions.size(); ++i)
    sum += luminance(clear(i)) * dome_.directions[i].z * cell_solid_angle;
  if (sum <= 0.0) return;
  scale_ *= illuminance_ / sum;
  cloud_key_ *= illuminance_ / sum;
  cloud_ambient_ *= illuminance_ / sum;
}

CloudView Sky::clouds(const dvec3& direction, float shift) const {
  if (!clouds_) return {};
  if (model_ == SkyModel::clear) return clouds_->see(vec3(direction), shift);
  // A closed cover lets nothing pass; its own brightness stands for `direct`.
  CloudView closed;
  closed.passed = 0.0f;
  closed.direct = clouds_->closed(vec3(direction));
  return closed;
}

dvec3 Sky::with_clouds(const dvec3& cloudless, const CloudView& view) const {
  if (!clouds_) return cloudless;
  if (model_ != SkyModel::clear) return cloudless * double(view.direct);
  const double own = double(view.air), behind = 1.0 - double(view.passed);
  return cloudless * (double(view.passed) + behind * (1.0 - own)) +
         own * (cloud_key_ * double(view.direct) + cloud_ambient_ * double(view.ambient));
}

dvec3 Sky::over_clouds(const dvec3& direction, const dvec3& cloudless, const CloudView& view) const {
  const double share = haze_share(direction.z);
  const dvec3 clear = with_clouds(cloudless, view);
  return share > 0.0 ? clear * (1.0 - share) + airlight(direction) * share : clear;
}

dvec3 Sky::clear(const dvec3& d) const { return with_clouds(cloudless(d), clouds(d)); }

dvec3 Sky::clear(size_t i) const {
  const dvec3 cloudless = scaled(dome_.unscaled[i]);
  return dome_.clouds.empty() ? cloudless : with_clouds(cloudless, dome_.clouds[i]);
}

dvec3 Sky::cloudless(const dvec3& d) const { return scaled(unscaled(d)); }

dvec3 Sky::scaled(const dvec3& unscaled) const {
  return model_ == SkyModel::uniform ? dvec3(illuminance_ / pi) : scale_ * unscaled;
}

dvec3 Sky::unscaled(const dvec3& d) const {
  if (model_ == SkyModel::uniform) return dvec3(1.0);
  if (model_ == SkyModel::overcast) return dvec3(overcast_shape(d.z));
  dvec3 sum = night_ * night_shape(d.z);
  if (sun_) sum += sun_->radiance(d);
  if (moon_) sum += moon_->radiance(d);
  return sum;
}

double Sky::haze_share(double z) const {
  return depth_ > 0.0 ? 1.0 - std::exp(-depth_ / std::max(z, 1e-9)) : 0.0;
}

dvec3 Sky::airlight(const dvec3& direction) const {
  const double g = haze_asymmetry, base = 1.0 + g * g - 2.0 * g * glm::dot(direction, key_direction_);
  return haze_ambient_ + haze_directed_ / (base * std::sqrt(base));
}

void Sky::add_haze(const Lighting& lighting, const KeyLight& key) {
  // The air scatters the light that comes to it from everywhere: the mean over the sphere, and the key light
  // by its phase function (Henyey and Greenstein 1941). The whole is scaled so that level ground gets the
  // light that the layer lets through.
  const bool uniform = model_ == SkyModel::uniform;
  const double clear_lux = illuminance_;
  const LayerLight below = through_layer(key.lux, key.direction.z, clear_lux, lighting.haze_depth,
                                         uniform ? 1.0 : lighting.ground_albedo);
  const dvec3 key_color = key.lux > 0.0 ? key_illuminance_ / key.lux : dvec3(0.0);
  key_illuminance_ = key_color * below.direct_lux;
  depth_ = lighting.haze_depth;
  dvec3 mean(0.0), on_ground(0.0);
  for (size_t i = 0; i < dome_.directions.size(); ++i) {
    const dvec3 above = clear(i);
    mean += above * (cell_solid_angle / (4.0 * pi));
    on_ground += above * (dome_.directions[i].z * cell_solid_angle);
  }
  for (size_t i = 0; i < dome_.directions.size(); ++i) mean += ground_ * (cell_solid_angle / (4.0 * pi));
  // Light scattered many times has the colour of all light that came in, less the part that goes straight
  // through.
  if (key.lux > 0.0) on_ground += key_color * (std::max(key.direction.z, 0.0) * (key.lux - below.direct_lux));
  haze_ambient_ = luminance(on_ground) > 0.0 ? of_luminance(on_ground, luminance(mean)) : dvec3(0.0);
  haze_directed_ = key_illuminance_ * ((1.0 - haze_asymmetry * haze_asymmetry) / (4.0 * pi));
  if (depth_ <= 0.0) return;
  double kept = 0.0, added = 0.0;
  for (size_t i = 0; i < dome_.directions.size(); ++i) {
    const dvec3& d = dome_.directions[i];
    const double share = haze_share(d.z);
    kept += luminance(clear(i)) * (1.0 - share) * d.z * cell_solid_angle;
    added += luminance(airlight(d)) * share * d.z * cell_solid_angle;
  }
  const double scale = (below.sky_lux - kept) / added;
  haze_ambient_ *= scale;
  haze_directed_ *= scale;
  illuminance_ = below.sky_lux;
  if (!uniform)
    ground_ *= (below.direct_lux * key.direction.z + below.sky_lux) /
               (key.lux * std::max(key.direction.z, 0.0) + clear_lux);
}

dvec3 Sky::through_haze(const dvec3& d, const dvec3& clear) const {
  dvec3 sky(0.0);
  const double share = haze_share(d.z);
  if (share < 1.0) sky += clear * (1.0 - share);
  if (share > 0.0) sky += airlight(d) * share;
  return sky;
}

dvec3 Sky::radiance(const dvec3& direction) const {
  if (direction.z > 0.0) return through_haze(direction, clear(direction));
  if (-direction.z >= all_ground) return ground_;
  // Haze lies over the horizon: the sky's lowest ring fades into the ground over twelve degrees.
  const double level = std::hypot(direction.x, direction.y);
  const dvec3 d = level > 1e-6 ? dvec3(direction.x / level, direction.y / level, 0.0) : dvec3(1, 0, 0);
  return glm::mix(through_haze(d, clear(d)), ground_, glm::smoothstep(0.0, all_ground, -direction.z));
}

void Sky::over_sphere(const std::function<void(const dvec3&, const dvec3&, double)>& visit) const {
  for (size_t i = 0; i < dome_.directions.size(); ++i)
    visit(dome_.directions[i], through_haze(dome_.directions[i], clear(i)), cell_solid_angle);
  over_rings(rings / 2, rings, [&](const dvec3& d) { visit(d, radiance(d), cell_solid_angle); });
}

std::array<dvec3, 9> sky_irradiance(const Sky& sky, bool ground) {
  // The factors are Y_lm without their polynomials, and the cosine lobe's A_l / pi = 1, 2/3, 1/4 (Ramamoorthi
  // and Hanrahan, "An Efficient Representation for Irradiance Environment Maps", SIGGRAPH 2001, eq. 3 and 9).
  constexpr double y[9] = {0.282095, 0.488603, 0.488603, 0.488603, 1.092548,
                           1.092548, 0.315392, 1.092548, 0.546274};
  constexpr double lobe[9] = {1.0, 2.0 / 3, 2.0 / 3, 2.0 / 3, 0.25, 0.25, 0.25, 0.25, 0.25};
  const auto polynomial = [](int i, const dvec3& n) {
    switch (i) {
      case 0:
        return 1.0;
      case 1:
        return n.y;
      case 2:
        return n.z;
      case 3:
        return n.x;
      case 4:
        return n.x * n.y;
      case 5:
        return n.y * n.z;
      case 6:
        return 3.0 * n.z * n.z - 1.0;
      case 7:
        return n.x * n.z;
      default:
        return n.x * n.x - n.y * n.y;
    }
  };
  std::array<dvec3, 9> result{};
  sky.over_sphere([&](const dvec3& d, const dvec3& radiance, double solid_angle) {
    if (!ground && d.z <= 0.0) return;
    const dvec3 weighted = radiance * solid_angle;
    for (int i = 0; i < 9; ++i) result[i] += weighted * polynomial(i, d);
  });
  double upwards = 0.0;
  for (int i = 0; i < 9; ++i) {
    result[i] *= y[i] * y[i] * lobe[i];
    upwards += luminance(result[i]) * polynomial(i, dvec3(0, 0, 1));
  }
  // Order 2 is a few per cent off, but level ground shall be exact.
  if (upwards > 0.0)
    for (dvec3& coefficient : result) coefficient *= sky.illuminance() / pi / upwards;
  return result;
}

}  // namespace greatx::render
