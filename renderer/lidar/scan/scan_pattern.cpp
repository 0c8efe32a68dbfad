// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "renderer/lidar/scan/scan_pattern.h"

#include <cmath>

#include "core/error.h"

namespace greatx::render {

namespace {

ScanPattern empty_pattern(uint64_t columns, uint64_t rows) {
  GREATX_CHECK(columns >= 1 && columns <= most_columns, "{} columns of shots", columns);
  GREATX_CHECK(rows >= 1 && rows <= most_channels, "{} channels", rows);
  GREATX_CHECK(columns * rows <= most_shots, "{} x {} shots", columns, rows);
  ScanPattern pattern;
  pattern.columns = static_cast<uint32_t>(columns);
  pattern.rows = static_cast<uint32_t>(rows);
  pattern.directions.reserve(columns * rows);
  pattern.rings.reserve(columns * rows);
  pattern.instants.reserve(columns * rows);
  return pattern;
}

/// Returns the index of a time that is not before those added so far.
uint32_t instant_of(ScanPattern& pattern, double time_s) {
  if (pattern.times_s.empty() || time_s > pattern.times_s.back()) pattern.times_s.push_back(time_s);
  return static_cast<uint32_t>(pattern.times_s.size() - 1);
}

void add(ScanPattern& pattern, const dvec3& direction, uint32_t ring, double time_s) {
  pattern.directions.push_back(direction);
  pattern.rings.push_back(static_cast<uint16_t>(ring));
  pattern.instants.push_back(instant_of(pattern, time_s));
}

ScanPattern pattern_of(const SpinningScan& scan) {
  ScanPattern pattern = empty_pattern(scan.azimuth_steps, scan.elevations.size());
  for (uint32_t step = 0; step < scan.azimuth_steps; ++step) {
    const double azimuth = scan.azimuth_start + step * scan.azimuth_span / scan.azimuth_steps;
    const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
    for (uint32_t channel = 0; channel < pattern.rows; ++channel) {
      const double level = std::cos(scan.elevations[channel]);
      add(pattern, {level * cosine, level * sine, std::sin(scan.elevations[channel])}, channel,
          step * scan.sweep_s / scan.azimuth_steps);
    }
  }
  return pattern;
}

double between(double first, double last, uint32_t i, uint32_t count) {
  return count == 1 ? first : first + (last - first) * i / (count - 1);
}

ScanPattern pattern_of(const RasterScan& scan) {
  const uint64_t shots = uint64_t{scan.columns} * scan.rows;
  GREATX_CHECK(scan.rows <= most_channels, "{} lines", scan.rows);
  ScanPattern pattern = empty_pattern(shots, 1);
  for (uint32_t row = 0; row < scan.rows; ++row) {
    for (uint32_t i = 0; i < scan.columns; ++i) {
      const uint32_t column = scan.alternate && row % 2 == 1 ? scan.columns - 1 - i : i;
      const double azimuth = between(scan.azimuth_first, scan.azimuth_last, column, scan.columns),
                   elevation = between(scan.elevation_first, scan.elevation_last, row, scan.rows);
      add(pattern, beam_direction(azimuth, elevation), row,
          static_cast<double>(pattern.size()) * scan.sweep_s / static_cast<double>(shots));
    }
  }
  return pattern;
}

/// Returns 2 pi times the fraction of `turns`, which is exact however long a run is.
double angle_of(double turns) { return 2.0 * pi * (turns - std::floor(turns)); }

ScanPattern pattern_of(const RosetteScan& scan, double start_s) {
  ScanPattern pattern = empty_pattern(scan.shots, 1);
  for (uint32_t shot = 0; shot < scan.shots; ++shot) {
    const double offset_s = shot * scan.sweep_s / scan.shots;
    dvec2 v(0.0);
    for (int i = 0; i < 2; ++i) {
      const double angle = angle_of(scan.rotations_hz[i] * (start_s + offset_s)) + scan.phases[i];
      v += scan.deflections[i] * dvec2(std::cos(angle), std::sin(angle));
    }
    const double off_axis = std::hypot(v.x, v.y);
    const dvec2 side = off_axis > 0.0 ? std::sin(off_axis) / off_axis * v : dvec2(0.0);
    add(pattern, {std::cos(off_axis), side.x, side.y}, 0, offset_s);
  }
  return pattern;
}

ScanPattern pattern_of(const ShotTable& table) {
  ScanPattern pattern = empty_pattern(table.shots.size(), 1);
  double before_s = 0.0;
  for (const TableShot& shot : table.shots) {
    GREATX_CHECK(shot.time_s >= before_s, "a shot at {} s after one at {} s", shot.time_s, before_s);
    before_s = shot.time_s;
    add(pattern, beam_direction(shot.azimuth, shot.elevation), shot.channel, shot.time_s);
  }
  return pattern;
}

}  // namespace

dvec3 beam_direction(double azimuth, double elevation) {
  const double level = std::cos(elevation);
  return {level * std::cos(azimuth), level * std::sin(azimuth), std::sin(elevation)};
}

ScanPattern scan_pattern(const Scan& scan, double start_s) {
  if (const auto* spinning = std::get_if<SpinningScan>(&scan)) return pattern_of(*spinning);
  if (const auto* raster = std::get_if<RasterScan>(&scan)) return pattern_of(*raster);
  if (const auto* rosette = std::get_if<RosetteScan>(&scan)) return pattern_of(*rosette, start_s);
  return pattern_of(std::get<ShotTable>(scan));
}

bool repeats(const Scan& scan) { return !std::holds_alternative<RosetteScan>(scan); }

double duration_s(const Scan& scan) {
  if (const auto* table = std::get_if<ShotTable>(&scan))
    return table->shots.empty() ? 0.0 : table->shots.back().time_s;
  return std::visit(
      [](const auto& s) {
        if constexpr (requires { s.sweep_s; })
          return s.sweep_s;
        else
          return 0.0;
      },
      scan);
}

}  // namespace greatx::render
