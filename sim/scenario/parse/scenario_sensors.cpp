// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the common part of nodes[].sensors[].
#include <array>
#include <cmath>
#include <set>

#include "core/units.h"
#include "sim/scenario/parse/scenario_parse.h"

namespace greatx::sim {
namespace {

Mount parse_mount(const Field& field) {
  const FieldMap map(field, {"position_m", "rotation_deg"});
  Mount mount;
  if (const auto f = map.find("position_m")) mount.position_m = f->position();
  if (const auto f = map.find("rotation_deg")) mount.rotation = f->angles_deg();
  return mount;
}

/// The keys of every sensor that fires by itself, and the keys that pictures share.
const Keys fired{"name", "type", "mount", "rate_hz", "see_own_body"};
const Keys pinhole{"width", "height", "fov_deg",      "fx",         "fy",     "cx",
                   "cy",    "near_m", "antialiasing", "distortion", "outputs"};

/// Returns the keys of each kind, in the order of parse_sensor's.
std::array<Keys, 5> keys_of_kind() {
  return {fired + pinhole +
              Keys{"exposure_ev100", "exposure", "motion_blur_samples", "vignetting", "noise", "box_classes"},
          fired + pinhole +
              Keys{"camera", "steps", "threshold", "noise", "dark_cd_m2", "bright_cd_m2", "refractory_s",
                   "cutoff_hz", "difference", "max_events_per_pixel"},
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
                       "outputs"},
          fired + Keys{"waveform", "transmit", "receive", "illuminator", "power_dbm", "field_of_view",
                       "echoes", "receiver", "processing", "outputs"},
          Keys{"name", "type", "mount"} + antenna_keys};
}

}  // namespace

SensorConfig parse_sensor(const Field& field, const Rational& tick_rate_hz, PatternFiles& patterns) {
  enum { camera, event_camera, lidar, radar, antenna };
  const size_t kind = kind_of(field, "type", {"camera", "event_camera", "lidar", "radar", "antenna"});
  const FieldMap map(field, keys_of_kind()[kind]);
  SensorConfig sensor;
  sensor.where = field.where();
  const Field name = map.require("name", "a name");
  sensor.name = name.name();
  if (sensor.name == "pose") name.fail("a name other than 'pose', which is every node's own record");
  if (const auto f = map.find("mount")) sensor.mount = parse_mount(*f);
  if (kind != antenna)
    sensor.rate_hz = rate_of(map.require("rate_hz", "a rate greater than 0 such as 10, 29.97 or 30000/1001"),
                             tick_rate_hz);
  if (kind == camera) sensor.config = parse_camera(map);
  if (kind == event_camera) sensor.config = parse_event_camera(map, sensor.rate_hz);
  if (kind == lidar) sensor.config = parse_lidar(map, sensor.rate_hz);
  if (kind == radar) sensor.config = parse_radar(map, patterns);
  if (kind == antenna) sensor.config = parse_antenna(map, patterns);
  return sensor;
}

}  // namespace greatx::sim
