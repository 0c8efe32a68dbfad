// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/sensor_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "core/text.h"
#include "core/units.h"
#include "view/overlay/shape_parts.h"

namespace greatx::view {

namespace {

constexpr io::Color frustum_color{255, 214, 120}, antenna_color{226, 160, 255};
constexpr double pattern_range_db = 30.0;
constexpr int pattern_zeniths = 18, pattern_azimuths = 36;  // steps

void add_frustum(Shapes& shapes, const CameraFacts& camera, const Pose& world_from_sensor, double depth_m,
                 uint32_t row) {
  const auto corner = [&](double u, double v) {
    return world_from_sensor.apply(depth_m * pixel_ray(camera, u, v));
  };
  const dvec3 corners[] = {corner(0, 0), corner(camera.width, 0), corner(camera.width, camera.height),
                           corner(0, camera.height)};
  for (int i = 0; i < 4; ++i) {
    shapes.lines.push_back({world_from_sensor.position, corners[i], frustum_color, 1.5f, row});
    shapes.lines.push_back({corners[i], corners[(i + 1) % 4], frustum_color, 1.5f, row});
  }
  // A triangle says which side of the picture is up.
  const dvec3 tip = 0.5 * (corners[0] + corners[1]) +
                    0.2 * (0.5 * (corners[0] + corners[1]) - 0.5 * (corners[2] + corners[3]));
  shapes.lines.push_back({glm::mix(corners[0], corners[1], 0.35), tip, frustum_color, 1.5f, row});
  shapes.lines.push_back({tip, glm::mix(corners[0], corners[1], 0.65), frustum_color, 1.5f, row});
}

std::string text_of_camera(const std::string& name, const std::string& kind, const CameraFacts& camera) {
  return fmt::format(
      "{} ({})\n{:.0f} x {:.0f} pixels\nfx {:.2f}, fy {:.2f}, cx {:.2f}, cy {:.2f}\n"
      "field of view {:.1f} x {:.1f} deg{}",
      name, kind, camera.width, camera.height, camera.fx, camera.fy, camera.cx, camera.cy,
      degrees(std::atan(camera.cx / camera.fx) + std::atan((camera.width - camera.cx) / camera.fx)),
      degrees(std::atan(camera.cy / camera.fy) + std::atan((camera.height - camera.cy) / camera.fy)),
      camera.distorted ? "\nthe frustum leaves the lens's distortion out" : "");
}

/// Power gains of an element over the sphere, [zenith + 1, azimuth].
std::vector<double> pattern_gains(const rf::AntennaArray& array) {
  std::vector<double> gains;
  const double slant = array.slant(0);
  for (int i = 0; i <= pattern_zeniths; ++i)
    for (int j = 0; j < pattern_azimuths; ++j) {
      const double zenith = pi * i / pattern_zeniths, azimuth = 2.0 * pi * j / pattern_azimuths;
      // At the poles the azimuth is 0 exactly, as everywhere in rf/antenna.
      const dvec3 direction = i == 0 ? dvec3(0, 0, 1)
                              : i == pattern_zeniths
                                  ? dvec3(0, 0, -1)
                                  : dvec3(std::sin(zenith) * std::cos(azimuth),
                                          std::sin(zenith) * std::sin(azimuth), std::cos(zenith));
      const rf::Jones field = rf::element_field(array.pattern, slant, direction);
      gains.push_back(std::norm(field.theta) + std::norm(field.phi));
    }
  return gains;
}

/// Draws the surface, and returns the largest gain in dB.
double add_pattern(Shapes& shapes, const rf::AntennaArray& array, const Pose& world_from_antenna,
                   double tip_m, uint32_t row) {
  const std::vector<double> gains = pattern_gains(array);
  const double largest = *std::ranges::max_element(gains);
  if (!(largest > 0.0)) return -std::numeric_limits<double>::infinity();
  const auto share = [&](int i, int j) {
    const double gain = gains[static_cast<size_t>(i * pattern_azimuths + j % pattern_azimuths)] / largest;
    return gain > 0.0 ? std::max(0.0, 1.0 + decibels(gain) / pattern_range_db) : 0.0;
  };
  const auto point = [&](int i, int j) {
    const double zenith = pi * i / pattern_zeniths,
                 azimuth = 2.0 * pi * (j % pattern_azimuths) / pattern_azimuths;
    return world_from_antenna.apply(
        tip_m * share(i, j) *
        dvec3(std::sin(zenith) * std::cos(azimuth), std::sin(zenith) * std::sin(azimuth), std::cos(zenith)));
  };
  const auto line = [&](int i0, int j0, int i1, int j1) {
    const double level = std::max(share(i0, j0), share(i1, j1));
    if (level <= 0.0) return;
    shapes.lines.push_back({point(i0, j0), point(i1, j1), io::viridis(level), 1.0f, row});
  };
  for (int i = 1; i < pattern_zeniths; ++i)
    for (int j = 0; j < pattern_azimuths; ++j) line(i, j, i, j + 1);
  for (int j = 0; j < pattern_azimuths; j += 2)
    for (int i = 0; i < pattern_zeniths; ++i) line(i, j, i + 1, j);
  return decibels(largest);
}

/// Draws the sensors of a run.
class SensorDrawing {
 public:
  SensorDrawing(const RecordTables& tables, const NodePoses& poses, const SensorOptions& options)
      : tables_(tables), poses_(poses), options_(options) {}

