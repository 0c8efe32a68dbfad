// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Paths as tables, JSON and CSV. All of it comes receiver by receiver, so that thousands need no memory.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "draw/paths/facts.h"

namespace greatx::apps {

/// One line about a receiver, then one line a path, with units in the heads of the columns.
std::string table_of(const PathLink& link, const PathScene& scene);
/// The heads of the table with one line a receiver, and its lines.
std::string brief_head();
std::string brief_row(const PathLink& link, double carrier_hz);

/// Everything about a receiver: figures of the link and all paths; positions in world coordinates, SI units,
/// radians.
nlohmann::ordered_json json_of(const PathLink& link, const PathScene& scene);

/// The compact form:
/// receiver,x_m,y_m,z_m,distance_m,paths,line_of_sight,path_gain_db,first_delay_ns,delay_spread_ns. Cells
/// that mean nothing without a path are empty.
std::string csv_head();
std::string csv_row(const PathLink& link, double carrier_hz);

}  // namespace greatx::apps
