// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "sim/scenario/parse/rcs_csv.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/ranges.h>

#include "core/budget.h"
#include "core/hash.h"
#include "core/units.h"
#include "sim/scenario/parse/csv.h"

namespace greatx::sim {
namespace {

constexpr double equal_angles_deg = 1e-6;  ///< angles that differ by less are equal
constexpr double even_step = 0.01;         ///< fraction of a step; angles are often written with few digits
constexpr double most_dbsm = 200.0, most_scatter_m = 1e10;
constexpr uint64_t most_grid = 1ull << 40;  ///< places that still have numbers

using Columns = std::span<const std::string_view>;
constexpr std::string_view monostatic_rcs[] = {"theta_deg", "phi_deg", "rcs_dbsm"};
constexpr std::string_view monostatic_field[] = {"theta_deg", "phi_deg", "s_tt_re", "s_tt_im",
                                                 "s_tp_re",   "s_tp_im", "s_pp_re", "s_pp_im"};
constexpr std::string_view bistatic_rcs[] = {"theta_in_deg", "phi_in_deg", "theta_out_deg", "phi_out_deg",
                                             "rcs_dbsm"};
constexpr std::string_view bistatic_field[] = {"theta_in_deg", "phi_in_deg", "theta_out_deg", "phi_out_deg",
                                               "s_tt_re",      "s_tt_im",    "s_tp_re",       "s_tp_im",
                                               "s_pt_re",      "s_pt_im",    "s_pp_re",       "s_pp_im"};
constexpr Columns rcs_headers[] = {monostatic_rcs, monostatic_field, bistatic_rcs, bistatic_field};

/// Holds a line: up to four angles, and the matrix.
struct RcsLine {
  std::array<double, 4> angles{};
  rf::ScatterMatrix matrix{};
  int line = 0;
};

/// Holds the values of one angle, ascending.
struct RcsAxis {
  std::vector<double> values;
  bool closed = false;  ///< the last azimuth is the first one again
  size_t kept() const { return values.size() - closed; }
  size_t index(double value) const {
    const auto at = std::lower_bound(values.begin(), values.end(), value - 2.0 * equal_angles_deg);
    return static_cast<size_t>(at - values.begin());
  }
};

class RcsParser {
 public:
  RcsParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  std::shared_ptr<const rf::RcsTable> parse();

 private:
  template <typename... Args>
  [[noreturn]] void fail(int line, fmt::format_string<Args...> format, Args&&... args) const {
    throw_user_error("{}:{}: {}", name_, line, fmt::format(format, std::forward<Args>(args)...));
  }
  size_t angles() const { return columns_.size() == 3 || columns_.size() == 8 ? 2 : 4; }
  bool of_rcs() const { return columns_.back() == "rcs_dbsm"; }
  void read_header(const CsvLine& line);
  RcsLine read(const CsvLine& line) const;
  rf::ScatterMatrix matrix_of(std::span<const double> values) const;
  int line_of(size_t angle, double value) const;
  RcsAxis axis(size_t angle) const;
  void check_zenith(size_t angle, const std::vector<double>& values) const;
  bool check_azimuth(size_t angle, const std::vector<double>& values) const;
  std::string describe(const std::vector<RcsAxis>& axes, uint64_t place) const;
  std::vector<const RcsLine*> grid(const std::vector<RcsAxis>& axes) const;
  std::vector<rf::ScatterMatrix> samples(const std::vector<RcsAxis>& axes) const;

