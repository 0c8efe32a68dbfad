// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads CSV tables of places on the Earth. Their columns are found by the names in the header line, as
// receivers of satellite navigation and programs for GPX and NMEA write them, and have any order.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/earth_positions.h"

namespace greatx::sim {

enum class PlaceColumn : size_t {
  latitude,   ///< lat, latitude
  longitude,  ///< lon, lng, long, longitude
  height,     ///< ele, elevation, alt, altitude, height
  time,       ///< t, time, timestamp, utc
  yaw,        ///< yaw_deg
  pitch,      ///< pitch_deg
  roll,       ///< roll_deg
};

class PlaceTable {
 public:
  /// Whether the line names a latitude or a longitude, so that the table has places on the Earth.
  static bool begins(const CsvLine& line);
  /// Takes the header. Throws UserError if a required column is missing, or if a name occurs twice or is
  /// neither that of a required column nor that of an optional one. Of the optional columns all are there or
  /// none.
  PlaceTable(const CsvLine& header, std::span<const PlaceColumn> required,
             std::span<const PlaceColumn> optional = {});

  bool has(PlaceColumn column) const { return cells_[static_cast<size_t>(column)].has_value(); }
  /// Returns the number of the column's cell in each line.
  size_t cell(PlaceColumn column) const { return *cells_[static_cast<size_t>(column)]; }
  /// Throws UserError unless the line has a cell for each column.
  void check(const CsvLine& line) const;
  /// Returns a finite number from -most to most. Throws UserError for anything else.
  double number(const CsvLine& line, PlaceColumn column, double most) const;
  dvec3 position(const CsvLine& line, const EarthPositions& earth) const;
  /// Throws UserError "file:line:column: NAME: expected ..., found ...".
  [[noreturn]] void fail(const CsvLine& line, PlaceColumn column, const std::string& expected,
                         const std::string& found) const;

 private:
  size_t width_ = 0;
  std::array<std::optional<size_t>, 7> cells_;
};

}  // namespace greatx::sim
