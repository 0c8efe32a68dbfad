// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
#include "io/formats/packed_columns.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "io/formats/deflate.h"

namespace greatx::io {

namespace {

/// HDF5 keeps the size of a chunk in 32 bits.
constexpr uint64_t most_column_bytes = std::numeric_limits<uint32_t>::max();
/// Deflate never packs more than 1032 bytes into one (zlib's technical notes).
constexpr uint64_t most_deflated = 1032, spare_bytes = 64;
constexpr int64_t most_rows = int64_t{1} << 32;
constexpr const char* components[] = {"x", "y", "z", "intensity"};

bool is_cloud_array(const ArraySpec& array) {
  return array.dtype == DType::f32 && array.shape == std::vector<int64_t>{-1, 4};
}

bool is_plain_name(const std::string& name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Writes the first bytes of all elements, then the second ones, and so on, as HDF5's filter shuffle does.
void shuffle(std::span<const std::byte> values, size_t element, std::vector<std::byte>& out) {
  out.resize(values.size());
  const size_t count = values.size() / element;
  for (size_t byte = 0; byte < element; ++byte) {
    const std::byte* from = values.data() + byte;
    std::byte* const to = out.data() + byte * count;
    for (size_t i = 0; i < count; ++i, from += element) to[i] = *from;
  }
}

void unshuffle(std::span<const std::byte> bytes, size_t element, std::span<std::byte> values) {
  const size_t count = bytes.size() / element;
  for (size_t byte = 0; byte < element; ++byte) {
    const std::byte* const from = bytes.data() + byte * count;
    std::byte* to = values.data() + byte;
    for (size_t i = 0; i < count; ++i, to += element) *to = from[i];
  }
}

template <typename T>
std::span<const std::byte> keep(const std::vector<T>& values, std::vector<std::byte>& buffer) {
  const auto bytes = std::as_bytes(std::span(values));
  buffer.assign(bytes.begin(), bytes.end());
  return buffer;
}

/// Returns differences as u32, or as i64 (modulo 2^64) if one is negative or does not fit.
std::span<const std::byte> code_steps(std::span<const int64_t> values, PackedPlace& place,
                                      std::vector<std::byte>& buffer) {
  if (values.empty()) return {};
  place.first = values[0];
  std::vector<uint64_t> steps(values.size());
  uint64_t all = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    steps[i] = static_cast<uint64_t>(values[i]) - static_cast<uint64_t>(values[i - 1]);
    all |= steps[i];
  }
  if (all > std::numeric_limits<uint32_t>::max()) {
    place.type = static_cast<int64_t>(PackedType::i64);
    return keep(steps, buffer);
  }
  place.type = static_cast<int64_t>(PackedType::u32);
  return keep(std::vector<uint32_t>(steps.begin(), steps.end()), buffer);
}

float multiple(double step, int32_t factor) { return static_cast<float>(step * factor); }

/// Returns values over the step as i16 or i32, or the values themselves if they are not multiples bit by bit.
std::span<const std::byte> code_multiples(std::span<const float> values, double step, PackedPlace& place,
                                          std::vector<std::byte>& buffer) {
  std::vector<int32_t> factors(values.size());
  bool small = true;
  for (size_t i = 0; i < values.size(); ++i) {
    const double factor = std::nearbyint(values[i] / step);
    const bool fits = std::abs(factor) <= std::numeric_limits<int32_t>::max();  // false for NaN
    if (fits) factors[i] = static_cast<int32_t>(factor);
    const float back = multiple(step, factors[i]);
    if (!fits || std::memcmp(&back, &values[i], sizeof back) != 0) {
      place.type = static_cast<int64_t>(PackedType::declared);
      return std::as_bytes(values);
    }
    small = small && factors[i] == static_cast<int16_t>(factors[i]);
  }
  place.type = static_cast<int64_t>(small ? PackedType::i16 : PackedType::i32);
  if (!small) return keep(factors, buffer);
  return keep(std::vector<int16_t>(factors.begin(), factors.end()), buffer);
}

bool may_have(const PackedColumn& column, int64_t type) {
  const auto is = [type](PackedType wanted) { return type == static_cast<int64_t>(wanted); };
  switch (column.coding) {
    case PackedColumn::Coding::plain:
      return is(PackedType::declared);
    case PackedColumn::Coding::steps:
      return is(PackedType::u32) || is(PackedType::i64);
    case PackedColumn::Coding::multiples:
      return is(PackedType::i16) || is(PackedType::i32) || is(PackedType::declared);
  }
  return false;
}

template <typename Stored>
void add_steps(std::span<const std::byte> bytes, int64_t first, std::span<int64_t> values) {
  auto value = static_cast<uint64_t>(first);
  for (size_t i = 0; i < values.size(); ++i) {
    Stored step = 0;
    std::memcpy(&step, bytes.data() + i * sizeof step, sizeof step);
    value += step;
    values[i] = static_cast<int64_t>(value);
  }
}

template <typename Stored>
void multiply(std::span<const std::byte> bytes, double step, std::span<float> values) {
  for (size_t i = 0; i < values.size(); ++i) {
    Stored factor = 0;
    std::memcpy(&factor, bytes.data() + i * sizeof factor, sizeof factor);
    values[i] = multiple(step, factor);
  }
}

}  // namespace

uint64_t PackedColumn::row_elements() const {
  uint64_t elements = 1;
  for (size_t axis = varies() ? 1 : 0; axis < shape.size(); ++axis)
    elements *= static_cast<uint64_t>(shape[axis]);
  return elements;
}

size_t size_of(PackedType type, DType declared) {
  switch (type) {
    case PackedType::u32:
    case PackedType::i32:
      return 4;
    case PackedType::i64:
      return 8;
    case PackedType::i16:
      return 2;
    case PackedType::declared:
      break;
  }
  return size_of(declared);
}

std::vector<PackedColumn> packed_columns(std::span<const ArraySpec> arrays) {
  std::vector<PackedColumn> columns;
  for (size_t i = 0; i < arrays.size(); ++i) {
    const ArraySpec& array = arrays[i];
    using Coding = PackedColumn::Coding;
    if (is_cloud_array(array)) {
      for (int c = 0; c < 4; ++c) {
        const Coding coding = c < 3 && array.step > 0.0 ? Coding::multiples : Coding::plain;
        columns.push_back({array.name + "/" + components[c],
                           i,
                           c,
                           coding,
                           array.dtype,
                           {-1},
                           coding == Coding::multiples ? array.step : 0.0,
                           c < 3 ? array.unit : "1"});
      }
    } else if (array.dtype == DType::i64 && array.shape == std::vector<int64_t>{-1}) {
      columns.push_back(
          {array.name + "_steps", i, -1, Coding::steps, array.dtype, array.shape, 0.0, array.unit});
    } else {
      columns.push_back({array.name, i, -1, Coding::plain, array.dtype, array.shape, 0.0, array.unit});
    }
  }
  return columns;
}

std::string fault_of_packed(std::span<const ArraySpec> arrays) {
  for (const ArraySpec& array : arrays) {
    if (!is_plain_name(array.name))
      return fmt::format("\"{}\": expected a name of letters, digits and '_'", array.name);
    if (array.dtype == DType::complex64) return fmt::format("{}: complex numbers are not packed", array.name);
    uint64_t bytes = size_of(array.dtype);
    for (const int64_t extent : array.shape)
      if (extent >= 0) bytes *= static_cast<uint64_t>(extent);  // at most largest_array
    if (bytes == 0 || bytes > most_column_bytes)
      return fmt::format("{}: expected rows of 1 to {} bytes, found {}", array.name, most_column_bytes,
                         bytes);
  }
  std::set<std::string> names;
  for (const PackedColumn& column : packed_columns(arrays)) {
    // A group "points" holds points/x; "t_first" lies beside "t_steps".
    std::vector<std::string> taken{column.name.substr(0, column.name.find('/'))};
    if (column.component > 0) taken.clear();
    if (column.coding == PackedColumn::Coding::steps) taken.push_back(arrays[column.array].name + "_first");
    for (const std::string& name : taken)
      if (!names.insert(name).second) return fmt::format("two arrays would share the name {}", name);
  }
  return {};
}

PackedPlace pack_column(const PackedColumn& column, const Array& array, int level, Bytes& out) {
  PackedPlace place{static_cast<int64_t>(out.size())};
  place.rows = column.varies() ? array.shape[0] : 1;
  thread_local std::vector<std::byte> coded, shuffled;
  std::span<const std::byte> values = array.bytes;
  std::vector<float> component;
  if (column.component >= 0) {
    const std::span<const float> rows = array.as<float>();
    component.resize(rows.size() / 4);
    for (size_t i = 0; i < component.size(); ++i)
      component[i] = rows[4 * i + static_cast<size_t>(column.component)];
    values = std::as_bytes(std::span(component));
  }
  if (column.coding == PackedColumn::Coding::steps) {
    place.type = static_cast<int64_t>(PackedType::u32);
    values = code_steps(array.as<int64_t>(), place, coded);
  } else if (column.coding == PackedColumn::Coding::multiples) {
    values = code_multiples(component, column.step, place, coded);
  }
  if (values.empty()) return place;
  if (values.size() > most_column_bytes)
    throw_user_error("{}: expected at most {} bytes in a record of a compressed data set, found {}",
                     column.name, most_column_bytes, values.size());
  const size_t element = size_of(static_cast<PackedType>(place.type), column.dtype);
  if (element > 1) {
    shuffle(values, element, shuffled);
    values = shuffled;
  }
  append_deflated(values, level, out);
  place.bytes = static_cast<int64_t>(out.size()) - place.offset;
  return place;
}

void check_place(const PackedColumn& column, const PackedPlace& place, uint64_t file_bytes,
                 const std::string& name) {
  const auto fail = [&](const std::string& expected, int64_t found) {
    throw_user_error("{}: {}: expected {}, found {}", name, column.name, expected, found);
  };
  if (!may_have(column, place.type)) fail("a type that the column may have", place.type);
  if (place.rows < 0 || place.rows > most_rows || (!column.varies() && place.rows != 1))
    fail(column.varies() ? "a number of rows" : "1 row", place.rows);
  const uint64_t element = size_of(static_cast<PackedType>(place.type), column.dtype);
  uint64_t plain = 0, declared = 0;
  const uint64_t rows = static_cast<uint64_t>(place.rows);
  if (__builtin_mul_overflow(rows, column.row_elements() * element, &plain) || plain > most_column_bytes ||
      __builtin_mul_overflow(rows, column.row_elements() * size_of(column.dtype), &declared) ||
      declared > uint64_t{4} << 30)
    fail(fmt::format("a record of at most {} bytes", most_column_bytes), place.rows);
  const auto offset = static_cast<uint64_t>(place.offset), bytes = static_cast<uint64_t>(place.bytes);
  if (place.offset < 0 || place.bytes < 0 || offset > file_bytes || bytes > file_bytes - offset)
    fail(fmt::format("packed bytes within the {} of the file", file_bytes), place.offset);
  if ((plain == 0) != (bytes == 0) || plain > bytes * most_deflated + (bytes > 0 ? spare_bytes : 0))
    fail(fmt::format("packed bytes of {} rows", place.rows), place.bytes);
}

Array unpack_column(const PackedColumn& column, const PackedPlace& place, std::span<const std::byte> packed,
                    const std::string& name) {
  std::vector<int64_t> shape = column.shape;
  if (column.varies()) shape[0] = place.rows;
  Array array(column.dtype, shape);
  if (array.bytes.empty()) return array;
  const auto type = static_cast<PackedType>(place.type);
  const size_t element = size_of(type, column.dtype);
  const size_t size = static_cast<size_t>(array.element_count()) * element;
  thread_local std::vector<std::byte> inflated, coded;
  const bool in_place = element == 1 && type == PackedType::declared;
  if (!in_place) inflated.resize(size);
  const std::span<std::byte> to = in_place ? std::span(array.bytes) : std::span(inflated);
  if (!inflate_exactly(packed, to))
    throw_user_error("{}: {}: expected {} bytes that unpack to {}", name, column.name, packed.size(), size);
  if (in_place) return array;
  if (type == PackedType::declared) {
    unshuffle(inflated, element, array.bytes);
    return array;
  }
  coded.resize(size);
  unshuffle(inflated, element, coded);
  if (type == PackedType::u32)
    add_steps<uint32_t>(coded, place.first, array.as<int64_t>());
  else if (type == PackedType::i64)
    add_steps<uint64_t>(coded, place.first, array.as<int64_t>());
  else if (type == PackedType::i16)
    multiply<int16_t>(coded, column.step, array.as<float>());
  else
    multiply<int32_t>(coded, column.step, array.as<float>());
  return array;
}

}  // namespace greatx::io
