// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/navigation/gnss.h"

#include <algorithm>
#include <cmath>
#include <complex>
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

/// Standard deviation of a measured carrier-to-noise density, dB.
constexpr double cn0_std_db = 1.0;
constexpr double cross_polar_db = 6.0;

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

double reflection_loss_db(double cosine) {
  constexpr double l1_ghz = 1.57542, vacuum_s_per_m_ghz = 17.98;  // ITU-R P.2040-4, eq. 9
  const double conductivity = 0.0462 * std::pow(l1_ghz, 0.7822);
  const std::complex<double> permittivity(5.24, -vacuum_s_per_m_ghz * conductivity / l1_ghz);
  const std::complex<double> inside = std::sqrt(permittivity - (1.0 - cosine * cosine));
  const std::complex<double> across = (cosine - inside) / (cosine + inside),
                             along = (permittivity * cosine - inside) / (permittivity * cosine + inside);
  const double same_sense = std::norm(0.5 * (along + across)),
               other_sense = std::norm(0.5 * (along - across));
  return -10.0 * std::log10(same_sense + other_sense * std::pow(10.0, -0.1 * cross_polar_db));
}

double nominal_cn0(double elevation) { return 37.0 + 8.0 * std::sin(elevation); }

double weakness_factor(double deficit_db) {
  constexpr double slope = 2.0;
  return std::pow(10.0, slope * std::max(0.0, deficit_db - 2.0 * cn0_std_db) / 20.0);
}

SignalPath reflected_path(const dvec3& to_satellite, const dvec3& normal, double distance_m,
                          const dvec3& velocity) {
  const double facing = glm::dot(normal, to_satellite);
  return {SignalPath::State::reflected, 2.0 * distance_m * facing, 2.0 * glm::dot(normal, velocity) * facing,
          reflection_loss_db(facing)};
}

Gnss::Gnss(const GnssReceiver& receiver, const LocalFrame& frame, uint64_t seed, const std::string& name,
           uint32_t sequence, double step_s)
    : receiver_(receiver),
      frame_(frame),
      local_from_earth_(axes_of(frame.reference().origin)),
      code_(StreamKey(seed, fmt::format("{}/code", name), sequence)),
      doppler_(StreamKey(seed, fmt::format("{}/doppler", name), sequence)),
      strength_(StreamKey(seed, fmt::format("{}/cn0", name), sequence)) {
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

/// Adds the errors of one satellite, and tells the receiver their standard deviations in view, but not
/// whether the signal came by a reflection: of that it has the strength alone.
void Gnss::disturb(SatelliteView& view, RangeMeasurement& measurement, size_t satellite, int64_t sample) {
  const GnssErrors& e = receiver_.errors;
  Processes& p = processes_[satellite];
  const double code = e.code_m * code_factor(view.elevation);
  const double doppler = e.doppler * code_factor(view.elevation) / std::sqrt(2.0);
  const double multipath = e.multipath * multipath_std(view.elevation);
  const double ionosphere = e.ionosphere_m * ionosphere_obliquity(view.elevation);
  const double troposphere = e.troposphere_m * troposphere_mapping(view.elevation);
  const uint64_t draw = static_cast<uint64_t>(sample) * satellite_count + satellite;
  const double weaker = std::pow(10.0, view.path.loss_db / 20.0);  // noise grows as the amplitude falls
  view.range_error_m = weaker * code * code_.at(draw) + multipath * p.multipath.at(sample) +
                       e.orbit_m * p.orbit.at(sample) + ionosphere * p.ionosphere.at(sample) +
                       troposphere * p.troposphere.at(sample) + view.path.excess_m;
  view.rate_error = weaker * doppler * doppler_.at(draw) + view.path.excess_rate;
  view.cn0 = nominal_cn0(view.elevation) - view.path.loss_db + cn0_std_db * strength_.at(draw);
  measurement.range_m += view.range_error_m;
  measurement.rate += view.rate_error;
  // A receiver that knows of no error still weighs its satellites equally.
  constexpr double least_std = 1e-6;
  measurement.range_std_m =
      std::max(least_std, std::sqrt(code * code + multipath * multipath + e.orbit_m * e.orbit_m +
                                    ionosphere * ionosphere + troposphere * troposphere));
  measurement.rate_std = std::max(least_std, doppler);
}

/// Widens the deviations of a signal that is too weak for its elevation. A wall in any direction changes the
/// rate of a reflection by 2 v cos(a) cos(b), of mean square v^2; the receiver knows its speed well enough
/// for that from the epochs before.
void Gnss::weigh(const SatelliteView& view, double speed, RangeMeasurement& measurement) const {
  const double factor = weakness_factor(nominal_cn0(view.elevation) - view.cn0);
  measurement.range_std_m *= factor;
  measurement.rate_std = std::hypot(factor * measurement.rate_std, (1.0 - 1.0 / factor) * speed);
}

void Gnss::solve(GnssEpoch& epoch, std::span<const RangeMeasurement> measurements,
                 std::span<const size_t> tracked) const {
  epoch.used = static_cast<uint32_t>(measurements.size());
  std::optional<CheckedFix> checked;
  if (receiver_.integrity) {
    checked = solve_checked(measurements, dvec3(0.0), receiver_.false_alarm);
  } else if (std::optional<PositionFix> fix = solve_position(measurements, dvec3(0.0))) {
    checked = CheckedFix{.fix = std::move(*fix), .used = std::vector<bool>(measurements.size(), true)};
  }
  if (!checked || checked->fix.dilutions.pdop > receiver_.most_pdop) return;
  for (size_t i = 0; i < tracked.size(); ++i) epoch.satellites[tracked[i]].used = checked->used[i];
  epoch.used = static_cast<uint32_t>(std::ranges::count(checked->used, true));
  if (receiver_.integrity && checked->fix.redundancy > 0)
    epoch.integrity = checked->ranges_disagree ? Integrity::disagree : Integrity::agree;
  epoch.fix = std::move(checked->fix);
}

GnssEpoch Gnss::measure(double unix_s, const dvec3& position_m, const dvec3& velocity, const Sky& sky,
                        int64_t sample) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const dvec3 origin = geocentric(frame_.reference().origin);
  const std::array<Satellite, satellite_count> constellation = nominal_constellation(unix_s);
  GnssEpoch epoch;
  std::vector<RangeMeasurement> measurements;
  std::vector<size_t> tracked;
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
    view.range_error_m = view.rate_error = view.cn0 = none;
    if (view.elevation < receiver_.mask) {
      view.path.state = SignalPath::State::below;
      continue;
    }
    view.path = sky(direction);
    if (view.path.state == SignalPath::State::blocked) continue;
    m.range_m = distance;
    m.rate = glm::dot(direction, m.satellite_velocity - velocity);
    disturb(view, m, i, sample);
    if (receiver_.integrity) weigh(view, glm::length(velocity), m);
    measurements.push_back(m);
    tracked.push_back(i);
  }
  solve(epoch, measurements, tracked);
  return epoch;
}

}  // namespace greatx::navigation
