// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads tables of scattering (docs/targets.md).
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "rf/targets/rcs_table.h"

namespace greatx::sim {

/// The most directions, or pairs of directions, of a table.
inline constexpr size_t most_rcs_lines = 1u << 21;

/// Parses a table whose header is one of
///     theta_deg,phi_deg,rcs_dbsm
///     theta_deg,phi_deg,s_tt_re,s_tt_im,s_tp_re,s_tp_im,s_pp_re,s_pp_im
///     theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,rcs_dbsm
///     theta_in_deg,phi_in_deg,theta_out_deg,phi_out_deg,s_tt_re,...,s_tp,s_pt,s_pp_im
/// Directions point away from the target, in its frame. Zeniths go from 0 to 180 and azimuths once around,
/// both in even steps, and every combination occurs once. A cross-section stands for both polarizations, with
/// phase 0 and nothing between them. `name` stands for the file in messages. Throws UserError "file:line:
/// ..." for anything else, with the direction that is missing.
std::shared_ptr<const rf::RcsTable> parse_rcs_csv(std::string_view text, const std::string& name);
std::shared_ptr<const rf::RcsTable> load_rcs_csv(const std::filesystem::path& file);

}  // namespace greatx::sim
