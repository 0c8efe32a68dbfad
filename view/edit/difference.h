// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// How the records of one tick differ between two settings of a scenario: the error of a faster setting, or
// the effect of a change.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dataset/dataset_format.h"
#include "view/run/run.h"

namespace greatx::view {

/// The difference of one array of one sensor.
struct Difference {
  std::string sensor;  ///< "csi"
  std::string array;   ///< "cfr"
  bool equal = false;  ///< byte by byte
  /// In words with units: "-52.3 dB", "0.4 % of pixels, 12 at most". Empty if equal.
  std::string text;
  /// Of complex arrays: 10 log10(sum |b - a|^2 / sum |a|^2), dB.
  std::optional<double> error_db;
};

/// Compares two arrays of one meaning, `a` before and `b` after. Bytes are compared by pixel; complex numbers
/// by their error relative to the power of `a`; floating-point numbers by their mean and largest difference
/// where both are finite, and by the count of places where only one is. Arrays of other sizes are compared by
/// their first axis alone.
Difference difference(const ArraySpec& spec, const Array& a, const Array& b);

/// Compares the records of one tick. Sensors and arrays are matched by name; those that only one side has are
/// told of by a row. Sensors without a record at the tick are left out.
std::vector<Difference> differences(const io::DatasetInfo& before, const ShownTick& a,
                                    const io::DatasetInfo& after, const ShownTick& b);

}  // namespace greatx::view