  Shapes draw() {
    for (const SensorFacts& sensor : tables_.sensors()) {
      const bool hidden = is_hidden(sensor.place);
      if (!hidden && sensor.camera && options_.cameras && sensor.camera->shared_with.empty()) camera(sensor);
      if (!hidden && (sensor.kind == "lidar" || sensor.kind == "radar") && options_.axes) axes(sensor);
      if (!sensor.channel || !options_.antennas) continue;
      for (const AntennaFacts& end : sensor.channel->transmitters) antenna(end);
      for (const AntennaFacts& end : sensor.channel->receivers) antenna(end);
    }
    if (without_pattern_ > 0)
      shapes_.note(fmt::format("antennas: {} more without their patterns", without_pattern_));
    if (patterns_ > 0) add_pattern_legend();
    if (unplaced_ > 0) shapes_.note(fmt::format("sensors: {} that the poses do not place", unplaced_));
    return std::move(shapes_);
  }

 private:
  /// Not the colours of gains, which the legend of paths has.
  void add_pattern_legend() {
    shapes_.legend.emplace_back("pattern: strongest direction", io::viridis(1.0));
    shapes_.legend.emplace_back(fmt::format("pattern: {:.0f} dB weaker, at the antenna", pattern_range_db),
                                io::viridis(0.0));
  }
  bool is_hidden(const Place& place) const { return place.node && place.node == options_.hidden_node; }
  std::optional<Pose> placed(const Place& place) {
    std::optional<Pose> pose = poses_.world_from(place);
    if (!pose) ++unplaced_;
    return pose;
  }
  void name_at(const dvec3& at, const std::string& name, io::Color color) {
    if (options_.names) shapes_.labels.push_back({at, name, color});
  }

  void camera(const SensorFacts& sensor) {
    const std::optional<Pose> pose = placed(sensor.place);
    if (!pose) return;
    const std::string name = printable(sensor.place.name);
    const uint32_t row = shapes_.add_row(text_of_camera(name, sensor.kind, *sensor.camera),
                                         row_id("sensor " + sensor.place.name, 0));
    add_frustum(shapes_, *sensor.camera, *pose, options_.frustum_m, row);
    name_at(pose->position, name, frustum_color);
  }

  void axes(const SensorFacts& sensor) {
    const std::optional<Pose> pose = placed(sensor.place);
    if (!pose) return;
    const std::string name = printable(sensor.place.name);
    const uint32_t row =
        shapes_.add_row(fmt::format("{} ({})\nx forward red, y left green, z up blue", name, sensor.kind),
                        row_id("sensor " + sensor.place.name, 0));
    add_axes(shapes_, *pose, options_.axis_m, row);
    name_at(pose->position, name, white);
  }

  /// An antenna of several channels once, with the spacing that it has in the first of them.
  void antenna(const AntennaFacts& antenna) {
    if (is_hidden(antenna.place) || !drawn_.insert(antenna.place.name).second) return;
    const std::optional<Pose> pose = placed(antenna.place);
    if (!pose) return;
    const rf::AntennaArray& array = antenna.array;
    const std::string name = printable(antenna.place.name);
    const uint32_t elements = array.element_count(), ports = array.polarization_count();
    const size_t stride =
        std::max<size_t>(1, (elements + options_.most_elements - 1) / options_.most_elements);
    std::string text = fmt::format("{} (antenna)\n{}, polarization {}\n{} element{}, {} port{}", name,
                                   antenna.pattern, antenna.polarization, elements, elements == 1 ? "" : "s",
                                   array.port_count(), array.port_count() == 1 ? "" : "s");
    if (stride > 1) text += fmt::format("\none element in {} is drawn", stride);
    const uint32_t row = shapes_.add_row(text, row_id("sensor " + antenna.place.name, 0));
    for (size_t element = 0; element < elements; element += stride)
      shapes_.points.push_back({pose->apply(array.element_position(static_cast<uint32_t>(element) * ports)),
                                antenna_color, 3.0f, PointShape::Mark::dot, row});
    name_at(pose->position, name, antenna_color);
    if (!options_.patterns) return;
    if (patterns_ == options_.most_patterns) {
      ++without_pattern_;
      return;
    }
    ++patterns_;
    const double largest_db = add_pattern(shapes_, array, *pose, options_.pattern_m, row);
    if (std::isfinite(largest_db))
      shapes_.rows[row].text += fmt::format("\nlargest gain of an element {:.2f} dBi", largest_db);
  }

  const RecordTables& tables_;
  const NodePoses& poses_;
  const SensorOptions& options_;
  Shapes shapes_;
  std::set<std::string> drawn_;
  size_t patterns_ = 0, without_pattern_ = 0, unplaced_ = 0;
};

}  // namespace

dvec3 pixel_ray(const CameraFacts& camera, double u, double v) {
  return {1.0, -(u - camera.cx) / camera.fx, -(v - camera.cy) / camera.fy};
}

Shapes sensor_shapes(const RecordTables& tables, const NodePoses* poses, const SensorOptions& options) {
  if (poses != nullptr) return SensorDrawing(tables, *poses, options).draw();
  Shapes shapes;
  shapes.note("sensors: the poses of this tick are not known");
  return shapes;
}

}  // namespace greatx::view
