// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the radiance of sky and air as functions of direction, and the key light (docs/light.md). Colours
// are linear Rec. 709.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "core/vec.h"
#include "renderer/light/clouds.h"
#include "renderer/light/lighting.h"

namespace greatx::render {

/// Returns 0.2126 R + 0.7152 G + 0.0722 B (ITU-R BT.709).
double luminance(const dvec3& color);

/// The angular radii of the sun's and the moon's discs, rad, at their mean distances.
inline constexpr double sun_radius = 0.004652, moon_radius = 0.004520;

/// The colour that pictures show as white. It is that of a white card on the ground under a clear sky
/// (turbidity 2, albedo 0.15), with the sun 45 degrees high. Daylight thus looks neutral, evening warm and
/// shade blue.
inline constexpr dvec3 daylight_white{1.114954, 0.977658, 0.882823};

class Sky {
 public:
  /// `haze` says whether fog and rain count, and `clouds` whether clouds do.
  Sky(const Lighting& lighting, bool haze, bool clouds = false);
  /// Returns cd/m^2 per channel from a unit direction, z up, without discs and stars.
  dvec3 radiance(const dvec3& direction) const;
  /// Calls visit(direction, its radiance, solid angle) over a product rule of the sphere that has the horizon
  /// on a cell border.
  void over_sphere(const std::function<void(const dvec3& direction, const dvec3& radiance,
                                            double solid_angle)>& visit) const;
  /// These three compute the radiance above the horizon in parts, for finer maps: without clouds and haze,
  /// what an observer sees of the clouds (`shift`: Clouds::see), and the whole.
  dvec3 cloudless(const dvec3& direction) const;
  CloudView clouds(const dvec3& direction, float shift = 0.5f) const;
  dvec3 over_clouds(const dvec3& direction, const dvec3& cloudless, const CloudView& view) const;
  /// Returns the lux per channel of the key light on a surface that faces it, below fog and rain; zero
  /// without a key light.
  const dvec3& key_illuminance() const { return key_illuminance_; }
  /// Returns the lux of all other light on level ground, below fog and rain.
  double illuminance() const { return illuminance_; }
  /// The radiance of endless haze is `ambient` + `directed` (1 + g^2 - 2 g cos)^-1.5, with the cosine of the
  /// angle from the key light.
  const dvec3& haze_ambient() const { return haze_ambient_; }
  const dvec3& haze_directed() const { return haze_directed_; }

 private:
  /// Describes a clear sky lit by one body.
  struct Lit;
  /// Holds what the rule of over_sphere() sees above the horizon: all sums are over it.
  struct Dome {
    std::vector<dvec3> directions, unscaled;
    std::vector<CloudView> clouds;  ///< empty without clouds
  };
  /// These two are above the horizon and without haze, in any direction and in one of the dome's.
  dvec3 clear(const dvec3& direction) const;
  dvec3 clear(size_t dome_index) const;
  dvec3 unscaled(const dvec3& direction) const;  ///< cloudless() / scale_
  dvec3 scaled(const dvec3& unscaled) const;
  dvec3 with_clouds(const dvec3& cloudless, const CloudView& view) const;
  dvec3 through_haze(const dvec3& direction, const dvec3& clear) const;
  void add_clouds(const Lighting& lighting);
  void add_ground(const Lighting& lighting, const KeyLight& key);
  void add_haze(const Lighting& lighting, const KeyLight& key);
  dvec3 airlight(const dvec3& direction) const;
  double haze_share(double z) const;  ///< share of haze in a view above the horizon

  std::shared_ptr<const Lit> sun_, moon_;
  Dome dome_;
  SkyModel model_;
  dvec3 night_{0.0};  ///< zenith radiance of airglow and the glow of cities
  double scale_ = 1.0, illuminance_ = 0.0, depth_ = 0.0;
  dvec3 key_direction_{0.0, 0.0, 1.0}, key_illuminance_{0.0}, ground_{0.0};
  dvec3 haze_ambient_{0.0}, haze_directed_{0.0};
  std::shared_ptr<const Clouds> clouds_;
  dvec3 cloud_key_{0.0};      ///< radiance of a cloud in the key light (CloudView::direct 1)
  dvec3 cloud_ambient_{0.0};  ///< and in all other light
};

/// Returns the irradiance over pi in real spherical harmonics to order 2, with the basis' constants
/// multiplied in, in the order of light.glsl. Its luminance straight up is exactly the sky's illuminance over
/// pi. Without `ground`, nothing comes from below the horizon.
std::array<dvec3, 9> sky_irradiance(const Sky& sky, bool ground = true);

}  // namespace greatx::render
