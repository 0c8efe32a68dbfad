// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the fields of paths for the values of a fit, and how they change with each value.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rf/surface/surfaces.h"
#include "sim/fit/links.h"

namespace greatx::sim {

/// The field of one path as Path::transfer, or its derivative by a parameter.
using FitTransfer = std::array<rf::Complex, 4>;

/// The paths of a link whose field depends on parameters, in the order of FitLink::touched.
struct FitFields {
  std::vector<FitTransfer> transfers;             ///< [touched]
  std::vector<std::vector<FitTransfer>> slopes;   ///< [touched][its parameters]; empty if not asked for
};

/// Computes fields and their slopes for one set of values. Thread-safe once made.
///
/// The slopes are central differences of path_transfer() in fp64, with a step of 1e-5 of the value (and at
/// least 1e-7 of its unit), and one-sided at the end of a property's range. Their error is of the order of
/// 1e-9 of the slope; it slows the last digits of a fit and moves no minimum.
class TransferSlopes {
 public:
  /// `materials` outlives this. `values`: [parameters].
  TransferSlopes(const FitMaterials& materials, std::span<const FitProperty> properties,
                 std::span<const double> values, bool slopes);
  FitFields of(const FitLink& link) const;

 private:
  struct Step {
    rf::RadioSurfaces below, above;
    double width = 0.0;
  };
  rf::RadioSurfaces surfaces_;
  std::vector<Step> steps_;  ///< [parameters]; empty without slopes
};

}  // namespace greatx::sim
