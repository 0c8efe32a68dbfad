// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Arrays of a record by name, checked. Records may come from files, so nothing about them is believed.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "core/record.h"

namespace greatx::view {

class RecordArrays {
 public:
  /// Both must outlive this. Throws UserError unless the record has the arrays that the sensor declares.
  RecordArrays(const SensorSpec& spec, const Record& record);

  /// Whether the sensor delivers the array and the record holds it. An array without shape and bytes counts
  /// as left out.
  bool has(std::string_view name) const;
  /// The elements of the array. -1 in `shape` stands for any extent. Throws UserError "SENSOR: ARRAY, tick N:
  /// expected <f4 [n, 4], found ..." if it is not there, or is not of this type and shape.
  template <typename T>
  std::span<const T> get(std::string_view name, const std::vector<int64_t>& shape) const {
    return checked(name, DTypeOf<T>::value, shape).template as<T>();
  }
  /// The same, of finite numbers alone.
  template <typename T>
  std::span<const T> finite(std::string_view name, const std::vector<int64_t>& shape) const {
    const std::span<const T> values = get<T>(name, shape);
    expect_finite(name, values);
    return values;
  }
  /// The first extent of an array of any type.
  int64_t rows(std::string_view name) const;
  /// Throws UserError: "SENSOR: ARRAY, tick N: expected ..., found ...".
  [[noreturn]] void fail(std::string_view name, std::string_view expected, std::string_view found) const;

 private:
  const Array* find(std::string_view name) const;
  const Array& checked(std::string_view name, DType dtype, const std::vector<int64_t>& shape) const;
  void expect_finite(std::string_view name, std::span<const float> values) const;
  void expect_finite(std::string_view name, std::span<const double> values) const;

  const SensorSpec& spec_;
  const Record& record_;
};

}  // namespace greatx::view
