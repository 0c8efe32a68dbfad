// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/edit/difference.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "core/array_numbers.h"

namespace greatx::view {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Returns element i as a number, whatever the type; NaN for complex ones.
double element(const Array& array, size_t i) {
  return array.dtype == DType::complex64 ? none : number_at(array, i);
}

void compare_complex(const Array& a, const Array& b, Difference& row) {
  const auto x = a.as<std::complex<float>>(), y = b.as<std::complex<float>>();
  double error = 0.0, power = 0.0;
  for (size_t i = 0; i < x.size(); ++i) {
    const std::complex<double> before(x[i]), after(y[i]);
    error += std::norm(after - before);
    power += std::norm(before);
  }
  row.error_db = power > 0.0 ? 10.0 * std::log10(error / power) : std::numeric_limits<double>::infinity();
  row.text = power > 0.0 ? fmt::format("error {:.1f} dB of its power", *row.error_db)
                         : std::string("it was zero before");
}

/// Counts of the elements of two arrays.
struct Counts {
  size_t differ = 0, both = 0, one_sided = 0;
  double sum = 0.0, most = 0.0;
};

Counts count(const Array& a, const Array& b, size_t elements) {
  Counts counts;
  for (size_t i = 0; i < elements; ++i) {
    const double x = element(a, i), y = element(b, i);
    if (std::isfinite(x) != std::isfinite(y)) ++counts.one_sided;
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    const double delta = std::abs(y - x);
    ++counts.both;
    counts.differ += delta > 0.0 ? 1 : 0;
    counts.sum += delta;
    counts.most = std::max(counts.most, delta);
  }
  return counts;
}

bool is_real(DType type) { return type == DType::f32 || type == DType::f64; }

std::string unit_after(const std::string& unit) { return unit.empty() || unit == "1" ? "" : " " + unit; }

}  // namespace

Difference difference(const ArraySpec& spec, const Array& a, const Array& b) {
  Difference row;
  row.array = spec.name;
  row.equal = a.dtype == b.dtype && a.shape == b.shape && a.bytes == b.bytes;
  if (row.equal) return row;
  if (a.dtype != b.dtype || a.shape != b.shape) {
    const int64_t before = a.shape.empty() ? 1 : a.shape[0], after = b.shape.empty() ? 1 : b.shape[0];
    row.text = before != after ? fmt::format("{} instead of {}", after, before) : std::string("other sizes");
    return row;
  }
  if (a.dtype == DType::complex64) {
    compare_complex(a, b, row);
    return row;
  }
  const auto elements = static_cast<size_t>(a.element_count());
  const Counts counts = count(a, b, elements);
  const double share = 100.0 * static_cast<double>(counts.differ) / static_cast<double>(elements);
  row.text = fmt::format("{:.3g} % differ", share);
  if (is_real(a.dtype) || a.dtype == DType::u8) {
    const std::string unit = a.dtype == DType::u8 ? " of 255" : unit_after(spec.unit);
    const double mean = counts.both > 0 ? counts.sum / static_cast<double>(counts.both) : 0.0;
    row.text += fmt::format(", by {:.3g}{} on average, {:.3g}{} at most", mean, unit, counts.most, unit);
  }
  if (counts.one_sided > 0) row.text += fmt::format("; {} have a value on one side alone", counts.one_sided);
  return row;
}

std::vector<Difference> differences(const io::DatasetInfo& before, const ShownTick& a,
                                    const io::DatasetInfo& after, const ShownTick& b) {
  std::vector<Difference> rows;
  const auto find = [](const io::DatasetInfo& info, const std::string& name) {
    const auto found = std::ranges::find(info.sensors, name, &SensorSpec::name);
    return found == info.sensors.end() ? info.sensors.size()
                                       : static_cast<size_t>(found - info.sensors.begin());
  };
  const auto record = [](const ShownTick& tick, size_t sensor) -> const Record* {
    const auto found = std::ranges::find(tick.packet.records, sensor, &Record::sensor);
    return found == tick.packet.records.end() ? nullptr : &*found;
  };
  for (size_t i = 0; i < before.sensors.size(); ++i) {
    const SensorSpec& spec = before.sensors[i];
    const size_t j = find(after, spec.name);
    if (j == after.sensors.size()) {
      rows.push_back({spec.name, "", false, "is gone", {}});
      continue;
    }
    const Record *const x = record(a, i), *const y = record(b, j);
    if (x == nullptr || y == nullptr) continue;
    for (size_t k = 0; k < spec.arrays.size(); ++k) {
      const auto other = std::ranges::find(after.sensors[j].arrays, spec.arrays[k].name, &ArraySpec::name);
      if (other == after.sensors[j].arrays.end()) {
        rows.push_back({spec.name, spec.arrays[k].name, false, "is gone", {}});
        continue;
      }
      const auto place = static_cast<size_t>(other - after.sensors[j].arrays.begin());
      rows.push_back(difference(spec.arrays[k], x->arrays[k], y->arrays[place]));
      rows.back().sensor = spec.name;
    }
  }
  for (const SensorSpec& spec : after.sensors)
    if (find(before, spec.name) == before.sensors.size())
      rows.push_back({spec.name, "", false, "is new", {}});
  return rows;
}

}  // namespace greatx::view
