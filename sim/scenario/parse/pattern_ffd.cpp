// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/ranges.h>

#include "core/hash.h"
#include "core/units.h"
#include "rf/antenna/pattern_cuts.h"
#include "sim/scenario/parse/pattern_file.h"
#include "sim/scenario/parse/words.h"

namespace greatx::sim {
namespace {

constexpr size_t most_ffd_samples = 1u << 22;
constexpr size_t most_ffd_blocks = 100'000;
constexpr double ffd_angle_tolerance_deg = 1e-6;
/// Fractions of the largest amplitude, as for CSV: where the first meridian occurs again, and at a pole.
constexpr double ffd_seam_tolerance = 1e-3, ffd_pole_tolerance = 0.1;
constexpr double frequency_tolerance = 1e-6;
/// The radiated power may exceed the power that makes it by so much: solvers are no more accurate.
constexpr double power_tolerance = 0.02;
constexpr double vacuum_impedance = 1.0 / (vacuum_permittivity * speed_of_light);

/// Describes the steps of an angle.
struct FfdRange {
  double start_deg = 0.0, stop_deg = 0.0;
  size_t count = 0;
};

class FfdParser {
 public:
  FfdParser(std::string_view text, const std::string& name, const PatternOptions& options)
      : text_(text), name_(name), options_(options), reader_(text, name, " \t,;") {}
  rf::PatternTable parse();

 private:
  CsvLine line(const std::string& expected);
  static double number(const CsvLine& line, size_t cell, const char* field);
  FfdRange range(const char* field);
  void read_theta();
  void read_phi();
  /// Reads the blocks; keeps the rows of the one that the options choose.
  void read_blocks(const CsvLine& head);
  void read_rows(std::optional<CsvLine> first, bool keep);
  /// Refuses rows in which one direction has two values, and returns the largest amplitude.
  double check_directions() const;
  void end();
  rf::PatternTable table() const;
  double amplitude(size_t row) const {
    return std::hypot(std::abs(rows_[row].theta), std::abs(rows_[row].phi));
  }

