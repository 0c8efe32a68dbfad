// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// nodes[].sensors[]: what all have, LiDARs.
#include <cmath>
#include <set>

#include "core/units.h"
#include "sim/scenario/scenario_parse.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_channels = 4096;

Mount parse_mount(const Field& field) {
  const FieldMap map(field, {"position_m", "rotation_deg"});
  Mount mount;
  if (const auto f = map.find("position_m")) mount.position_m = f->vector3();
  if (const auto f = map.find("rotation_deg")) mount.rotation = f->angles_deg();
  return mount;
}

void parse_elevations(const FieldMap& map, LidarConfig& lidar) {
  for (const char* even : {"channels", "elevation_min_deg", "elevation_max_deg"})
    map.exclude("elevations_deg", even);
  if (const auto table = map.find("elevations_deg")) {
    const std::vector<Field> items = table->list("elevations", 1);
    if (items.size() > most_channels) table->fail(fmt::format("at most {} elevations", most_channels));
    for (const Field& item : items) lidar.elevations.push_back(radians(item.between(-90.0, 90.0)));
    return;
  }
  const uint32_t channels =
      map.require("channels", "a number of channels (or 'elevations_deg')").integer32(1, most_channels);
  const double low = map.require("elevation_min_deg", "an angle in degrees").between(-90.0, 90.0);
  const Field high_field = map.require("elevation_max_deg", "an angle in degrees");
  const double high = high_field.between(-90.0, 90.0);
  if (high < low) high_field.fail(fmt::format("an angle of at least elevation_min_deg, {}", low));
  if (channels == 1 && high != low) high_field.fail(fmt::format("elevation_min_deg, {}, for 1 channel", low));
  for (uint32_t i = 0; i < channels; ++i)
    lidar.elevations.push_back(radians(channels == 1 ? low : low + (high - low) * i / (channels - 1)));
}

LidarConfig parse_lidar(const FieldMap& map, const Rational& rate_hz) {
  LidarConfig lidar;
  parse_elevations(map, lidar);
  if (const auto f = map.find("azimuth_steps")) lidar.azimuth_steps = f->integer32(1, 1u << 20);
  if (const auto f = map.find("azimuth_start_deg")) lidar.azimuth_start = radians(f->between(-360.0, 360.0));
  if (const auto f = map.find("azimuth_span_deg")) {
    const double span_deg = f->between(-360.0, 360.0);
    if (span_deg == 0.0) f->fail("an angle other than 0");
    lidar.azimuth_span = radians(span_deg);
  }
  if (const auto f = map.find("sweep_s")) {
    lidar.sweep_s = f->non_negative();
    const double period_s = 1.0 / rate_hz.value();
    if (lidar.sweep_s > period_s * (1.0 + 1e-9)) f->fail(fmt::format("at most one period, {} s", period_s));
  }
  const auto min_range = map.find("min_range_m"), max_range = map.find("max_range_m");
  if (min_range) lidar.min_range_m = min_range->non_negative();
  if (max_range) lidar.max_range_m = max_range->positive();
  if (lidar.max_range_m <= lidar.min_range_m) {
    if (max_range) max_range->fail(fmt::format("a number greater than min_range_m, {}", lidar.min_range_m));
    min_range->fail(fmt::format("a number less than max_range_m, {}", lidar.max_range_m));
  }
  if (const auto f = map.find("wavelength_nm"))
    lidar.wavelength_nm = f->choice({"905", "1550"}) == 0 ? 905.0 : 1550.0;
  if (const auto f = map.find("see_own_body")) lidar.see_own_body = f->boolean();
  return lidar;
}

/// Of every sensor that fires by itself, then what pictures share.
const Keys fired{"name", "type", "mount", "rate_hz", "see_own_body"};
const Keys pinhole{"width", "height", "fov_deg",      "fx",         "fy",     "cx",
                   "cy",    "near_m", "antialiasing", "distortion", "outputs"};

/// The keys of each kind, in the order of parse_sensor's.
const Keys keys_of_kind[] = {
    fired + pinhole +
        Keys{"exposure_ev100", "exposure", "motion_blur_samples", "vignetting", "noise", "box_classes"},
    fired + pinhole +
        Keys{"steps", "threshold", "noise", "dark_cd_m2", "bright_cd_m2", "refractory_s", "cutoff_hz",
             "difference", "max_events_per_pixel"},
    fired + Keys{"channels", "elevation_min_deg", "elevation_max_deg", "elevations_deg", "azimuth_steps",
                 "azimuth_start_deg", "azimuth_span_deg", "sweep_s", "min_range_m", "max_range_m",
                 "wavelength_nm"},
    Keys{"name", "type", "mount", "pattern", "pattern_file", "polarization", "slant_deg",
         "polarization_model", "plane", "rows", "columns", "row_spacing_wl", "column_spacing_wl",
         "elements_wl"}};

}  // namespace

SensorConfig parse_sensor(const Field& field, const Rational& tick_rate_hz, PatternFiles& patterns) {
  enum { camera, event_camera, lidar, antenna };
  const size_t kind = kind_of(field, "type", {"camera", "event_camera", "lidar", "antenna"});
  const FieldMap map(field, keys_of_kind[kind]);
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
  if (kind == antenna) sensor.config = parse_antenna(map, patterns);
  return sensor;
}

}  // namespace greatx::sim
