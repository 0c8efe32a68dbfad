// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Parses the LiDARs of nodes[].sensors[].
#include <cmath>

#include "core/units.h"
#include "renderer/lidar/scan/footprint.h"
#include "sim/scenario/parse/scenario_parse.h"
#include "sim/scenario/parse/shot_csv.h"

namespace greatx::sim {
namespace {

constexpr uint32_t most_table_channels = 4096;
constexpr int most_point_steps = 32767;

/// Parses the elevations of a spinning scanner: a table, or evenly spaced ones.
std::vector<double> parse_elevations(const FieldMap& map) {
  for (const char* even : {"elevation_min_deg", "elevation_max_deg"}) map.exclude("elevations_deg", even);
  std::vector<double> elevations;
  if (const auto table = map.find("elevations_deg")) {
    const std::vector<Field> items = table->list("elevations", 1);
    if (items.size() > most_table_channels)
      table->fail(fmt::format("at most {} elevations", most_table_channels));
    for (const Field& item : items) elevations.push_back(radians(item.between(-90.0, 90.0)));
    const auto channels = map.find("channels");
    if (channels && channels->integer32(1, most_table_channels) != elevations.size())
      table->fail(fmt::format("{} elevations, one a channel", channels->text()),
                  fmt::format("{}", elevations.size()));
    return elevations;
  }
  const uint32_t channels =
      map.require("channels", "a number of channels (or 'elevations_deg', 'raster', 'rosette', 'shots_file')")
          .integer32(1, most_table_channels);
  const double low = map.require("elevation_min_deg", "an angle in degrees").between(-90.0, 90.0);
  const Field high_field = map.require("elevation_max_deg", "an angle in degrees");
  const double high = high_field.between(-90.0, 90.0);
  if (high < low) high_field.fail(fmt::format("an angle of at least elevation_min_deg, {}", low));
  if (channels == 1 && high != low) high_field.fail(fmt::format("elevation_min_deg, {}, for 1 channel", low));
  for (uint32_t i = 0; i < channels; ++i)
    elevations.push_back(radians(channels == 1 ? low : low + (high - low) * i / (channels - 1)));
  return elevations;
}

render::SpinningScan parse_spinning(const FieldMap& map) {
  render::SpinningScan scan;
  scan.elevations = parse_elevations(map);
  if (const auto f = map.find("azimuth_steps")) {
    const auto most = static_cast<uint32_t>(
        std::min<size_t>(render::most_columns, render::most_shots / scan.elevations.size()));
    scan.azimuth_steps = f->integer32(1, most);
  }
  if (const auto f = map.find("azimuth_start_deg")) scan.azimuth_start = radians(f->between(-360.0, 360.0));
  if (const auto f = map.find("azimuth_span_deg")) {
    const double span_deg = f->between(-360.0, 360.0);
    if (span_deg == 0.0) f->fail("an angle other than 0");
    scan.azimuth_span = radians(span_deg);
  }
  return scan;
}

/// Parses [first, last] in degrees, each from -limit to limit.
void parse_range_deg(const Field& field, double limit, double& first, double& last) {
  const std::vector<Field> ends = field.list("angles", 2);
  if (ends.size() != 2) field.fail("2 angles, the first and the last");
  first = radians(ends[0].between(-limit, limit));
  last = radians(ends[1].between(-limit, limit));
}

render::RasterScan parse_raster(const Field& field) {
  const FieldMap map(field, {"columns", "rows", "azimuth_deg", "elevation_deg", "alternate"});
  render::RasterScan scan;
  scan.rows = map.require("rows", "a number of lines").integer32(1, render::most_channels);
  scan.columns = map.require("columns", "a number of shots a line")
                     .integer32(1, std::max(1u, render::most_columns / scan.rows));
  parse_range_deg(map.require("azimuth_deg", "[first, last]"), 360.0, scan.azimuth_first, scan.azimuth_last);
  parse_range_deg(map.require("elevation_deg", "[first, last]"), 90.0, scan.elevation_first,
                  scan.elevation_last);
  if (const auto f = map.find("alternate")) scan.alternate = f->boolean();
  return scan;
}

/// Parses two numbers, one for each prism.
template <typename Read>
void parse_pair(const Field& field, double (&values)[2], const Read& read) {
  const std::vector<Field> items = field.list("numbers", 2);
  if (items.size() != 2) field.fail("2 numbers, one a prism");
  for (int i = 0; i < 2; ++i) values[i] = read(items[static_cast<size_t>(i)]);
}

render::RosetteScan parse_rosette(const Field& field) {
  const FieldMap map(field, {"shots", "deflection_deg", "rotation_hz", "phase_deg"});
  render::RosetteScan scan;
  scan.shots = map.require("shots", "a number of shots a sweep").integer32(1, render::most_columns);
  const Field deflection = map.require("deflection_deg", "[first prism, second prism]");
  parse_pair(deflection, scan.deflections, [](const Field& f) { return radians(f.between(0.0, 45.0)); });
  if (scan.deflections[0] + scan.deflections[1] == 0.0) deflection.fail("a prism that deflects");
  parse_pair(map.require("rotation_hz", "[first prism, second prism]"), scan.rotations_hz,
             [](const Field& f) { return f.between(-1e5, 1e5); });
  if (const auto f = map.find("phase_deg"))
    parse_pair(*f, scan.phases, [](const Field& p) { return radians(p.between(-360.0, 360.0)); });
  return scan;
}

double parse_sweep(const FieldMap& map, const Rational& rate_hz) {
  const auto f = map.find("sweep_s");
  if (!f) return 0.0;
  const double sweep_s = f->non_negative(), period_s = 1.0 / rate_hz.value();
  if (sweep_s > period_s * (1.0 + 1e-9)) f->fail(fmt::format("at most one period, {} s", period_s));
  return sweep_s;
}

/// Parses exactly one of the four patterns.
render::Scan parse_scan(const FieldMap& map, const Rational& rate_hz) {
  constexpr std::array spinning = {"channels",        "elevation_min_deg", "elevation_max_deg",
                                   "elevations_deg",  "azimuth_steps",     "azimuth_start_deg",
                                   "azimuth_span_deg"};
  constexpr std::array others = {"raster", "rosette", "shots_file"};
  for (const char* other : others) {
    for (const char* key : spinning) map.exclude(other, key);
    for (const char* another : others)
      if (other != another) map.exclude(other, another);
  }
  map.exclude("shots_file", "sweep_s");  // the table has the times
  if (const auto f = map.find("shots_file")) {
    render::ShotTable table = load_shots(f->file());
    const double period_s = 1.0 / rate_hz.value(), last_s = table.shots.back().time_s;
    if (last_s > period_s * (1.0 + 1e-9))
      f->fail(fmt::format("times of at most one period, {} s", period_s),
              fmt::format("a last one of {} s", last_s));
    return table;
  }
  const double sweep_s = parse_sweep(map, rate_hz);
  if (const auto f = map.find("raster")) {
    render::RasterScan scan = parse_raster(*f);
    scan.sweep_s = sweep_s;
    return scan;
  }
  if (const auto f = map.find("rosette")) {
    render::RosetteScan scan = parse_rosette(*f);
    scan.sweep_s = sweep_s;
    if (sweep_s == 0.0) f->fail("a sweep_s greater than 0: its prisms turn while it fires", "none");
    return scan;
  }
  render::SpinningScan scan = parse_spinning(map);
  scan.sweep_s = sweep_s;
  return scan;
}

void parse_ranges(const FieldMap& map, LidarConfig& lidar) {
  const auto min_range = map.find("min_range_m"), max_range = map.find("max_range_m");
  if (min_range) lidar.min_range_m = min_range->non_negative(most_position_m);
  if (max_range) lidar.max_range_m = max_range->positive(1e-3, most_position_m);
  if (lidar.max_range_m > lidar.min_range_m) return;
  if (max_range) max_range->fail(fmt::format("a number greater than min_range_m, {}", lidar.min_range_m));
  min_range->fail(fmt::format("a number less than max_range_m, {}", lidar.max_range_m));
}

void parse_beam(const Field& field, LidarConfig& lidar) {
  const FieldMap map(field, {"divergence_mrad", "rings"});
  const Field divergence = map.require("divergence_mrad", "the full angle at 1/e^2 in mrad");
  lidar.divergence = 1e-3 * divergence.between(0.0, 100.0);
  if (const auto f = map.find("rings")) lidar.rings = f->integer32(0, render::most_rings);
  if (lidar.rings > 0 && lidar.divergence == 0.0)
    divergence.fail(fmt::format("an angle greater than 0 for {} rings of sub-rays", lidar.rings));
}

render::ReturnMode parse_mode(const Field& field) {
  return static_cast<render::ReturnMode>(field.choice({"strongest", "last", "dual", "all"}));
}

void parse_returns(const Field& field, LidarConfig& lidar) {
  if (field.is_scalar()) {
    lidar.returns.mode = parse_mode(field);
    return;
  }
  const FieldMap map(field, {"mode", "most", "resolution_m"});
  lidar.returns.mode = parse_mode(map.require("mode", "one of strongest, last, dual, all"));
  if (const auto f = map.find("most")) {
    if (lidar.returns.mode != render::ReturnMode::all) f->fail("no limit but with mode 'all'");
    lidar.returns.most = f->integer32(1, 255);
  }
  if (const auto f = map.find("resolution_m"))
    lidar.returns.resolution_m = f->positive(1e-6, most_position_m);
}

void parse_receiver(const Field& field, render::Receiver& receiver) {
  const FieldMap map(field, {"aperture_m", "efficiency"});
  if (const auto f = map.find("aperture_m")) receiver.aperture_diameter_m = f->positive(1e-6, 1e3);
  if (const auto f = map.find("efficiency")) {
    receiver.system_efficiency = f->between(0.0, 1.0);
    if (receiver.system_efficiency == 0.0) f->fail("a part greater than 0");
  }
}

/// Parses a noise, or the rating of a data sheet: the distance at which a surface is detected, and its
/// probability.
void parse_detection(const Field& field, render::Receiver& receiver) {
  const FieldMap map(field, {"noise_equivalent_power", "threshold", "range_m", "reflectance", "probability"});
  for (const char* rating : {"range_m", "reflectance", "probability"})
    map.exclude("noise_equivalent_power", rating);
  render::Receiver::Detection detection;
  if (const auto f = map.find("threshold")) detection.threshold = f->between(0.0, 1e3);
  if (const auto f = map.find("noise_equivalent_power")) {
    detection.noise_equivalent_power = f->positive();
    receiver.detection = detection;
    return;
  }
  const double range_m = map.require("range_m", "a range in metres (or 'noise_equivalent_power')")
                             .positive(1e-3, most_position_m);
  double reflectance = 0.1, probability = 0.9;
  if (const auto f = map.find("reflectance")) {
    reflectance = f->between(0.0, 1.0);
    if (reflectance == 0.0) f->fail("a reflectance greater than 0");
  }
  if (const auto f = map.find("probability")) {
    probability = f->number();
    if (!(probability > 0.0 && probability < 1.0)) f->fail("a number between 0 and 1, both excluded");
    if (detection.threshold + render::normal_quantile(probability) <= 0.0)
      f->fail(fmt::format(
          "a probability that noise alone does not exceed with a threshold of {}, more than {:.3g}",
          detection.threshold, render::normal_cdf(-detection.threshold)));
  }
  receiver.detection = render::rated(receiver, range_m, reflectance, probability, detection.threshold);
}

void parse_noise(const Field& field, render::Receiver& receiver) {
  const FieldMap map(field, {"range_m", "rise_m"});
  if (const auto f = map.find("range_m")) receiver.range_std_m = f->non_negative(most_position_m);
  if (const auto f = map.find("rise_m")) {
    receiver.rise_m = f->non_negative(most_position_m);
    if (receiver.rise_m > 0.0 && !receiver.detection)
      f->fail("'detection', which says how strong the noise is", "none there");
  }
}

void parse_outputs(const Field& field, LidarConfig::Outputs& outputs) {
  bool* const wanted[] = {&outputs.points, &outputs.ply, &outputs.pcd, &outputs.kitti};
  for (bool* output : wanted) *output = false;
  outputs.listed = true;
  for (const Field& item : field.list("outputs", 1)) {
    bool& output = *wanted[item.choice({"points", "ply", "pcd", "kitti"})];
    if (output) item.fail("every output once", fmt::format("a second '{}'", item.text()));
    output = true;
  }
}

/// Parses the step of coordinates. Its multiples up to the range must fit 16 bits.
double parse_point_step(const Field& field, double max_range_m) {
  const double step_m = field.positive(1e-6, 1e3), least_m = max_range_m / most_point_steps;
  if (step_m < least_m)
    field.fail(fmt::format("a step of at least max_range_m / {} = {:.6g}, so that coordinates fit 16 bits",
                           most_point_steps, least_m));
  return step_m;
}

}  // namespace

LidarConfig parse_lidar(const FieldMap& map, const Rational& rate_hz) {
  LidarConfig lidar;
  lidar.scan = parse_scan(map, rate_hz);
  parse_ranges(map, lidar);
  if (const auto f = map.find("wavelength_nm"))
    lidar.wavelength_nm = f->choice({"905", "1550"}) == 0 ? 905.0 : 1550.0;
  if (const auto f = map.find("see_own_body")) lidar.see_own_body = f->boolean();
  if (const auto f = map.find("beam")) parse_beam(*f, lidar);
  if (const auto f = map.find("returns")) parse_returns(*f, lidar);
  if (const auto f = map.find("receiver")) parse_receiver(*f, lidar.receiver);
  if (const auto f = map.find("detection")) parse_detection(*f, lidar.receiver);
  if (const auto f = map.find("noise")) parse_noise(*f, lidar.receiver);
  if (const auto f = map.find("point_step_m")) lidar.point_step_m = parse_point_step(*f, lidar.max_range_m);
  if (const auto f = map.find("outputs")) parse_outputs(*f, lidar.outputs);
  return lidar;
}

}  // namespace greatx::sim