  std::string_view text_;
  const std::string& name_;
  const PatternOptions& options_;
  WordReader reader_;
  bool downwards_ = true;    ///< theta from 0 to 180
  bool phi_closed_ = false;  ///< the last azimuth is the first one again
  size_t thetas_ = 0, phis_ = 0;
  double first_phi_deg_ = 0.0;
  std::vector<rf::Jones> rows_;  ///< [thetas, phis], r E in V
  std::vector<int> lines_;
};

CsvLine FfdParser::line(const std::string& expected) {
  if (std::optional<CsvLine> line = reader_.next()) return *line;
  throw_user_error("{}:{}: expected {}, found the end of the file", name_, reader_.line(), expected);
}

double FfdParser::number(const CsvLine& line, size_t cell, const char* field) {
  const std::optional<double> value = csv_number(line.cells[cell].text);
  if (!value || !std::isfinite(*value))
    line.fail(cell, fmt::format("{}: expected a finite number, found '{}'", field, line.cells[cell].text));
  return *value;
}

FfdRange FfdParser::range(const char* field) {
  const CsvLine head = line(fmt::format("{} as 'start stop count'", field));
  if (head.cells.size() != 3)
    head.fail(0, fmt::format("{}: expected 'start stop count', found {} words", field, head.cells.size()));
  const double count = number(head, 2, field);
  if (!(count >= 3.0 && count <= most_ffd_samples) || count != std::floor(count))
    head.fail(2, fmt::format("{}: expected 3 angles or more, found {}", field, head.cells[2].text));
  return {number(head, 0, field), number(head, 1, field), static_cast<size_t>(count)};
}

void FfdParser::read_theta() {
  const FfdRange theta = range("theta");
  const auto is = [&](double start, double stop) {
    return std::abs(theta.start_deg - start) <= ffd_angle_tolerance_deg &&
           std::abs(theta.stop_deg - stop) <= ffd_angle_tolerance_deg;
  };
  downwards_ = is(0.0, 180.0);
  if (!downwards_ && !is(180.0, 0.0))
    throw_user_error("{}:{}: theta: expected 0 to 180 degrees or 180 to 0, found {} to {}", name_,
                     reader_.line(), theta.start_deg, theta.stop_deg);
  thetas_ = theta.count;
}

void FfdParser::read_phi() {
  const FfdRange phi = range("phi");
  const double span = phi.stop_deg - phi.start_deg, step = span / (static_cast<double>(phi.count) - 1.0);
  phi_closed_ = std::abs(span - 360.0) <= ffd_angle_tolerance_deg;
  if (!phi_closed_ && !(std::abs(span + step - 360.0) <= 1e-3 * std::abs(step)))
    throw_user_error("{}:{}: phi: expected azimuths once around (360 degrees), found {} from {} to {}", name_,
                     reader_.line(), phi.count, phi.start_deg, phi.stop_deg);
  phis_ = phi.count;
  first_phi_deg_ = phi.start_deg;
  if (phis_ - phi_closed_ < 4)
    throw_user_error("{}:{}: phi: expected 4 azimuths or more, found {}", name_, reader_.line(),
                     phis_ - phi_closed_);
  if (thetas_ * phis_ > most_ffd_samples)
    throw_user_error("{}:{}: phi: expected at most {} directions, found {} by {}", name_, reader_.line(),
                     most_ffd_samples, thetas_, phis_);
}

void FfdParser::read_rows(std::optional<CsvLine> first, bool keep) {
  constexpr std::array<const char*, 4> fields{"E_theta_re", "E_theta_im", "E_phi_re", "E_phi_im"};
  for (size_t n = 0; n < thetas_ * phis_; ++n) {
    const CsvLine row = first ? *first : line(fmt::format("row {} of {}", n + 1, thetas_ * phis_));
    first.reset();
    if (row.cells.size() != 4 || !csv_number(row.cells[0].text))
      row.fail(0, fmt::format("expected row {} of {}, 4 numbers ({}), found '{}' and {} words", n + 1,
                              thetas_ * phis_, fmt::join(fields, ", "), row.cells[0].text, row.cells.size()));
    if (!keep) continue;
    std::array<double, 4> values{};
    for (size_t k = 0; k < 4; ++k) {
      values[k] = number(row, k, fields[k]);
      if (!(std::abs(values[k]) <= 1e15))
        row.fail(k, fmt::format("{}: expected at most 1e15 V, found {}", fields[k], row.cells[k].text));
    }
    rows_.push_back({{values[0], values[1]}, {values[2], values[3]}});
    lines_.push_back(row.number);
  }
}

void FfdParser::read_blocks(const CsvLine& head) {
  const double count = head.cells.size() == 2 ? number(head, 1, "Frequencies") : 0.0;
  if (!(count >= 1.0 && count <= most_ffd_blocks) || count != std::floor(count))
    head.fail(head.cells.size() - 1, fmt::format("Frequencies: expected their number, 1 to {}, found '{}'",
                                                 most_ffd_blocks, head.cells.back().text));
  std::vector<double> frequencies;
  for (size_t n = 0; n < static_cast<size_t>(count); ++n) {
    const CsvLine block = line(fmt::format("'Frequency' {} of {}", n + 1, count));
    if (block.cells.size() != 2 || lower_case(block.cells[0].text) != "frequency")
      block.fail(0,
                 fmt::format("expected 'Frequency' {} of {}, found '{}'", n + 1, count, block.cells[0].text));
    const double frequency_hz = number(block, 1, "Frequency");
    if (!(frequency_hz > 0.0))
      block.fail(1, fmt::format("Frequency: expected a positive number, found {}", frequency_hz));
    frequencies.push_back(frequency_hz);
    const bool chosen = options_.frequency_hz ? std::abs(frequency_hz - *options_.frequency_hz) <=
                                                    frequency_tolerance * *options_.frequency_hz
                                              : count == 1.0;
    read_rows({}, chosen && rows_.empty());
  }
  if (!rows_.empty()) return;
  frequencies.resize(std::min<size_t>(frequencies.size(), 8));
  throw PatternOptionError(name_, "pattern_frequency_hz",
                           fmt::format("one of the file's {} frequencies ({}{})", count,
                                       fmt::join(frequencies, ", "), count > 8.0 ? ", ..." : ""),
                           options_.frequency_hz ? fmt::format("{}", *options_.frequency_hz) : "none");
}

double FfdParser::check_directions() const {
  double largest = 0.0;
  for (size_t row = 0; row < rows_.size(); ++row) largest = std::max(largest, amplitude(row));
  if (!(largest > 0.0)) throw_user_error("{}:{}: expected a field somewhere, found none", name_, lines_[0]);
  for (size_t row = 0; row < rows_.size(); ++row) {
    const size_t first = row - row % phis_;
    const rf::Jones &a = rows_[first], &b = rows_[row];
    const double apart = std::abs(a.theta - b.theta) + std::abs(a.phi - b.phi);
    if (phi_closed_ && row == first + phis_ - 1 && apart > ffd_seam_tolerance * largest)
      throw_user_error("{}:{}: expected the field of line {} again, 360 degrees later, found another one",
                       name_, lines_[row], lines_[first]);
    const bool pole = first == 0 || first == rows_.size() - phis_;
    if (pole && std::abs(amplitude(row) - amplitude(first)) > ffd_pole_tolerance * largest)
      throw_user_error(
          "{}:{}: expected the strength of line {} at a pole, which is one direction, found "
          "{:.4g} V beside {:.4g} V",
          name_, lines_[row], lines_[first], amplitude(row), amplitude(first));
  }
  return largest;
}

void FfdParser::end() {
  if (const std::optional<CsvLine> more = reader_.next())
    more->fail(0, fmt::format("expected the end of the file, found '{}'", more->cells[0].text));
}

rf::PatternTable FfdParser::table() const {
  // U = |r E|^2/(2 Z0) is the power per solid angle of a field of peak values; the gain is 4 pi U/P (IEEE Std
  // 145). The scale is taken out of the fields first, so that squares stay in range.
  const double largest = check_directions();
  const size_t kept = phis_ - phi_closed_;
  std::vector<rf::Jones> samples;
  samples.reserve(thetas_ * kept);
  for (size_t i = 0; i < thetas_; ++i)
    for (size_t j = 0; j < kept; ++j) {
      const rf::Jones& field = rows_[(downwards_ ? i : thetas_ - 1 - i) * phis_ + j];
      samples.push_back({field.theta / largest, field.phi / largest});
    }
  const rf::PatternTable::Grid grid{static_cast<uint32_t>(thetas_), static_cast<uint32_t>(kept),
                                    radians(first_phi_deg_)};
  const double mean = rf::mean_gain(rf::PatternTable(grid, samples));
  double scale = 1.0 / std::sqrt(mean);  // of a directivity
  if (options_.power_w) {
    const double largest_gain = 4.0 * pi * largest / *options_.power_w * largest / (2.0 * vacuum_impedance);
    if (!(largest_gain * mean <= 1.0 + power_tolerance))
      throw PatternOptionError(name_, "pattern_power_w",
                               fmt::format("the power that makes the fields, which radiate {:.6g} W",
                                           largest_gain * mean * *options_.power_w),
                               fmt::format("{:.6g} W", *options_.power_w));
    scale = std::sqrt(largest_gain);
  }
  for (rf::Jones& sample : samples) sample = {sample.theta * scale, sample.phi * scale};
  const std::string choice =
      fmt::format("\n{}\n{}", options_.frequency_hz.value_or(0.0), options_.power_w.value_or(0.0));
  return rf::PatternTable(grid, std::move(samples), std::filesystem::path(name_).filename().string(),
                          Sha256().update(text_).update(choice).hex());
}

rf::PatternTable FfdParser::parse() {
  read_theta();
  read_phi();
  const CsvLine head = line("'Frequencies' or a row of fields");
  if (lower_case(head.cells[0].text) == "frequencies") {
    read_blocks(head);
  } else {
    if (options_.frequency_hz)
      throw PatternOptionError(name_, "pattern_frequency_hz", "no frequency, since the file names none",
                               fmt::format("{}", *options_.frequency_hz));
    read_rows(head, true);
  }
  end();
  return table();
}

}  // namespace

rf::PatternTable parse_pattern_ffd(std::string_view text, const std::string& name,
                                   const PatternOptions& options) {
  return FfdParser(text, name, options).parse();
}

}  // namespace greatx::sim
