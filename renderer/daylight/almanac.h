// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the places of sun and moon over a point of the Earth at an instant. The source is J. Meeus,
// "Astronomical Algorithms", 2nd edition (1998); its chapters are named beside the code that follows them.
// The code runs in fp64 on the host and needs no device.
//
// The accuracy from 1900 to 2150 is 0.01 degrees for the sun, and for the moon 10" in longitude and 4" in
// latitude (the bounds that Meeus states). The unmodelled UT1 - UTC adds at most 0.004 degrees of hour angle.
// After today, the drift of Delta T adds at most 0.001 degrees (sun) and 0.02 degrees (moon). Refraction is
// that of a standard air, which is wrong by more than 0.1 degrees near the horizon whenever the air is
// layered.
#pragma once

#include "core/vec.h"

namespace greatx::render {

/// Describes a point of the Earth's surface (WGS 84), and the air there, for refraction.
struct Observer {
  double latitude = 0.0, longitude = 0.0;  ///< rad, north and east positive
  double height_m = 0.0;
  double pressure_hpa = 1010.0, temperature_k = 283.15;
};

/// Describes a place as seen from the Earth's centre: the apparent place of the date.
struct GeocentricPlace {
  double longitude = 0.0, latitude = 0.0;           ///< ecliptic, rad; of the moon without nutation
  double right_ascension = 0.0, declination = 0.0;  ///< rad
  double distance_m = 0.0;
};

/// Describes a place as seen by an observer.
struct Sighting {
  double azimuth = 0.0;         ///< rad, from x (east) towards y (north), in (-pi, pi]
  double elevation = 0.0;       ///< rad above the horizon, lifted by refraction
  double true_elevation = 0.0;  ///< without refraction
  double distance_m = 0.0;      ///< from the observer
  double angular_radius = 0.0;  ///< rad
};

struct SunAndMoon {
  Sighting sun, moon;
  double moon_phase_angle = 0.0;  ///< sun - moon - Earth, rad: 0 full, pi new (ch. 48)
};

/// Returns TT - UT in seconds for a decimal year of 1900 to 2150, after F. Espenak and J. Meeus, "Five
/// Millennium Canon of Solar Eclipses", NASA/TP-2006-214141, section 2.7.
double delta_t(double year);

/// Returns the Julian day of UTC seconds since 1970-01-01.
double julian_day(double unix_s);

/// Return the geocentric places by ch. 25 (low accuracy) and ch. 47. `jde` is the Julian ephemeris day (TT).
GeocentricPlace sun_from_earth(double jde);
GeocentricPlace moon_from_earth(double jde);

/// Returns the phase angle by ch. 48, eq. 48.2 and 48.3.
double phase_angle(const GeocentricPlace& sun, const GeocentricPlace& moon);
/// Returns the illuminated share of the disc, eq. 48.1.
double illuminated_share(double phase_angle);

/// Returns how much refraction lifts a body, rad: G. Saemundsson (Meeus, eq. 16.4), for pressure and
/// temperature as I. Reda and A. Andreas, "Solar Position Algorithm for Solar Radiation Applications",
/// NREL/TP-560-34302 (2003), eq. 42. Below -5/6 degrees, where nothing is seen any more, it fades to 0 at -6
/// degrees.
double refraction(double true_elevation, double pressure_hpa, double temperature_k);

/// Returns the positions of sun and moon. `unix_s` is UTC seconds since 1970-01-01.
SunAndMoon sun_and_moon(double unix_s, const Observer& observer);

}  // namespace greatx::render
