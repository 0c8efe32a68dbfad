// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Formats paths as tables, JSON and CSV, receiver by receiver, so that the memory does not grow with the
// number of receivers.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "draw/paths/facts.h"

namespace greatx::apps {

/// Returns a table: one line about the receiver, then one line for each path, with units in the heads of the
/// columns.
std::string table_of(const PathLink& link, const PathScene& scene);
/// Returns the head of the table with one line for each receiver.
std::string brief_head();
/// Returns a line of that table.
std::string brief_row(const PathLink& link, double carrier_hz);

/// Returns everything about a receiver: the figures of the link and all its paths. Positions are in world
/// coordinates, values in SI units, angles in radians. If the scene has a georeference, the ends also have
/// latitude, longitude in degrees and height above the ellipsoid.
nlohmann::ordered_json json_of(const PathLink& link, const PathScene& scene);

/// Returns the header line of the compact CSV:
/// receiver,x_m,y_m,z_m,distance_m,paths,line_of_sight,path_gain_db,first_delay_ns,delay_spread_ns, and for a
/// scene with a georeference latitude_deg,longitude_deg,height_m (above the ellipsoid).
std::string csv_head(const PathScene& scene);
/// Returns the line of a receiver. Cells that have no meaning without a path are empty.
std::string csv_row(const PathLink& link, const PathScene& scene);

}  // namespace greatx::apps
