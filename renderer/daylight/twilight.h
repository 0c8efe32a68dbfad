// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How much light a clear sky gives level ground by day, twilight and night: lux. P. Janiczek and J. DeYoung, "Computer
// Programs for Sun and Moon Illuminance with Contingent Tables and Diagrams", US Naval Observatory Circular 171 (1987);
// the cubics as in P. K. Seidelmann (ed.), "Explanatory Supplement to the Astronomical Almanac" (1992). Measured levels
// behind it scatter by some 20 % by day and by a factor of two at night.
//
// Elevations are those without refraction.
#pragma once

namespace greatx::render {

/// Starlight and airglow on level ground: what the circular leaves of twilight at -18 degrees.
inline constexpr double natural_night_lux = 6.46e-4;

/// Sun and sky together, the sun at its mean distance. The cubics' pieces, which miss one another by up to 1 %, are
/// blended over half a degree. Below -18 degrees: natural_night_lux.
double sunlight_lux(double elevation);

/// The moon's disc and the sky that it lights together, full and at its mean distance: 0.27 lux at the zenith. Fades to
/// nothing from -0.8 to -2 degrees.
double full_moonlight_lux(double elevation);

/// Of a night sky whose zenith has the given luminance, on level ground: night_shape's integral, 4/3 pi.
double night_sky_lux(double zenith_cd_m2);
/// Luminance over the zenith's, by the sine of the elevation: 1 + 2 (1 - z)^2. Airglow is seen edge on near the horizon,
/// and cities stand there: two to four times the zenith's (R. Garstang, "Night-Sky Brightness at Observatories and
/// Sites", PASP 101 (1989)).
double night_shape(double z);

/// Share of the full moon's light: C. W. Allen, "Astrophysical Quantities", 3rd ed. (1973), section 66:
/// 0.026 |i| + 4e-9 i^4 magnitudes at phase angle i in degrees. 0.09 at the quarters.
double moon_phase_share(double phase_angle);

/// Under a closed cover of clouds while the sun is above the horizon: 300 + 21000 sin(elevation), IES, "Recommended
/// Practice for the Calculation of Daylight Availability", RP-21 (1984), table 1. Below, a fifth of the clear sky's, from
/// which it takes over continuously between 0 and 2 degrees.
double overcast_lux(double elevation);

}  // namespace greatx::render
