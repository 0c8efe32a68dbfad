// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "view/overlay/record_arrays.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/budget.h"
#include "core/error.h"

namespace greatx::view {

namespace {

std::string form(DType dtype, const std::vector<int64_t>& shape) {
  std::vector<std::string> axes;
  for (const int64_t extent : shape) axes.push_back(extent < 0 ? "n" : std::to_string(extent));
  return fmt::format("{} [{}]", numpy_name(dtype), fmt::join(axes, ", "));
}

/// Whether the array has the bytes that its shape says.
bool is_whole(const Array& array) {
  uint64_t bytes = size_of(array.dtype);
  for (const int64_t extent : array.shape) {
    if (extent < 0) return false;
    bytes = saturating_product({bytes, static_cast<uint64_t>(extent)});
  }
  return bytes == array.bytes.size();
}

bool fits(const Array& array, DType dtype, const std::vector<int64_t>& shape) {
  return array.dtype == dtype && std::ranges::equal(array.shape, shape, [](int64_t found, int64_t wanted) {
           return wanted < 0 || found == wanted;
         });
}

template <typename T>
size_t first_not_finite(std::span<const T> values) {
  size_t at = 0;
  while (at < values.size() && std::isfinite(values[at])) ++at;
  return at;
}

}  // namespace

RecordArrays::RecordArrays(const SensorSpec& spec, const Record& record) : spec_(spec), record_(record) {
  if (record.arrays.size() != spec.arrays.size())
    throw_user_error("{}: tick {}: expected {} arrays, found {}", spec.name, record.tick, spec.arrays.size(),
                     record.arrays.size());
}

const Array* RecordArrays::find(std::string_view name) const {
  const auto spec = std::ranges::find(spec_.arrays, name, &ArraySpec::name);
  if (spec == spec_.arrays.end()) return nullptr;
  const Array& array = record_.arrays[static_cast<size_t>(spec - spec_.arrays.begin())];
  return array.shape.empty() && array.bytes.empty() ? nullptr : &array;
}

bool RecordArrays::has(std::string_view name) const { return find(name) != nullptr; }

int64_t RecordArrays::rows(std::string_view name) const {
  const Array* const array = find(name);
  if (array == nullptr || array->shape.empty()) fail(name, "an array of rows", array ? "a number" : "none");
  return array->shape[0];
}

void RecordArrays::fail(std::string_view name, std::string_view expected, std::string_view found) const {
  throw_user_error("{}: {}, tick {}: expected {}, found {}", spec_.name, name, record_.tick, expected, found);
}

const Array& RecordArrays::checked(std::string_view name, DType dtype,
                                   const std::vector<int64_t>& shape) const {
  const Array* const array = find(name);
  if (array == nullptr) fail(name, form(dtype, shape), "none");
  if (!fits(*array, dtype, shape)) fail(name, form(dtype, shape), form(array->dtype, array->shape));
  if (!is_whole(*array))
    fail(name, form(array->dtype, array->shape), fmt::format("{} bytes", array->bytes.size()));
  return *array;
}

void RecordArrays::expect_finite(std::string_view name, std::span<const float> values) const {
  if (const size_t at = first_not_finite(values); at < values.size())
    fail(name, "finite values", fmt::format("{} in element {}", values[at], at));
}

void RecordArrays::expect_finite(std::string_view name, std::span<const double> values) const {
  if (const size_t at = first_not_finite(values); at < values.size())
    fail(name, "finite values", fmt::format("{} in element {}", values[at], at));
}

}  // namespace greatx::view
