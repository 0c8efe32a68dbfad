// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "core/units.h"
#include "view/overlay/record_arrays.h"
#include "view/overlay/sensing_shapes.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

constexpr io::Color receding_color{255, 104, 92}, approaching_color{92, 184, 255},
    resting_color{236, 236, 220}, fan_color{120, 200, 170};

/// Nearly at rest: less than a hundredth of the velocities that the radar tells apart.
io::Color velocity_color(double velocity_m_s, double largest_m_s) {
  if (std::abs(velocity_m_s) <= 0.01 * largest_m_s) return resting_color;
  return velocity_m_s > 0.0 ? receding_color : approaching_color;
}

/// An arc of the sensor's x-y plane.
void add_arc(Shapes& shapes, const Pose& world_from_sensor, const RadarFacts& facts, double range_m,
             uint32_t row) {
  const int pieces =
      std::clamp(static_cast<int>(std::ceil(degrees(facts.azimuth_max - facts.azimuth_min) / 5.0)), 1, 144);
  const auto at = [&](int i) {
    const double azimuth = facts.azimuth_min + (facts.azimuth_max - facts.azimuth_min) * i / pieces;
    return world_from_sensor.apply(range_m * dvec3(std::cos(azimuth), std::sin(azimuth), 0.0));
  };
  for (int i = 0; i < pieces; ++i) shapes.lines.push_back({at(i), at(i + 1), fan_color, 1.0f, row});
}

void add_fan(Shapes& shapes, const SensorSpec& spec, const RadarFacts& facts, const Pose& world_from_sensor,
             double wanted_m) {
  const double range_m = wanted_m > 0.0 ? std::min(wanted_m, facts.range_span_m) : facts.range_span_m;
  if (range_m <= 0.0 || facts.azimuth_max <= facts.azimuth_min) return;
  const uint32_t row =
      shapes.add_row(fmt::format("{}: field of view\nazimuth {:.1f} to {:.1f} deg, drawn as far as {:.1f} m\n"
                                 "range is unambiguous to {:.1f} m, velocity to {:.2f} m/s",
                                 spec.name, degrees(facts.azimuth_min), degrees(facts.azimuth_max), range_m,
                                 facts.range_span_m, facts.velocity_max_m_s),
                     row_id("fan " + spec.name, 0));
  for (const double azimuth : {facts.azimuth_min, facts.azimuth_max})
    shapes.lines.push_back(
        {world_from_sensor.position,
         world_from_sensor.apply(range_m * dvec3(std::cos(azimuth), std::sin(azimuth), 0.0)), fan_color, 1.0f,
         row});
  for (const double share : {0.5, 1.0}) {
    add_arc(shapes, world_from_sensor, facts, share * range_m, row);
    const double middle = 0.5 * (facts.azimuth_min + facts.azimuth_max);
    shapes.labels.push_back(
        {world_from_sensor.apply(share * range_m * dvec3(std::cos(middle), std::sin(middle), 0.0)),
         fmt::format("{:.0f} m", share * range_m), fan_color});
  }
}

/// A piece of the shell between two ranges, from the radar as the detection sees it. A beam of no width is
/// a line there.
struct RadarCell {
  double range_m = 0.0, azimuth = 0.0, elevation = 0.0;
  double range_bin_m = 0.0, azimuth_beam = 0.0, elevation_beam = 0.0;
};

void add_cell(Shapes& shapes, const Pose& world_from_sensor, const RadarCell& cell, io::Color color,
              uint32_t row) {
  constexpr int pieces = 4;                            // of a curved edge
  const auto at = [&](double u, double v, double w) {  // -0.5 to 0.5 in range, azimuth, elevation
    const double range_m = std::max(0.0, cell.range_m + u * cell.range_bin_m);
    const double azimuth = cell.azimuth + v * cell.azimuth_beam,
                 elevation = std::clamp(cell.elevation + w * cell.elevation_beam, -0.5 * pi, 0.5 * pi);
    return world_from_sensor.apply(range_m * dvec3(std::cos(elevation) * std::cos(azimuth),
                                                   std::cos(elevation) * std::sin(azimuth),
                                                   std::sin(elevation)));
  };
  const auto edge = [&](const dvec3& from, const dvec3& to) {
    for (int i = 0; i < pieces; ++i) {
      const dvec3 a = glm::mix(from, to, static_cast<double>(i) / pieces),
                  b = glm::mix(from, to, (i + 1.0) / pieces);
      const dvec3 p = at(a.x, a.y, a.z), q = at(b.x, b.y, b.z);
      if (p != q) shapes.lines.push_back({p, q, color, 1.0f, row});
    }
  };
  for (const double s : {-0.5, 0.5})
    for (const double t : {-0.5, 0.5}) {
      edge({-0.5, s, t}, {0.5, s, t});
      edge({s, -0.5, t}, {s, 0.5, t});
      edge({s, t, -0.5}, {s, t, 0.5});
    }
}

