// SPDX-FileCopyrightText: 2026 The greatx authors
// SPDX-License-Identifier: Apache-2.0
//
// Computes the fields of paths for the values of a fit, and how they change with each value.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "rf/gradient/path_slopes.h"
#include "rf/surface/surfaces.h"
#include "sim/fit/links.h"

namespace greatx::sim {

/// The field of one path as Path::transfer, or its derivative by a parameter.
using FitTransfer = std::array<rf::Complex, 4>;

/// The paths of a link whose field depends on parameters, in the order of FitLink::touched.
struct FitFields {
  std::vector<FitTransfer> transfers;            ///< [touched]
  std::vector<std::vector<FitTransfer>> slopes;  ///< [touched][its parameters]; empty if not asked for
};

/// Computes fields and their slopes for one set of values. The slopes are the exact derivatives of the field
/// (rf/gradient/path_slopes.h); a value that several materials share has the sum of theirs. Thread-safe once
/// made.
class TransferSlopes {
 public:
  /// `values`: [parameters].
  TransferSlopes(const FitMaterials& materials, std::span<const FitParameter> parameters,
                 std::span<const double> values, bool slopes);
  FitFields of(const FitLink& link) const;

 private:
  rf::RadioSurfaces surfaces_;
  std::vector<std::vector<rf::ChannelParameter>>
      of_parameter_;  ///< [parameters][materials]; empty: no slopes
};

}  // namespace greatx::sim
