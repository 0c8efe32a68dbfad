// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "rf/antenna/pattern_cuts.h"
#include "sim/scenario/parse/pattern_file.h"
#include "sim/scenario/parse/words.h"

namespace greatx::sim {
namespace {

constexpr double dipole_gain_dbi = 2.15;      ///< dBd are above the gain of a half-wave dipole
constexpr double most_attenuation_db = 1000;  ///< a null
constexpr double most_gain_dbi = 100;
constexpr size_t most_cut_values = 3600;
constexpr double cut_angle_tolerance = 0.01;  ///< of a step; angles are often written with few digits

class MsiParser {
 public:
  MsiParser(std::string_view text, const std::string& name) : reader_(text, name, " \t"), name_(name) {}
  /// Returns the cuts as the file has them: horizontal angles clockwise.
  rf::PatternCuts parse();

 private:
  static double value_of(const CsvLine& line, size_t cell, const char* field);
  void read_gain(const CsvLine& line);
  /// Reads the lines of a cut, which may stand in any order.
  std::vector<double> read_cut(const CsvLine& head, const char* field, size_t multiple);

  WordReader reader_;
  const std::string& name_;
  std::optional<double> gain_dbi_;
};

double MsiParser::value_of(const CsvLine& line, size_t cell, const char* field) {
  const std::optional<double> value = csv_number(line.cells[cell].text);
  if (!value || !std::isfinite(*value))
    line.fail(cell, fmt::format("{}: expected a finite number, found '{}'", field, line.cells[cell].text));
  return *value;
}

void MsiParser::read_gain(const CsvLine& line) {
  if (gain_dbi_) line.fail(0, "GAIN: expected one gain, found a second one");
  if (line.cells.size() < 2) line.fail(0, "GAIN: expected a number, found nothing");
  // The unit may follow without a blank: 15.5dBi.
  const std::string_view word = line.cells[1].text;
  const size_t unit_at = std::min(word.find_first_of("dD"), word.size());
  const std::optional<double> number = csv_number(word.substr(0, unit_at));
  if (!number || !std::isfinite(*number) || std::abs(*number) > most_gain_dbi)
    line.fail(1, fmt::format("GAIN: expected a number from -100 to 100, found '{}'", word));
  std::string unit = lower_case(word.substr(unit_at));
  if (unit.empty() && line.cells.size() > 2) unit = lower_case(line.cells[2].text);
  if (!unit.empty() && unit != "dbd" && unit != "dbi")
    line.fail(std::min<size_t>(2, line.cells.size() - 1),
              fmt::format("GAIN: expected dBd or dBi (none: dBd), found '{}'", unit));
  gain_dbi_ = *number + (unit == "dbi" ? 0.0 : dipole_gain_dbi);
}

std::vector<double> MsiParser::read_cut(const CsvLine& head, const char* field, size_t multiple) {
  const std::optional<double> count =
      head.cells.size() == 2 ? csv_number(head.cells[1].text) : std::optional<double>();
  if (!count || !(*count >= 4.0 && *count <= most_cut_values) || std::fmod(*count, double(multiple)) != 0.0)
    head.fail(head.cells.size() - 1,
              fmt::format("{}: expected the number of its values, {} from 4 to {}, found '{}'", field,
                          multiple == 1 ? "an integer" : "a multiple of 4", most_cut_values,
                          head.cells.back().text));
  const auto size = static_cast<size_t>(*count);
  std::vector<double> values(size);
  std::vector<int> lines(size, 0);
  for (size_t n = 0; n < size; ++n) {
    const std::optional<CsvLine> line = reader_.next();
    if (!line)
      throw_user_error("{}:{}: {}: expected {} lines 'angle attenuation', found {}", name_, reader_.line(),
                       field, size, n);
    if (line->cells.size() != 2 || !csv_number(line->cells[0].text))
      line->fail(0, fmt::format("{}: expected line {} of {}, 'angle attenuation', found '{}{}'", field, n + 1,
                                size, line->cells[0].text, line->cells.size() > 1 ? " ..." : ""));
    const double angle_deg = value_of(*line, 0, field), attenuation_db = value_of(*line, 1, field);
    if (!(std::abs(angle_deg) <= 360.0))
      line->fail(0, fmt::format("{}: expected an angle from -360 to 360, found {}", field, angle_deg));
    if (!(attenuation_db >= 0.0 && attenuation_db <= most_attenuation_db))
      line->fail(1, fmt::format("{}: expected an attenuation from 0 to {} dB, found {}", field,
                                most_attenuation_db, attenuation_db));
    const double steps = angle_deg / 360.0 * *count, nearest = std::round(steps);
    if (std::abs(steps - nearest) > cut_angle_tolerance)
      line->fail(0, fmt::format("{}: expected a multiple of {:.6g} degrees, found {}", field, 360.0 / *count,
                                angle_deg));
    const auto at = static_cast<size_t>(std::fmod(nearest + *count, *count));
    if (lines[at] != 0)
      line->fail(0, fmt::format("{}: expected every angle once, found {} again (line {})", field, angle_deg,
                                lines[at]));
    lines[at] = line->number;
    values[at] = attenuation_db;
  }
  return values;
}

rf::PatternCuts MsiParser::parse() {
  rf::PatternCuts cuts;
  while (const std::optional<CsvLine> line = reader_.next()) {
    const std::string key = lower_case(line->cells[0].text);
    if (key == "gain") {
      read_gain(*line);
    } else if (key == "horizontal" || key == "vertical") {
      const bool vertical = key == "vertical";
      std::vector<double>& cut = vertical ? cuts.vertical_db : cuts.horizontal_db;
      const char* const field = vertical ? "VERTICAL" : "HORIZONTAL";
      if (!cut.empty()) line->fail(0, fmt::format("{}: expected one cut, found a second one", field));
      cut = read_cut(*line, field, vertical ? 4 : 1);
    } else if (line->number > 1 && csv_number(line->cells[0].text)) {
      line->fail(0, fmt::format("expected 'KEY value', found '{}'", line->cells[0].text));
    }
  }
  for (const auto& [missing, field] :
       {std::pair(!gain_dbi_, "GAIN"), std::pair(cuts.horizontal_db.empty(), "HORIZONTAL"),
        std::pair(cuts.vertical_db.empty(), "VERTICAL")})
    if (missing) throw_user_error("{}:{}: {}: expected a line, found none", name_, reader_.line(), field);
  cuts.gain_dbi = *gain_dbi_;
  return cuts;
}

}  // namespace

rf::PatternTable parse_pattern_msi(std::string_view text, const std::string& name,
                                   const PatternOptions& options) {
  rf::PatternCuts cuts = MsiParser(text, name).parse();
  std::reverse(cuts.horizontal_db.begin() + 1, cuts.horizontal_db.end());
  if (!options.vertical_up) std::reverse(cuts.vertical_db.begin() + 1, cuts.vertical_db.end());
  return rf::pattern_of_cuts(cuts, std::filesystem::path(name).filename().string(),
                             Sha256().update(text).update(options.vertical_up ? "\nup" : "\ndown").hex());
}

}  // namespace greatx::sim
