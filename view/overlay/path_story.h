// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// The answer to "why is this path there?": one path of a record, interaction by interaction, as a table and
// in words.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/record.h"
#include "view/overlay/path_records.h"
#include "view/overlay/record_tables.h"

namespace greatx::view {

/// One interaction of a path.
struct PathStop {
  rf::InteractionType type = rf::InteractionType::none;
  dvec3 at{0.0};       ///< world, m
  double leg_m = 0.0;  ///< of the leg that ends here
  std::string object, material;
  std::optional<uint32_t> facet, element;  ///< indices of the scene, where the record has them
  /// Of the incoming ray: from the surface's normal, rad; of a diffraction from the edge. What the record's
  /// points alone do not give (all but reflections) is there if the experiment is.
  std::optional<double> angle;
  /// Of this interaction alone, mean of both polarizations, dB. It follows from the material, so that it is
  /// there only if the experiment is. Diffraction and scattering have none: theirs depends on the distances.
  std::optional<double> loss_db;
  std::string more;  ///< of the surface or the edge, from the experiment; may be empty
};

struct PathStory {
  uint64_t row_id = 0;  ///< path_row_id()
  uint64_t id = 0;
  std::string chain, from, to;
  dvec3 start{0.0}, end{0.0};  ///< world, m
  std::vector<PathStop> stops;
  double last_leg_m = 0.0;
  double length_m = 0.0, delay_s = 0.0, doppler_hz = 0.0;
  double gain_db = 0.0;        ///< apps::path_gain()
  double free_space_db = 0.0;  ///< of a line of sight of the same length
  double wavelength_m = 0.0;
  dvec2 departure{0.0}, arrival{0.0};  ///< zenith, azimuth, rad, world axes
  std::optional<double> foliage_m;     ///< of its length inside foliage
};

/// The path of the record with this path_row_id(); none if the record has no such path, no paths at all, or
/// ends that the run does not place. Throws UserError if an array is not as docs/dataset.md has it.
std::optional<PathStory> path_story(const RecordTables& tables, const SensorSpec& spec, const Record& record,
                                    const NodePoses& poses, uint64_t row_id);

/// One line for the transmitter, for each interaction and for the receiver.
std::vector<std::string> words_of(const PathStory& story);

}  // namespace greatx::view
