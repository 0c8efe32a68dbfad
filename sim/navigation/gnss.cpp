// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/gnss.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/units.h"

namespace greatx::navigation {

namespace {

/// Returns the turn from Earth-centred axes to those of the frame: rows east, north, up.
dmat3 axes_of(const Geodetic& origin) {
  const double latitude = radians(origin.latitude_deg), longitude = radians(origin.longitude_deg);
  const double sp = std::sin(latitude), cp = std::cos(latitude);
  const double sl = std::sin(longitude), cl = std::cos(longitude);
  return {dvec3(-sl, -sp * cl, cp * cl), dvec3(cl, -sp * sl, cp * sl), dvec3(0.0, cp, sp)};
}

/// Below a degree it is that of a degree, since no model is made for less.
double code_factor(double elevation) {
  const double s = std::max(std::sin(elevation), std::sin(radians(1.0)));
  return std::sqrt(1.0 + 1.0 / (s * s));
}

double multipath_std(double elevation) { return 0.13 + 0.53 * std::exp(-degrees(elevation) / 10.0); }

}  // namespace

double ionosphere_obliquity(double elevation) {
  const double left = 0.53 - elevation / pi;
  return 1.0 + 16.0 * left * left * left;
}

double troposphere_mapping(double elevation) {
  const double s = std::sin(elevation);
  return 1.001 / std::sqrt(0.002001 + s * s);
}

SignalPath reflected_path(const dvec3& to_satellite, const dvec3& normal, double distance_m,
                          const dvec3& velocity) {
  const double facing = glm::dot(normal, to_satellite);
  return {SignalPath::State::reflected, 2.0 * distance_m * facing, 2.0 * glm::dot(normal, velocity) * facing};
}

Gnss::Gnss(const GnssReceiver& receiver, const LocalFrame& frame, uint64_t seed, const std::string& name,
           uint32_t sequence, double step_s)
    : receiver_(receiver),
      frame_(frame),
      local_from_earth_(axes_of(frame.reference().origin)),
      code_(StreamKey(seed, fmt::format("{}/code", name), sequence)),
      doppler_(StreamKey(seed, fmt::format("{}/doppler", name), sequence)) {
  const GnssErrors& e = receiver.errors;
  for (size_t i = 0; i < satellite_count; ++i) {
    const auto process = [&](const char* what, double time_s) {
      return GaussMarkov(StreamKey(seed, fmt::format("{}/{}.{}", name, what, slot_name(i)), sequence), 1.0,
                         time_s, step_s);
    };
    processes_.push_back({process("orbit", e.orbit_time_s), process("ionosphere", e.ionosphere_time_s),
                          process("troposphere", e.troposphere_time_s),
                          process("multipath", e.multipath_time_s)});
  }
}

/// Adds the errors of one satellite, and tells the receiver their standard deviations, but not whether the
/// signal came by a reflection.
void Gnss::disturb(SatelliteView& view, RangeMeasurement& measurement, size_t satellite, int64_t sample) {
  const GnssErrors& e = receiver_.errors;
  Processes& p = processes_[satellite];
  const double code = e.code_m * code_factor(view.elevation);
  const double doppler = e.doppler * code_factor(view.elevation) / std::sqrt(2.0);
  const double multipath = e.multipath * multipath_std(view.elevation);
  const double ionosphere = e.ionosphere_m * ionosphere_obliquity(view.elevation);
  const double troposphere = e.troposphere_m * troposphere_mapping(view.elevation);
  const uint64_t draw = static_cast<uint64_t>(sample) * satellite_count + satellite;
  view.range_error_m = code * code_.at(draw) + multipath * p.multipath.at(sample) +
                       e.orbit_m * p.orbit.at(sample) + ionosphere * p.ionosphere.at(sample) +
                       troposphere * p.troposphere.at(sample) + view.path.excess_m;
  view.rate_error = doppler * doppler_.at(draw) + view.path.excess_rate;
  measurement.range_m += view.range_error_m;
  measurement.rate += view.rate_error;
  // A receiver that knows of no error still weighs its satellites equally.
  constexpr double least_std = 1e-6;
  measurement.range_std_m =
      std::max(least_std, std::sqrt(code * code + multipath * multipath + e.orbit_m * e.orbit_m +
                                    ionosphere * ionosphere + troposphere * troposphere));
  measurement.rate_std = std::max(least_std, doppler);
}

GnssEpoch Gnss::measure(double unix_s, const dvec3& position_m, const dvec3& velocity, const Sky& sky,
                        int64_t sample) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const dvec3 origin = geocentric(frame_.reference().origin);
  const std::array<Satellite, satellite_count> constellation = nominal_constellation(unix_s);
  GnssEpoch epoch;
  std::vector<RangeMeasurement> measurements;
  for (size_t i = 0; i < satellite_count; ++i) {
    RangeMeasurement m;
    m.satellite_m = local_from_earth_ * (constellation[i].position_m - origin);
    m.satellite_velocity = local_from_earth_ * constellation[i].velocity;
    const dvec3 to = m.satellite_m - position_m;
    const double distance = glm::length(to);
    const dvec3 direction = to / distance;
    SatelliteView& view = epoch.satellites[i];
    view.azimuth = std::atan2(direction.y, direction.x);
    view.elevation = std::asin(direction.z);
    view.range_error_m = view.rate_error = none;
    if (view.elevation < receiver_.mask) {
      view.path.state = SignalPath::State::below;
      continue;
    }
    view.path = sky(direction);
    if (view.path.state == SignalPath::State::blocked) continue;
    m.range_m = distance;
    m.rate = glm::dot(direction, m.satellite_velocity - velocity);
    disturb(view, m, i, sample);
    measurements.push_back(m);
  }
  epoch.used = static_cast<uint32_t>(measurements.size());
  epoch.fix = solve_position(measurements, dvec3(0.0));
  if (epoch.fix && epoch.fix->dilutions.pdop > receiver_.most_pdop) epoch.fix.reset();
  return epoch;
}

}  // namespace greatx::navigation
