// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads field patterns of antenna elements from CSV (docs/scenario.md, "Imported patterns").
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "rf/antenna/pattern_table.h"

namespace greatx::sim {

/// Reads a pattern in one of two forms. The header line, which must be there, tells them apart:
///   theta_deg,phi_deg,gain_dbi                                 F_theta = sqrt of the gain, F_phi = 0;
///                                                              -inf: none
///   theta_deg,phi_deg,f_theta_re,f_theta_im,f_phi_re,f_phi_im  amplitude gains, |F|^2 = power gain
/// Each line is a sample, in any order: zeniths from 0 to 180 and azimuths once around, each in even steps,
/// with every pair of them once. The azimuth 360 degrees after the first may be there as well, with the same
/// values. Throws UserError "file:line:column: expected ..., found ..." for everything else: gaps, doubles,
/// numbers that are not finite, uneven steps, less than the whole sphere, and poles with several strengths.
/// Strengths at a pole differ if they are more than a tenth of the largest amplitude apart. That is far more
/// than measurements scatter, and means that columns are mixed up, or that zenith is taken for elevation.
rf::PatternTable load_pattern_csv(const std::filesystem::path& file);
/// Does the same from text; `name` stands for the file in messages, and in the table without its folder.
rf::PatternTable parse_pattern_csv(std::string_view text, const std::string& name);

}  // namespace greatx::sim
