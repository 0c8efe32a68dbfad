// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/constellation.h"

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace greatx::navigation {

namespace {

constexpr double orbit_radius_m = 26559.7e3, orbit_inclination = radians(55.0);
/// The Earth's rate of rotation in the GPS interface, rad/s (IS-GPS-200, table 20-IV).
constexpr double gps_earth_rate = 7.2921151467e-5;
/// The defined epoch, 1993-07-01T00:00:00Z, and the Greenwich hour angle then, 18 h 36 min 14.4 s.
constexpr double orbit_epoch_unix_s = 741484800.0;
constexpr double epoch_hour_angle = radians(15.0 * (18.0 + 36.0 / 60.0 + 14.4 / 3600.0));

constexpr double plane_nodes_deg[6] = {272.847, 332.847, 32.847, 92.847, 152.847, 212.847};
constexpr double slot_latitudes_deg[6][4] = {
    {268.126, 161.786, 11.676, 41.806},  {80.956, 173.336, 309.976, 204.376},
    {111.876, 11.796, 339.666, 241.556}, {135.226, 265.446, 35.156, 167.356},
    {197.046, 302.596, 66.066, 333.686}, {238.886, 345.226, 105.206, 135.346}};

Satellite in_orbit(double node, double argument, double node_rate, double argument_rate) {
  const double ci = std::cos(orbit_inclination), si = std::sin(orbit_inclination);
  const double cn = std::cos(node), sn = std::sin(node), cu = std::cos(argument), su = std::sin(argument);
  Satellite satellite;
  satellite.position_m = orbit_radius_m * dvec3(cu * cn - su * ci * sn, cu * sn + su * ci * cn, su * si);
  const dvec3 by_argument = orbit_radius_m * dvec3(-su * cn - cu * ci * sn, -su * sn + cu * ci * cn, cu * si);
  const dvec3 by_node(-satellite.position_m.y, satellite.position_m.x, 0.0);
  satellite.velocity = argument_rate * by_argument + node_rate * by_node;
  return satellite;
}

}  // namespace

std::array<Satellite, satellite_count> nominal_constellation(double unix_s) {
  const double elapsed_s = unix_s - orbit_epoch_unix_s, mean_motion = 2.0 * gps_earth_rate;
  std::array<Satellite, satellite_count> satellites;
  for (size_t plane = 0; plane < 6; ++plane)
    for (size_t slot = 0; slot < 4; ++slot) {
      const double node = radians(plane_nodes_deg[plane]) - epoch_hour_angle - gps_earth_rate * elapsed_s;
      const double argument = radians(slot_latitudes_deg[plane][slot]) + mean_motion * elapsed_s;
      satellites[4 * plane + slot] = in_orbit(node, argument, -gps_earth_rate, mean_motion);
    }
  return satellites;
}

std::string slot_name(size_t satellite) {
  GREATX_CHECK(satellite < satellite_count, "satellite {}", satellite);
  return {static_cast<char>('A' + satellite / 4), static_cast<char>('1' + satellite % 4)};
}

}  // namespace greatx::navigation