  std::string_view text_;
  const std::string& name_;
  Columns columns_;
  int header_line_ = 1;
  std::vector<RcsLine> lines_;
};

void RcsParser::read_header(const CsvLine& line) {
  std::vector<std::string> names;
  for (const CsvCell& cell : line.cells) names.push_back(lower_case(cell.text));
  for (const Columns& columns : rcs_headers)
    if (std::equal(names.begin(), names.end(), columns.begin(), columns.end())) columns_ = columns;
  if (columns_.empty()) {
    std::vector<std::string> headers;
    for (const Columns& columns : rcs_headers)
      headers.push_back(fmt::format("'{}'", fmt::join(columns, ",")));
    line.fail(0, fmt::format("expected the header {}, found '{}'", fmt::join(headers, " or "),
                             fmt::join(names, ",")));
  }
  header_line_ = line.number;
}

rf::ScatterMatrix RcsParser::matrix_of(std::span<const double> values) const {
  if (of_rcs()) {
    const double amplitude = std::sqrt(std::pow(10.0, 0.1 * values[0]) / (4.0 * pi));
    return {amplitude, 0.0, 0.0, amplitude};
  }
  const auto entry = [&](size_t i) { return rf::Complex(values[2 * i], values[2 * i + 1]); };
  if (angles() == 2) return {entry(0), entry(1), entry(1), entry(2)};
  return {entry(0), entry(1), entry(2), entry(3)};
}

RcsLine RcsParser::read(const CsvLine& line) const {
  if (line.cells.size() != columns_.size())
    line.fail(line.cells.size() - 1, fmt::format("expected {} values ({}), found {}", columns_.size(),
                                                 fmt::join(columns_, ", "), line.cells.size()));
  std::vector<double> values;
  for (size_t i = 0; i < columns_.size(); ++i) {
    const std::string_view text = line.cells[i].text;
    const std::optional<double> value = csv_number(text);
    const bool nothing = of_rcs() && i + 1 == columns_.size() && value && *value < 0.0;  // -inf dBsm
    if (!value || !(std::isfinite(*value) || nothing))
      line.fail(i, fmt::format("{}: expected a finite number, found {}", columns_[i],
                               text.empty() ? "a gap" : fmt::format("'{}'", text)));
    const bool angle = i < angles();
    if (angle && i % 2 == 0 && !(*value >= 0.0 && *value <= 180.0))
      line.fail(i, fmt::format("{}: expected a zenith from 0 to 180 (0: up), found {}", columns_[i], *value));
    if (angle && i % 2 == 1 && !(std::abs(*value) <= 360.0))
      line.fail(i, fmt::format("{}: expected an azimuth from -360 to 360, found {}", columns_[i], *value));
    if (!angle && (of_rcs() ? *value > most_dbsm : std::abs(*value) > most_scatter_m))
      line.fail(
          i, of_rcs()
                 ? fmt::format("{}: expected at most {} dBsm, found {}", columns_[i], most_dbsm, *value)
                 : fmt::format("{}: expected at most {:g} m, found {}", columns_[i], most_scatter_m, *value));
    values.push_back(*value);
  }
  RcsLine result;
  std::copy_n(values.begin(), angles(), result.angles.begin());
  result.matrix = matrix_of(std::span(values).subspan(angles()));
  result.line = line.number;
  return result;
}

int RcsParser::line_of(size_t angle, double value) const {
  for (const RcsLine& line : lines_)
    if (std::abs(line.angles[angle] - value) <= equal_angles_deg) return line.line;
  return header_line_;
}

void RcsParser::check_zenith(size_t angle, const std::vector<double>& values) const {
  const bool low = values.front() > equal_angles_deg;
  if (low || values.back() < 180.0 - equal_angles_deg)
    fail(line_of(angle, low ? values.front() : values.back()),
         "{}: expected zeniths from 0 to 180, found them from {} to {}", columns_[angle], values.front(),
         values.back());
}

bool RcsParser::check_azimuth(size_t angle, const std::vector<double>& values) const {
  const double span = values.back() - values.front();
  const double step = values.size() > 1 ? span / (static_cast<double>(values.size()) - 1.0) : 360.0;
  const bool whole = values.size() > 1 && std::abs(span - 360.0) <= even_step * step;
  if (!whole && std::abs(span + step - 360.0) > even_step * step)
    fail(line_of(angle, values.back()),
         "{}: expected azimuths once around (360 degrees), found {} from {} to {}", columns_[angle],
         values.size(), values.front(), values.back());
  return whole;
}

RcsAxis RcsParser::axis(size_t angle) const {
  RcsAxis axis;
  std::vector<double>& values = axis.values;
  for (const RcsLine& line : lines_) values.push_back(line.angles[angle]);
  std::sort(values.begin(), values.end());
  values.erase(
      std::unique(values.begin(), values.end(), [](double a, double b) { return b - a <= equal_angles_deg; }),
      values.end());
  std::vector<double> gaps;
  for (size_t i = 1; i < values.size(); ++i) gaps.push_back(values[i] - values[i - 1]);
  if (!gaps.empty()) {
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    for (size_t i = 1; i < values.size(); ++i)
      if (std::abs(values[i] - values[i - 1] - *middle) > *middle * even_step)
        fail(line_of(angle, values[i]), "{}: expected even steps, {:.6g} after {:.6g}, found {:.6g}",
             columns_[angle], values[i - 1] + *middle, values[i - 1], values[i]);
  }
  if (angle % 2 == 0)
    check_zenith(angle, values);
  else
    axis.closed = check_azimuth(angle, values);
  return axis;
}

std::string RcsParser::describe(const std::vector<RcsAxis>& axes, uint64_t place) const {
  std::vector<std::string> parts(axes.size());
  for (size_t i = axes.size(); i-- > 0;) {
    const uint64_t size = axes[i].values.size();
    parts[i] = fmt::format("{} {:.6g}", columns_[i], axes[i].values[place % size]);
    place /= size;
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<const RcsLine*> RcsParser::grid(const std::vector<RcsAxis>& axes) const {
  // The lines are sorted by their place in the grid and not written into it, because a grid of many different
  // angles may have far more places than the file has lines.
  std::vector<uint64_t> sizes(4, 1);
  for (size_t i = 0; i < axes.size(); ++i) sizes[i] = axes[i].values.size();
  const uint64_t expected = saturating_product({sizes[0], sizes[1], sizes[2], sizes[3]});
  if (expected > most_grid)
    fail(header_line_,
         "expected a line for each combination of angles, of which there are {}, found {} lines",
         fmt::join(std::span(sizes).first(axes.size()), " x "), lines_.size());
  std::vector<std::pair<uint64_t, const RcsLine*>> places;
  for (const RcsLine& line : lines_) {
    uint64_t place = 0;
    for (size_t i = 0; i < axes.size(); ++i)
      place = place * axes[i].values.size() + axes[i].index(line.angles[i]);
    places.emplace_back(place, &line);
  }
  std::sort(places.begin(), places.end());
  std::vector<const RcsLine*> ordered;
  for (uint64_t i = 0; i < expected; ++i) {
    if (i < places.size() && places[i].first < i)
      fail(places[i].second->line, "{}: expected every direction once, found a second line like {}",
           describe(axes, places[i].first), places[i - 1].second->line);
    if (i == places.size() || places[i].first != i)
      fail(i == 0 ? header_line_ : ordered.back()->line, "{}: expected a line, found none (a gap)",
           describe(axes, i));
    ordered.push_back(places[i].second);
  }
  if (places.size() > expected)
    fail(places[expected].second->line, "{}: expected every direction once, found a second line",
         describe(axes, places[expected].first));
  return ordered;
}

std::vector<rf::ScatterMatrix> RcsParser::samples(const std::vector<RcsAxis>& axes) const {
  std::vector<rf::ScatterMatrix> kept;
  const std::vector<const RcsLine*> all = grid(axes);
  for (uint64_t place = 0; place < all.size(); ++place) {
    uint64_t rest = place;
    bool again = false;
    for (size_t i = axes.size(); i-- > 0;) {
      again |= rest % axes[i].values.size() >= axes[i].kept();
      rest /= axes[i].values.size();
    }
    if (!again) kept.push_back(all[place]->matrix);
  }
  return kept;
}

std::shared_ptr<const rf::RcsTable> RcsParser::parse() {
  CsvReader reader(text_, name_);
  while (const std::optional<CsvLine> line = reader.next()) {
    if (columns_.empty())
      read_header(*line);
    else
      lines_.push_back(read(*line));
    if (lines_.size() > most_rcs_lines)
      line->fail(0, fmt::format("expected at most {} directions, found more", most_rcs_lines));
  }
  if (lines_.empty())
    throw_user_error("{}:{}: expected the scattering of directions, found none", name_, header_line_);
  std::vector<RcsAxis> axes;
  for (size_t angle = 0; angle < angles(); ++angle) axes.push_back(axis(angle));
  const auto grid_of = [&](size_t first) {
    return rf::RcsTable::Grid{static_cast<uint32_t>(axes[first].values.size()),
                              static_cast<uint32_t>(axes[first + 1].kept()),
                              radians(axes[first + 1].values.front())};
  };
  return std::make_shared<rf::RcsTable>(grid_of(0), angles() == 4 ? grid_of(2) : rf::RcsTable::Grid{},
                                        samples(axes), std::filesystem::path(name_).filename().string(),
                                        Sha256().update(text_).hex());
}

}  // namespace

std::shared_ptr<const rf::RcsTable> parse_rcs_csv(std::string_view text, const std::string& name) {
  return RcsParser(text, name).parse();
}

std::shared_ptr<const rf::RcsTable> load_rcs_csv(const std::filesystem::path& file) {
  return parse_rcs_csv(read_csv_file(file, "a table of scattering (theta_deg, phi_deg, ...)"), file.string());
}

}  // namespace greatx::sim
