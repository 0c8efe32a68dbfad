// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Finds the directions and times of a LiDAR's shots: it turns the parameters of a scanner into a list of
// shots (docs/lidar.md).
//
//   SpinningScan | RasterScan | RosetteScan | ShotTable ─► ScanPattern ─► LidarPass
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "core/units.h"
#include "core/vec.h"

namespace greatx::render {

/// Holds the shots of a sweep, in the order fired. The sensor frame has x forward, y left, z up; azimuth
/// counts from x towards y, elevation above the x-y plane. The shots of one column stand beside those of the
/// next on the sphere, which makes tracing quick.
struct ScanPattern {
  uint32_t columns = 0, rows = 1;
  std::vector<dvec3> directions;   ///< [columns * rows] unit, row by row within a column
  std::vector<uint16_t> rings;     ///< [columns * rows] channel
  std::vector<uint32_t> instants;  ///< [columns * rows] index into times_s
  std::vector<double> times_s;     ///< after the tick, each once, ascending
  size_t size() const { return directions.size(); }
};

inline constexpr uint32_t most_shots = 1u << 22;   ///< most shots of a sweep
inline constexpr uint32_t most_columns = 500'000;  ///< fits the groups of a dispatch that every device takes
inline constexpr uint32_t most_channels = 65'535;

/// Describes a spinning scanner. All channels fire together. Step k looks at azimuth_start + k * azimuth_span
/// / azimuth_steps, k * sweep_s / azimuth_steps after the tick (sweep_s 0: all at the tick).
struct SpinningScan {
  std::vector<double> elevations;  ///< rad, one a channel; the ring number is the index
  uint32_t azimuth_steps = 1024;
  double azimuth_start = 0.0, azimuth_span = 2.0 * pi;  ///< rad; left is positive
  double sweep_s = 0.0;
};

/// Describes a scanner that fires line by line (rings), each shot by itself, evenly in angle, both ends
/// included. Shot i fires i * sweep_s / (columns * rows) after the tick. If `alternate`, every second line
/// goes backwards, as with a mirror that swings to and fro.
struct RasterScan {
  uint32_t columns = 1, rows = 1;
  double azimuth_first = 0.0, azimuth_last = 0.0;      ///< rad
  double elevation_first = 0.0, elevation_last = 0.0;  ///< rad
  bool alternate = false;
  double sweep_s = 0.0;
};

/// Describes a Risley pair: two prisms one behind the other that turn at rates of their own, each of which
/// deflects the beam by a constant angle. To first order in the angles the deflections add as vectors, v(t) =
/// sum of d_i (cos, sin)(2 pi f_i t + phase_i). The beam leaves |v| off the x axis, towards (y, z) = v / |v|
/// (G. F. Marshall, "Risley prism scan patterns", Proc. SPIE 3787 (1999), pp. 74-86; the exact refraction at
/// the four faces and the figures of a device: R. G. Brazeal, B. E. Wilkinson, H. H. Hochmair, Sensors 21
/// (2021), 4722). Rates of opposite sign give rosettes. t is the time since the sequence began, so that the
/// pattern does not repeat from sweep to sweep.
struct RosetteScan {
  uint32_t shots = 10'000;                               ///< shots of a sweep, evenly over sweep_s
  double deflections[2] = {radians(9.6), radians(9.6)};  ///< rad
  double rotations_hz[2] = {120.0, -77.0};
  double phases[2] = {0.0, 0.0};  ///< rad
  double sweep_s = 0.0;
};

/// Describes a shot of a table. The shots may be any, in the order fired.
struct TableShot {
  double time_s = 0.0;                    ///< after the tick; not before that of the shot before
  double azimuth = 0.0, elevation = 0.0;  ///< rad
  uint16_t channel = 0;
};
struct ShotTable {
  std::vector<TableShot> shots;
  std::string file;    ///< as named by the user
  std::string sha256;  ///< SHA-256 of its text
};

using Scan = std::variant<SpinningScan, RasterScan, RosetteScan, ShotTable>;

/// Returns the shots of a sweep that begins `start_s` after the start of the sequence (which matters only
/// to rosettes). Throws ContractError for scans that are empty or beyond the limits above.
ScanPattern scan_pattern(const Scan& scan, double start_s = 0.0);
/// Returns whether every sweep has the same shots.
bool repeats(const Scan& scan);
/// Returns the last shot's time after the tick.
double duration_s(const Scan& scan);

/// Returns the unit vector of an azimuth and an elevation.
dvec3 beam_direction(double azimuth, double elevation);

}  // namespace greatx::render
