// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the Earth's magnetic field by IGRF-13 to degree 8.
#pragma once

#include "core/geodesy.h"

namespace greatx::navigation {

/// The years for which the model is kept. Outside of them the field is that of the nearer end.
inline constexpr double first_field_year = 2020.0, last_field_year = 2030.0;

/// Returns the field of the Earth's core, T, in the axes east, north, up of `place` at a year (2026.5).
///
/// The model is IGRF-13 (P. Alken et al., "International Geomagnetic Reference Field: the thirteenth
/// generation", Earth, Planets and Space 73 (2021), 49): its coefficients of 2020 and their secular variation
/// up to degree 8. Left out are degrees 9 to 13 (142 nT rms over the Earth's surface), the crust, whose
/// anomalies are beyond 13 (some hundred nT, locally more), currents in the ionosphere (some ten nT, storms
/// more), and changes of the secular variation after 2020.
dvec3 magnetic_field(const Geodetic& place, double year);

/// Returns the year with its fraction of an instant, seconds since 1970, with years of 365.2425 days.
double year_of(double unix_s);

}  // namespace greatx::navigation
