// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/navigation/gnss_sensor.h"

#include <limits>

#include <nlohmann/json.hpp>

#include "core/units.h"

namespace greatx::sim {

namespace {

constexpr auto satellites = static_cast<int64_t>(navigation::satellite_count);

double start_time(const GnssConfig& config, const EarthPlace& place) {
  if (config.unix_s) return *config.unix_s;
  if (!place.unix_s)
    throw_user_error(
        "a GNSS receiver needs the time, since its satellites move: expected 'time' (RFC 3339), or "
        "environment.time, found neither");
  return *place.unix_s;
}

dvec3 vector_of(const Geodetic& place) { return {place.latitude_deg, place.longitude_deg, place.height_m}; }

/// Returns a symmetric matrix as an array f64 [3, 3].
Array array_of_matrix(const dmat3& matrix) {
  return Array::of<double>({3, 3}, std::span<const double>(&matrix[0].x, 9));
}

}  // namespace

GnssSensor::GnssSensor(const Experiment& experiment, uint32_t node, uint32_t sensor)
    : HostSensor(experiment, node, sensor, "gnss"),
      gnss_config_(std::get<GnssConfig>(config().config)),
      place_(require_earth_place(experiment, "a GNSS receiver")),
      unix_s_(start_time(gnss_config_, place_)),
      view_(*experiment.world) {
  declare_arrays();
  const navigation::GnssErrors& e = gnss_config_.receiver.errors;
  nlohmann::json metadata{{"unix_time_s", unix_s_},
                          {"mask_deg", degrees(gnss_config_.receiver.mask)},
                          {"most_pdop", gnss_config_.receiver.most_pdop},
                          {"reflections", gnss_config_.reflections},
                          {"integrity", gnss_config_.receiver.integrity},
                          {"false_alarm", gnss_config_.receiver.false_alarm},
                          {"integrity_states", {"unknown", "agree", "disagree"}},
                          {"satellite_states", {"below the mask", "direct", "reflected", "blocked"}},
                          {"errors",
                           {{"code_m", e.code_m},
                            {"doppler_m_s", e.doppler},
                            {"multipath", e.multipath},
                            {"multipath_time_s", e.multipath_time_s},
                            {"orbit_m", e.orbit_m},
                            {"orbit_time_s", e.orbit_time_s},
                            {"ionosphere_m", e.ionosphere_m},
                            {"ionosphere_time_s", e.ionosphere_time_s},
                            {"troposphere_m", e.troposphere_m},
                            {"troposphere_time_s", e.troposphere_time_s}}},
                          {"non_finite",
                           {"position", "geodetic", "velocity", "position_covariance", "velocity_covariance",
                            "dop", "pseudorange_error", "range_rate_error", "satellite_cn0"}}};
  for (size_t i = 0; i < navigation::satellite_count; ++i)
    metadata["satellites"].push_back(navigation::slot_name(i));
  describe(std::move(metadata));
}

void GnssSensor::declare_arrays() {
  declare("position", DType::f64, {3}, "m", "[xyz] measured position in the world; NaN without a fix");
  declare("geodetic", DType::f64, {3}, "deg, deg, m",
          "[latitude longitude height] the same on the Earth: WGS 84, height above the ellipsoid");
  declare("velocity", DType::f64, {3}, "m/s", "[xyz] measured velocity in the world, by Doppler shifts");
  declare("position_covariance", DType::f64, {3, 3}, "m^2", "[xyz, xyz] as the receiver takes it");
  declare("velocity_covariance", DType::f64, {3, 3}, "m^2/s^2", "[xyz, xyz] as the receiver takes it");
  declare("dop", DType::f64, {5}, "1", "[geometry position horizontal vertical time] dilution of precision");
  declare("fix", DType::u8, {1}, "1", "1: position and velocity are known; 0: they are not");
  declare("satellites_used", DType::u8, {1}, "1", "satellites of the fix, or tracked without one");
  declare("integrity", DType::u8, {1}, "1", "ranges: 0 not checked, 1 agree, 2 disagree (wider covariance)");
  declare("position_true", DType::f64, {3}, "m", "[xyz] position of the antenna in the world");
  declare("geodetic_true", DType::f64, {3}, "deg, deg, m", "[latitude longitude height] of the antenna");
  declare("velocity_true", DType::f64, {3}, "m/s", "[xyz] velocity of the antenna in the world");
  declare("satellite_state", DType::u8, {satellites}, "1",
          "[satellite] 0 below the mask, 1 direct, 2 reflected, 3 blocked");
  declare("satellite_used", DType::u8, {satellites}, "1", "[satellite] 1: of the fix; 0: it is not");
  declare("satellite_azimuth", DType::f64, {satellites}, "rad",
          "[satellite] from x (east) towards y (north)");
  declare("satellite_elevation", DType::f64, {satellites}, "rad", "[satellite] above the horizon");
  declare("pseudorange_error", DType::f64, {satellites}, "m", "[satellite] NaN if it is not tracked");
  declare("range_rate_error", DType::f64, {satellites}, "m/s", "[satellite] NaN if it is not tracked");
  declare("satellite_cn0", DType::f64, {satellites}, "dB-Hz",
          "[satellite] measured carrier-to-noise density; NaN if it is not tracked");
}

void GnssSensor::begin(uint32_t sequence) {
  gnss_.emplace(gnss_config_.receiver, place_.frame, experiment_.scenario.seed, spec_.name, sequence,
                period_s_);
}

std::vector<Array> GnssSensor::measure(const TickContext& context) {
  const Motion antenna = mounted_motion(context);
  const World& world = *experiment_.world;
  const navigation::Sky sky = view_.sky({world.scene.to_local(antenna.pose.position), antenna.velocity,
                                         context.body_poses, world.body_of_node[node_]},
                                        gnss_config_.reflections);
  const navigation::GnssEpoch epoch = gnss_->measure(unix_s_ + context.time_s, antenna.pose.position,
                                                     antenna.velocity, sky, sample_at(context.tick));
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  navigation::PositionFix fix;
  if (epoch.fix) {
    fix = *epoch.fix;
  } else {
    fix.position_m = fix.velocity = dvec3(none);
    for (int i = 0; i < 3; ++i) fix.position_covariance[i] = fix.velocity_covariance[i] = dvec3(none);
    fix.dilutions = {none, none, none, none, none};
  }
  ++records_;
  fixes_ += epoch.fix.has_value();
  std::vector<uint8_t> states, used;
  std::vector<double> azimuths, elevations, range_errors, rate_errors, strengths;
  for (const navigation::SatelliteView& view : epoch.satellites) {
    states.push_back(static_cast<uint8_t>(view.path.state));
    azimuths.push_back(view.azimuth);
    elevations.push_back(view.elevation);
    range_errors.push_back(view.range_error_m);
    rate_errors.push_back(view.rate_error);
    strengths.push_back(view.cn0);
    used.push_back(view.used ? 1 : 0);
    direct_ += view.path.state == navigation::SignalPath::State::direct;
    reflected_ += view.path.state == navigation::SignalPath::State::reflected;
    blocked_ += view.path.state == navigation::SignalPath::State::blocked;
  }
  const auto byte = [](size_t value) {
    const auto narrow = static_cast<uint8_t>(value);
    return Array::of<uint8_t>({1}, std::span<const uint8_t>(&narrow, 1));
  };
  const double dop[] = {fix.dilutions.gdop, fix.dilutions.pdop, fix.dilutions.hdop, fix.dilutions.vdop,
                        fix.dilutions.tdop};
  std::vector<Array> arrays;
  arrays.push_back(array_of_vector(fix.position_m));
  arrays.push_back(array_of_vector(epoch.fix ? vector_of(place_.frame.place(fix.position_m)) : dvec3(none)));
  arrays.push_back(array_of_vector(fix.velocity));
  arrays.push_back(array_of_matrix(fix.position_covariance));
  arrays.push_back(array_of_matrix(fix.velocity_covariance));
  arrays.push_back(Array::of<double>({5}, dop));
  arrays.push_back(byte(epoch.fix.has_value()));
  arrays.push_back(byte(epoch.used));
  arrays.push_back(byte(static_cast<size_t>(epoch.integrity)));
  arrays.push_back(array_of_vector(antenna.pose.position));
  arrays.push_back(array_of_vector(vector_of(place_.frame.place(antenna.pose.position))));
  arrays.push_back(array_of_vector(antenna.velocity));
  arrays.push_back(Array::of<uint8_t>({satellites}, states));
  arrays.push_back(Array::of<uint8_t>({satellites}, used));
  for (const std::vector<double>* column : {&azimuths, &elevations, &range_errors, &rate_errors, &strengths})
    arrays.push_back(Array::of<double>({satellites}, *column));
  return arrays;
}

void GnssSensor::count(std::map<std::string, uint64_t>& counts) const {
  counts[spec_.name + ".epochs"] += records_;
  counts[spec_.name + ".fixes"] += fixes_;
  counts[spec_.name + ".direct"] += direct_;
  counts[spec_.name + ".reflected"] += reflected_;
  counts[spec_.name + ".blocked"] += blocked_;
}

}  // namespace greatx::sim
