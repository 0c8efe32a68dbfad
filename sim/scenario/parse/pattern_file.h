// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Reads field patterns of antenna elements from the files of vendors and of field solvers (docs/scenario.md,
// "Imported patterns").
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "rf/antenna/pattern_table.h"

namespace greatx::sim {

enum class PatternFormat { csv, msi, ffd };
/// Returns the format by the ending of the name: .msi and .pln, .ffd, or CSV for anything else.
PatternFormat pattern_format(const std::filesystem::path& file);

/// Says what a pattern file leaves open.
struct PatternOptions {
  std::optional<double> frequency_hz;  ///< .ffd: the block that is read, to 1e-6 of the frequency
  /// .ffd: the power that makes the fields, W: incident power gives the realized gain, accepted power the
  /// gain. Without it the fields are scaled to a mean gain of 1: the gain is the directivity.
  std::optional<double> power_w;
  bool vertical_up = false;  ///< .msi: angles of the vertical cut grow upwards
  auto operator<=>(const PatternOptions&) const = default;
};

/// Reports an option that the file contradicts. `key` is its key in a scenario.
struct PatternOptionError : UserError {
  PatternOptionError(const std::string& file, std::string option, std::string what_expected,
                     std::string what_found)
      : UserError(fmt::format("{}: {}: expected {}, found {}", file, option, what_expected, what_found)),
        key(std::move(option)),
        expected(std::move(what_expected)),
        found(std::move(what_found)) {}
  std::string key, expected, found;
};

/// Reads a pattern of any format. Throws PatternOptionError, or UserError "file:line:column: expected ...,
/// found ...".
rf::PatternTable load_pattern_file(const std::filesystem::path& file, const PatternOptions& options);

/// Reads the format of MSI Planet: lines "KEY value" with GAIN (dBd, unless it says dBi), HORIZONTAL n and
/// VERTICAL n with n lines "angle attenuation" each. Horizontal angles are clockwise seen from above. See
/// rf::pattern_of_cuts() for the sphere. `name` stands for the file in messages, and in the table without its
/// folder.
rf::PatternTable parse_pattern_msi(std::string_view text, const std::string& name,
                                   const PatternOptions& options);

/// Reads the far field of Ansys HFSS: "start stop count" of theta and of phi in degrees; if the far field
/// depends on frequency, "Frequencies n" and for each of them "Frequency f"; then lines with the real and the
/// imaginary part of r E_theta and of r E_phi in V (peak values, e^{+j w t}), phi the fastest.
rf::PatternTable parse_pattern_ffd(std::string_view text, const std::string& name,
                                   const PatternOptions& options);

}  // namespace greatx::sim
