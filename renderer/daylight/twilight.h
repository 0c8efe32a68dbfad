// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Defines the light that a clear sky gives level ground by day, twilight and night, in lux. The source is P.
// Janiczek and J. DeYoung, "Computer Programs for Sun and Moon Illuminance with Contingent Tables and
// Diagrams", US Naval Observatory Circular 171 (1987). The cubics are those of P. K. Seidelmann (ed.),
// "Explanatory Supplement to the Astronomical Almanac" (1992). The measured levels behind it scatter by some
// 20 % by day and by a factor of two at night.
//
// Elevations are those without refraction.
#pragma once

namespace greatx::render {

/// Starlight and airglow on level ground: the rest that the circular leaves of twilight at -18 degrees.
inline constexpr double natural_night_lux = 6.46e-4;

/// Returns the light of sun and sky together, with the sun at its mean distance. The pieces of the cubics,
/// which miss one another by up to 1 %, are blended over half a degree. Below -18 degrees the light is
/// natural_night_lux.
double sunlight_lux(double elevation);

/// Returns the light of the moon's disc and of the sky that it lights, with the moon full and at its mean
/// distance: 0.27 lux at the zenith. It fades to nothing from -0.8 to -2 degrees.
double full_moonlight_lux(double elevation);

/// Returns the light on level ground of a night sky whose zenith has the given luminance: night_shape's
/// integral, 4/3 pi.
double night_sky_lux(double zenith_cd_m2);
/// Returns the luminance over the zenith's, by the sine of the elevation: 1 + 2 (1 - z)^2. Near the horizon
/// airglow is seen edge on, and cities stand there: two to four times the zenith's luminance (R. Garstang,
/// "Night-Sky Brightness at Observatories and Sites", PASP 101 (1989)).
double night_shape(double z);

/// Returns the share of the full moon's light: C. W. Allen, "Astrophysical Quantities", 3rd ed. (1973),
/// section 66. The loss is 0.026 |i| + 4e-9 i^4 magnitudes at phase angle i in degrees. The share is 0.09 at
/// the quarters.
double moon_phase_share(double phase_angle);

/// Returns the light under a closed cover of clouds. While the sun is above the horizon it is
/// 300 + 21000 sin(elevation), IES, "Recommended Practice for the Calculation of Daylight Availability",
/// RP-21 (1984), table 1. Below the horizon it is a fifth of the clear sky's. Between 0 and 2 degrees one
/// takes over from the other continuously.
double overcast_lux(double elevation);

}  // namespace greatx::render
