// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the part of nodes[].sensors[] that all kinds share, and selects the parser of a kind from a table.
#include <algorithm>
#include <array>

#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/sensor_kinds.h"

namespace greatx::sim {
namespace {

Mount parse_mount(const Field& field) {
  const FieldMap map(field, {"position_m", "rotation_deg"});
  Mount mount;
  if (const auto f = map.find("position_m")) mount.position_m = position_of(*f);
  if (const auto f = map.find("rotation_deg")) mount.rotation = angles_of(*f);
  return mount;
}

/// The keys of every sensor that fires at a rate of its own, of those that see, and of all cameras.
const Keys mounted{"name", "type", "mount", "rate_hz"};
const Keys fired = mounted + Keys{"see_own_body"};
const Keys pinhole{"width", "height", "fov_deg",      "fx",         "fy",   "cx",
                   "cy",    "near_m", "antialiasing", "distortion", "lens", "outputs"};

/// Holds the inputs of a parser besides its map.
struct SensorContext {
  Rational rate_hz;
  PatternFiles& patterns;
};

/// Describes the parser of one kind.
struct SensorParser {
  Keys keys;  ///< the keys of its map
  SensorSettings (*parse)(const FieldMap& map, const SensorContext& context) = nullptr;
};
using SensorParsers = std::array<SensorParser, sensor_kind_count>;

/// Returns the table of parsers, indexed like sensor_kinds. A new kind needs a row here.
SensorParsers sensor_parsers() {
  SensorParsers parsers;
  parsers[sensor_kind_index<CameraConfig>()] = {
      fired + pinhole +
          Keys{"exposure_ev100", "exposure", "motion_blur_samples", "vignetting", "noise", "box_classes",
               "rolling_shutter", "chromatic_aberration", "glare", "lens_drops"},
      [](const FieldMap& map, const SensorContext& context) -> SensorSettings {
        const CameraConfig camera = parse_camera(map);
        if (camera.rolling.readout_s * context.rate_hz.value() > 1.0)
          map.find("rolling_shutter")->fail("a readout_s of at most the time from picture to picture");
        return camera;
      }};
  parsers[sensor_kind_index<EventCameraConfig>()] = {
      fired + pinhole +
          Keys{"camera", "steps", "threshold", "noise", "dark_cd_m2", "bright_cd_m2", "refractory_s",
               "cutoff_hz", "difference", "max_events_per_pixel"},
      [](const FieldMap& map, const SensorContext& context) -> SensorSettings {
        return parse_event_camera(map, context.rate_hz);
      }};
  parsers[sensor_kind_index<LidarConfig>()] = {
      fired + Keys{"channels",
                   "elevation_min_deg",
                   "elevation_max_deg",
                   "elevations_deg",
                   "azimuth_steps",
                   "azimuth_start_deg",
                   "azimuth_span_deg",
                   "sweep_s",
                   "min_range_m",
                   "max_range_m",
                   "wavelength_nm",
                   "raster",
                   "rosette",
                   "shots_file",
                   "beam",
                   "returns",
                   "receiver",
                   "detection",
                   "noise",
                   "point_step_m",
                   "outputs"},
      [](const FieldMap& map, const SensorContext& context) -> SensorSettings {
        return parse_lidar(map, context.rate_hz);
      }};
  parsers[sensor_kind_index<RadarConfig>()] = {
      fired + Keys{"waveform", "transmit", "receive", "illuminator", "power_dbm", "field_of_view", "echoes",
                   "receiver", "interference", "processing", "outputs"},
      [](const FieldMap& map, const SensorContext& context) -> SensorSettings {
        return parse_radar(map, context.patterns);
      }};
  parsers[sensor_kind_index<AntennaConfig>()] = {
      Keys{"name", "type", "mount"} + antenna_keys,
      [](const FieldMap& map, const SensorContext& context) -> SensorSettings {
        return parse_antenna(map, context.patterns);
      }};
  parsers[sensor_kind_index<ImuConfig>()] = {
      mounted +
          Keys{"device", "samples_per_record", "output", "earth_rotation", "accelerometer", "gyroscope"},
      [](const FieldMap& map, const SensorContext&) -> SensorSettings { return parse_imu(map); }};
  parsers[sensor_kind_index<GnssConfig>()] = {
      mounted + Keys{"time", "mask_deg", "most_pdop", "reflections", "integrity", "false_alarm", "errors"},
      [](const FieldMap& map, const SensorContext&) -> SensorSettings { return parse_gnss(map); }};
  parsers[sensor_kind_index<BarometerConfig>()] = {
      mounted + Keys{"sea_level_hpa", "noise_pa", "bias_pa", "drift_pa", "drift_time_s", "resolution_pa"},
      [](const FieldMap& map, const SensorContext&) -> SensorSettings { return parse_barometer(map); }};
  parsers[sensor_kind_index<MagnetometerConfig>()] = {
      mounted + Keys{"noise_ut", "hard_iron_ut", "soft_iron", "drift_ut", "drift_time_s", "resolution_ut",
                     "range_ut"},
      [](const FieldMap& map, const SensorContext&) -> SensorSettings { return parse_magnetometer(map); }};
  for (size_t kind = 0; kind < sensor_kind_count; ++kind)
    GREATX_CHECK(parsers[kind].parse != nullptr, "sensors of type {} have no parser",
                 sensor_kinds[kind].type);
  return parsers;
}

/// Returns the row of sensor_kinds for the key `type`.
size_t sensor_type(const Field& field) {
  std::array<std::string_view, sensor_kind_count> types;
  std::ranges::transform(sensor_kinds, types.begin(), &SensorKind::type);
  return kind_of(field, "type", types);
}

}  // namespace

SensorConfig parse_sensor(const Field& field, const Rational& tick_rate_hz, PatternFiles& patterns) {
  static const SensorParsers parsers = sensor_parsers();
  const size_t kind = sensor_type(field);
  const FieldMap map(field, parsers[kind].keys);
  SensorConfig sensor;
  sensor.where = field.where();
  const Field name = map.require("name", "a name");
  sensor.name = name.name();
  if (sensor.name == "pose") name.fail("a name other than 'pose', which is every node's own record");
  if (const auto f = map.find("mount")) sensor.mount = parse_mount(*f);
  if (sensor_kinds[kind].fires)
    sensor.rate_hz = rate_of(map.require("rate_hz", "a rate greater than 0 such as 10, 29.97 or 30000/1001"),
                             tick_rate_hz);
  sensor.config = parsers[kind].parse(map, {sensor.rate_hz, patterns});
  return sensor;
}

}  // namespace greatx::sim
