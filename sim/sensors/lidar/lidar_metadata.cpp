// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/sensors/lidar/lidar_metadata.h"

#include <cmath>

#include "core/units.h"

namespace greatx::sim {

using Json = nlohmann::json;

namespace {

Json json_of_scan(const render::SpinningScan& scan) {
  Json json = {{"azimuth_steps", scan.azimuth_steps},
               {"azimuth_start_deg", degrees(scan.azimuth_start)},
               {"azimuth_span_deg", degrees(scan.azimuth_span)},
               {"sweep_s", scan.sweep_s}};
  for (const double elevation : scan.elevations) json["elevations_deg"].push_back(degrees(elevation));
  return json;
}

Json json_of_scan(const render::RasterScan& scan) {
  return {{"columns", scan.columns},
          {"rows", scan.rows},
          {"azimuth_deg", {degrees(scan.azimuth_first), degrees(scan.azimuth_last)}},
          {"elevation_deg", {degrees(scan.elevation_first), degrees(scan.elevation_last)}},
          {"alternate", scan.alternate},
          {"sweep_s", scan.sweep_s}};
}

Json json_of_scan(const render::RosetteScan& scan) {
  return {{"shots", scan.shots},
          {"deflection_deg", {degrees(scan.deflections[0]), degrees(scan.deflections[1])}},
          {"rotation_hz", {scan.rotations_hz[0], scan.rotations_hz[1]}},
          {"phase_deg", {degrees(scan.phases[0]), degrees(scan.phases[1])}},
          {"sweep_s", scan.sweep_s}};
}

Json json_of_scan(const render::ShotTable& table) {
  return {{"shots", table.shots.size()}, {"file", table.file}, {"sha256", table.sha256}};
}

const char* name_of(render::ReturnMode mode) {
  constexpr const char* names[] = {"strongest", "last", "dual", "all"};
  return names[static_cast<size_t>(mode)];
}

Json json_of_receiver(const render::Receiver& receiver) {
  Json json = {{"aperture_m", receiver.aperture_diameter_m}, {"efficiency", receiver.system_efficiency}};
  if (receiver.detection) {
    json["noise_equivalent_power"] = receiver.detection->noise_equivalent_power;
    json["threshold"] = receiver.detection->threshold;
  }
  json["range_std_m"] = receiver.range_std_m;
  json["rise_m"] = receiver.rise_m;
  json["backscatter_per_m_sr"] = receiver.backscatter_per_m_sr;
  return json;
}

template <typename T>
Array column(const std::vector<T>& values) {
  return Array::of<T>({static_cast<int64_t>(values.size())}, values);
}

}  // namespace

double point_error_m(const LidarConfig& config) {
  if (config.point_step_m == 0.0) return 0.0;
  return std::sqrt(3.0) * (0.5 * config.point_step_m + std::ldexp(config.max_range_m, -23));
}

void round_points(render::LidarScan& scan, double step_m) {
  // Adding 0 makes -0 a 0, which is the only multiple of its kind.
  const auto rounded = [&](float value) {
    return static_cast<float>(step_m * std::nearbyint(value / step_m)) + 0.0f;
  };
  for (auto& point : scan.points) {
    point.x = rounded(point.x);
    point.y = rounded(point.y);
    point.z = rounded(point.z);
  }
}

std::vector<ArraySpec> lidar_arrays(const LidarConfig& config) {
  const ArraySpec points{"points",
                         DType::f32,
                         {-1, 4},
                         "m",
                         "[return, x y z intensity] in the sensor frame at the shot's own time",
                         config.point_step_m};
  if (!config.outputs.clouds()) return {points};
  return {
      points,
      {"ring", DType::u16, {-1}, "1", "[return] channel"},
      {"time_offset", DType::f32, {-1}, "s", "[return] of the shot after the tick"},
      {"range", DType::f32, {-1}, "m", "[return] along the beam"},
      {"power", DType::f32, {-1}, "1", "[return] received over transmitted power"},
      {"share", DType::f32, {-1}, "1", "[return] of the beam's energy that goes no further"},
      {"return_number", DType::u16, {-1}, "1", "[return] 1: the nearest that the shot's receiver detected"},
      {"return_count", DType::u16, {-1}, "1", "[return] that the shot's receiver detected"},
      {"instance", DType::u32, {-1}, "1", "[return] index into instances + 1; 0: fog or rain"},
      {"material", DType::u32, {-1}, "1", "[return] index into materials + 1; 0: fog or rain"},
  };
}

std::vector<Array> arrays_of(const render::LidarScan& scan, const LidarConfig::Outputs& outputs) {
  const auto count = static_cast<int64_t>(scan.size());
  std::vector<Array> arrays;
  arrays.push_back(
      Array::of<float>({count, 4}, std::span(count > 0 ? &scan.points[0].x : nullptr, scan.size() * 4)));
  if (!outputs.clouds()) return arrays;
  arrays.push_back(column(scan.ring));
  arrays.push_back(column(scan.time_offset_s));
  arrays.push_back(column(scan.range_m));
  arrays.push_back(column(scan.power));
  arrays.push_back(column(scan.share));
  arrays.push_back(column(scan.return_number));
  arrays.push_back(column(scan.return_count));
  arrays.push_back(column(scan.instance));
  arrays.push_back(column(scan.material));
  return arrays;
}

Json lidar_metadata(const LidarConfig& config, const render::LidarDesc& desc) {
  Json metadata = std::visit([](const auto& scan) { return json_of_scan(scan); }, config.scan);
  constexpr const char* patterns[] = {"spinning", "raster", "rosette", "table"};
  metadata["pattern"] = patterns[config.scan.index()];
  metadata["min_range_m"] = desc.min_range_m;
  metadata["max_range_m"] = desc.max_range_m;
  metadata["wavelength_nm"] = desc.wavelength_nm;
  metadata["divergence_rad"] = desc.divergence;
  metadata["rings"] = desc.rings;
  metadata["returns"] = name_of(desc.returns.mode);
  metadata["range_resolution_m"] = desc.returns.resolution_m;
  metadata["receiver"] = json_of_receiver(desc.receiver);
  metadata["extinction_per_m"] = desc.receiver.extinction_per_m;
  if (config.point_step_m > 0.0) {
    metadata["point_step_m"] = config.point_step_m;
    metadata["point_error_m"] = point_error_m(config);
  }
  metadata["frame"] = "x forward, y left, z up";
  return metadata;
}

}  // namespace greatx::sim
