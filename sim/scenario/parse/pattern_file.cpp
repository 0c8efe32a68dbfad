// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/pattern_file.h"

#include "sim/scenario/parse/csv.h"
#include "sim/scenario/parse/pattern_csv.h"

namespace greatx::sim {

PatternFormat pattern_format(const std::filesystem::path& file) {
  const std::string ending = lower_case(file.extension().string());
  if (ending == ".msi" || ending == ".pln") return PatternFormat::msi;
  return ending == ".ffd" ? PatternFormat::ffd : PatternFormat::csv;
}

rf::PatternTable load_pattern_file(const std::filesystem::path& file, const PatternOptions& options) {
  switch (pattern_format(file)) {
    case PatternFormat::msi:
      return parse_pattern_msi(read_csv_file(file, "an antenna pattern (MSI Planet)"), file.string(),
                               options);
    case PatternFormat::ffd:
      return parse_pattern_ffd(read_csv_file(file, "an antenna pattern (HFSS far field)"), file.string(),
                               options);
    case PatternFormat::csv:
      break;
  }
  return load_pattern_csv(file);
}

}  // namespace greatx::sim
