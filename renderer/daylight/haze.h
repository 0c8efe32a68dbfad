// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the extinction of light by fog and rain: 1/m, one way. The same liquid water and rain rate
// attenuate radio.
//
// Drops are tens (fog) to thousands (rain) of times larger than the wavelength. Their extinction is therefore
// twice their cross section whatever the wavelength (H. C. van de Hulst, "Light Scattering by Small
// Particles", 1957, ch. 8): one figure serves eyes, 905 nm and 1550 nm. For the small drops of a haze (below
// 1 um) it would not.
#pragma once

namespace greatx::render {

/// Returns 144.7 M^0.88 per km for M g/m^3 of liquid water: B. A. Kunkel, "Parameterization of Droplet
/// Terminal Velocity and Extinction Coefficient in Fog Models", J. Climate Appl. Meteor. 23 (1984), pp.
/// 34-41, with a visibility of 0.027 M^-0.88 km at a contrast of 2 %.
double fog_extinction(double liquid_water_g_m3);

/// Returns 1.076 R^0.67 dB/km for R mm/h: ITU-R P.1814 (2007), eq. 9 and table 3, after T. H. Carbonneau and
/// D. R. Wisely (1998).
double rain_extinction(double rain_mm_h);

/// Returns the distance at which a black target's contrast against the horizon is 2 %: 3.912 / extinction (H.
/// Koschmieder, 1924).
double visibility_m(double extinction_per_m);

/// The mean cosine of the angle by which the drops scatter visible light (fog: 0.80 to 0.87).
inline constexpr double haze_asymmetry = 0.85;

/// Describes the light from above after a layer of drops that absorb nothing.
struct LayerLight {
  double direct_lux;  ///< on a surface that faces the light
  double sky_lux;     ///< on level ground, all other light
};
/// Returns the light below a layer of fog and rain. `direct_lux` comes from an elevation with the given sine
/// (0 or less: not at all), and `sky_lux` comes from the sky, on level ground. The layer has the vertical
/// optical depth `depth` and stands on ground of the given albedo. Direct light falls as exp(-depth / sine).
/// All light together follows the two-stream approximation, T = 1 / (1 + (1 - g) depth / 2) (C. F. Bohren,
/// "Multiple Scattering of Light and Some of Its Observable Consequences", Am. J. Phys. 55 (1987), eq. 9),
/// and T / (1 - albedo (1 - T)) with the ground's reflections. The only loss is the light that goes back up.
LayerLight through_layer(double direct_lux, double sine, double sky_lux, double depth, double ground_albedo);

}  // namespace greatx::render