std::string cells_text(const RadarFacts& radar) {
  const auto beam = [](double width, const char* name) {
    return width > 0.0 ? fmt::format("{:.3g} deg {}", degrees(width), name) : fmt::format("any {}", name);
  };
  return fmt::format("cells: {:.3g} m range x {} x {}; velocities {:.3g} m/s apart", radar.range_bin_m,
                     beam(radar.azimuth_beam, "azimuth"), beam(radar.elevation_beam, "elevation"),
                     radar.velocity_bin_m_s);
}

/// The direction in which the range grows: away from both ends.
dvec3 away_from(const dvec3& receiver, const std::optional<dvec3>& transmitter, const dvec3& target) {
  const auto unit = [](const dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : dvec3(0.0);
  };
  if (!transmitter) return unit(target - receiver);
  return unit(unit(target - receiver) + unit(target - *transmitter));
}

}  // namespace

Shapes radar_shapes(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                    const NodePoses* poses, const RadarOptions& options) {
  Shapes shapes;
  const SensorFacts& facts = tables.facts(spec);
  if (!facts.radar) throw_user_error("{}: expected the metadata of a radar", spec.name);
  const RadarFacts& radar = *facts.radar;
  const RecordArrays arrays(spec, record);
  const NodePoses* const known = poses_for(shapes, spec, record, poses);
  if (known == nullptr) return shapes;
  const std::optional<Pose> now = known->world_from(facts.place),
                            middle = known->world_from(facts.place, radar.frame_middle_s);
  if (!now || !middle) {
    shapes.note(spec.name + ": the poses have no such node, so it cannot be placed");
    return shapes;
  }
  if (options.fan) add_fan(shapes, spec, radar, *now, options.fan_range_m);
  if (!arrays.has("detections")) {
    shapes.note(spec.name + ": its detections are not recorded: add 'detections' to its outputs");
    return shapes;
  }
  std::optional<dvec3> transmitter;
  if (radar.illuminator)
    if (const std::optional<Pose> pose = known->world_from(*radar.illuminator, radar.frame_middle_s))
      transmitter = pose->position;
  const std::span<const float> places = arrays.finite<float>("detections", {-1, 4});
  const auto count = static_cast<int64_t>(places.size() / 4);
  const auto column = [&](const char* name) { return arrays.finite<float>(name, {count}); };
  const std::span<const float> range = column("range"), velocity = column("velocity"),
                               azimuth = column("azimuth"), elevation = column("elevation"),
                               snr = column("snr"), power = column("power");
  const std::span<const uint32_t> instance = arrays.get<uint32_t>("instance", {count});
  size_t false_alarms = 0;
  for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
    const dvec3 at = middle->apply({places[4 * i], places[4 * i + 1], places[4 * i + 2]});
    const bool real = instance[i] != 0;
    false_alarms += !real;
    const io::Color color =
        real ? velocity_color(static_cast<double>(velocity[i]), radar.velocity_max_m_s) : dim_color;
    const uint32_t row = shapes.add_row(fmt::format(
        "{}: {}\nrange {:.2f} m, velocity {:+.2f} m/s ({})\nazimuth {:.2f} deg, elevation {:.2f} deg\n"
        "SNR {:.1f} dB, power {:.1f} dBm, RCS {:.1f} dBsm",
        spec.name, real ? tables.instance_name(instance[i]) : std::string("false alarm"), range[i],
        velocity[i],
        velocity[i] > 0.0f   ? "receding"
        : velocity[i] < 0.0f ? "approaching"
                             : "at rest",
        degrees(static_cast<double>(azimuth[i])), degrees(static_cast<double>(elevation[i])), snr[i],
        power[i], places[4 * i + 3]));
    shapes.points.push_back(
        {at, color, 5.0f, real ? PointShape::Mark::diamond : PointShape::Mark::cross, row, true});
    if (options.cells && !radar.illuminator)
      add_cell(
          shapes, *middle,
          {static_cast<double>(range[i]), static_cast<double>(azimuth[i]), static_cast<double>(elevation[i]),
           radar.range_bin_m, radar.azimuth_beam / std::max(0.1, std::cos(static_cast<double>(azimuth[i]))),
           radar.elevation_beam},
          color, row);
    const dvec3 motion =
        options.arrow_s * static_cast<double>(velocity[i]) * away_from(middle->position, transmitter, at);
    if (motion != dvec3(0.0)) shapes.lines.push_back({at, at + motion, color, 2.0f, row, true, true});
  }
  shapes.note(fmt::format("{}: {} detections, {} of them false alarms; arrows: {:g} s of radial velocity",
                          spec.name, count, false_alarms, options.arrow_s));
  if (options.cells)
    shapes.note(radar.illuminator ? spec.name + ": bistatic, so its resolution cells are not drawn"
                                  : cells_text(radar));
  shapes.legend.emplace_back("receding", receding_color);
  shapes.legend.emplace_back("approaching", approaching_color);
  if (radar.velocity_max_m_s > 0.0)
    shapes.note(fmt::format("velocities are unambiguous to {:.2f} m/s", radar.velocity_max_m_s));
  return shapes;
}

}  // namespace greatx::view
